"""A compile unit: its documents are resolved together and lowered one after the other."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

from sysmlc.diagnostics import Coverage, Sink, Verdict
from sysmlc.frontends.sysml.handlers import HANDLERS
from sysmlc.frontends.sysml.lowering import Lowering
from sysmlc.frontends.sysml.usage import accepted, flowing
from sysmlc.ir import Graph
from sysmlc.language.tree import Document, Node

if TYPE_CHECKING:
    from sysmlc.language.names import Model


def lower(
    documents: Sequence[Document], model: "Model", graph: Graph, sink: Sink, coverage: Coverage
) -> None:
    """Add the elements of all documents to the graph and account for every node of them."""
    low = Lowering(documents, model, graph, sink, HANDLERS)
    low.accepted = accepted(documents)
    low.flowing = flowing(documents)
    for document in documents:
        low.lower_all(document.root.members, None)
    low.finish()
    for document in documents:
        _count(low, document, coverage)


def _count(low: Lowering, document: Document, coverage: Coverage) -> None:
    """Count each node once; what has no verdict of its own shares that of its owner."""
    counts = coverage.file(document.path)
    found: list[tuple[Node, Verdict]] = [(document.root, Verdict.MAPPED)]
    while found:
        node, verdict = found.pop()
        counts.count(node.kind, verdict)
        for one in node.members:
            found.append((one, low.verdicts.get(id(one)) or _inherited(verdict)))


def _inherited(verdict: Verdict) -> Verdict:
    """What is inside an approximated element is mapped, unless something else was said of it."""
    return Verdict.MAPPED if verdict is Verdict.APPROXIMATED else verdict
