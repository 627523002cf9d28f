"""Findings about nodes: reported at once, or recorded until all files are read."""

from sysmlc.diagnostics import Rule, Sink, Subject
from sysmlc.frontends.caex import rules
from sysmlc.frontends.caex.document import Document, Node
from sysmlc.frontends.caex.identifiers import Identifiers, LocatedNode
from sysmlc.frontends.caex.types import MissingTarget
from sysmlc.frontends.caex.vocabulary import ROLE_REFERENCES
from sysmlc.ir import Element, Graph, list_items

_CLASS_REFERENCES = {
    **ROLE_REFERENCES,
    "InternalElement": "RefBaseSystemUnitPath",
    "Attribute": "RefAttributeType",
    "AttributeType": "RefAttributeType",
}
"""XML attributes that name classes; for all other tags it is RefBaseClassPath."""


class Findings:
    """Reports about nodes, and findings that the last step reports together."""

    def __init__(self, sink: Sink) -> None:
        self.sink = sink
        self.missing_targets: dict[MissingTarget, list[LocatedNode]] = {}
        """References that do not resolve, by what is missing."""
        self.unknown_units: dict[tuple[Document, str], list[Node]] = {}
        self.invalid_values: dict[tuple[Document, str, str], list[int]] = {}
        """Rows by data type and text, for texts that are no value of the data type."""
        self.unknown_data_types: dict[tuple[Document, str], int] = {}
        """The first row with a data type that XML Schema does not have."""

    def report(
        self, rule: Rule, document: Document, node: Node, cause: str = "", **facts: str
    ) -> None:
        """Report a rule about a node, at its location."""
        self.sink.report(
            rule,
            Subject(qualified_name(node), node.element_id, document.locate(node)),
            notes=(),
            help="",
            cause=cause,
            **facts,
        )


def record_unresolved_path(graph: Graph, element: Element, node: Node) -> None:
    """Store the text of an unresolved reference; the back end ``aml`` writes it again."""
    paths = list_items(element.attrs.get("unresolved_paths"))
    path = (node.tag, read_class_reference(node))
    if path not in paths:
        graph.set(element, unresolved_paths=(*paths, path))


def report_inexact_id(
    findings: Findings, ids: Identifiers, document: Document, node: Node, id: str
) -> None:
    """Report an ID that was found only without regard to braces and case."""
    located = ids.find_inexact(id) if id not in ids else None
    if located is not None:
        literal = located[1].attributes["ID"]
        facts = {"element": node.name, "id": id, "meant": literal}
        findings.report(rules.INEXACT_ID, document, node, **facts)


def report_ids(findings: Findings, ids: Identifiers, documents: list[Document]) -> None:
    """Report IDs that several elements of one file have, and elements that have none."""
    for id, nodes in ids.iter_repeated():
        files: set[Document] = set()
        for document, node in nodes:
            if document in files:
                findings.report(
                    rules.REPEATED_ID, document, node, f"ID {id}", id=id, element=node.name
                )
            files.add(document)
    for document in documents:
        _report_elements_without_id(findings, ids, document)


def _report_elements_without_id(findings: Findings, ids: Identifiers, document: Document) -> None:
    """Report the first element without ID; the message counts the others.

    Links of CAEX 3.0 find interfaces by their IDs.
    """
    rows = ids.list_rows_without_id(document, "InternalElement")
    if document.version.startswith("3"):
        interfaces = ids.list_rows_without_id(document, "ExternalInterface")
        rows = sorted([*rows, *interfaces])
    if rows:
        node, rest = document.node(rows[0]), len(rows) - 1
        count = f", nor have {rest} more elements of the file" if rest else ""
        findings.report(rules.MISSING_ID, document, node, element=qualified_name(node), more=count)


def read_class_reference(node: Node) -> str:
    """Return the class path, or the ID of a master, that a node names."""
    return node.attributes.get(_CLASS_REFERENCES.get(node.tag, "RefBaseClassPath"), "").strip()


def qualified_name(node: Node) -> str:
    """Return the names from the library or hierarchy down, joined by ``::``."""
    nodes = (node, *node.iter_ancestors())
    names = [part.name or part.tag for part in nodes if part.tag != "CAEXFile"]
    return "::".join(reversed(names))
