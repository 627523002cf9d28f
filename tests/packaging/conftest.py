"""The distributions of the package, and an environment into which only the wheel is installed."""

import os
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


@dataclass(frozen=True)
class Environment:
    """A virtual environment with the package and its dependencies, without any extra."""

    folder: Path

    @property
    def programs(self) -> Path:
        """The folder of the interpreter and of the command ``sysmlc``."""
        return next(self.folder.glob("[bS]*/python*")).parent

    @property
    def python(self) -> str:
        """The interpreter."""
        return str(next(self.programs.glob("python*")))

    def variables(self) -> dict[str, str]:
        """Variables of processes that find the programs of this environment first."""
        inherited = {key: value for key, value in os.environ.items() if key != "PYTHONPATH"}
        path = os.pathsep.join([str(self.programs), inherited["PATH"]])
        return {**inherited, "PATH": path, "VIRTUAL_ENV": str(self.folder)}


@pytest.fixture(scope="session")
def dist(tmp_path_factory) -> Path:
    """A folder with the source distribution and the wheel that was built from it."""
    folder = tmp_path_factory.mktemp("dist")
    run = [sys.executable, "-m", "build", "--no-isolation", "--outdir", str(folder), str(ROOT)]
    done = subprocess.run(run, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    return folder


@pytest.fixture(scope="session")
def environment(dist, tmp_path_factory) -> Environment:
    """An environment after ``pip install`` of the wheel, which needs the package index."""
    folder = tmp_path_factory.mktemp("plain") / "env"
    subprocess.run([sys.executable, "-m", "venv", str(folder)], check=True)
    made = Environment(folder)
    (wheel,) = dist.glob("*.whl")
    pip = [made.python, "-m", "pip", "install", "--quiet", "--disable-pip-version-check"]
    subprocess.run([*pip, str(wheel)], check=True, env=made.variables())
    return made
