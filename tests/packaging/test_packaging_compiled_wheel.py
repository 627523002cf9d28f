"""A wheel with compiled modules reads plants as Python does, and passes the same tests."""

import os
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
pytestmark = pytest.mark.slow

DIGESTS = """
import sys
from hashlib import sha256
from pathlib import Path
from sysmlc.driver import Request, compile_model
from sysmlc.ir import graph, text
from sysmlc.frontends.caex import pieces

if sys.argv[1] == "compiled":
    assert {graph.__file__[-3:], pieces.__file__[-3:]} == {".so"}, graph.__file__
for name in sys.argv[2:]:
    made = compile_model(Request((Path(name),)))
    told = "".join(f"{one.rule.code} {one.message}\\n" for one in made.diagnostics)
    said = text.print_text(made.graph)
    print(Path(name).name, sha256((told + said).encode()).hexdigest())
"""
ON_COMPILED = (
    "tests/frontends/caex",
    "tests/ir/test_ir_graph.py",
    "tests/ir/test_ir_references.py",
)
"""Tests that are run on the compiled modules, too."""


def packages(folder):
    """The folder that the wheel was unpacked into."""
    run = [sys.executable, "-m", "build", "--wheel", "--no-isolation", "--outdir", str(folder)]
    env = {**os.environ, "SYSMLC_COMPILED": "1"}
    done = subprocess.run([*run, str(ROOT)], capture_output=True, text=True, env=env)
    assert done.returncode == 0, done.stdout[-3000:] + done.stderr[-3000:]
    (wheel,) = folder.glob("*.whl")
    assert not wheel.name.endswith("none-any.whl")
    zipfile.ZipFile(wheel).extractall(folder / "packages")
    return folder / "packages"


def environment(packages=None):
    env = {key: value for key, value in os.environ.items() if key != "PYTHONPATH"}
    return env if packages is None else {**env, "PYTHONPATH": str(packages)}


def models():
    """Plants of the examples, and of the corpus where it is."""
    folders = [ROOT / "examples"]
    corpus = os.environ.get("SYSMLC_CORPUS")
    if corpus:
        folders += [Path(corpus) / "aml" / name for name in ("dev", "bad", "baygate")]
    found = (path for folder in folders for path in sorted(folder.rglob("*")))
    return [str(path) for path in found if path.suffix in (".aml", ".amlx")]


def read_by(which, env):
    """Digests of the graphs and findings of all plants, one a line."""
    run = [sys.executable, "-c", DIGESTS, which, *models()]
    done = subprocess.run(run, capture_output=True, text=True, env=env)
    assert done.returncode == 0, done.stderr[-3000:]
    return done.stdout.splitlines()


def test_it_reads_all_plants_as_python_does_and_passes_the_tests_of_what_is_compiled(tmp_path):
    """One test, for the wheel takes most of the time, and tests may run in several processes."""
    env = environment(packages(tmp_path))
    assert read_by("compiled", env) == read_by("python", environment())
    run = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", *ON_COMPILED]
    done = subprocess.run(run, capture_output=True, text=True, cwd=ROOT, env=env)
    assert done.returncode == 0, done.stdout[-3000:]
