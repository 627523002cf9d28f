"""Configuration: ``sysmlc.toml`` or ``[tool.sysmlc]``, checked against its JSON Schema."""

import json
import os
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

from msgspec import Struct, field

from sysmlc.diagnostics import Severity
from sysmlc.diagnostics.suppress import Suppression
from sysmlc.sources import Roots, SourceError
from sysmlc.sources.limits import DOCUMENT_LIMITS
from sysmlc.sources.whole import read_whole
from sysmlc.support import resources
from sysmlc.support.suggestions import did_you_mean
from sysmlc.support.toml_text import TomlError, parse_toml

if TYPE_CHECKING:
    from jsonschema import ValidationError

FILE_NAME = "sysmlc.toml"
_MAX_PARTS = 100
_MAX_BYTES = 240
"""Folders in a path of the configuration, and bytes in the name of one: file systems allow 255,
and outputs add suffixes."""
_LONGEST_MESSAGE = 300
_EXCERPT = 100
"""Characters of either end of a longer message that are shown."""
_WILDCARDS = "*?["


class ConfigError(Exception):
    """The configuration cannot be used; the message says where and why."""


class ModelUnit(Struct, frozen=True):
    """One ``[[model]]``: files that are compiled together, and where their outputs go."""

    name: str
    files: tuple[str, ...]
    output: str
    emit: tuple[str, ...] = ()


class Config(Struct, frozen=True):
    """What a project chose; ``folder`` is where its file stands, None when there is none.

    Paths of the file may not lead out of ``root``, the project root of the file.
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
    """Seconds for a command; 0 is no limit besides that of the command line."""
    memory_limit: float = 0.0
    """GiB for a command; 0 is no limit besides that of the command line."""


def find_project_root(start: Path) -> Path:
    """Return the nearest folder from *start* upwards that holds ``sysmlc.toml`` or ``.git``.

    *start* is a model or a folder. Without such a folder the root is *start* itself, or the folder
    of the model. ``.git`` is a file in worktrees and submodules.
    """
    folder = _folder_of(start)
    for parent in (folder, *folder.parents):
        if (parent / FILE_NAME).is_file() or (parent / ".git").exists():
            return parent
    return folder


def find_boundary(output: Path) -> Path:
    """Return the folder outside which a run with ``-o output`` writes nothing.

    A user may name any folder. But where the path as it is written lies in a project, a symbolic
    link in it must not lead out of the project, because the repository may contain that link.
    """
    for folder in Path(os.path.abspath(output)).parents:  # noqa: PTH100 - links stay as written
        if (folder / FILE_NAME).is_file() or (folder / ".git").exists():
            return folder
    return output


def find(start: Path) -> Path | None:
    """Return the configuration file of the project that holds *start*, if it has one.

    ``sysmlc.toml`` of the project root wins; else the nearest ``pyproject.toml`` inside the root
    that has ``[tool.sysmlc]`` counts. Files above the root are ignored: they belong to others.
    Raises ConfigError.
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
            if _tool_table(_parse(project, _read(project))) is not None:
                return project
    return None


def _folder_of(start: Path) -> Path:
    return start.resolve() if start.is_dir() else start.parent.resolve()


def _refuse_outside(file: Path, root: Path) -> Path:
    """Return *file* unless it is a symbolic link that leads out of *root*."""
    if not Roots((root,)).allows(file):
        raise ConfigError(
            f"{file}: is a link that leads out of the project root; "
            "replace it by the file, or name the file with --config"
        )
    return file


def load(file: Path | None) -> Config:
    """The configuration of a file; the defaults when there is none. Raises ConfigError."""
    if file is None:
        return Config()
    text = _read(file)
    config = _config(file.absolute(), _table(file, text))
    _check_paths(file, text, config)
    return config


def _check_paths(file: Path, text: str, config: Config) -> None:
    """Refuse paths that lead out of the project root. Raises ConfigError.

    A repository must not choose what is read or written elsewhere on the machine.
    """
    _check_lengths(file, text, config)
    entries = [("templates", config.templates)]
    outputs = [config.output, *(unit.output for unit in config.models)]
    for unit in config.models:
        if not _is_inside(unit.name):
            message = f"the name '{unit.name}' leads out of the output folder"
            raise ConfigError(f"{file}:{_line(text, 'name')}: {message}; use a plain name")
        entries += [("files", pattern) for pattern in unit.files]
    # Links in the path of an output folder count when something is written to it.
    entries += [("output", output) for output in outputs if not _is_inside(output)]
    for key, value in entries:
        if not _is_confined(value, config):
            raise ConfigError(
                f"{file}:{_line(text, key)}: '{key}': '{value}' leads out of the project root "
                f"'{config.root}'; only paths on the command line may do that"
            )


def _check_lengths(file: Path, text: str, config: Config) -> None:
    """Refuse paths that no file system can hold. Raises ConfigError."""
    entries = [("output", config.output), ("templates", config.templates)]
    for unit in config.models:
        entries += [("name", unit.name), ("output", unit.output)]
        entries += [("files", pattern) for pattern in unit.files]
    for key, value in entries:
        parts = Path(value).parts
        if len(parts) > _MAX_PARTS or any(len(os.fsencode(part)) > _MAX_BYTES for part in parts):
            message = f"'{value[:_EXCERPT]}...' is longer than file systems allow"
            raise ConfigError(f"{file}:{_line(text, key)}: '{key}': {message}")


def _is_inside(name: str) -> bool:
    """Whether the name of a unit, used as a folder, stays below the folder that it is in."""
    return not Path(name).is_absolute() and ".." not in Path(name).parts and "\0" not in name


