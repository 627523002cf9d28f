"""``sysmlc format``: rewrite files in KerML and SysML v2 in canonical layout."""

import difflib
import os
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import click
from msgspec import Struct

from sysmlc.cli import terminal
from sysmlc.support.counts import count
from sysmlc.support.escapes import escape_undecodable

if TYPE_CHECKING:
    from sysmlc.diagnostics.renderers import Finding

_LANGUAGES = ("sysml", "kerml")
_WRITABLE = 0o222


class _Text(Struct, frozen=True):
    """The text of a file before and after formatting.

    ``path`` is None for standard input, ``after`` is None if the text has syntax errors.
    """

    name: str
    path: Path | None
    before: str
    after: str | None
    findings: "tuple[Finding, ...]" = ()

    @property
    def is_changed(self) -> bool:
        return self.after is not None and self.after != self.before


@click.command(
    "format",
    short_help="Put SysML v2 and KerML files into canonical layout.",
    epilog="""\b
Examples:
  sysmlc format plant.sysml
  sysmlc format models/ --check     # for continuous integration: exit code 1 if a file would change
  sysmlc format models/ --diff      # shows the changes
  sysmlc format models/ --fix       # also writes 'public' where an import has no visibility
  sysmlc format - < plant.sysml     # from standard input to standard output""",
)
@click.argument(
    "files",
    nargs=-1,
    required=True,
    type=click.Path(path_type=Path, allow_dash=True),
    metavar="FILE...",
)
@click.option("--check", is_flag=True, help="Write nothing; list the files that would change.")
@click.option("--diff", "shows_diff", is_flag=True, help="Write nothing; print the changes.")
@click.option(
    "--fix", is_flag=True, help="Write 'public' before imports without visibility (SM197), too."
)
@click.option(
    "--language",
    type=click.Choice(_LANGUAGES),
    help="Language of all files, if their suffixes do not show it.",
)
@click.pass_context
def command(
    ctx: click.Context,
    /,
    files: tuple[Path, ...],
    check: bool,
    shows_diff: bool,
    fix: bool,
    language: str | None,
) -> None:
    """Format FILE...: files, folders with .sysml and .kerml files, or - for standard input.

    Only white space changes, unless --fix is given; tokens, comments and notes do not. Files with
    syntax errors are not changed. Exit code 0: success; 1: a file has syntax errors or, with
    --check or --diff, would change; 2: a file cannot be read or written.
    """
    texts = [_read(path, language, fix=fix) for path in _expand(files)]
    _show([finding for text in texts for finding in text.findings])
    changed = [text for text in texts if text.is_changed]
    if shows_diff:
        click.echo("".join(line for text in changed for line in _diff(text)), nl=False)
    elif check:
        click.echo("".join(f"{text.name}\n" for text in changed), nl=False)
    else:
        _write(texts)
    has_errors = any(text.after is None for text in texts)
    ctx.exit(1 if has_errors or (changed and (check or shows_diff)) else 0)


def _expand(files: tuple[Path, ...]) -> Iterator[Path]:
    for path in files:
        if str(path) == "-":
            yield path
            continue
        _refuse_link(path)
        if path.is_dir():
            yield from _list_folder(path)
        else:
            yield path


def _refuse_link(path: Path) -> None:
    """Exit with code 2 if a path is a link, or leads out of the project in which it is written.

    The links of a repository, which a wildcard of the shell names too, may come from a stranger.
    """
    from sysmlc.cli.session import fail
    from sysmlc.config import find_boundary
    from sysmlc.sources import Roots

    if path.is_symlink():
        fail(f"'{path.as_posix()}' is a link; name what it leads to")
    if not Roots((find_boundary(path),)).allows(path):
        fail(f"'{path.as_posix()}' leads out of the project through a link; name the file itself")


