"""Reads and checks the configuration of a project: ``sysmlc.toml`` or ``[tool.sysmlc]``."""

import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from fnmatch import fnmatch
from pathlib import Path
from typing import Any

from msgspec import Struct, field

from sysmlc.diagnostics import Severity
from sysmlc.diagnostics.diagnostic import format_position
from sysmlc.diagnostics.sink import Suppression
from sysmlc.documents import DocumentError, Spot, Value, list_violations, parse_toml
from sysmlc.sources import Roots, SourceError
from sysmlc.sources.files import read_whole
from sysmlc.sources.source import DOCUMENT_LIMITS

FILE_NAME = "sysmlc.toml"
_MAX_PARTS = 100
"""Parts of a path in the configuration."""
_MAX_BYTES = 240
"""Bytes of the name of one folder: file systems allow 255, and outputs add suffixes."""
_EXCERPT = 100
"""Characters of a longer path that are shown."""
_WILDCARDS = "*?["


class ConfigError(Exception):
    """The configuration cannot be used; the message gives the location and the reason.

    *path* are the keys that lead to a wrong value, if the message does not give its location.
    """

    def __init__(self, message: str, path: Sequence[str] = ()) -> None:
        super().__init__(message)
        self.path = path


class ModelUnit(Struct, frozen=True):
    """An entry ``[[model]]``: files that are compiled together, and their output folder."""

    name: str
    files: tuple[str, ...]
    output: str
    emit: tuple[str, ...] = ()


class Config(Struct, frozen=True):
    """The settings of a project, with their defaults.

    ``file`` is the configuration file, ``folder`` contains it, and ``root`` is the project root,
    out of which no path in the file may lead. All three are None without a configuration file.
    """

    folder: Path | None = None
    root: Path | None = None
    file: Path | None = None
    output: str = "out"
    emit: tuple[str, ...] = ()
    strict: bool = False
    strict_input: bool = False
    diagrams: str = "derived"
    templates: str = ""
    rules: Mapping[str, Severity | None] = field(default_factory=dict)
    suppress: tuple[Suppression, ...] = ()
    passes: Mapping[str, Mapping[str, object]] = field(default_factory=dict)
    models: tuple[ModelUnit, ...] = ()
    time_limit: float = 0.0
    """Seconds for a command; 0 adds no limit to that of the command line."""
    memory_limit: float = 0.0
    """GiB for a command; 0 adds no limit to that of the command line."""


def find_project_root(start: Path) -> Path:
    """Return the nearest folder from *start* upwards that holds ``sysmlc.toml`` or ``.git``.

    *start* is a model or a folder. If there is no such folder, the root is *start* itself, or the
    folder that contains the model. ``.git`` is a file in worktrees and submodules.
    """
    folder = _folder_of(start)
    return next(filter(is_project_root, (folder, *folder.parents)), folder)


def is_project_root(folder: Path) -> bool:
    """Whether a folder holds ``sysmlc.toml`` or ``.git``, and so is the root of a project."""
    return (folder / FILE_NAME).is_file() or (folder / ".git").exists()


def find_boundary(output: Path, inputs: Iterable[Path] = ()) -> Path:
    """Return the folder outside which ``-o output`` must not write: the project around *output*.

    A user may name any folder. But if the path, as it is written, lies in a project, its symbolic
    links may come from the repository, so that they must not lead out of the project. The project
    of an input is one even if it has neither ``sysmlc.toml`` nor ``.git``. Outside of projects the
    result is *output* itself.
    """
    path = Path(os.path.abspath(output))  # noqa: PTH100 - links stay as written
    for folder in path.parents:
        if is_project_root(folder):
            return folder
    roots = [root for root in map(find_project_root, inputs) if root in path.parents]
    return max(roots, key=lambda root: len(root.parts), default=output)


def find_config_file(start: Path) -> Path | None:
    """Return the configuration file of the project that holds *start*, if it has one.

    It is ``sysmlc.toml`` in the project root, else the nearest ``pyproject.toml`` inside the root
    that has a table ``[tool.sysmlc]``. Files above the root are ignored, because they belong to
    something else. Raises ConfigError.
    """
    root = find_project_root(start)
    if (root / FILE_NAME).is_file():
        return _refuse_outside(root / FILE_NAME, root)
    folder = _folder_of(start)
    for parent in (folder, *folder.parents):
        project = parent / "pyproject.toml"
        if not parent.is_relative_to(root):
            break
        if project.is_file():
            _refuse_outside(project, root)
            if _read_settings(project) is not None:
                return project
    return None


