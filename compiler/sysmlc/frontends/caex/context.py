"""State that the readers of nodes share: the graph, ids, resolved classes, and findings."""

from collections import Counter
from collections.abc import Callable

from sysmlc.diagnostics import Rule, Sink, Subject, Verdict
from sysmlc.frontends.caex import rules
from sysmlc.frontends.caex.document import Document, Node
from sysmlc.frontends.caex.identifiers import Identifiers, LocatedNode
from sysmlc.frontends.caex.types import MissingTarget, Type, TypeTable, split_path
from sysmlc.frontends.caex.vocabulary import LIBRARIES, ROLE_REFERENCES, Family
from sysmlc.ir import AttrValue, Element, Graph, Kind, list_items

LibraryProvider = Callable[["Context", Family, str], bool]
"""Adds the standard library of a name to the graph, and returns whether there is one to add."""

_MAPPED = Verdict.MAPPED
_BUILT_IN: dict[str, AttrValue] = {"external": True, "library": True}

_ROOT_TAGS = frozenset({*LIBRARIES, "InstanceHierarchy"})
_CLASS_REFERENCES = {
    **ROLE_REFERENCES,
    "InternalElement": "RefBaseSystemUnitPath",
    "Attribute": "RefAttributeType",
    "AttributeType": "RefAttributeType",
}
"""XML attributes that name classes; for all other tags it is RefBaseClassPath."""


