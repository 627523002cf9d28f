"""Golden files: ``golden`` compares texts with a folder, ``--update-golden`` writes the folder."""

import difflib
from collections.abc import Mapping
from pathlib import Path

import pytest

GOLDEN = Path(__file__).parent / "golden"
_SHOWN = 80


def pytest_addoption(parser):
    parser.addoption(
        "--update-golden",
        action="store_true",
        help="write the golden files anew and show what differs",
    )


class Golden:
    """Compares what a test made with the folder ``tests/golden/<name>``."""

    def __init__(self, update: bool, show) -> None:
        self._update = update
        self._show = show

    def check(self, name: str, made: Mapping[str, str]) -> None:
        """Fail when a file is missing, is too much or differs; with the option, write instead."""
        folder = GOLDEN / name
        kept = _files(folder)
        differences = [
            text
            for path in sorted(kept.keys() | made.keys())
            if (text := _difference(path, kept.get(path, ""), made.get(path, "")))
        ]
        if self._update:
            self._write(folder, made, kept)
            self._show("\n".join(differences))
        elif differences:
            hint = "if this is right: pytest --update-golden, then read the difference\n"
            pytest.fail(hint + "\n".join(differences), pytrace=False)

    def _write(self, folder: Path, made: Mapping[str, str], kept: Mapping[str, str]) -> None:
        for path in kept.keys() - made.keys():
            (folder / path).unlink()
        for path, text in made.items():
            (folder / path).parent.mkdir(parents=True, exist_ok=True)
            (folder / path).write_bytes(text.encode("utf-8"))


def _files(folder: Path) -> dict[str, str]:
    return {
        path.relative_to(folder).as_posix(): path.read_bytes().decode("utf-8")
        for path in sorted(folder.rglob("*"))
        if path.is_file()
    }


def _difference(path: str, old: str, new: str) -> str:
    lines = list(
        difflib.unified_diff(
            old.splitlines(), new.splitlines(), f"golden/{path}", f"made/{path}", lineterm=""
        )
    )
    rest = f"\n... {len(lines) - _SHOWN} more lines" if len(lines) > _SHOWN else ""
    return "\n".join(lines[:_SHOWN]) + rest


@pytest.fixture
def golden(request):
    """The golden files, to compare with or to write."""
    terminal = request.config.get_terminal_writer()
    return Golden(request.config.getoption("--update-golden"), terminal.line)
