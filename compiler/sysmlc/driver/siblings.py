"""Files of the project that declare names which a file named alone uses.

Texts of SysML v2 do not name the files that they refer to. A hook or an editor names the changed
file only, which is then compiled with the other files of its unit.
"""

import os
import re
from collections.abc import Iterable, Iterator, Sequence
from collections.abc import Set as AbstractSet
from pathlib import Path

from sysmlc.config import is_project_root
from sysmlc.diagnostics import Sink
from sysmlc.driver.inputs import Recognised, ask_names, find_model_files, recognise
from sysmlc.frontends.base import FileNames, Frontend, LibraryFrontend, UnitFrontend
from sysmlc.sources import Roots, Source, SourceError
from sysmlc.sources.files import is_special, read_whole
from sysmlc.sources.source import DEFAULT_LIMITS

_SUFFIXES = (".sysml", ".kerml")
"""Suffixes of texts: other models, which may be large, name the files that they refer to."""


def find_siblings(
    texts: Iterable[Recognised],
    known: AbstractSet[Path],
    roots: Roots,
    frontends: Sequence[Frontend],
    sink: Sink,
) -> list[Path]:
    """Return the files below *roots* that declare names which *texts* use, directly or not.

    *known* are the real paths of the files that belong to the unit anyway. Only files of front ends
    whose folders are units have siblings.
    """
    worklist = [names for text in texts if (names := _read_names(text, sink)) is not None]
    if not worklist:
        return []
    declared = set[str]().union(*(names.declared for names in worklist))
    # A project may contain a copy of the standard library, which is not meant by a single file.
    for frontend in frontends:
        if isinstance(frontend, LibraryFrontend):
            declared |= frontend.list_library_names()
    candidates = dict(_load_candidates(known, roots))
    seemingly_declared = {path: _find_declared(source) for path, source in candidates.items()}
    siblings: list[Path] = []
    while worklist:
        names = worklist.pop()
        wanted = names.used - names.local - declared
        for path in [p for p in candidates if not seemingly_declared[p].isdisjoint(wanted)]:
            items = recognise([candidates[path]], frontends, None, Sink())
            sibling_names = next(filter(None, (_read_names(item, sink) for item in items)), None)
            if sibling_names is not None and not sibling_names.declared.isdisjoint(wanted):
                del candidates[path]
                siblings.append(path)
                worklist.append(sibling_names)
                declared |= sibling_names.declared
    return siblings


def _read_names(item: Recognised, sink: Sink) -> FileNames | None:
    """Return the names of a text, or None if the folder of the file is no unit."""
    frontend = item.frontend
    if not isinstance(frontend, UnitFrontend) or not frontend.is_folder_unit:
        return None
    return ask_names(frontend, item.source, sink)


def _load_candidates(known: AbstractSet[Path], roots: Roots) -> Iterator[tuple[Path, Source]]:
    """Yield the files that may be siblings, with their content; skip those that cannot be read.

    A folder outside of projects, such as that of downloads, may contain anything, so that its
    subfolders are not searched.
    """
    for folder in roots.folders:
        for path in sorted(
            file for file in _list_files(folder) if file.suffix.lower() in _SUFFIXES
        ):
            real = Path(os.path.realpath(path))
            if real in known or not roots.allows(path) or is_special(path):
                continue
            try:
                yield path, Source(path.name, read_whole(path, path.name, DEFAULT_LIMITS))
            except SourceError:
                continue


def _list_files(folder: Path) -> list[Path]:
    """Return the files that may be siblings; none if the folder cannot be listed."""
    try:
        return list(find_model_files(folder) if is_project_root(folder) else folder.iterdir())
    except OSError:
        return []


# Possessive quantifiers: a word of a megabyte would otherwise take quadratic time.
_NAME = r"(?:'((?:[^'\\]|\\.)*+)'|(?<!\w)(\w++))"
_DECLARATION = re.compile(rf"{_NAME}\s*+(?:[{{;\[]|:(?!:))|<\s*+{_NAME}\s*+>")
"""A name before what may follow the name of a declaration, or a short name."""


def _find_declared(source: Source) -> set[str]:
    """Return the names before signs that may follow the name of a declaration, and short names.

    The search is quick, so that most files of a project are not parsed.
    """
    text = source.data.decode("utf-8", "replace")
    return {name for names in _DECLARATION.findall(text) for name in names if name}
