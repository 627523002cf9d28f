"""A compile unit: its documents are resolved together and lowered one after the other."""

from collections.abc import Sequence
from itertools import chain, pairwise
from typing import TYPE_CHECKING

from sysmlc.diagnostics import Coverage, Sink
from sysmlc.frontends.sysml.account import account
from sysmlc.frontends.sysml.blame import blame
from sysmlc.frontends.sysml.connections import steps_of_value
from sysmlc.frontends.sysml.handlers import HANDLERS
from sysmlc.frontends.sysml.lowering import Lowering
from sysmlc.frontends.sysml.parameters import pin_of
from sysmlc.frontends.sysml.places import Home
from sysmlc.frontends.sysml.strays import tell
from sysmlc.frontends.sysml.usage import ByKind, accepted, by_kind, flowing, together
from sysmlc.ir import Element, Graph, Kind
from sysmlc.ir.query.activities import pin_subkind
from sysmlc.language.library import SHIPPED
from sysmlc.language.tree import Document, Node
from sysmlc.support.recursion import allow_recursion

if TYPE_CHECKING:
    from sysmlc.language.names import Model


def lower(
    documents: Sequence[Document],
    model: "Model",
    graph: Graph,
    sink: Sink,
    coverage: Coverage,
) -> None:
    """Add the elements of all documents to the graph and account for every node of them."""
    homes = [Home(one) for one in documents]
    low = Lowering(homes, model, graph, sink, HANDLERS)
    each, depth = [], 0
    for home in homes:
        ours, levels = by_kind(home.document.root)
        low.settle_in(home, chain.from_iterable(ours.values()))
        each.append(ours)
        depth = max(depth, levels)
    found = together(each)
    low.accepted = accepted(found)
    low.flowing = flowing(found)
    # What waits until all else is there, such as ends of connections, may be as deep.
    with allow_recursion(depth):
        for root in low.roots:
            low.lower_all(root.members, None)
        low.last(lambda: _give_pins(low, found))
        low.finish()
    low.end_branches()
    _say_pins(graph)
    tell(low)
    blame(low)
    for home, ours in zip(homes, each, strict=True):
        if not home.path.startswith(SHIPPED):
            account(low, home, ours, coverage)


def _give_pins(low: Lowering, found: ByKind) -> None:
    """Give steps the output pins whose values other steps and guards speak of (``pick.ok``)."""
    for node in sorted(found.get("FeatureChainExpression", ()), key=_position):
        for step, feature in pairwise(low.element(one) for one in steps_of_value(node)):
            if step is not None and feature is not None and step.kind is Kind.ACTION:
                _give_pin(low, step, feature)


def _position(node: Node) -> list[int]:
    """Where a node is below the root: nodes in this order are in the order of the text."""
    found: list[int] = []
    while node.owner is not None:
        found.append(node.owner.members.index(node))
        node = node.owner
    return found[::-1]


def _give_pin(low: Lowering, step: Element, feature: Element) -> None:
    is_out = feature.attrs.get("direction") in ("out", "return", "inout")
    if feature.kind is Kind.PARAMETER and is_out:
        pin_of(low, step, feature)


def _say_pins(graph: Graph) -> None:
    """Say what the pins of calls and opaque actions are, where metadata does not."""
    for pin in graph.of_kind(Kind.PIN):
        owner = None if pin.subkind else graph.owner(pin)
        if owner is not None:
            graph.set(pin, subkind=pin_subkind(owner, pin) or None)
