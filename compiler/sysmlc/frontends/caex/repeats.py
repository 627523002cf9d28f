"""Names that should be of one element alone: of classes, libraries, attributes, aliases."""

from sysmlc.diagnostics import Severity, rule
from sysmlc.frontends.caex.context import Context, path_of
from sysmlc.frontends.caex.document import Document, Node
from sysmlc.frontends.caex.vocabulary import CLASS_TAGS, LIBRARIES

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


def report(context: Context) -> None:
    """Tell of the rows that could not have the id that their name makes."""
    for document, row in sorted(context.repeated, key=lambda pair: (pair[0].name, pair[1])):
        node = document.node(row)
        if node.tag in _NAMED and not document.is_built_in and _is_repeated(node):
            above = node.parent or node
            owner = f"'{path_of(above) or document.name}'"
            facts = {"owner": owner, "tag": node.tag, "name": node.name}
            context.report(REPEATED_NAME, document, node, **facts)


def _is_repeated(node: Node) -> bool:
    """Whether an element before it beside it has its name."""
    above = node.parent
    beside = above.of(node.tag) if above is not None else ()
    return any(one.name == node.name and one.row < node.row for one in beside)


def declare(context: Context, document: Document, node: Node, file: str) -> None:
    """Let an alias mean a file; the first that declares it counts."""
    alias = node.attributes.get("Alias", "")
    if context.types.declare(document, alias, file) != file:
        others = document.root.of("ExternalReference")
        first = next(one for one in others if one.attributes.get("Alias", "") == alias)
        paths = [one.attributes.get("Path", "") for one in (first, node)]
        facts = {"alias": alias, "first": paths[0], "path": paths[1]}
        context.report(REPEATED_ALIAS, document, node, **facts)
