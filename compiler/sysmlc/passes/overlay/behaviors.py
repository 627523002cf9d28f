"""Behaviours that a SysML model describes and the overlay gives to blocks and operations."""

from sysmlc.ir import Edge, Element
from sysmlc.ir.query import parameters
from sysmlc.overlay.model import BlockEntry, OperationEntry, Term
from sysmlc.passes.overlay import rules
from sysmlc.passes.overlay.blocks import add_parameter, operation_of
from sysmlc.passes.overlay.finder import BEHAVIOR, BLOCK, Finder


def note_behaviors(finder: Finder, entry: BlockEntry) -> None:
    """Look for the behaviours of a block while all of them are where their model has them."""
    for term in (entry.behavior, *(operation.method for operation in entry.operations)):
        if term is not None:
            finder.behaviors[term.text] = finder.named(term.text, BEHAVIOR)


def add_behaviors(finder: Finder, entry: BlockEntry) -> None:
    """Make activities and state machines methods, or the block's classifier behaviour."""
    block = block_of(finder, entry)
    if block is None:
        return
    if entry.behavior is not None:
        _give(finder, block, block, Edge.CLASSIFIER_BEHAVIOR, entry.behavior)
    for operation in entry.operations:
        if operation.method is not None:
            _give_method(finder, block, operation, operation.method)


def behaviors_of(finder: Finder, block: Element) -> list[Element]:
    """Behaviours that a block owns: those that overlays gave it are among them."""
    owned = finder.graph.owned(block)
    return [one for one in owned if one.kind in BEHAVIOR.kinds]


def block_of(finder: Finder, entry: BlockEntry) -> Element | None:
    """The block of an entry; that it is not clear has been reported before."""
    for word in (entry.key.text, entry.key.path):
        found = finder.named(word, BLOCK) if word else []
        if found:
            return found[0] if len(found) == 1 else None
    return None


def _give_method(finder: Finder, block: Element, entry: OperationEntry, method: Term) -> None:
    graph = finder.graph
    operation = operation_of(finder, block, entry.name)
    if operation is None or graph.owner(operation) is not block:
        return
    found = _give(finder, block, operation, Edge.METHOD, method)
    if found is not None and entry.parameters is None and not parameters(graph, operation):
        for number, one in enumerate(parameters(graph, found)):
            direction = str(one.attrs.get("direction", "in"))
            word = Term(one.name, entry.name.spot)
            add_parameter(
                finder, operation, number, word, direction, graph.target(one, Edge.TYPED_BY)
            )


def _give(
    finder: Finder, block: Element, holder: Element, edge: Edge, term: Term
) -> Element | None:
    """Let the edge lead to the behaviour, which the block owns then (UML 2.5.1 clause 13.2.3)."""
    graph = finder.graph
    known = graph.target(holder, edge)
    if known is not None and graph.owner(known) is block and known.name == _last(term):
        return known
    found = finder.only(term, finder.behaviors.get(term.text, []), BEHAVIOR, "")
    if found is None:
        return None
    taken = _taken_by(finder, found)
    if known is not None or taken is not None:
        about = graph.qualified_name(taken or holder)
        behavior = (found if known is None else known).name
        finder.report(rules.BEHAVIOR_TAKEN, term, behavior=behavior, holder=about)
        return None
    graph.move(found, block)
    graph.connect(edge, holder, found)
    return found


def _last(term: Term) -> str:
    return term.text.rpartition("#")[2].rpartition("::")[2].rpartition("/")[2].strip("[]")


def _taken_by(finder: Finder, behavior: Element) -> Element | None:
    """Whose method or classifier behaviour it is already."""
    for edge in (Edge.METHOD, Edge.CLASSIFIER_BEHAVIOR):
        found = finder.graph.source(behavior, edge)
        if found is not None:
            return found
    return None
