"""Compile units of a run and their output folders.

The files to compile are those that the command line names, or those of every ``[[model]]``.
"""

import os
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click
from msgspec import Struct
from msgspec.structs import replace

from sysmlc.cli import terminal
from sysmlc.cli.session import fail

if TYPE_CHECKING:
    from sysmlc.cli.session import Settings
    from sysmlc.config import Config
    from sysmlc.driver import OpenedUnit, Request


class Selection(Struct, frozen=True):
    """Files of a ``[[model]]``, or files and folders of the command line, with their output folder.

    ``name`` is the name of the ``[[model]]``. Files without it may be several compile units.
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
    """Return the selected models, or every ``[[model]]`` if no model is named.

    A ``[[model]]`` is selected if one of its files is named, or is in a named folder. One more
    selection at the end has the other files and folders.
    """
    from sysmlc.config import find_boundary

    folder = config.folder or Path.cwd()
    declared = [(unit, _expand(config, index)) for index, unit in enumerate(config.models)]
    chosen = [
        Selection(
            tuple(files),
            output / unit.name if output and len(declared) > 1 else output or folder / unit.output,
            emit or unit.emit or config.emit,
            find_boundary(output, models) if output else config.root or Path.cwd(),
            unit.name,
        )
        for unit, files in declared
        if not models or any(_contains(model, file) for model in models for file in files)
    ]
    listed = [file for unit in chosen for file in unit.files]
    rest = tuple(m for m in models if not any(_is_same_file(m, file) for file in listed))
    if rest:
        plain = output or (folder / config.output if config.folder else Path(config.output))
        boundary = find_boundary(output, models) if output else config.root or Path.cwd()
        chosen.append(Selection(rest, plain, emit or config.emit, boundary))
    if not chosen:
        raise click.UsageError("name a model, or list [[model]] units in sysmlc.toml")
    return chosen


def _expand(config: "Config", index: int) -> list[Path]:
    """Return the files of the ``[[model]]`` with this index, without pipes, sockets and devices.

    Exits with code 2 if a file is outside the project root.
    """
    from sysmlc.config import ConfigError, expand_files, locate_key
    from sysmlc.sources.files import is_special

    files: list[Path] = []
    for pattern in config.models[index].files:
        try:
            matches = expand_files(config, [pattern])
        except ConfigError as problem:
            fail(str(problem))
        if not matches and config.file is not None:
            place = locate_key(config.file, ["model", index, "files"])
            message = f"'{pattern}' in 'files' matches no file"
            terminal.echo(f"sysmlc: warning: {place}: {message}", err=True)
        files += matches
    for file in filter(is_special, files):
        message = f"'{file}' is a pipe, a socket or a device; it is not read"
        terminal.echo(f"sysmlc: warning: {message}", err=True)
    return [file for file in files if not is_special(file)]


def _contains(model: Path, file: Path) -> bool:
    """Whether *model* is the file itself or a folder that contains it."""
    return Path(os.path.realpath(file)).is_relative_to(os.path.realpath(model))


def _is_same_file(left: Path, right: Path) -> bool:
    return os.path.realpath(left) == os.path.realpath(right)


# -- compile units -----------------------------------------------------------------------------

_MAX_LISTED_UNITS = 10
"""The largest number of units that a message lists."""


class Unit(Struct, frozen=True):
    """A compile unit whose files have been read, with its output folder.

    ``name`` is unique in the run and safe as a folder name. Nothing is written outside
    ``boundary``: the project root, or what ``find_boundary`` returns for a named folder.
    """

    request: "Request"
    opened: "OpenedUnit"
    name: str
    output: Path
    emit: tuple[str, ...]
    boundary: Path

    @property
    def config(self) -> "Config":
        """The configuration of the unit's project."""
        return self.request.config


def open_units(
    models: Sequence[Path], config: "Config", settings: "Settings", output: Path | None
) -> list[Unit]:
    """Read the files of all compile units of a run.

    Each ``[[model]]`` is a unit; the other files that were named, or that lie in a named folder,
    are partitioned (``driver.units``). A folder with its own ``sysmlc.toml`` below a named folder
    is compiled as if it were named alone. One unit is written to the output folder itself, several
    units to a folder each.
    """
    from sysmlc.config import find_boundary

    units = _give_unique_names(_open_project(models, config, settings, output))
    if output is None:
        return units
    boundary = find_boundary(output, models)
    if len(units) == 1:
        # The unit may belong to a project below the named folder, with an output folder of its own.
        is_placed = units[0].boundary == boundary
        return units if is_placed else [replace(units[0], output=output, boundary=boundary)]
    return [replace(unit, output=output / unit.name, boundary=boundary) for unit in units]


