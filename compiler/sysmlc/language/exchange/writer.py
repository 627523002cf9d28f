"""Writes the tree of KerML and SysML v2 as XMI (.kermlx, .sysmlx; KerML 1.0, 10.2)."""

import re
from collections.abc import Callable, Iterator, Sequence
from posixpath import dirname, relpath, splitext
from urllib.parse import quote

from sysmlc.diagnostics import Rule, Sink, Subject
from sysmlc.language.exchange import rules
from sysmlc.language.exchange.elements import Element, Link, walk
from sysmlc.language.exchange.files import File, Files
from sysmlc.language.exchange.naming import shown
from sysmlc.language.exchange.xmi import Targets, is_writable, lines
from sysmlc.language.library import SHIPPED
from sysmlc.language.places import place
from sysmlc.language.tree import Document, Node

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
        root = _root(node)
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
        where = place(self._document, node.start)
        facts = {"element": shown(node), "name": what, "feature": what}
        self._sink.report(rule, Subject(shown(node), place=where), notes=(), help="", **facts)


def _root(node: Node) -> Node:
    while node.owner is not None:
        node = node.owner
    return node


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
