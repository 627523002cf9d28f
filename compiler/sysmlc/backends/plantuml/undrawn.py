"""What no diagram shows: one finding for each owner and kind."""

from collections.abc import Collection

from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.ir.query import interactions as sequence

NOT_DRAWN = rule(
    "SM701",
    "in-no-diagram",
    Severity.INFO,
    "{count} {kind} of '{owner}' in no diagram: {names}",
    help="the element is still in the graph (--emit graph) and in the other outputs",
)

DRAWN_KINDS = (
    Kind.CLASS,
    Kind.COMPONENT,
    Kind.INTERFACE,
    Kind.DATA_TYPE,
    Kind.ENUMERATION,
    Kind.ENUMERATION_LITERAL,
    Kind.SIGNAL,
    Kind.ACTOR,
    Kind.INSTANCE,
    Kind.SLOT,
    Kind.ITEM,
    Kind.ASSOCIATION,
    Kind.PROPERTY,
    Kind.PORT,
    Kind.FLOW_PROPERTY,
    Kind.OPERATION,
    Kind.RECEPTION,
    Kind.PARAMETER,
    Kind.CONSTRAINT,
    Kind.CONNECTOR,
    Kind.CONNECTOR_END,
    Kind.ITEM_FLOW,
    Kind.DEPENDENCY,
    Kind.REQUIREMENT,
    Kind.TEST_CASE,
    Kind.ACTIVITY,
    Kind.ACTION,
    Kind.STRUCTURED,
    Kind.PIN,
    Kind.ACTIVITY_PARAMETER,
    Kind.OBJECT_NODE,
    Kind.DATA_STORE,
    Kind.CONTROL,
    Kind.CONTROL_FLOW,
    Kind.OBJECT_FLOW,
    Kind.PARTITION,
    Kind.STATE_MACHINE,
    Kind.REGION,
    Kind.STATE,
    Kind.PSEUDOSTATE,
    Kind.FINAL_STATE,
    Kind.TRANSITION,
    Kind.TRIGGER,
    Kind.INTERACTION,
    Kind.LIFELINE,
    Kind.MESSAGE,
    Kind.FRAGMENT,
    Kind.OPERAND,
    Kind.OBSERVATION,
    Kind.USE_CASE,
    Kind.EXTEND,
    Kind.EXTENSION_POINT,
)
"""Kinds that have a place in the diagrams."""

OTHER_KINDS = (
    Kind.UNIT,
    Kind.QUANTITY_KIND,
    Kind.VIEW,
    Kind.GENERAL_ORDERING,
    Kind.GENERALIZATION_SET,
    Kind.PARAMETER_SET,
    Kind.STEREOTYPE,
    Kind.DOCUMENT,
)
"""Kinds with a meaning of their own that no diagram has a place for."""

_FILES = frozenset({"caex", "collada", "plcopen", "external-data"})
"""Subkinds of documents that stand for files, of the model and of others it refers to."""
_NAMES_SHOWN = 3


def report(graph: Graph, shown: Collection[str], sink: Sink) -> None:
    """Report every element of the model that no diagram shows; ``shown`` are the ids of the others.

    What stands inside an element that is reported is not reported again. What a parameter of a
    template stands for is named behind the template's name.
    """
    known = graph.of_kind(*DRAWN_KINDS, *OTHER_KINDS)
    missed = [item for item in known if item.id not in shown and _is_ours(item)]
    formal = {
        item.id for one in graph.of_kind(Kind.TEMPLATE_PARAMETER) for item in graph.owned(one)
    }
    missed = [item for item in missed if item.id not in formal]
    gone = {item.id for item in missed}
    groups: dict[tuple[str, Kind], list[Element]] = {}
    for item in missed:
        if not any(above.id in gone for above in graph.ancestors(item)):
            groups.setdefault((item.owner or "", item.kind), []).append(item)
    for (owner, kind), items in groups.items():
        _report(graph, graph.get(owner), kind, items, sink)


def _is_ours(item: Element) -> bool:
    is_drawing = item.kind is Kind.VIEW and item.subkind == "diagram"
    is_file = item.kind is Kind.DOCUMENT and item.subkind in _FILES
    return not item.attrs.get("external") and not is_drawing and not is_file


def _report(
    graph: Graph, owner: Element | None, kind: Kind, items: list[Element], sink: Sink
) -> None:
    names = [" ".join(item.name.split()) or "without name" for item in items[:_NAMES_SHOWN]]
    names += ["..."] if len(items) > _NAMES_SHOWN else []
    sink.report(
        NOT_DRAWN,
        graph.subject(items[0]),
        count=len(items),
        kind=kind if len(items) == 1 else f"{kind} elements",
        owner=graph.qualified_name(owner) if owner is not None else "the model",
        names=", ".join(names),
    )


OVERTAKEN = rule(
    "SM710",
    "overtaken-message",
    Severity.INFO,
    "message '{message}' of '{interaction}' is drawn where it is sent, though '{other}' comes "
    "first on lifeline '{lifeline}'",
)


def report_overtaken_messages(graph: Graph, sink: Sink) -> None:
    """Report each message that something else overtakes on the lifeline that receives it."""
    for interaction in graph.of_kind(Kind.INTERACTION):
        for container in sequence.containers(graph, interaction):
            items = sequence.happenings(graph, container)
            at = {item.id: number for number, item in enumerate(items)}
            for item in items:
                _check_overtaking(graph, sink, interaction, items, at, item)


def _check_overtaking(
    graph: Graph,
    sink: Sink,
    interaction: Element,
    items: list[Element],
    at: dict[str, int],
    sent: Element,
) -> None:
    message = sequence.sent(graph, sent)
    received = graph.target(message, Edge.RECEIVE_EVENT) if message is not None else None
    if message is None or received is None or received.id not in at:
        return
    lifelines = {one.id for one in sequence.covered(graph, received)}
    for other in items[at[sent.id] + 1 : at[received.id]]:
        found = [one for one in sequence.covered(graph, other) if one.id in lifelines]
        if found and _drawn_position(graph, at, other) > at[sent.id]:
            _report_overtaken(graph, sink, interaction, message, other, found[0])
            return


def _drawn_position(graph: Graph, at: dict[str, int], other: Element) -> int:
    """Where it is drawn: a message at the first of its ends, an execution with its ends."""
    if other.kind is Kind.EXECUTION:
        return -1
    message = sequence.received(graph, other)
    first = graph.target(message, Edge.SEND_EVENT) if message is not None else None
    return min(at[other.id], at.get(first.id, at[other.id]) if first is not None else at[other.id])


def _report_overtaken(
    graph: Graph, sink: Sink, interaction: Element, message: Element, other: Element, line: Element
) -> None:
    from sysmlc.backends.plantuml.sequence_labels import event_name

    sink.report(
        OVERTAKEN,
        graph.subject(message),
        message=event_name(graph, message),
        interaction=graph.qualified_name(interaction),
        other=event_name(graph, other),
        lifeline=line.name or "without name",
    )
