"""What sysmlc answers to a hostile file, and that it does so within the limits of the issue."""

import json
from dataclasses import dataclass
from pathlib import Path

from fuzz.guard import Ended, Guard

SECONDS = 1.0
"""Processor time of a command (user and system), beside that of starting Python."""
MEGABYTES = 300

HEAD = '<?xml version="1.0" encoding="UTF-8"?>\n'
ROOT = (
    '<uml:Model xmi:version="20131001" xmlns:xmi="http://www.omg.org/spec/XMI/20131001"'
    ' xmlns:uml="http://www.eclipse.org/uml2/5.0.0/UML" xmi:id="m" name="M">'
)
CLASS = '<packagedElement xmi:type="uml:Class" xmi:id="c" name="C"/>'


def model(content: str = CLASS, head: str = HEAD) -> str:
    """A document of Papyrus."""
    return f"{head}{ROOT}{content}</uml:Model>"


@dataclass(frozen=True, slots=True)
class Found:
    """A finding as JSON tells it."""

    code: str
    file: str
    line: int | None
    column: int | None
    message: str


@dataclass(frozen=True, slots=True)
class Answer:
    """How a command ended and what it found, remarks left out."""

    ended: Ended
    findings: tuple[Found, ...]

    @property
    def codes(self) -> list[str]:
        """Codes of the findings."""
        return [found.code for found in self.findings]

    @property
    def only(self) -> Found:
        """The one finding that there is."""
        (found,) = self.findings
        return found


class GeneralizationQueries:
    """A folder with a hostile file, and the process that is asked about it."""

    def __init__(self, guard: Guard, folder: Path) -> None:
        self.folder = folder
        self._guard = guard
        (folder / ".git").mkdir()

    def write(self, data: bytes | str, name: str = "m.uml") -> Path:
        """Write a file into the folder."""
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(data if isinstance(data, bytes) else data.encode())
        return path

    def about(self, data: bytes | str, name: str = "m.uml") -> Answer:
        """What ``sysmlc check`` says about a file with this content."""
        self.write(data, name)
        return self.check(name)

    def run(self, *args: str) -> Ended:
        """How a command ends; fails when it took too much or ended otherwise."""
        ended = self._guard.run(self.folder, *args)
        assert not ended.is_fault, ended.told
        assert ended.seconds <= SECONDS, ended.told
        assert ended.megabytes <= MEGABYTES, ended.told
        return ended

    def check(self, *args: str) -> Answer:
        """What ``sysmlc check`` says; fails when it took too much or ended otherwise."""
        ended = self.run("check", *args, "--format", "json")
        told = json.loads(ended.out)["diagnostics"]
        keys = ("code", "file", "line", "column", "message")
        shown = [Found(*(one[k] for k in keys)) for one in told if one["severity"] != "info"]
        return Answer(ended, tuple(shown))