def _folder_of(start: Path) -> Path:
    return start.resolve() if start.is_dir() else start.parent.resolve()


def _refuse_outside(file: Path, root: Path) -> Path:
    """Return *file*. Raises ConfigError if it is a symbolic link that leads out of *root*."""
    if not Roots((root,)).allows(file):
        raise ConfigError(
            f"{file}: is a link that leads out of the project root; "
            "replace it by the file, or name the file with --config"
        )
    return file


def read_config(file: Path | None) -> Config:
    """Return the configuration in a file, or the defaults without a file. Raises ConfigError."""
    if file is None:
        return Config()
    document = _read_settings(file) or Value(Spot(), entries={})
    for violation in list_violations(document, "sysmlc-config.schema.json"):
        raise ConfigError(f"{_format_spot(file, violation.spot)}: {violation}")
    config = _make_config(file.absolute(), document.as_json())
    _check_paths(file, document, config)
    return config


def _check_paths(file: Path, document: Value, config: Config) -> None:
    """Raise ConfigError for a path that is too long or leads out of the project root.

    A repository must not decide which files elsewhere on the machine are read or written.
    """
    for path, value in _list_paths(config):
        key = [step for step in path if isinstance(step, str)][-1]
        problem = _find_problem(key, value, config)
        if problem:
            raise ConfigError(f"{_format_spot(file, document.find_key(path))}: {problem}")


def _list_paths(config: Config) -> Iterator[tuple[list[str | int], str]]:
    """Yield the paths in the configuration, each with the keys that lead to it."""
    yield ["output"], config.output
    yield ["templates"], config.templates
    for index, unit in enumerate(config.models):
        owner: list[str | int] = ["model", index]
        yield [*owner, "name"], unit.name
        yield [*owner, "output"], unit.output
        yield from (([*owner, "files", number], file) for number, file in enumerate(unit.files))


def _find_problem(key: str, value: str, config: Config) -> str:
    """Return what is wrong with a path of the configuration, or an empty text."""
    parts = Path(value).parts
    if len(parts) > _MAX_PARTS or any(len(os.fsencode(part)) > _MAX_BYTES for part in parts):
        return f"'{key}': '{value[:_EXCERPT]}...' is longer than file systems allow"
    if key == "name":
        advice = "leads out of the output folder; use a plain name"
        return "" if _is_inside(value) else f"the name '{value}' {advice}"
    # Links in the path of an output folder are checked when a file is written to it.
    if (key == "output" and _is_inside(value)) or _is_confined(value, config):
        return ""
    return (
        f"'{key}': '{value}' leads out of the project root '{config.root}'; "
        "only paths on the command line may do that"
    )


def _is_inside(name: str) -> bool:
    """Whether a path is relative and has no ``..``, so that it leads into its folder."""
    return not Path(name).is_absolute() and ".." not in Path(name).parts and "\0" not in name


def _is_confined(pattern: str, config: Config) -> bool:
    """Whether a path is in the project root; of a pattern, the part before its wildcards."""
    if "\0" in pattern:
        return False
    parts = Path(pattern).parts
    wildcard_parts = (index for index, part in enumerate(parts) if set(part) & set(_WILDCARDS))
    first = next(wildcard_parts, len(parts))
    if config.folder is None or config.root is None or ".." in parts[first:]:
        return False
    # Patterns are expanded in the folder of the configuration.
    if first < len(parts) and Path(pattern).is_absolute():
        return False
    return Roots((config.root,)).allows(config.folder.joinpath(*parts[:first]))


def expand_files(config: Config, patterns: Iterable[str]) -> list[Path]:
    """Return the files that match patterns of the configuration, sorted for each pattern.

    Raises ConfigError for a symbolic link to a file or folder outside the project root.
    """
    folder, files = config.folder or Path.cwd(), list[Path]()
    for pattern in patterns:
        has_wildcard = any(sign in pattern for sign in _WILDCARDS)
        files += _expand_pattern(pattern, folder, config) if has_wildcard else [folder / pattern]
    for path in files:
        _refuse_link_out(path, config)
    return files


def _expand_pattern(pattern: str, folder: Path, config: Config) -> list[Path]:
    """Return what matches a pattern in *folder*, sorted; ``**`` matches folders of any depth.

    ``Path.glob`` would follow links and list folders outside the project root.
    """
    paths = [folder]
    for part in Path(pattern).parts:
        # Links may lead in circles. By its real path, each folder is searched once for a part.
        folders = {os.path.realpath(path): path for path in reversed(paths) if path.is_dir()}
        for path in folders.values():
            _refuse_link_out(path, config)
        paths = sorted({match for path in folders.values() for match in _match(part, path)})
    return paths


