"""Reports about elements that no diagram shows, and about messages that PlantUML cannot draw."""

from collections.abc import Collection

from sysmlc.backends.plantuml.connections import is_within_association
from sysmlc.backends.plantuml.sequence_labels import name_of_event
from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.ir.compare.titles import spell_kind
from sysmlc.ir.query import interactions
from sysmlc.support.counts import count

NOT_DRAWN = rule(
    "SM701",
    "in-no-diagram",
    Severity.INFO,
    "{count} of '{owner}' in no diagram: {names}",
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
"""Kinds that some diagram shows."""

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
"""Kinds that no diagram shows although authors give their elements a meaning."""

_FILES = frozenset({"caex", "collada", "plcopen", "external-data"})
"""Subkinds of documents that represent files, of which no diagram is expected."""
_NAMES_SHOWN = 3


def report_undrawn(graph: Graph, shown: Collection[str], sink: Sink) -> None:
    """Report the elements whose ids are not in *shown*, in one diagnostic for each owner and kind.

    Elements inside a reported element are not reported. Template parameters count as shown, because
    the name of the template lists them.
    """
    candidates = graph.of_kind(*DRAWN_KINDS, *OTHER_KINDS)
    undrawn = [
        item
        for item in candidates
        if item.id not in shown
        and _is_expected(item)
        and not (item.kind is Kind.ITEM_FLOW and is_within_association(graph, item))
    ]
    formal = {
        item.id
        for parameter in graph.of_kind(Kind.TEMPLATE_PARAMETER)
        for item in graph.owned(parameter)
    }
    undrawn = [item for item in undrawn if item.id not in formal]
    undrawn_ids = {item.id for item in undrawn}
    groups: dict[tuple[str, Kind], list[Element]] = {}
    for item in undrawn:
        if not any(owner_.id in undrawn_ids for owner_ in graph.ancestors(item)):
            groups.setdefault((item.owner or "", item.kind), []).append(item)
    for (owner, kind), items in groups.items():
        _report_group(graph, graph.get(owner), kind, items, sink)


def _is_expected(item: Element) -> bool:
    is_drawing = item.kind is Kind.VIEW and item.subkind == "diagram"
    is_file = item.kind is Kind.DOCUMENT and item.subkind in _FILES
    return not item.attrs.get("external") and not is_drawing and not is_file


def _report_group(
    graph: Graph, owner: Element | None, kind: Kind, items: list[Element], sink: Sink
) -> None:
    names = [" ".join(item.name.split()) or "without name" for item in items[:_NAMES_SHOWN]]
    names += ["..."] if len(items) > _NAMES_SHOWN else []
    sink.report(
        NOT_DRAWN,
        graph.subject(items[0]),
        count=count(len(items), spell_kind(kind)),
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
    """Report each message that another event overtakes on the receiving lifeline.

    PlantUML draws a message at one height, so that it cannot show a message that is under way.
    """
    for interaction in graph.of_kind(Kind.INTERACTION):
        for container in interactions.iter_containers(graph, interaction):
            items = interactions.interaction_fragments(graph, container)
            positions = {item.id: number for number, item in enumerate(items)}
            for item in items:
                _check_overtaking(graph, sink, interaction, items, positions, item)


def _check_overtaking(
    graph: Graph,
    sink: Sink,
    interaction: Element,
    items: list[Element],
    positions: dict[str, int],
    send_event: Element,
) -> None:
    message = interactions.sent_message(graph, send_event)
    receive_event = graph.target(message, Edge.RECEIVE_EVENT) if message is not None else None
    if message is None or receive_event is None or receive_event.id not in positions:
        return
    lifelines = {lifeline.id for lifeline in interactions.covered_lifelines(graph, receive_event)}
    for other in items[positions[send_event.id] + 1 : positions[receive_event.id]]:
        shared = [
            lifeline
            for lifeline in interactions.covered_lifelines(graph, other)
            if lifeline.id in lifelines
        ]
        if shared and _find_drawn_position(graph, positions, other) > positions[send_event.id]:
            _report_overtaken(graph, sink, interaction, message, other, shared[0])
            return


def _find_drawn_position(graph: Graph, positions: dict[str, int], event: Element) -> int:
    """Return the position at which PlantUML draws an event.

    A received message is drawn where it is sent. An execution has no position of its own (-1),
    because its occurrences draw it.
    """
    if event.kind is Kind.EXECUTION:
        return -1
    message = interactions.received_message(graph, event)
    first = graph.target(message, Edge.SEND_EVENT) if message is not None else None
    return min(
        positions[event.id],
        positions.get(first.id, positions[event.id]) if first is not None else positions[event.id],
    )


def _report_overtaken(
    graph: Graph, sink: Sink, interaction: Element, message: Element, other: Element, line: Element
) -> None:

    sink.report(
        OVERTAKEN,
        graph.subject(message),
        message=name_of_event(graph, message),
        interaction=graph.qualified_name(interaction),
        other=name_of_event(graph, other),
        lifeline=line.name or "without name",
    )
