"""Names that should be of one element alone: of classes, libraries, attributes, aliases."""

from collections.abc import Iterator

from sysmlc.diagnostics import Severity, rule
from sysmlc.frontends.caex.context import Context, path_of
from sysmlc.frontends.caex.document import Document, Node
from sysmlc.frontends.caex.strange import is_free
from sysmlc.frontends.caex.vocabulary import CLASS_TAGS, LIBRARIES

REPEATED_NAME = rule(
    "SM635",
    "repeated-caex-name",
    Severity.WARNING,
    "{owner} has two of '{tag}' named '{name}'",
    help="rename or remove one of them",
)
REPEATED_ALIAS = rule(
    "SM636",
    "repeated-alias",
    Severity.WARNING,
    "the alias '{alias}' stands for '{path}' here, and for '{first}' before",
    help="give one of them another alias",
)

_NAMED = frozenset({*CLASS_TAGS, *LIBRARIES, "Attribute"})
"""Elements that are found by name; an internal element, interface or link has an ID for that."""


def report(context: Context) -> None:
    """Report each row that has the same parent, tag and name as a row before it."""
    for document in context.documents:
        if document.is_built_in:
            continue
        for row in _repeated_rows(document):
            node = document.node(row)
            above = node.parent or node
            facts = {"owner": f"'{path_of(above) or document.name}'", "tag": node.tag}
            context.report(REPEATED_NAME, document, node, name=node.name, **facts)


def _repeated_rows(document: Document) -> Iterator[int]:
    """Yield the rows that have the parent, tag and name of a row before them."""
    keys: set[tuple[int, str, str]] = set()
    columns = zip(document.tags, document.parents, document.attributes, strict=True)
    for row, (tag, parent, attributes) in enumerate(columns):
        if tag in _NAMED:
            key = parent, tag, attributes.get("Name", "")
            if key in keys and not is_free(document, row):
                yield row
            keys.add(key)


def declare(context: Context, document: Document, node: Node, file: str) -> None:
    """Let an alias mean a file; the first that declares it counts."""
    alias = node.attributes.get("Alias", "")
    if context.types.declare(document, alias, file) != file:
        others = document.root.of("ExternalReference")
        first = next(one for one in others if one.attributes.get("Alias", "") == alias)
        paths = [one.attributes.get("Path", "") for one in (first, node)]
        facts = {"alias": alias, "first": paths[0], "path": paths[1]}
        context.report(REPEATED_ALIAS, document, node, **facts)
