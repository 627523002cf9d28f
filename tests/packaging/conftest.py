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
        """The path of the interpreter."""
        return str(next(self.programs.glob("python*")))

    def variables(self) -> dict[str, str]:
        """Return environment variables with which a process finds these programs first."""
        inherited = {key: value for key, value in os.environ.items() if key != "PYTHONPATH"}
        path = os.pathsep.join([str(self.programs), inherited["PATH"]])
        return {**inherited, "PATH": path, "VIRTUAL_ENV": str(self.folder)}


@pytest.fixture(scope="session")
def dist(tmp_path_factory) -> Path:
    """A folder with the source distribution and the wheel that was built from it."""
    folder = tmp_path_factory.mktemp("dist")
    run = [sys.executable, "-m", "build", "--no-isolation", "--outdir", str(folder), str(ROOT)]
    result = subprocess.run(run, capture_output=True, text=True)
    assert result.returncode == 0, result.stdout + result.stderr
    return folder


@pytest.fixture(scope="session")
def environment(dist, tmp_path_factory) -> Environment:
    """An environment in which the wheel and its dependencies are installed."""
    folder = tmp_path_factory.mktemp("plain") / "env"
    subprocess.run([sys.executable, "-m", "venv", str(folder)], check=True)
    environment = Environment(folder)
    (wheel,) = dist.glob("*.whl")
    pip = [environment.python, "-m", "pip", "install", "--quiet", "--disable-pip-version-check"]
    subprocess.run([*pip, str(wheel)], check=True, env=environment.variables())
    return environment
