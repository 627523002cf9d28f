"""Writes trees of KerML and SysML v2 as XMI (.kermlx, .sysmlx; KerML 1.0, 10.2)."""

import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from posixpath import dirname, relpath, splitext
from urllib.parse import quote

from sysmlc.diagnostics import Rule, Sink, Subject
from sysmlc.language.interchange import rules
from sysmlc.language.interchange.effective_names import Redefined, nothing, shown
from sysmlc.language.interchange.element_ids import conjugated, identify
from sysmlc.language.interchange.elements import Element, Link, walk
from sysmlc.language.interchange.metamodel import stated
from sysmlc.language.interchange.unfolding import unfold
from sysmlc.language.library import SHIPPED
from sysmlc.language.metaclasses import is_a
from sysmlc.language.tree import AttributeValue, Document, Node, find_root, locate

_MEMBERSHIPS = {"importedMembership"}
"""Features that refer to the membership of an element, not to the element."""


class File:
    """An unfolded document, and which elements of it are those of which nodes."""

    def __init__(self, document: Document, redefined: Redefined = nothing) -> None:
        self.document = document
        self.root = unfold(document.root)
        identify(self.root, document, redefined)
        self._elements: dict[Node, Element] = {}
        self._memberships: dict[Node, Element] = {}
        self._conjugates: dict[Node | None, Element] = {}
        for element, owner in walk(self.root):
            if element.node is not None:
                self._memberships.setdefault(element.node, element)
                self._elements[element.node] = element
            if element.kind == "ConjugatedPortDefinition" and owner is not None:
                self._conjugates[conjugated(element)] = element

    def target(self, node: Node, feature: str) -> Element | None:
        """The element that a feature refers to when it leads to ``node``."""
        if feature == "conjugatedPortDefinition":
            return self._conjugates.get(node)
        return (self._memberships if feature in _MEMBERSHIPS else self._elements).get(node)


class Files:
    """The documents that references may lead to; those of a library may be shared by models.

    ``redefined`` says what features redefine implicitly: they are named, and have ids, by that.
    """

    def __init__(
        self,
        documents: Iterable[Document],
        library: "Files | None" = None,
        redefined: Redefined = nothing,
    ) -> None:
        self.redefined = redefined
        self._documents: dict[Node, Document] = {}
        self._files: dict[Node, File] = {}
        self._library = library
        self.add(documents)

    def add(self, documents: Iterable[Document]) -> None:
        """References may lead to these documents too."""
        self._documents.update((document.root, document) for document in documents)

    def of(self, root: Node) -> File | None:
        """The file of the document with that root; None for one that is not known."""
        if root in self._files:
            return self._files[root]
        if root in self._documents:
            return self._files.setdefault(root, File(self._documents[root], self.redefined))
        return self._library.of(root) if self._library is not None else None


NAMESPACE = "https://www.omg.org/spec/SysML/20250201"
_ROOT = (
    'xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI"'
    ' xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"'
    f' xmlns:sysml="{NAMESPACE}"'
)
_RELATIONSHIP, _RELATED = "ownedRelationship", "ownedRelatedElement"
_ESCAPES = str.maketrans(
    {"&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;", "\n": "&#xA;", "\t": "&#x9;"}
    | {"\r": "&#xD;"}
)
FORBIDDEN = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\ud800-\udfff\ufffe\uffff]")
"""What XML 1.0 cannot have in any way."""
_REPLACEMENT = "\ufffd"
_OF_ANY_KIND = {"memberElement", "annotatedElement", "client", "supplier"}
"""Features typed by the abstract Element: a reference to another file says the metaclass."""

Targets = dict[str, list[tuple[str, str]]]
"""The targets of an element by feature: the id or the href, and for an href the metaclass."""


def lines(root: Element, targets: Callable[[Element], Targets]) -> Iterator[str]:
    """The lines of the file with this root namespace."""
    yield '<?xml version="1.0" encoding="UTF-8"?>'
    tag = f"sysml:{root.kind}"
    stack: list[str | tuple[Element, str, str, str]] = [(root, tag, f"{tag} {_ROOT}", "")]
    while stack:
        item = stack.pop()
        if isinstance(item, str):
            yield item
        else:
            yield _begin(*item, stack, targets(item[0]))


def _begin(
    element: Element,
    tag: str,
    start: str,
    indent: str,
    stack: list[str | tuple[Element, str, str, str]],
    found: Targets,
) -> str:
    """The start tag of an element; what comes after it is put on the stack, last things first."""
    local = {name: [id for id, kind in ones if not kind] for name, ones in found.items()}
    texts = {name: _text(fact) for name, fact in element.attributes.items()}
    texts |= {name: " ".join(ids) for name, ids in local.items() if ids}
    said = "".join(f' {name}="{text.translate(_ESCAPES)}"' for name, text in texts.items())
    inner = f"{indent}  "
    hrefs = list(_hrefs(found, inner))
    begun = f'{indent}<{start} xmi:id="{element.id}" elementId="{element.id}"{said}'
    if not element.owned and not hrefs:
        return f"{begun}/>"
    stack += [f"{indent}</{tag}>", *reversed(hrefs)]
    for owned in reversed(element.owned):
        name = _tag(element, owned)
        stack.append((owned, name, f'{name} xsi:type="sysml:{owned.kind}"', inner))
    return f"{begun}>"


