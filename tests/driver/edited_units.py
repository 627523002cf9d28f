"""A unit of texts that is compiled, edited and compiled again, with a cache of its own."""

import shutil
from collections.abc import Mapping
from pathlib import Path

import pytest
from click.testing import CliRunner

from sysmlc import cache, resources
from sysmlc.cli import group
from sysmlc.driver import compilation
from sysmlc.ir import seen
from sysmlc.language import library


def compiled_units(
    monkeypatch: pytest.MonkeyPatch, folder: Path, texts: Mapping[str, str]
) -> list[object]:
    """Make ``unit`` of the texts in the folder, and go there; the list of what is compiled."""
    monkeypatch.setenv(cache.VARIABLE, str(folder / "cache"))
    monkeypatch.setenv(library.VARIABLE, str(resources.path("metamodels", "core")))
    monkeypatch.chdir(folder)
    Path("unit").mkdir()
    for name, text in texts.items():
        Path("unit", name).write_text(text)
    happened: list[object] = []
    real = compilation._Run.compilation

    def counted(run: compilation._Run) -> compilation.Compilation:
        happened.append(run)
        return real(run)

    monkeypatch.setattr(compilation._Run, "compilation", counted)
    return happened


def work_used_again(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """The readers whose work a process that stays uses again, from now on and as they come."""
    monkeypatch.setattr(seen, "_LAST", {})
    readers: list[str] = []
    real = seen.Seen.known

    def known(self: seen.Seen, reader: str, given: object) -> object:
        found = real(self, reader, given)
        readers.extend([reader] if found else [])
        return found

    monkeypatch.setattr(seen.Seen, "known", known)
    return readers


def sysmlc(*arguments: str) -> tuple[int, str, str]:
    """The command in this process: exit code, what it prints, what it tells."""
    result = CliRunner().invoke(group.sysmlc, list(arguments))
    return result.exit_code, result.stdout, result.stderr


def files(folder: str) -> dict[str, str]:
    """All files below a folder."""
    return {p.relative_to(folder).as_posix(): p.read_text() for p in Path(folder).rglob("*.*")}


def assert_is_as_from_a_clean_build(*options: str) -> None:
    """The outputs and every finding are those of a run without a cache."""
    shutil.rmtree("clean", ignore_errors=True)
    told = sysmlc("unit", "-o", "out", *options, "--format", "json")
    assert told == sysmlc("unit", "-o", "clean", *options, "--format", "json", "--no-cache")
    assert files("out") == files("clean")


def edited(name: str, old: str, new: str) -> None:
    """Replace the first place of a text in a file of the unit."""
    path = Path("unit") / name
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new, 1))