class Context:
    """The lowering of the files of one unit."""

    def __init__(
        self, documents: list[Document], graph: Graph, sink: Sink, provide_library: LibraryProvider
    ) -> None:
        self.documents = documents
        self.graph = graph
        self.sink = sink
        self.types = TypeTable(documents)
        self.ids = Identifiers(documents)
        self.mirror_nodes: list[LocatedNode] = []
        """Mirrors of interfaces and attributes, to be connected when all elements exist."""
        self.masters: dict[tuple[Document, Node], Node | str] = {}
        """Final master of each mirror as a file sees it, or the reference that leads nowhere."""
        self.circular_mirrors: set[Node] = set()
        """Mirrors whose chain of masters leads into a cycle."""
        self.id_references: dict[str, bool] = {}
        """Whether a text in the place of a class path is an ID."""
        self.interface_meanings: dict[str, str] = {}
        """Meanings (``vocabulary.INTERFACE_MEANINGS``) of ports, by the id of the port."""
        self.group_kinds: dict[tuple[Document, str], Kind | None] = {}
        """Facet or Group for each path of a role, else None."""
        # Findings that the last step reports.
        self.missing_targets: dict[MissingTarget, list[LocatedNode]] = {}
        """References that do not resolve, by what is missing."""
        self.unknown_units: dict[tuple[Document, str], list[Node]] = {}
        self.invalid_values: dict[tuple[Document, str, str], list[int]] = {}
        """Rows by data type and text, for texts that are no value of the data type."""
        self.unknown_data_types: dict[tuple[Document, str], int] = {}
        """The first row with a data type that XML Schema does not have."""
        self._provide_library = provide_library
        self._resolved: dict[tuple[Document, Family, str], Type] = {}
        roots = (
            node for document in documents for node in document.root.iter_children(*_ROOT_TAGS)
        )
        numbers = Counter((node.tag, node.name) for node in roots)
        self._repeated_roots = {key for key, number in numbers.items() if number > 1}

    # -- elements ----------------------------------------------------------------------------------

    def add_element(
        self,
        kind: Kind,
        node: Node,
        document: Document,
        owner: str | None,
        id: str = "",
        **attrs: AttrValue,
    ) -> Element:
        """Add the element of a node, without the attributes that are None or empty."""
        present = {key: value for key, value in attrs.items() if value not in (None, "", ())}
        element = self.add_row(kind, document, node.row, owner, id)
        element.attrs.update(present)
        return element

    def add_row(
        self,
        kind: Kind,
        document: Document,
        row: int,
        owner: str | None,
        id: str = "",
        attrs: dict[str, AttrValue] | None = None,
    ) -> Element:
        """Add the element of a row, and mark the row as mapped."""
        name, ordinal = document.attributes[row].get("Name", ""), document.ordinals[row]
        if not id:
            id = document.ids[row]
            if not id or self.ids.is_repeated(id):
                id = self.derive_id(document, row, owner)
        source = document.name
        if document.is_built_in:
            source, ordinal, attrs = "", -1, {**_BUILT_IN, **(attrs or {})}
        if id in self.graph:
            id = self.make_unique(id, document.node(row))
        element = self.graph.add(Element(id, kind, name, owner, ordinal, source, {**(attrs or {})}))
        document.element_ids[row] = id
        document.verdicts[row] = _MAPPED
        return element

    def set_location(self, element: Element, document: Document, ordinal: int) -> None:
        """Set file and position of an element; built-in elements are in no file of the unit."""
        if document.is_built_in:
            element.attrs.update(external=True, library=True)
        else:
            element.ordinal, element.source = ordinal, document.name

    def derive_id(self, document: Document, row: int, owner: str | None) -> str:
        """Return the ID of a row, or an id derived from its owner and name.

        An ID that several elements of the unit have is prefixed with the file. The graph may
        already have an element with the derived id.
        """
        id, name = document.ids[row], document.attributes[row].get("Name", "")
        if id:
            return f"{document.name}#{id}" if self.ids.is_repeated(id) else id
        tag = document.tags[row]
        if owner:
            return f"{owner}/{name or tag}"
        return f"{document.name if (tag, name) in self._repeated_roots else tag}#{name}"

    def make_unique(self, id: str, node: Node) -> str:
        """Return the id, with the position of the node appended if the graph has it already."""
        return f"{id}~{node.ordinal}" if id in self.graph else id

    def find_node(self, id: str, document: Document | None = None) -> LocatedNode | None:
        """Return the node with the ID; if several files have it, that of *document*."""
        return self.ids.find(id, document)

    # -- classes -----------------------------------------------------------------------------------

    def find_resolved(self, text: str, family: Family, document: Document) -> Type | None:
        """Return the class to which a path was resolved earlier; None if it was not."""
        return self._resolved.get((document, family, text))

    def resolve_type(
        self, text: str, family: Family, document: Document, node: Node
    ) -> Type | None:
        """Return the class that a path means, or record the path of *node* as missing."""
        type = self.look_up_type(text, family, document)
        if isinstance(type, MissingTarget):
            self.missing_targets.setdefault(type, []).append((document, node))
            return None
        return type

    def look_up_type(self, text: str, family: Family, document: Document) -> Type | MissingTarget:
        """Return the class that a path means, in the unit or else in a standard library."""
        resolved = self._resolved.get((document, family, text))
        if resolved is not None:
            return resolved
        type = self.types.find(text, family, document)
        if isinstance(type, MissingTarget) and type.kind in ("library", "file"):
            library = split_path(text).names[0]
            if self._provide_library(self, family, library):
                type = self.types.find(text, family, document)
        if isinstance(type, Type):
            self._resolved[document, family, text] = type
        return type

    # -- findings ----------------------------------------------------------------------------------

    def report(
        self, rule: Rule, document: Document, node: Node, cause: str = "", **facts: str
    ) -> None:
        """Report a rule about a node, at its location."""
        self.sink.report(
            rule, self.subject(document, node), notes=(), help="", cause=cause, **facts
        )

    def subject(self, document: Document, node: Node) -> Subject:
        """Return the node as the subject of a diagnostic."""
        return Subject(qualified_name(node), node.element_id, document.locate(node))

    def record_unresolved_path(self, element: Element, node: Node) -> None:
        """Store the text of an unresolved reference; the back end ``aml`` writes it again."""
        paths = list_items(element.attrs.get("unresolved_paths"))
        path = (node.tag, read_class_reference(node))
        if path not in paths:
            self.graph.set(element, unresolved_paths=(*paths, path))

    def report_inexact_id(self, document: Document, node: Node, id: str) -> None:
        """Report an ID that was found only without regard to braces and case."""
        located = self.ids.find_inexact(id) if id not in self.ids else None
        if located is not None:
            literal = located[1].attributes["ID"]
            facts = {"element": node.name, "id": id, "meant": literal}
            self.report(rules.INEXACT_ID, document, node, **facts)

    def report_ids(self) -> None:
        """Report IDs that several elements of one file have, and elements that have none."""
        for id, nodes in self.ids.iter_repeated():
            files: set[Document] = set()
            for document, node in nodes:
                if document in files:
                    self.report(
                        rules.REPEATED_ID, document, node, f"ID {id}", id=id, element=node.name
                    )
                files.add(document)
        for document in self.documents:
            self._report_elements_without_id(document)

    def _report_elements_without_id(self, document: Document) -> None:
        """Report the first element without ID; the message counts the others.

        Links of CAEX 3.0 find interfaces by their IDs.
        """
        rows = self.ids.list_rows_without_id(document, "InternalElement")
        if document.version.startswith("3"):
            interfaces = self.ids.list_rows_without_id(document, "ExternalInterface")
            rows = sorted([*rows, *interfaces])
        if rows:
            node, rest = document.node(rows[0]), len(rows) - 1
            count = f", nor have {rest} more elements of the file" if rest else ""
            self.report(rules.MISSING_ID, document, node, element=qualified_name(node), more=count)

    def release_nodes(self) -> None:
        """Break the reference cycles of documents and nodes, which are not needed any more."""
        for document in self.documents:
            document.release_nodes()


def read_class_reference(node: Node) -> str:
    """Return the class path, or the ID of a master, that a node names."""
    return node.attributes.get(_CLASS_REFERENCES.get(node.tag, "RefBaseClassPath"), "").strip()


def qualified_name(node: Node) -> str:
    """Return the names from the library or hierarchy down, joined by ``::``."""
    nodes = (node, *node.iter_ancestors())
    names = [part.name or part.tag for part in nodes if part.tag != "CAEXFile"]
    return "::".join(reversed(names))
