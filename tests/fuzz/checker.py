"""Check of a hostile file by sysmlc, within limits of time and memory."""

import json
import struct
from dataclasses import dataclass
from pathlib import Path

from fuzz.fork_server import CommandResult, ForkServer

HEAD = '<?xml version="1.0" encoding="UTF-8"?>\n'
SECONDS = 1.0
"""Processor time of a command (user and system), without that of starting Python."""
MEGABYTES = 300

ROOT = (
    '<uml:Model xmi:version="20131001" xmlns:xmi="http://www.omg.org/spec/XMI/20131001"'
    ' xmlns:uml="http://www.eclipse.org/uml2/5.0.0/UML" xmi:id="m" name="M">'
)
CLASS = '<packagedElement xmi:type="uml:Class" xmi:id="c" name="C"/>'


def make_model(content: str = CLASS, head: str = HEAD) -> str:
    """Return a document of Papyrus."""
    return f"{head}{ROOT}{content}</uml:Model>"


def nest_entities(levels: int) -> str:
    """Return a DOCTYPE with *levels* entities, each ten times as long as the one before."""
    entities = "".join(f"<!ENTITY e{n} '{f'&e{n - 1};' * 10}'>" for n in range(1, levels))
    return f"<!DOCTYPE a [<!ENTITY e0 'lolololol'>{entities}]>"


def change_size(archive: bytes, old: int, new: int) -> bytes:
    """Make all headers of an archive state another size of an unpacked entry."""
    size = struct.pack("<I", old)
    assert size in archive
    return archive.replace(size, struct.pack("<I", new))


@dataclass(frozen=True, slots=True)
class Finding:
    """A diagnostic from the JSON output."""

    code: str
    file: str
    line: int | None
    column: int | None
    message: str


@dataclass(frozen=True, slots=True)
class CheckResult:
    """The result of a command and its diagnostics without those of severity info."""

    command: CommandResult
    diagnostics: tuple[Finding, ...]

    @property
    def exit_code(self) -> int:
        """The exit code of the command."""
        return self.command.code

    @property
    def codes(self) -> list[str]:
        """The codes of the diagnostics."""
        return [diagnostic.code for diagnostic in self.diagnostics]

    @property
    def diagnostic(self) -> Finding:
        """The only diagnostic; fails if there are none or several."""
        (diagnostic,) = self.diagnostics
        return diagnostic


class Checker:
    """Runs commands on hostile files in a folder and fails if one crashes or exceeds the limits."""

    def __init__(self, server: ForkServer, folder: Path) -> None:
        self.folder = folder
        self._server = server
        (folder / ".git").mkdir()

    def write(self, data: bytes | str, name: str = "m.uml") -> Path:
        """Write a file into the folder."""
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(data if isinstance(data, bytes) else data.encode())
        return path

    def check_content(self, data: bytes | str, name: str = "m.uml") -> CheckResult:
        """Check a file with this content."""
        self.write(data, name)
        return self.check(name)

    def run(self, *args: str) -> CommandResult:
        """Run a command; fail if it crashes or exceeds the limits."""
        result = self._server.run(self.folder, *args)
        assert not result.is_crash, result.summary
        assert result.seconds <= SECONDS, result.summary
        assert result.megabytes <= MEGABYTES, result.summary
        return result

    def check(self, *args: str) -> CheckResult:
        """Run ``sysmlc check`` and read its diagnostics; fail if it crashes or exceeds limits."""
        result = self.run("check", *args, "--format", "json")
        entries = json.loads(result.out)["diagnostics"]
        keys = ("code", "file", "line", "column", "message")
        diagnostics = [
            Finding(*(entry[k] for k in keys)) for entry in entries if entry["severity"] != "info"
        ]
        return CheckResult(result, tuple(diagnostics))