def _tag(element: Element, owned: Element) -> str:
    """What owns it: a plain relationship owns elements, but annotations as relationships."""
    is_plain = is_a(element.kind, "Relationship") and not is_a(element.kind, "Namespace")
    return _RELATED if is_plain and owned.kind != "Annotation" else _RELATIONSHIP


def _hrefs(found: Targets, indent: str) -> Iterable[str]:
    for name, ones in found.items():
        for href, kind in ones:
            if kind:
                type = f' xsi:type="sysml:{kind}"' if name in _OF_ANY_KIND else ""
                yield f'{indent}<{name}{type} href="{href.translate(_ESCAPES)}"/>'


def _text(fact: AttributeValue) -> str:
    if isinstance(fact, bool):
        return "true" if fact else "false"
    return FORBIDDEN.sub(_REPLACEMENT, str(fact))


def is_writable(element: Element) -> Iterator[str]:
    """The features of the element with characters that XML cannot have."""
    for name, fact in element.attributes.items():
        if isinstance(fact, str) and name in stated(element.kind) and FORBIDDEN.search(fact):
            yield name


_REPOSITORY = re.compile(r"(^|/)\.(git(?:/|$))", re.IGNORECASE)
_SUFFIXES = {"sysml": ".sysmlx", "kerml": ".kermlx"}


def write(
    document: Document,
    others: Sequence[Document] | Files,
    sink: Sink,
    at: Callable[[Document], str] | None = None,
) -> bytes:
    """The document as an interchange file; references are those that names were resolved to.

    ``others`` are the documents, libraries included, that references may lead to: they become
    hrefs relative to the path of the document, to where ``at`` says that the interchange
    files are, by default those of the same names; to write several documents of a model, they are
    given as the same ``Files``. What leads nowhere is reported and left out.
    """
    files = others if isinstance(others, Files) else Files(others)
    writer = _Writer(document, files, sink, at or interchange_path)
    return ("\n".join(lines(writer.root, writer.targets)) + "\n").encode()


def interchange_path(document: Document) -> str:
    """Return the path of the interchange file of a document: another suffix, archives as folders.

    What an output path may not contain (backslashes, repositories of git) is percent-encoded.
    """
    path = document.path.removeprefix(SHIPPED).replace("!", "/").replace("\\", "%5C")
    path = _REPOSITORY.sub(r"\1%2E\2", path)
    return splitext(path)[0] + _SUFFIXES[document.language]


class _Writer:
    def __init__(
        self,
        document: Document,
        others: Files,
        sink: Sink,
        at: Callable[[Document], str],
    ) -> None:
        self._at = at
        self._document = document
        self._sink = sink
        self._others = others
        self._file = File(document, others.redefined)
        self._folder = dirname(at(document)) or "."
        self.root = self._file.root
        self._prune()

    def targets(self, element: Element) -> Targets:
        """What the features of an element refer to."""
        found: Targets = {}
        for feature, target in element.targets:
            if isinstance(target, Element):
                found.setdefault(feature, []).append((target.id, ""))
            else:
                found.setdefault(feature, []).append(self._link(feature, target))
        return found

    # -- references ------------------------------------------------------------------------------

    def _link(self, feature: str, link: Link) -> tuple[str, str]:
        node = link.node
        if node is None:
            return link.text, "Element"
        root = find_root(node)
        file = self._file if root is self._document.root else self._others.of(root)
        target = file.target(node, feature) if file else None
        if file is None or target is None:
            return "", ""
        if root is self._document.root:
            return target.id, ""
        path = relpath(self._at(file.document), self._folder)
        return f"{quote(path)}#{target.id}", target.kind

    # -- what cannot be written ------------------------------------------------------------------

    def _prune(self) -> None:
        """Report and take out the relationships whose targets are not known."""
        about = self._document.root
        for element, _ in walk(self.root):
            about = element.node or about
            for feature in is_writable(element):
                self._report(rules.UNWRITABLE_TEXT, about, feature)
            lost = {owned: next(_lost(owned), None) for owned in element.owned}
            for name in filter(None, lost.values()):
                self._report(rules.UNWRITTEN_REFERENCE, about, name)
            element.owned[:] = [owned for owned in element.owned if lost[owned] is None]

    def _report(self, rule: Rule, node: Node, what: str) -> None:
        where = locate(self._document, node.start)
        facts = {"element": shown(node), "name": what, "feature": what}
        self._sink.report(rule, Subject(shown(node), place=where), notes=(), help="", **facts)


def _lost(element: Element) -> Iterator[str]:
    """How references of a relationship, and of a chain that it owns, are named that lead nowhere.

    An href of a file that was read stays what it is.
    """
    for _, target in element.targets:
        if isinstance(target, Link) and target.node is None and "#" not in target.text:
            yield str(target.reference)
    for owned in element.owned:
        if owned.node is None and owned.kind in ("Feature", "FeatureChaining"):
            yield from _lost(owned)
