"""A project that may be hostile, files outside of it, and the command line in it."""

from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from sysmlc.cli import group

MODEL = """\
Package pkg "Plant"
  Class gate "Gate"
    Port gate.in "in"
"""


class Project:
    """The project root ``folder`` with a model; ``outside`` is a folder that is no part of it."""

    def __init__(self, folder: Path, outside: Path) -> None:
        self.folder = folder
        self.outside = outside

    def write(self, name: str, text: str = MODEL) -> Path:
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
        return path

    def run(self, *arguments: str) -> Result:
        """Run ``sysmlc`` in the project root."""
        return CliRunner().invoke(group.sysmlc, list(arguments), catch_exceptions=False)

    def snapshot(self, folder: Path | None = None) -> dict[str, bytes | None]:
        """Return path and content of everything below *folder* (None: not a regular file)."""
        folder = folder or self.outside.parent
        return {
            path.relative_to(folder).as_posix(): path.read_bytes()
            if path.is_file() and not path.is_symlink()
            else None
            for path in folder.rglob("*")
        }


@pytest.fixture
def project(tmp_path, monkeypatch) -> Project:
    project = Project(tmp_path / "project", tmp_path / "outside")
    project.folder.mkdir()
    project.outside.mkdir()
    (project.folder / ".git").mkdir()
    project.write(".git/HEAD", "ref: refs/heads/main\n")
    project.write("plant.ir")
    (project.outside / "secret.ir").write_text('Package pkg "Secret"\n')
    monkeypatch.chdir(project.folder)
    return project
