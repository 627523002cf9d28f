"""Packages (ISO/IEC 29500-2, Open Packaging Conventions): what AutomationML packs into .amlx."""

import posixpath
from collections.abc import Sequence
from typing import NamedTuple
from urllib.parse import unquote

from sysmlc.sources.error import SourceError
from sysmlc.sources.source import Source
from sysmlc.sources.xml import parse, parser

SUFFIX = ".amlx"
_ROOT_DOCUMENT = "http://schemas.automationml.org/container/relationship/RootDocument"
_CONTENT_TYPES = "[Content_Types].xml"
_OF_PACKAGE = "_rels/.rels"
_RELATIONSHIP = "http://schemas.openxmlformats.org/package/2006/relationships}Relationship"


class Relationship(NamedTuple):
    """What a package says about one part: where that is said, its type and its target."""

    file: str
    offset: int
    type: str
    target: str


def is_relationships(entry: str) -> bool:
    """Whether an entry of an archive holds relationships."""
    return entry.endswith(".rels") and posixpath.basename(posixpath.dirname(entry)) == "_rels"


def is_package(name: str, entries: Sequence[str]) -> bool:
    """Whether an archive is a package of AutomationML: by its name or by what is in it."""
    holds_aml = any(entry.lower().endswith((".aml", ".caex")) for entry in entries)
    return name.lower().endswith(SUFFIX) or (_OF_PACKAGE in entries and holds_aml)


def check(archive: str, entries: Sequence[str], relationships: Sequence[Source]) -> None:
    """Check that one root document is named, and that parts and relationships fit.

    Raises SourceError, located in the file of relationships where one is at fault.
    """
    found = [one for source in relationships for one in _read(source)]
    _check_root(archive, [one for one in found if one.type == _ROOT_DOCUMENT])
    parts = {entry for entry in entries if not entry.endswith("/")}
    for one in found:
        if one.target not in parts:
            raise SourceError(f"it has no part '{one.target}'", one.file, one.offset)
    known = {one.target for one in found} | {_CONTENT_TYPES}
    for entry in sorted(parts - known):
        if not is_relationships(entry):
            message = f"no relationship of the package leads to its part '{entry}'"
            raise SourceError(message, f"{archive}!{entry}", 0)


def _check_root(archive: str, roots: Sequence[Relationship]) -> None:
    if not roots:
        raise SourceError("no relationship names its root document", f"{archive}!{_OF_PACKAGE}", 0)
    if len(roots) > 1:
        names = " and ".join(f"'{one.target}'" for one in roots)
        message = f"it has {len(roots)} root documents, {names}"
        raise SourceError(message, roots[1].file, roots[1].offset)


def _read(source: Source) -> list[Relationship]:
    """The relationships in a file of them; targets are entries of the archive."""
    found: list[Relationship] = []
    made = parser()
    folder = posixpath.dirname(posixpath.dirname(source.name.partition("!")[2]))

    def start(tag: str, values: dict[str, str]) -> None:
        if tag == _RELATIONSHIP and values.get("TargetMode") != "External":
            target = unquote(values.get("Target", "").partition("#")[0])
            place = target.lstrip("/") if target.startswith("/") else f"{folder}/{target}"
            path = posixpath.normpath(place.lstrip("/"))
            kind = values.get("Type", "")
            found.append(Relationship(source.name, made.CurrentByteIndex, kind, path))

    made.StartElementHandler = start
    parse(source, made)
    return found