def _match(part: str, folder: Path) -> Iterator[Path]:
    """Yield what one part of a pattern matches in *folder*."""
    if part == "**":
        yield from (Path(path) for path, _, _ in os.walk(folder))
    elif set(part) & set(_WILDCARDS):
        with suppress(OSError):
            yield from (path for path in folder.iterdir() if fnmatch(path.name, part))
    elif os.path.lexists(folder / part):
        yield folder / part


def _refuse_link_out(path: Path, config: Config) -> None:
    root = config.root or Path.cwd()
    if not Roots((root,)).allows(path):
        raise ConfigError(
            f"{config.file}: '{path}' is a link that leads out of the project root '{root}'; "
            "only files named on the command line may do that"
        )


# -- reading -----------------------------------------------------------------------------------


def _read_settings(file: Path) -> Value | None:
    """Return the settings in a file, None if a ``pyproject.toml`` has none. Raises ConfigError."""
    try:
        document = parse_toml(_read_file(file))
    except DocumentError as error:
        raise ConfigError(f"{_format_spot(file, error.spot)}: {error}") from error
    if file.name != "pyproject.toml":
        return document
    tool = document.get("tool")
    table = tool.get("sysmlc") if tool else None
    return table if table and table.entries is not None else None


def _format_spot(file: Path, spot: Spot) -> str:
    return format_position(str(file), spot.line, spot.column)


def locate_key(file: Path, path: Sequence[str | int]) -> str:
    """Return ``file:line:column`` of a key of a configuration file, for a message."""
    settings = _read_settings(file)
    return _format_spot(file, settings.find_key(path) if settings else Spot())


def _read_file(file: Path) -> str:
    try:
        text = read_whole(file, str(file), DOCUMENT_LIMITS).decode("utf-8")
    except SourceError as problem:
        raise ConfigError(f"{file}: {problem.message}") from problem
    except UnicodeDecodeError as problem:
        raise ConfigError(f"{file}: cannot be read: {problem}") from problem
    return text.replace("\r\n", "\n")


# -- settings ----------------------------------------------------------------------------------

LEVELS = (
    "recipe",
    "task",
    "machine service",
    "infrastructure service",
    "machine function",
    "machine",
    "material",
    "capability",
    "opc ua call",
    "opc ua variable",
    "delay",
)
"""Levels of a recipe (docs/ir.md)."""


def _make_config(file: Path, table: Any) -> Config:  # noqa: ANN401
    return Config(
        folder=file.parent,
        root=find_project_root(file),
        file=file,
        output=table.get("output", "out"),
        emit=tuple(table.get("emit", ())),
        strict=table.get("strict", False),
        strict_input=table.get("strict-input", False),
        diagrams=table.get("diagrams", "derived"),
        templates=table.get("templates", ""),
        rules={
            key: None if word == "off" else Severity(word)
            for key, word in table.get("rules", {}).items()
        },
        suppress=tuple(Suppression(**entry) for entry in table.get("suppress", ())),
        passes=_make_pass_options(table),
        models=tuple(_make_unit(entry) for entry in table.get("model", ())),
        time_limit=float(table.get("time-limit", 0)),
        memory_limit=float(table.get("memory-limit", 0)),
    )


def _make_pass_options(table: dict[str, Any]) -> dict[str, dict[str, object]]:
    """Return the options of passes; ``[recipe.levels]`` is an option of the analysis ``recipe``."""
    options = {name: dict(fields) for name, fields in table.get("passes", {}).items()}
    levels = _read_levels(table.get("recipe", {}).get("levels", {}))
    if levels:
        options.setdefault("recipe", {})["levels"] = dict(sorted(levels.items()))
    return options


def _read_levels(table: dict[str, str | list[str]]) -> dict[str, str]:
    """Return the level of each element in the table ``[recipe.levels]``.

    An entry gives the level of an element (``"A::B" = "task"``), or the elements of a level
    (``task = "A::B"``).
    """
    levels: dict[str, str] = {}
    for key, value in table.items():
        level = key.replace("-", " ").replace("_", " ")
        if isinstance(value, list) or (value not in LEVELS and level in LEVELS):
            names = [value] if isinstance(value, str) else value
            levels |= dict.fromkeys(names, level)
        else:
            levels[key] = value
    return levels


def _make_unit(entry: dict[str, Any]) -> ModelUnit:
    name = entry["name"]
    emit = tuple(entry.get("emit", ()))
    return ModelUnit(name, tuple(entry["files"]), entry.get("output", f"out/{name}"), emit)