def _is_confined(pattern: str, config: Config) -> bool:
    """Whether a path lies in the project root; of a pattern, what stands before wildcards."""
    if "\0" in pattern:
        return False
    parts = Path(pattern).parts
    wild = next((at for at, part in enumerate(parts) if set(part) & set(_WILDCARDS)), len(parts))
    if config.folder is None or config.root is None or ".." in parts[wild:]:
        return False
    if wild < len(parts) and Path(pattern).is_absolute():
        return False  # Path.glob does not expand absolute patterns
    return Roots((config.root,)).allows(config.folder.joinpath(*parts[:wild]))


def expand_files(config: Config, patterns: Iterable[str]) -> list[Path]:
    """Return the files that patterns of the configuration name, in order.

    Files that links lead to outside the project root are refused. Raises ConfigError.
    """
    folder, root = config.folder or Path.cwd(), config.root or Path.cwd()
    files: list[Path] = []
    for pattern in patterns:
        has_wildcard = any(sign in pattern for sign in _WILDCARDS)
        files += sorted(folder.glob(pattern)) if has_wildcard else [folder / pattern]
    for path in files:
        if not Roots((root,)).allows(path):
            raise ConfigError(
                f"{config.file}: '{path}' is a link that leads out of the project root '{root}'; "
                "only files named on the command line may do that"
            )
    return files


def _table(file: Path, text: str) -> dict[str, Any]:
    """Return the settings of a file. Raises ConfigError."""
    table = _parse(file, text)
    if file.name == "pyproject.toml":
        table = _tool_table(table) or {}
    _validate(file, text, table)
    return table


def _read(file: Path) -> str:
    try:
        text = read_whole(file, str(file), DOCUMENT_LIMITS).decode("utf-8")
    except SourceError as problem:
        raise ConfigError(f"{file}: {problem.message}") from problem
    except UnicodeDecodeError as problem:
        raise ConfigError(f"{file}: cannot be read: {problem}") from problem
    return text.replace("\r\n", "\n")


def _parse(file: Path, text: str) -> dict[str, Any]:
    try:
        return parse_toml(text)
    except TomlError as problem:
        raise ConfigError(f"{file}:{problem.line}:{problem.column}: {problem}") from problem


def _tool_table(project: Mapping[str, Any]) -> dict[str, Any] | None:
    tool = project.get("tool")
    table = tool.get("sysmlc") if isinstance(tool, dict) else None
    return table if isinstance(table, dict) else None


def _validate(file: Path, text: str, table: object) -> None:

    from jsonschema import Draft202012Validator

    schema = resources.read_text("metamodels", "sysmlc-config.schema.json")
    validator = Draft202012Validator(json.loads(schema))
    errors = sorted(validator.iter_errors(table), key=lambda e: list(e.path))
    if errors:
        raise ConfigError(_explain(file, text, errors[0]))


def _explain(file: Path, text: str, error: "ValidationError") -> str:
    path = [str(part) for part in error.absolute_path]
    if error.validator == "additionalProperties":
        schema = cast("dict[str, dict[str, object]]", error.schema)
        properties = schema["properties"]
        instance = cast("dict[str, object]", error.instance)
        key = next(key for key in instance if key not in properties)
        advice = did_you_mean(key, properties)
        return f"{file}:{_line(text, key)}: unknown key '{'.'.join([*path, key])}'; {advice}"
    key = next((part for part in reversed(path) if not part.isdigit()), "")
    message = error.message
    if len(message) > _LONGEST_MESSAGE:  # it quotes the value; what is wrong with it comes last
        message = f"{message[:_EXCERPT]} ... {message[-_EXCERPT:]}"
    return f"{file}:{_line(text, key)}: '{'.'.join(path)}': {message}"


def _line(text: str, key: str) -> int:
    """Line of the first mention of a key: TOML parsers of the standard library keep no places."""
    for number, line in enumerate(text.splitlines(), 1):
        head = line.partition("=")[0] if "=" in line else line
        if key and key in head.strip(" []").replace('"', "").split("."):
            return number
        if key and head.strip(' "') == key:
            return number
    return 1


def _config(file: Path, table: dict[str, Any]) -> Config:
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
        rules={key: _severity(word) for key, word in table.get("rules", {}).items()},
        suppress=tuple(Suppression(**entry) for entry in table.get("suppress", ())),
        passes=_pass_options(table),
        models=tuple(_model(entry) for entry in table.get("model", ())),
        time_limit=float(table.get("time-limit", 0)),
        memory_limit=float(table.get("memory-limit", 0)),
    )


def _severity(word: str) -> Severity | None:
    return None if word == "off" else Severity(word)


def _pass_options(table: dict[str, Any]) -> dict[str, dict[str, object]]:
    options = {name: dict(fields) for name, fields in table.get("passes", {}).items()}
    levels = _levels(table.get("recipe", {}).get("levels", {}))
    if levels:
        options.setdefault("recipe", {})["levels"] = dict(sorted(levels.items()))
    return options


def _levels(given: dict[str, str | list[str]]) -> dict[str, str]:
    """Levels by element, said by element (``"A::B" = "task"``) or by level (``task = "A::B"``)."""
    found: dict[str, str] = {}
    for key, value in given.items():
        word = key.replace("-", " ").replace("_", " ")
        if isinstance(value, list) or (value not in LEVELS and word in LEVELS):
            names = [value] if isinstance(value, str) else value
            found |= dict.fromkeys(names, word)
        else:
            found[key] = value
    return found


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
"""Levels of a recipe, as docs/ir.md has them."""


def _model(entry: dict[str, Any]) -> ModelUnit:
    name = entry["name"]
    emit = tuple(entry.get("emit", ()))
    return ModelUnit(name, tuple(entry["files"]), entry.get("output", f"out/{name}"), emit)
