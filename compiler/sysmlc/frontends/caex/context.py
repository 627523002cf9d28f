"""What the readers of nodes share: the graph, ids, and findings about what leads nowhere."""

from collections import Counter
from collections.abc import Callable

from sysmlc.diagnostics import Rule, Sink, Subject, Verdict
from sysmlc.frontends.caex import rules
from sysmlc.frontends.caex.document import Document, Node
from sysmlc.frontends.caex.identifiers import Identifiers
from sysmlc.frontends.caex.paths import split
from sysmlc.frontends.caex.types import Missing, Type, Types
from sysmlc.frontends.caex.vocabulary import LIBRARIES, ROLE_REFERENCES, Family
from sysmlc.ir import AttrValue, Element, Graph, Kind

Provide = Callable[["Context", Family, str], bool]
"""Adds a standard library to the graph; says whether there is one of that name."""

_MAPPED = Verdict.MAPPED
_BUILT_IN: dict[str, AttrValue] = {"external": True, "library": True}

_ROOTS = frozenset({*LIBRARIES, "InstanceHierarchy"})
_REFERENCES = {
    **ROLE_REFERENCES,
    "InternalElement": "RefBaseSystemUnitPath",
    "Attribute": "RefAttributeType",
    "AttributeType": "RefAttributeType",
}
"""Attributes that name classes; of all other elements it is RefBaseClassPath."""


