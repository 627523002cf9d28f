"""Select the files to compile: those that the command line names, or every ``[[model]]``."""

import os
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click
from msgspec import Struct

from sysmlc.cli.session import fail

if TYPE_CHECKING:
    from sysmlc.config import Config


class Selection(Struct, frozen=True):
    """Files and folders that were named, or a ``[[model]]``, and where their outputs go.

    ``name`` is that of the ``[[model]]``; without one the files may be several compile units.
    Nothing is written outside ``boundary``: the project root, or what ``find_boundary`` returns for
    a folder that the user named.
    """

    files: tuple[Path, ...]
    output: Path
    emit: tuple[str, ...]
    boundary: Path
    name: str = ""


def select(
    models: Sequence[Path], config: "Config", output: Path | None, emit: tuple[str, ...]
) -> list[Selection]:
    """Return what was named, or every ``[[model]]``.

    A named file that a ``[[model]]`` lists brings the whole unit with it, and so does a named
    folder that such a file lies in. What else was named comes last.
    """
    from sysmlc.config import find_boundary

    folder = config.folder or Path.cwd()
    declared = [(unit, _expand(config, unit.files)) for unit in config.models]
    chosen = [
        Selection(
            tuple(files),
            output / unit.name if output and len(declared) > 1 else output or folder / unit.output,
            emit or unit.emit or config.emit,
            find_boundary(output) if output else config.root or Path.cwd(),
            unit.name,
        )
        for unit, files in declared
        if not models or any(_contains(model, file) for model in models for file in files)
    ]
    listed = [file for unit in chosen for file in unit.files]
    rest = tuple(m for m in models if not any(_same(m, file) for file in listed))
    if rest:
        plain = output or (folder / config.output if config.folder else Path(config.output))
        boundary = find_boundary(output) if output else config.root or Path.cwd()
        chosen.append(Selection(rest, plain, emit or config.emit, boundary))
    if not chosen:
        raise click.UsageError("name a model, or list [[model]] units in sysmlc.toml")
    return chosen


def _expand(config: "Config", patterns: Iterable[str]) -> list[Path]:
    """Return the files of a ``[[model]]``; ends with exit code 2 when one leads out of the root."""
    from sysmlc.config import ConfigError, expand_files

    try:
        return expand_files(config, patterns)
    except ConfigError as problem:
        fail(str(problem))


def _contains(model: Path, file: Path) -> bool:
    """Whether *model* is the file, or a folder that the file lies in."""
    return Path(os.path.realpath(file)).is_relative_to(os.path.realpath(model))


def _same(left: Path, right: Path) -> bool:
    return os.path.realpath(left) == os.path.realpath(right)
