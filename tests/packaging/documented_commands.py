"""The shell commands that the pages of the documentation and ``--help`` show."""

import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from click.testing import CliRunner

from sysmlc.cli.group import COMMANDS, sysmlc

ROOT = Path(__file__).parents[2]
PAGES = ("README.md", "CONTRIBUTING.md", "docs/*.md", "examples/*/*.md")
_SHELLS = ("sh", "bash", "shell", "console")
_PROGRAMS = (
    *("sysmlc", "pip", "pipx", "uv", "python", "python3", "make", "git"),
    *("java", "docker", "npm", "curl", "wget", "apt-get"),
)
_FENCE = re.compile(r"^(```+)(\w*)\n(.*?)^\1", re.DOTALL | re.MULTILINE)
_COMMAND = re.compile(rf"(?:\$ )?((?:\w+=\S+ )*(?:{'|'.join(_PROGRAMS)}) .+)")
_STEP = re.compile(r"- (?:run: (.+)|(uses: .+))")
"""A step of a workflow: a command, or an action of a service."""


@dataclass(frozen=True)
class Command:
    """A line for a shell, as a page shows it; a step that uses an action begins with ``uses:``."""

    page: str
    text: str


def find_commands() -> list[Command]:
    """Return the commands of all pages, page by page and in the order in which they stand."""
    paths = sorted(path for pattern in PAGES for path in ROOT.glob(pattern))
    texts = {path.relative_to(ROOT).as_posix(): path.read_text("utf-8") for path in paths}
    commands = [
        Command(page, text) for page, content in texts.items() for text in _commands_in(content)
    ]
    return commands + [
        Command(f"{name} --help", text) for name in _help_pages() for text in _examples_of(name)
    ]


def _commands_in(page: str) -> Iterator[str]:
    """Yield the commands of indented blocks, of fenced shell text and of workflow steps."""
    blocks = [(match.start(), match[2], match[3]) for match in _FENCE.finditer(page)]
    prose = _FENCE.sub(lambda match: " " * (len(match[0]) - 1) + "\n", page)
    for match in re.finditer(r"(?:^    .*\n)+", prose, re.MULTILINE):
        blocks.append((match.start(), "", match[0]))
    for _, language, block in sorted(blocks):
        for line in block.replace("\\\n", " ").splitlines():
            if language == "yaml":
                step = _STEP.fullmatch(line.strip())
                if step:
                    yield step[1] or step[2]
            elif language in _SHELLS and line.strip():
                yield line.strip().removeprefix("$ ")
            elif not language and (command := _COMMAND.fullmatch(line.strip())):
                yield re.sub(r"\s+", " ", command[1])


def _help_pages() -> Iterator[str]:
    yield "sysmlc"
    yield from (f"sysmlc {name}" for name in COMMANDS)
    yield "sysmlc contracts check"


def _examples_of(command: str) -> Iterator[str]:
    shown = CliRunner().invoke(sysmlc, [*command.split()[1:], "--help"], terminal_width=200)
    yield from re.findall(r"^ {4}(sysmlc .+)$", shown.stdout, re.MULTILINE)
