"""Packages of AutomationML (.amlx), which are Open Packaging Conventions (ISO/IEC 29500-2)."""

import posixpath
from collections.abc import Sequence
from typing import NamedTuple
from urllib.parse import unquote

from sysmlc.sources.archive import is_system_entry
from sysmlc.sources.source import Source, SourceError
from sysmlc.sources.xml import make_parser, parse

SUFFIX = ".amlx"
_ROOT_DOCUMENT = "http://schemas.automationml.org/container/relationship/RootDocument"
_CONTENT_TYPES = "[Content_Types].xml"
_PACKAGE_RELATIONSHIPS = "_rels/.rels"
_RELATIONSHIP = "http://schemas.openxmlformats.org/package/2006/relationships}Relationship"


class Relationship(NamedTuple):
    """A relationship of a package to one of its parts.

    ``offset`` is the position of the relationship in ``file``, ``target`` the entry of the part.
    """

    file: str
    offset: int
    type: str
    target: str


def holds_relationships(entry: str) -> bool:
    """Whether an entry of an archive lists relationships."""
    return entry.endswith(".rels") and posixpath.basename(posixpath.dirname(entry)) == "_rels"


def is_package(name: str, entries: Sequence[str]) -> bool:
    """Whether an archive is a package of AutomationML, by its name or by its entries."""
    holds_aml = any(entry.lower().endswith((".aml", ".caex")) for entry in entries)
    return name.lower().endswith(SUFFIX) or (_PACKAGE_RELATIONSHIPS in entries and holds_aml)


def check_package(archive: str, entries: Sequence[str], files: Sequence[Source]) -> None:
    """Check that a package has one root document, and that relationships and parts agree.

    *files* are the entries that hold relationships. Raises SourceError, located in one of these
    files if a relationship is wrong.
    """
    relationships = [relationship for file in files for relationship in _read_relationships(file)]
    _check_root(archive, [r for r in relationships if r.type == _ROOT_DOCUMENT])
    parts = {entry for entry in entries if not entry.endswith("/") and not is_system_entry(entry)}
    for relationship in relationships:
        if relationship.target not in parts:
            message = f"it has no part '{relationship.target}'"
            raise SourceError(message, relationship.file, relationship.offset)
    targets = {relationship.target for relationship in relationships}
    for entry in sorted(parts - targets - {_CONTENT_TYPES}):
        if not holds_relationships(entry):
            message = f"no relationship of the package leads to its part '{entry}'"
            raise SourceError(message, f"{archive}!{entry}", 0)


def _check_root(archive: str, roots: Sequence[Relationship]) -> None:
    if not roots:
        file = f"{archive}!{_PACKAGE_RELATIONSHIPS}"
        raise SourceError("no relationship names its root document", file, 0)
    if len(roots) > 1:
        names = " and ".join(f"'{root.target}'" for root in roots)
        message = f"it has {len(roots)} root documents, {names}"
        raise SourceError(message, roots[1].file, roots[1].offset)


def _read_relationships(source: Source) -> list[Relationship]:
    """Return the relationships in a file; their targets are entries of the archive."""
    relationships: list[Relationship] = []
    parser = make_parser()
    # Targets are relative to the folder that contains the folder _rels.
    folder = posixpath.dirname(posixpath.dirname(source.name.partition("!")[2]))

    def start(tag: str, values: dict[str, str]) -> None:
        if tag == _RELATIONSHIP and values.get("TargetMode") != "External":
            target = unquote(values.get("Target", "").partition("#")[0])
            path = target if target.startswith("/") else f"{folder}/{target}"
            entry = posixpath.normpath(path.lstrip("/"))
            kind = values.get("Type", "")
            relationships.append(Relationship(source.name, parser.CurrentByteIndex, kind, entry))

    parser.StartElementHandler = start
    parse(source, parser)
    return relationships
