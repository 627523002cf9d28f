"""Golden files: ``golden`` compares texts with a folder, ``--update-golden`` writes the folder.

Tests of real models carry the mark ``corpus`` and are skipped unless SYSMLC_CORPUS names a folder.
In continuous integration (CI), a test that needs PlantUML may not be skipped, and with
SYSMLC_CORPUS no test of real models either: such a skip is reported as a failure.
"""

import difflib
import gc
import os
import shutil
from collections.abc import Mapping
from pathlib import Path

import pytest
from hypothesis import settings

import plantuml_jar
from long_runs import examples

os.environ["SYSMLC_CACHE"] = "off"
"""Without the cache, a test sees what the code does and not the result of an earlier run."""

settings.register_profile(
    "sysmlc", deadline=None, derandomize="CI" in os.environ, max_examples=examples(100)
)
settings.load_profile("sysmlc")
"""No test asserts on time; continuous integration tries the same examples in every run."""

GOLDEN = Path(__file__).parent / "golden"
_MAX_DIFFERENCE_LINES = 80
"""Lines of one difference that a failure prints."""
_GARBAGE = 1_000_000
"""Objects that a worker may create before it collects garbage."""


gc.disable()
"""The automatic garbage collection is off; ``collect_garbage`` collects between modules.

What survives a collection, such as libraries, is omitted from later ones.
A worker holds millions of objects: imported modules, thousands of tests, cached libraries. The
interpreter would traverse all of them again and again, which takes a third of the run.
"""


def pytest_collection_finish():
    """Omit modules and tests from later garbage collections."""
    gc.collect()
    gc.freeze()


@pytest.fixture(autouse=True, scope="module")
def collect_garbage():
    yield
    if gc.get_count()[0] > _GARBAGE:
        gc.collect()
        gc.freeze()


def pytest_addoption(parser):
    parser.addoption(
        "--update-golden",
        action="store_true",
        help="write the golden files again and show the differences",
    )


class Golden:
    """Compares the files that a test produces with the folder ``tests/golden/<name>``."""

    def __init__(self, update: bool, show) -> None:
        self._update = update
        self._show = show

    def check(self, name: str, files: Mapping[str, str]) -> None:
        """Fail if a file is missing, unexpected or different; with ``--update-golden``, write."""
        folder = GOLDEN / name
        golden_files = _read_files(folder)
        differences = [
            text
            for path in sorted(golden_files.keys() | files.keys())
            if (text := _diff_file(path, golden_files.get(path, ""), files.get(path, "")))
        ]
        if self._update:
            self._write(folder, files, golden_files)
            self._show("\n".join(differences))
        elif differences:
            hint = "if this is right: pytest --update-golden, then read the difference\n"
            pytest.fail(hint + "\n".join(differences), pytrace=False)

    def _write(
        self, folder: Path, files: Mapping[str, str], golden_files: Mapping[str, str]
    ) -> None:
        for path in golden_files.keys() - files.keys():
            (folder / path).unlink()
        for path, text in files.items():
            (folder / path).parent.mkdir(parents=True, exist_ok=True)
            (folder / path).write_bytes(text.encode("utf-8"))


def _read_files(folder: Path) -> dict[str, str]:
    return {
        path.relative_to(folder).as_posix(): path.read_bytes().decode("utf-8")
        for path in sorted(folder.rglob("*"))
        if path.is_file()
    }


def _diff_file(path: str, old: str, new: str) -> str:
    lines = list(
        difflib.unified_diff(
            old.splitlines(), new.splitlines(), f"golden/{path}", f"now/{path}", lineterm=""
        )
    )
    rest = (
        f"\n... {len(lines) - _MAX_DIFFERENCE_LINES} more lines"
        if len(lines) > _MAX_DIFFERENCE_LINES
        else ""
    )
    return "\n".join(lines[:_MAX_DIFFERENCE_LINES]) + rest


@pytest.fixture
def golden(request):
    """Return the golden files, to compare with or to write."""
    terminal = request.config.get_terminal_writer()
    return Golden(request.config.getoption("--update-golden"), terminal.line)


def pytest_runtest_setup(item):
    if item.get_closest_marker("corpus") and not os.environ.get("SYSMLC_CORPUS"):
        pytest.skip("SYSMLC_CORPUS is not set")
    if item.get_closest_marker("nusmv") and not (shutil.which("NuSMV") or shutil.which("nuXmv")):
        pytest.skip("NuSMV and nuXmv are not installed")


@pytest.fixture(scope="session")
def corpus() -> Path:
    """Return the folder with real models; a test that uses it has the mark ``corpus``."""
    return Path(os.environ["SYSMLC_CORPUS"])


@pytest.fixture(scope="session")
def plantuml(tmp_path_factory) -> plantuml_jar.PlantUml:
    """Return real PlantUML; a test that uses it has the mark ``plantuml``."""
    if missing := plantuml_jar.list_missing_tools():
        pytest.skip(f"PlantUML cannot run without {missing}")
    return plantuml_jar.PlantUml(tmp_path_factory.mktemp("plantuml"))


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(item, call):
    report = yield
    if report.skipped and not hasattr(report, "wasxfail") and must_run(item):
        report.outcome = "failed"
        report.longrepr = f"{item.nodeid} may not be skipped here: {report.longrepr}"
    return report


@pytest.hookimpl(wrapper=True)
def pytest_make_collect_report(collector):
    report = yield
    if report.skipped and runs_in_ci_with_corpus():
        report.outcome = "failed"
        report.longrepr = f"{collector.nodeid} may not be skipped here: {report.longrepr}"
    return report


def runs_in_ci_with_corpus() -> bool:
    """Whether the tests run in continuous integration with the corpus."""
    return bool(os.environ.get("CI") and os.environ.get("SYSMLC_CORPUS"))


def must_run(item) -> bool:
    """Whether the environment requires the test, so that a skip of it is a failure."""
    if item.get_closest_marker("nusmv"):
        return False
    if item.get_closest_marker("corpus"):
        return runs_in_ci_with_corpus()
    return bool(item.get_closest_marker("plantuml") and os.environ.get("CI"))


def pytest_terminal_summary(terminalreporter):
    """Report in one line that tests of real models were skipped."""
    skips = terminalreporter.stats.get("skipped", [])
    count = sum("corpus" in report.keywords for report in skips)
    if count and not os.environ.get("SYSMLC_CORPUS"):
        terminalreporter.line(
            f"tests of real models were skipped ({count}): SYSMLC_CORPUS is not set"
        )