def _list_folder(folder: Path) -> list[Path]:
    """Return the files in *folder* to lay out, sorted; hidden folders are skipped.

    Links, pipes, sockets and devices are skipped with a warning. A file to which a link leads is
    laid out if it is in the folder itself.
    """
    from sysmlc.cli.session import fail
    from sysmlc.sources.files import is_special

    matches, files = list[Path](), list[Path]()
    for path, folders, names in os.walk(folder):
        folders[:] = [name for name in folders if not name.startswith(".")]
        matches += (
            Path(path, name) for name in names if Path(name).suffix[1:].lower() in _LANGUAGES
        )
    for file in sorted(matches):
        name = escape_undecodable(file.as_posix())
        if file.is_symlink():
            terminal.echo(f"sysmlc: warning: '{name}' is a link; it is not formatted", err=True)
        elif is_special(file):
            reason = "is a pipe, a socket or a device"
            terminal.echo(f"sysmlc: warning: '{name}' {reason}; it is not formatted", err=True)
        else:
            files.append(file)
    return files or fail(f"{folder.as_posix()} holds no .sysml or .kerml file")


def _read(path: Path, language: str | None, *, fix: bool) -> _Text:
    from sysmlc.cli.session import fail
    from sysmlc.sources import DEFAULT_LIMITS, SourceError
    from sysmlc.sources.files import read_whole

    name = escape_undecodable(path.as_posix())
    if name == "-" and sys.stdin is None:
        fail("standard input is closed")
    try:
        if name == "-":
            limit = DEFAULT_LIMITS.file_size
            # One byte above the limit shows that the input is too long.
            content = sys.stdin.buffer.read(limit + 1)
            if len(content) > limit:
                fail(f"standard input has more than {limit} bytes")
            return _format("-", None, content, language or "sysml", fix=fix)
        content = read_whole(path, name, DEFAULT_LIMITS)
        return _format(name, path, content, _find_language(path, language), fix=fix)
    except SourceError as problem:
        fail(f"{name} {problem.message}")
    except UnicodeDecodeError as problem:
        fail(f"{name} is not UTF-8: byte {problem.start} does not start a character")


def _find_language(path: Path, language: str | None) -> str:
    from sysmlc.cli.session import fail

    name = language or path.suffix[1:].lower()
    if name not in _LANGUAGES:
        fail(f"{path.as_posix()} ends neither in .sysml nor in .kerml: say --language")
    return name


def _format(name: str, path: Path | None, data: bytes, language: str, *, fix: bool) -> _Text:
    """Format a text; the result has the findings of the parser if there are syntax errors.

    With *fix*, imports get the visibility that they lack.
    """
    from sysmlc.diagnostics import Sink
    from sysmlc.diagnostics.renderers import make_report
    from sysmlc.language.formatter import add_import_visibilities, format_text
    from sysmlc.language.text import parse
    from sysmlc.sources import Source

    before = data.decode("utf-8-sig")
    sink, source = Sink(), Source(name, data)
    document = parse(before, name, language, sink, source)
    if sink.has_errors():
        return _Text(name, path, before, None, tuple(make_report(sink, [source]).findings))
    text = add_import_visibilities(document) if fix else before
    return _Text(name, path, before, format_text(text, language))


def _show(findings: "list[Finding]") -> None:
    from sysmlc.cli import reports, session

    if findings:
        reports.print_findings(findings, session.Settings())


def _diff(text: _Text) -> Iterator[str]:
    before, after = (part.splitlines(keepends=True) for part in (text.before, text.after or ""))
    for line in difflib.unified_diff(before, after, text.name, text.name):
        yield line if line.endswith("\n") else f"{line}\n\\ No newline at end of file\n"


def _write(texts: list[_Text]) -> None:
    for text in texts:
        if text.path is None:
            sys.stdout.buffer.write((text.after or text.before).encode())
        elif text.is_changed and text.after is not None:
            _replace(text.path, text.name, text.after)
    files = [text for text in texts if text.path is not None]
    changed = sum(text.is_changed for text in files)
    if files:
        click.echo(f"{changed} of {count(len(files), 'file')} reformatted", err=True)


def _replace(target: Path, name: str, content: str) -> None:
    """Replace the content of a file and preserve its permissions; exit if it is read-only."""
    from sysmlc.cli.session import fail
    from sysmlc.support.atomic_files import write

    try:
        mode = target.stat().st_mode
        # Replacing the file would succeed, because it needs permissions of the folder only.
        if not mode & _WRITABLE:
            fail(f"{name} is read-only")
        write(target, content.encode())
        target.chmod(mode)
    except OSError as problem:
        fail(f"{name} cannot be written: {problem.strerror or problem}")
