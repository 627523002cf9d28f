"""Writer of trees of KerML and SysML v2 as XMI (.kermlx, .sysmlx; KerML 1.0, 10.2)."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from posixpath import dirname, relpath, splitext
from urllib.parse import quote

from lxml import etree

from sysmlc.diagnostics import Rule, Sink, Subject
from sysmlc.language.interchange import rules
from sysmlc.language.interchange.effective_names import (
    RedefinitionQuery,
    describe_node,
    redefine_nothing,
)
from sysmlc.language.interchange.element_ids import assign_ids, find_conjugated
from sysmlc.language.interchange.metamodel import list_features
from sysmlc.language.interchange.unfolding import Element, Link, unfold, walk_elements
from sysmlc.language.library import SHIPPED
from sysmlc.language.metaclasses import is_a
from sysmlc.language.tree import AttributeValue, Document, Node, find_root, locate
from sysmlc.support.escapes import replace_illegal_in_xml
from sysmlc.support.output import make_path_of_input
from sysmlc.support.xml_text import make_root, print_element

_MEMBERSHIPS = {"importedMembership"}
"""Features that refer to the membership of an element instead of the element."""


class InterchangeFile:
    """An unfolded document, with the elements of its nodes."""

    def __init__(self, document: Document, redefined: RedefinitionQuery = redefine_nothing) -> None:
        self.document = document
        self.root = unfold(document.root)
        assign_ids(self.root, document, redefined)
        self._elements: dict[Node, Element] = {}
        self._memberships: dict[Node, Element] = {}
        self._conjugates: dict[Node | None, Element] = {}
        for element, owner in walk_elements(self.root):
            if element.node is not None:
                self._memberships.setdefault(element.node, element)
                self._elements[element.node] = element
            if element.kind == "ConjugatedPortDefinition" and owner is not None:
                self._conjugates[find_conjugated(element)] = element

    def target(self, node: Node, feature: str) -> Element | None:
        """Return the element of the file that a feature with the value ``node`` refers to.

        That is the element of the node, its membership, or for ``conjugatedPortDefinition`` the
        conjugated definition.
        """
        if feature == "conjugatedPortDefinition":
            return self._conjugates.get(node)
        return (self._memberships if feature in _MEMBERSHIPS else self._elements).get(node)


class InterchangeFiles:
    """The documents that references may lead to, each unfolded once on demand.

    Several models may share the files of a library. ``redefined`` returns implied redefinitions,
    which determine names and ids of features.
    """

    def __init__(
        self,
        documents: Iterable[Document],
        library: "InterchangeFiles | None" = None,
        redefined: RedefinitionQuery = redefine_nothing,
    ) -> None:
        self.redefined = redefined
        self._documents: dict[Node, Document] = {}
        self._files: dict[Node, InterchangeFile] = {}
        self._library = library
        self.add(documents)

    def add(self, documents: Iterable[Document]) -> None:
        """Let references lead to these documents too."""
        self._documents.update((document.root, document) for document in documents)

    def find_file(self, root: Node) -> InterchangeFile | None:
        """Return the file of the document with that root, or None if it is unknown."""
        if root in self._files:
            return self._files[root]
        if root in self._documents:
            return self._files.setdefault(
                root, InterchangeFile(self._documents[root], self.redefined)
            )
        return self._library.find_file(root) if self._library is not None else None


NAMESPACE = "https://www.omg.org/spec/SysML/20250201"
_XMI, _XSI = "http://www.omg.org/XMI", "http://www.w3.org/2001/XMLSchema-instance"
_TYPE = f"{{{_XSI}}}type"
_RELATIONSHIP, _RELATED = "ownedRelationship", "ownedRelatedElement"
_UNTYPED_FEATURES = {"memberElement", "annotatedElement", "client", "supplier"}
"""Features typed by the abstract Element: a reference to another file says the metaclass."""

Targets = dict[str, list[tuple[str, str]]]
"""The targets of an element by feature: the id or the href, and for an href the metaclass."""


def print_file(root: Element, targets: Callable[[Element], Targets]) -> str:
    """Return the text of the file with this root namespace."""
    namespaces = {"xmi": _XMI, "xsi": _XSI, "sysml": NAMESPACE}
    top = make_root(f"{{{NAMESPACE}}}{root.kind}", namespaces)
    top.set(f"{{{_XMI}}}version", "2.0")
    # A stack instead of recursion: models nest more deeply than Python's stack.
    stack = [(root, top)]
    while stack:
        element, node = stack.pop()
        element_targets = targets(element)
        _set_attributes(element, node, element_targets)
        _add_hrefs(node, element_targets)
        for owned in element.owned:
            child = etree.SubElement(node, _choose_tag(element, owned))
            child.set(_TYPE, f"sysml:{owned.kind}")
            stack.append((owned, child))
    return print_element(top)


def _set_attributes(element: Element, node: "etree._Element", targets: Targets) -> None:
    node.set(f"{{{_XMI}}}id", element.id)
    node.set("elementId", element.id)
    for name, fact in element.attributes.items():
        node.set(name, _write_value(fact))
    for name, references in targets.items():
        if local_ids := [id for id, kind in references if not kind]:
            node.set(name, " ".join(local_ids))


def _choose_tag(element: Element, owned: Element) -> str:
    """Return the tag of an owned element.

    A relationship that is not a namespace owns related elements, except annotations, which are
    relationships.
    """
    is_plain = is_a(element.kind, "Relationship") and not is_a(element.kind, "Namespace")
    return _RELATED if is_plain and owned.kind != "Annotation" else _RELATIONSHIP


def _add_hrefs(node: "etree._Element", targets: Targets) -> None:
    for name, references in targets.items():
        for href, kind in references:
            if kind:
                child = etree.SubElement(node, name)
                # A reader cannot create a proxy of the abstract metaclass Element, so the href has
                # a type.
                if name in _UNTYPED_FEATURES:
                    child.set(_TYPE, f"sysml:{kind}")
                child.set("href", replace_illegal_in_xml(href)[0])


def _write_value(fact: AttributeValue) -> str:
    if isinstance(fact, bool):
        return "true" if fact else "false"
    return replace_illegal_in_xml(str(fact))[0]


def _find_unwritable(element: Element) -> Iterator[str]:
    """Yield the features of the element with characters that XML cannot have."""
    for name, fact in element.attributes.items():
        if (
            isinstance(fact, str)
            and name in list_features(element.kind)
            and replace_illegal_in_xml(fact)[1]
        ):
            yield name


_SUFFIXES = {"sysml": ".sysmlx", "kerml": ".kermlx"}


def write(
    document: Document,
    others: Sequence[Document] | InterchangeFiles,
    sink: Sink,
    path_of: Callable[[Document], str] | None = None,
) -> bytes:
    """Return the document as an interchange file, with references as they are resolved.

    ``others`` are the documents, libraries included, that references may lead to. Such a reference
    is written as an href relative to the path of the document; ``path_of`` returns the paths of
    documents, by default those of the same names. To write several documents of a model, pass the
    same ``InterchangeFiles``. An unresolved reference is reported and omitted.
    """
    files = others if isinstance(others, InterchangeFiles) else InterchangeFiles(others)
    writer = _Writer(document, files, sink, path_of or interchange_path)
    return print_file(writer.root, writer.targets).encode()


def interchange_path(document: Document) -> str:
    """Return the path of the interchange file of a document: that of its text, another suffix."""
    path = make_path_of_input(document.path.removeprefix(SHIPPED))
    return splitext(path)[0] + _SUFFIXES[document.language]


class _Writer:
    def __init__(
        self,
        document: Document,
        others: InterchangeFiles,
        sink: Sink,
        path_of: Callable[[Document], str],
    ) -> None:
        self._at = path_of
        self._document = document
        self._sink = sink
        self._others = others
        self._file = InterchangeFile(document, others.redefined)
        self._folder = dirname(path_of(document)) or "."
        self.root = self._file.root
        self._prune()

    def targets(self, element: Element) -> Targets:
        """Return what the features of an element refer to."""
        targets: Targets = {}
        for feature, target in element.targets:
            if isinstance(target, Element):
                targets.setdefault(feature, []).append((target.id, ""))
            else:
                targets.setdefault(feature, []).append(self._resolve_link(feature, target))
        return targets

    # -- references ------------------------------------------------------------------------------

    def _resolve_link(self, feature: str, link: Link) -> tuple[str, str]:
        node = link.node
        if node is None:
            return link.text, "Element"
        root = find_root(node)
        file = self._file if root is self._document.root else self._others.find_file(root)
        target = file.target(node, feature) if file else None
        if file is None or target is None:
            return "", ""
        if root is self._document.root:
            return target.id, ""
        path = relpath(self._at(file.document), self._folder)
        return f"{quote(path)}#{target.id}", target.kind

    # -- what cannot be written ------------------------------------------------------------------

    def _prune(self) -> None:
        """Report and remove the relationships with unresolved targets."""
        node = self._document.root
        for element, _ in walk_elements(self.root):
            node = element.node or node
            for feature in _find_unwritable(element):
                self._report(rules.UNWRITABLE_TEXT, node, feature)
            lost = {owned: next(_find_lost(owned), None) for owned in element.owned}
            for name in filter(None, lost.values()):
                self._report(rules.UNWRITTEN_REFERENCE, node, name)
            # A relationship without its target would not be valid against the metamodel.
            element.owned[:] = [owned for owned in element.owned if lost[owned] is None]

    def _report(self, rule: Rule, node: Node, what: str) -> None:
        where = locate(self._document, node.start)
        facts = {"element": describe_node(node), "name": what, "feature": what}
        self._sink.report(
            rule, Subject(describe_node(node), place=where), notes=(), help="", **facts
        )


def _find_lost(element: Element) -> Iterator[str]:
    """Yield the unresolved references of a relationship and of a chain that it owns.

    An href of a file that was read is written unchanged.
    """
    for _, target in element.targets:
        if isinstance(target, Link) and target.node is None and "#" not in target.text:
            yield str(target.reference)
    for owned in element.owned:
        if owned.node is None and owned.kind in ("Feature", "FeatureChaining"):
            yield from _find_lost(owned)
