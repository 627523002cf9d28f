"""Reads templates: shipped ones, and those of a folder that is not trusted."""

from pathlib import Path
from typing import NamedTuple

from sysmlc.sources import SourceError
from sysmlc.sources.files import Roots, read_whole
from sysmlc.sources.source import Limits
from sysmlc.support import resources


class TemplateError(Exception):
    """A template cannot be used; the message starts with its file and line where known."""


class TemplateLimitError(TemplateError):
    """A template exceeded a limit, and the process that rendered it ended."""


class UnusableFolderError(TemplateError):
    """A folder holds a template that cannot be read safely."""


MAX_BYTES = 256 * 1024
"""Size limit of one template; the largest shipped one has 1.5 KiB."""
MAX_FILES = 200
"""Limit of templates in one folder; the largest shipped folder has 17."""


class TemplateText(NamedTuple):
    """Content of a template, and the name that messages use for its file."""

    text: str
    file: str


def read_shipped(backend: str) -> dict[str, TemplateText]:
    """Return the shipped templates of a back end by name."""
    return {
        path.name: TemplateText(path.read_text(encoding="utf-8"), path.name)
        for path in sorted(resources.path("templates", backend).glob("*.j2"))
    }


def read_custom(folder: Path, backend: str) -> dict[str, TemplateText]:
    """Return the templates of a user by name: files ``*.j2`` of *folder* and *folder*/*backend*.

    A file of the latter replaces one of the same name in the former. Only regular files are read,
    and no link is followed out of *folder*. Raises UnusableFolderError.
    """
    roots = Roots((folder,))
    templates: dict[str, TemplateText] = {}
    for directory, prefix in ((folder, ""), (folder / backend, f"{backend}/")):
        paths = sorted(directory.glob("*.j2")) if directory.is_dir() else []
        if len(paths) > MAX_FILES:
            raise UnusableFolderError(f"{prefix or '.'}: more than {MAX_FILES} templates")
        for path in paths:
            file = prefix + path.name
            if not roots.allows(path):
                raise UnusableFolderError(f"{file}: is a link out of the templates folder")
            templates[path.name] = TemplateText(_read(path, file), file)
    return templates


def _read(path: Path, file: str) -> str:
    try:
        content = read_whole(path, file, Limits(file_size=MAX_BYTES))
    except SourceError as problem:
        raise UnusableFolderError(f"{file}: {problem.message}") from problem
    try:
        return content.decode("utf-8")
    except UnicodeDecodeError as problem:
        raise UnusableFolderError(
            f"{file}: is not UTF-8: invalid byte at offset {problem.start}"
        ) from problem
