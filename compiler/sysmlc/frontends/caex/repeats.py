"""Names that should be of one element alone: of classes, libraries, attributes, aliases."""

from collections.abc import Iterable, Iterator
from itertools import compress, repeat
from operator import add

from sysmlc.diagnostics import Severity, rule
from sysmlc.frontends.caex.context import Context, path_of
from sysmlc.frontends.caex.document import Document, Node
from sysmlc.frontends.caex.strange import is_free
from sysmlc.frontends.caex.vocabulary import CLASS_TAGS, LIBRARIES, SIGNS

REPEATED_NAME = rule(
    "SM635",
    "repeated-caex-name",
    Severity.WARNING,
    "{owner} has two of '{tag}' named '{name}'",
    why="Class paths, mappings and the attributes that an instance repeats are found by name: of "
    "two with one name they mean the first.",
    help="rename or remove one of them",
    wrong='<Attribute Name="length"/><Attribute Name="length"/>',
    right='<Attribute Name="length"/><Attribute Name="width"/>',
)
REPEATED_ALIAS = rule(
    "SM636",
    "repeated-alias",
    Severity.WARNING,
    "the alias '{alias}' stands for '{path}' here, and for '{first}' before",
    why="An alias means one file. The first ExternalReference that declares it counts.",
    help="give one of them another alias",
    wrong='<ExternalReference Path="libs/roles.aml" Alias="Roles"/>\n'
    '<ExternalReference Path="libs/more.aml" Alias="Roles"/>',
    right='<ExternalReference Path="libs/roles.aml" Alias="Roles"/>\n'
    '<ExternalReference Path="libs/more.aml" Alias="More"/>',
)

_NAMED = frozenset({*CLASS_TAGS, *LIBRARIES, "Attribute"})
"""Elements that are found by name; an internal element, interface or link has an ID for that."""

_ARE_NAMED = bytes(sign in {SIGNS[tag] for tag in _NAMED} for sign in range(256))
"""Signs of rows as 1 for those that are found by name, 0 for all others."""

_AT_ONCE = 1 << 13
"""Rows that are looked at together; those of one element in the hierarchy are not divided."""


def report(context: Context) -> None:
    """Tell of each row that has the name of one before it beside it."""
    for document in context.documents:
        if document.is_built_in or not _has_repeats(document):
            continue
        for row in _repeated(document):
            node = document.node(row)
            above = node.parent or node
            facts = {"owner": f"'{path_of(above) or document.name}'", "tag": node.tag}
            context.report(REPEATED_NAME, document, node, name=node.name, **facts)


def _has_repeats(document: Document) -> bool:
    """Whether two rows beside one another may have a name: of one tag, or one by chance.

    Rows that state the same are looked at once, and some thousands of rows at a time, so that
    what is remembered of them stays near the processor: this is done for every file that is read.
    """
    are_named = document.signs.translate(_ARE_NAMED)
    names = _names(document, are_named)
    parents, alike = document.parents, document.alike
    upper = document.children(0)
    upper += [row for above in upper for row in document.children(above)]
    rows = [row for row in upper if are_named[row]]
    if _is_repeated(map(parents.__getitem__, rows), map(alike.__getitem__, rows), names):
        return True
    start = 0
    for row in [*sorted(upper), len(are_named)]:
        if row >= start + _AT_ONCE or row == len(are_named):
            named = are_named[start:row]
            beside = compress(parents[start:row], named)
            if _is_repeated(beside, compress(alike[start:row], named), names):
                return True
            start = row
    return False


def _names(document: Document, are_named: bytes) -> dict[int, int]:
    """A number for the name of each row that states what no row before it does.

    Numbers of two names are as far apart as there are rows: with that of a parent added, they
    are one number for both, which is compared in half the time of a pair.
    """
    stating = set(compress(document.alike, are_named))
    stated = map(document.attributes.__getitem__, stating)
    numbers: dict[str | None, int] = {}
    return {
        row: numbers.setdefault(name, len(numbers) * len(are_named))
        for row, name in zip(stating, map(dict.get, stated, repeat("Name")), strict=True)
    }


def _is_repeated(parents: Iterable[int], alike: Iterable[int], names: dict[int, int]) -> bool:
    """Whether two of some rows have the parent and the name in common."""
    beside = list(map(add, parents, map(names.__getitem__, alike)))
    return len(set(beside)) < len(beside)


def _key(document: Document, row: int) -> str:
    return f"{document.tags[row]} {document.attributes[row].get('Name', '')}"


def _repeated(document: Document) -> Iterator[int]:
    found = set()
    for row, (tag, parent) in enumerate(zip(document.tags, document.parents, strict=True)):
        if tag in _NAMED:
            key = (parent, _key(document, row))
            if key in found and not is_free(document, row):
                yield row
            found.add(key)


def declare(context: Context, document: Document, node: Node, file: str) -> None:
    """Let an alias mean a file; the first that declares it counts."""
    alias = node.attributes.get("Alias", "")
    if context.types.declare(document, alias, file) != file:
        others = document.root.of("ExternalReference")
        first = next(one for one in others if one.attributes.get("Alias", "") == alias)
        paths = [one.attributes.get("Path", "") for one in (first, node)]
        facts = {"alias": alias, "first": paths[0], "path": paths[1]}
        context.report(REPEATED_ALIAS, document, node, **facts)
