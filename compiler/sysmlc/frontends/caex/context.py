"""State that the readers of nodes share: the graph, ids, resolved classes, and findings."""

from collections import Counter
from collections.abc import Callable

from sysmlc.diagnostics import Sink, Verdict
from sysmlc.frontends.caex.document import Document, Node
from sysmlc.frontends.caex.findings import Findings, read_class_reference
from sysmlc.frontends.caex.identifiers import Identifiers
from sysmlc.frontends.caex.mirrors import MEMBER_FAMILIES, Mirrors
from sysmlc.frontends.caex.types import MissingTarget, Type, TypeTable, split_path
from sysmlc.frontends.caex.vocabulary import LIBRARIES, Family
from sysmlc.ir import AttrValue, Element, Graph, Kind

LibraryProvider = Callable[["Context", Family, str], bool]
"""Adds the standard library of a name to the graph, and returns whether there is one to add."""

_MAPPED = Verdict.MAPPED
_BUILT_IN: dict[str, AttrValue] = {"external": True, "library": True}

_ROOT_TAGS = frozenset({*LIBRARIES, "InstanceHierarchy"})


class Context:
    """The lowering of the files of one unit."""

    def __init__(
        self, documents: list[Document], graph: Graph, sink: Sink, provide_library: LibraryProvider
    ) -> None:
        self.documents = documents
        self.graph = graph
        self.types = TypeTable(documents)
        self.ids = Identifiers(documents)
        self.findings = Findings(sink)
        self.mirrors = Mirrors(graph, self.ids, self.findings)
        self.interface_meanings: dict[str, str] = {}
        """Meanings (``vocabulary.INTERFACE_MEANINGS``) of ports, by the id of the port."""
        self.group_kinds: dict[tuple[Document, str], Kind | None] = {}
        """Facet or Group for each path of a role, else None."""
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
            self.findings.missing_targets.setdefault(type, []).append((document, node))
            return None
        return type

    def resolve_member_class(self, node: Node, document: Document) -> Type | None:
        """Return the class that an attribute or external interface names.

        A mirror is recorded for ``Mirrors.connect``.
        """
        path = read_class_reference(node)
        if not path:
            return None
        if self.mirrors.is_mirror(node):
            self.mirrors.nodes.append((document, node))
            return None
        return self.resolve_type(path, MEMBER_FAMILIES[node.tag], document, node)

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