def find_leftover_outputs(units: Sequence[Unit]) -> list[Path]:
    """Return the output folders of earlier runs that belong to none of *units*.

    They are left by models that were renamed or deleted, and by a folder that was one unit.
    """
    from sysmlc.driver.ownership import is_output_folder

    used = {unit.output.resolve() for unit in units}
    used |= {
        (unit.config.folder / model.output).resolve()
        for unit in units
        if unit.config.folder is not None
        for model in unit.config.models
    }
    parents = [unit.output.resolve().parent for unit in units]
    shared = sorted(parent for parent in {*parents} if parents.count(parent) > 1)
    folders = [
        folder
        for parent in shared
        if parent.is_dir()
        for folder in (parent, *sorted(parent.glob("*")))
    ]
    return [folder for folder in folders if folder not in used and is_output_folder(folder)]


def open_named_units(models: Sequence[Path], config: "Config", settings: "Settings") -> list[Unit]:
    """Read the compile units of the named files and folders, and ignore ``[[model]]``.

    Commands that write no output folder use this function.
    """
    selection = Selection(tuple(models), Path(), (), Path())
    return list(_open_selection(selection, config, settings, ()))


def open_single_unit(models: Sequence[Path], config: "Config", settings: "Settings") -> Unit:
    """Read the named files; exit with code 2 if they are several compile units."""
    from sysmlc.cli.reports import localize_name
    from sysmlc.cli.session import fail

    units = open_named_units(models, config, settings)
    if len(units) > 1:
        files = [localize_name(unit.opened.root, unit.opened.first_file()) for unit in units]
        listed = ", ".join(files[:_MAX_LISTED_UNITS]) + (
            ", ..." if len(files) > _MAX_LISTED_UNITS else ""
        )
        fail(f"the models are {len(units)} compile units; name the files of one, such as {listed}")
    return units[0]


def _open_project(
    models: Sequence[Path], config: "Config", settings: "Settings", output: Path | None
) -> list[Unit]:
    """Open the units of a project, those of ``[[model]]`` first.

    Files that these read are excluded from the other units.
    """
    from sysmlc.cli.session import make_request
    from sysmlc.driver import open_unit

    selections = select(models, config, output, settings.emit)
    units: list[Unit] = []
    for selection in selections:
        if selection.name:
            request = make_request(selection.files, config, settings)
            opened = open_unit(request)
            units.append(
                Unit(
                    request,
                    opened,
                    selection.name,
                    selection.output,
                    selection.emit,
                    selection.boundary,
                )
            )
        else:
            read = [file.path for unit in units for file in unit.opened.reading.files]
            units += _open_selection(selection, config, settings, read)
    return units


def _make_unit(
    selection: "Selection", request: "Request", opened: "OpenedUnit", name: str, output: Path
) -> Unit:
    return Unit(request, opened, name, output, selection.emit, selection.boundary)


def _open_selection(
    selection: "Selection",
    config: "Config",
    settings: "Settings",
    excluded: Sequence[Path],
) -> Iterator[Unit]:
    """Yield the units of one selection, and the units of projects below its folders."""
    from sysmlc.cli.session import make_request
    from sysmlc.driver import open_units
    from sysmlc.driver.inputs import find_projects

    folders = [path.resolve() for path in selection.files if path.is_dir()]
    # A configuration of the command line holds for all files, so others are not looked for.
    ignores_others = settings.isolated or settings.config is not None
    projects = [] if ignores_others else [p for f in folders for p in find_projects(f)]
    request = replace(
        make_request(selection.files, config, settings),
        excluded=(*excluded, *projects),
        finds_siblings=True,
    )
    parts = open_units(request)
    is_alone = len(parts) == 1 and not excluded
    for opened in parts:
        if request.excluded and not opened.reading.files and not len(opened.sink):
            continue
        folder = selection.output if is_alone else selection.output / opened.name
        yield _make_unit(selection, request, opened, opened.name, folder)
    for project in projects:
        yield from _open_nested(project, settings, parts[0].root)


def _open_nested(project: Path, settings: "Settings", root: Path) -> Iterator[Unit]:
    """Open the units of a project below a named folder; their names start with its path."""
    from sysmlc.cli.session import load_config
    from sysmlc.support.output import assign_file_names

    units = _open_project([project], load_config([project], settings), settings, None)
    path = project.relative_to(root) if project.is_relative_to(root) else Path(project.name)
    (name,) = assign_file_names(["::".join(path.parts)]).values()
    for unit in units:
        yield replace(unit, name=name if len(units) == 1 else f"{name}.{unit.name}")


def _give_unique_names(units: Sequence[Unit]) -> list[Unit]:
    """Number names that differ in case only, because some file systems ignore case."""
    from sysmlc.support.output import fold_path

    counts: dict[str, int] = {}
    named: list[Unit] = []
    for unit in units:
        key = fold_path(unit.name)
        counts[key] = count = counts.get(key, 0) + 1
        named.append(unit if count == 1 else replace(unit, name=f"{unit.name}~{count}"))
    return named
