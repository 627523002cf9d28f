"""The commands and code blocks that the documentation and ``--help`` show."""

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
    """A shell command on a page. A workflow step that uses an action starts with ``uses:``."""

    page: str
    text: str


def read_block(page: str, title: str) -> str:
    """Return the code block below the comment ``<!-- title -->`` of a page."""
    text = (ROOT / page).read_text(encoding="utf-8")
    pattern = rf"<!-- {re.escape(title)} -->\n(```+)\w+\n(.*?)\1\n"
    match = re.search(pattern, text, re.DOTALL)
    assert match, (page, title)
    return match[2]


def find_commands() -> list[Command]:
    """Return the commands of all pages, page by page, in their order on the page."""
    paths = sorted(path for pattern in PAGES for path in ROOT.glob(pattern))
    texts = {path.relative_to(ROOT).as_posix(): path.read_text("utf-8") for path in paths}
    commands = [
        Command(page, text) for page, content in texts.items() for text in _iter_commands(content)
    ]
    return commands + [
        Command(f"{name} --help", text)
        for name in _iter_help_pages()
        for text in _iter_examples(name)
    ]


def _iter_commands(page: str) -> Iterator[str]:
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


def _iter_help_pages() -> Iterator[str]:
    yield "sysmlc"
    yield from (f"sysmlc {name}" for name in COMMANDS)
    yield from (f"sysmlc contracts {name}" for name in ("check", "refine"))


def _iter_examples(command: str) -> Iterator[str]:
    result = CliRunner().invoke(sysmlc, [*command.split()[1:], "--help"], terminal_width=200)
    yield from re.findall(r"^ {4}(sysmlc .+)$", result.stdout, re.MULTILINE)