class Context:
    """The lowering of the files of one unit."""

    def __init__(
        self, documents: list[Document], graph: Graph, sink: Sink, provide: Provide
    ) -> None:
        self.documents = documents
        self.graph = graph
        self.sink = sink
        self.types = Types(documents)
        self._provide = provide
        self.ids = Identifiers(documents)
        self.missing: dict[Missing, list[tuple[Document, Node]]] = {}
        self.mirrors: list[tuple[Document, Node]] = []
        self.special: dict[str, str] = {}
        self.strange_units: dict[tuple[Document, str], list[Node]] = {}
        self.unfit: dict[tuple[Document, str, str], list[int]] = {}
        """Rows by data type and text: values that it does not have."""
        self.unknown_types: dict[tuple[Document, str], int] = {}
        """The first row that names a data type that there is not."""
        self.masters: dict[tuple[Document, Node], Node | str] = {}
        """What mirrors stand for in the end, as a file sees it; the id that leads nowhere."""
        self.endless: set[Node] = set()
        """Mirrors that lead into a circle."""
        self.references: dict[str, bool] = {}
        """Whether texts in the place of class paths are ids."""
        self.shown: dict[tuple[Document, str], Kind | None] = {}
        """Facet or Group for the paths of roles that mean one."""
        self._found: dict[tuple[Document, Family, str], Type] = {}
        self._shared: set[tuple[str, str]] = set()
        self._know_roots()

    def _know_roots(self) -> None:
        names = Counter(
            (node.tag, node.name) for one in self.documents for node in one.root.of(*_ROOTS)
        )
        self._shared = {key for key, number in names.items() if number > 1}

    # -- elements ------------------------------------------------------------------------------

    def add(
        self,
        kind: Kind,
        node: Node,
        document: Document,
        owner: str | None,
        id: str = "",
        **attrs: AttrValue,
    ) -> Element:
        """Add the node's element; attributes that are None or empty stay away."""
        given: dict[str, AttrValue] = {
            key: value for key, value in attrs.items() if value not in (None, "", ())
        }
        element = self.add_at(kind, document, node.row, owner, id)
        element.attrs.update(given)
        return element

    def add_at(
        self,
        kind: Kind,
        document: Document,
        row: int,
        owner: str | None,
        id: str = "",
        attrs: dict[str, AttrValue] | None = None,
    ) -> Element:
        """Add the element of a row."""
        name, ordinal = document.attributes[row].get("Name", ""), document.ordinals[row]
        if not id:
            id = document.ids[row]
            if not id or self.ids.is_repeated(id):
                id = self.id_at(document, row, owner)
        source = document.name
        if document.is_built_in:
            source, ordinal, attrs = "", -1, {**_BUILT_IN, **(attrs or {})}
        if id in self.graph:
            id = self.free(id, document.node(row))
        element = self.graph.add(Element(id, kind, name, owner, ordinal, source, {**(attrs or {})}))
        document.elements[row] = id
        document.verdicts[row] = _MAPPED
        return element

    def place(self, element: Element, document: Document, ordinal: int) -> None:
        """Say where the element stands; what is built in stands in no file of the unit."""
        if document.is_built_in:
            element.attrs.update(external=True, library=True)
        else:
            element.ordinal, element.source = ordinal, document.name

    def id_of(self, node: Node, document: Document, owner: str | None) -> str:
        """The node's own id, or one made of its owner's and its name."""
        return self.free(self.id_at(document, node.row, owner), node)

    def id_at(self, document: Document, row: int, owner: str | None) -> str:
        """The same for a row; the graph may have it already."""
        id, name = document.ids[row], document.attributes[row].get("Name", "")
        if id:
            return f"{document.name}#{id}" if self.ids.is_repeated(id) else id
        if owner:
            return f"{owner}/{name or document.tags[row]}"
        tag = document.tags[row]
        return f"{document.name if (tag, name) in self._shared else tag}#{name}"

    def free(self, id: str, node: Node) -> str:
        """The id, made different when the graph has it."""
        return f"{id}~{node.ordinal}" if id in self.graph else id

    def find(self, id: str, document: Document | None = None) -> tuple[Document, Node] | None:
        """The node with the ID; of several files that have it, ``document`` is meant."""
        return self.ids.find(id, document)

    def tell_lenient(self, document: Document, node: Node, id: str) -> None:
        """Tell that an id was found only by leaving braces and case aside."""
        known = self.ids.find_plain(id) if id not in self.ids else None
        if known is not None:
            meant = known[1].attributes["ID"]
            self.report(rules.LENIENT_ID, document, node, element=node.name, id=id, meant=meant)

    # -- classes -------------------------------------------------------------------------------

    def known(self, text: str, family: Family, document: Document) -> Type | None:
        """The class that a path was found to mean before."""
        return self._found.get((document, family, text))

    def type(self, text: str, family: Family, document: Document, node: Node) -> Type | None:
        """The class that a path means; what leads nowhere is kept for one report."""
        found = self.look_up(text, family, document)
        if isinstance(found, Missing):
            self.missing.setdefault(found, []).append((document, node))
            return None
        return found

    def look_up(self, text: str, family: Family, document: Document) -> Type | Missing:
        """The class that a path means, in the unit or else in a standard library."""
        known = self._found.get((document, family, text))
        if known is not None:
            return known
        found = self.types.find(text, family, document)
        if isinstance(found, Missing) and found.what in ("library", "file"):
            library = split(text).names[0]
            if self._provide(self, family, library):
                found = self.types.find(text, family, document)
        if isinstance(found, Type):
            self._found[document, family, text] = found
        return found

    # -- findings ------------------------------------------------------------------------------

    def report(self, rule: Rule, document: Document, node: Node, **facts: str) -> None:
        """Report a rule about the node, at its place."""
        self.sink.report(rule, self.subject(document, node), notes=(), help="", **facts)

    def subject(self, document: Document, node: Node) -> Subject:
        """The node as the subject of a finding: its path, its element, its place."""
        return Subject(path_of(node), node.element, document.place(node))

    def keep_path(self, element: Element, node: Node) -> None:
        """Keep a reference that leads nowhere as it is written, for the way back to CAEX."""
        known = element.attrs.get("unresolved_paths")
        path = (node.tag, reference_of(node))
        kept = known if isinstance(known, tuple) else ()
        if path not in kept:
            self.graph.set(element, unresolved_paths=(*kept, path))

    def forget(self) -> None:
        """Let go what knows each other: nothing of it outlives the reading."""
        for document in self.documents:
            document.forget()

    def report_ids(self) -> None:
        """Ids that several elements of one file have, and elements that have none."""
        for id, alike in self.ids.repeated():
            seen: set[Document] = set()
            for document, node in alike:
                if document in seen:
                    self.report(rules.REPEATED_ID, document, node, id=id, element=node.name)
                seen.add(document)
        for document in self.documents:
            self._report_anonymous(document)

    def _report_anonymous(self, document: Document) -> None:
        without = self.ids.without(document, "InternalElement")
        if without:
            first, others = document.node(without[0]), len(without) - 1
            more = f", nor have {others} more elements of the file" if others else ""
            self.report(rules.NO_ID, document, first, element=path_of(first), more=more)


def reference_of(node: Node) -> str:
    """The class path, or the id of a master, that a node names."""
    return node.attributes.get(_REFERENCES.get(node.tag, "RefBaseClassPath"), "").strip()


def path_of(node: Node) -> str:
    """Names from the library or hierarchy down, joined by ``::``."""
    names = [part.name or part.tag for part in (node, *node.above()) if part.tag != "CAEXFile"]
    return "::".join(reversed(names))
