"""A wheel with compiled modules (docs/decisions/0021, 0028), built and unpacked to be measured."""

import os
import subprocess
import sys
import zipfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

ROOT = Path(__file__).parents[1]


def unpacked(folder: Path) -> Path:
    """Build the wheel into a folder; the folder that has its packages.

    Raises CalledProcessError where mypyc, setuptools or a C compiler is missing.
    """
    run = [sys.executable, "-m", "build", "--wheel", "--no-isolation", "--outdir", str(folder)]
    env = {**os.environ, "SYSMLC_COMPILED": "1"}
    done = subprocess.run([*run, str(ROOT)], capture_output=True, text=True, env=env)
    if done.returncode:
        print(done.stdout[-2000:], done.stderr[-2000:], file=sys.stderr)
    done.check_returncode()
    (wheel,) = folder.glob("*.whl")
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(folder / "packages")
    return folder / "packages"


@contextmanager
def first_on_path(folder: Path) -> Iterator[None]:
    """Let processes that are started here import the packages of a folder before all others."""
    before = os.environ.get("PYTHONPATH")
    os.environ["PYTHONPATH"] = str(folder)
    try:
        yield
    finally:
        if before is None:
            del os.environ["PYTHONPATH"]
        else:
            os.environ["PYTHONPATH"] = before
