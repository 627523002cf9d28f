"""The look of activity nodes: shape, title, and pins as rows."""

from collections.abc import Iterator

from msgspec import Struct

from sysmlc.backends.plantuml import labels
from sysmlc.backends.plantuml.relations import list_node_allocations
from sysmlc.backends.plantuml.state_machine import format_trigger
from sysmlc.ir import Edge, Element, Graph, Kind, as_texts, list_items
from sysmlc.ir.query import has_generated_name
from sysmlc.ir.query.classifiers import name_value_unit
from sysmlc.support.plantuml_text import format_label, wrap_lines

_CONTROL_SHAPES = {
    "initial": "start",
    "final": "end",
    "flow-final": "flowfinal",
    "decision": "choice",
    "merge": "choice",
    "fork": "fork",
    "join": "join",
}
_WITHOUT_KEYWORD = frozenset(["call-behavior", "call-operation", "opaque", ""])
_KEYWORDS = {
    "send": "send signal",
    "accept": "accept event",
    "accept-call": "accept call",
    "read": "read",
    "write": "write",
}
_SHAPES = {"accept": "accept", "accept-call": "accept", "send": "send", "broadcast": "send"}
_ROW_WIDTH = 44


class Look(Struct, frozen=True):
    """The look of a node.

    ``words`` are keywords and stereotypes. ``pins`` are the ids of the pins that the rows show, and
    ``shows`` the ids of the other elements that they show.
    """

    shape: str
    title: str
    words: tuple[str, ...] = ()
    rows: tuple[str, ...] = ()
    note: str = ""
    pins: tuple[str, ...] = ()
    shows: tuple[str, ...] = ()


def choose_look(graph: Graph, node: Element) -> Look:
    """Return the look of an activity node, from its kind and subkind."""
    if node.kind is Kind.CONTROL:
        return _look_of_control(graph, node)
    if node.kind in (Kind.ACTION, Kind.STRUCTURED):
        return _look_of_action(graph, node)
    return _look_of_object(graph, node)


def iter_handlers(graph: Graph, node: Element) -> Iterator[tuple[str, list[str]]]:
    """Yield the exception handlers of a protected node.

    Each is the id of the handler body with the names of the exception types.
    """
    for handler in list_items(node.attrs.get("handlers")):
        parts = list_items(handler)
        body, types = (as_texts(parts[index]) if len(parts) > index else () for index in (0, 2))
        elements = (graph.get(id) for id in types)
        yield (
            next(iter(body), ""),
            [labels.name(element) for element in elements if element is not None],
        )


def _look_of_control(graph: Graph, node: Element) -> Look:
    shape = _CONTROL_SHAPES.get(node.subkind, "control")
    if shape == "flowfinal":
        # State diagrams of PlantUML have no flow final node, so a large sign is drawn as text.
        return Look("flowfinal", "<size:22>⊗</size>")
    return Look(
        shape, format_label(labels.name(node)), note=format_label(_format_control_note(graph, node))
    )


def _format_control_note(graph: Graph, node: Element) -> str:
    """Return the texts that PlantUML cannot print inside a diamond or a bar."""
    behaviour = graph.get(str(node.attrs.get("decision_input", "")))
    parts = [
        "" if node.subkind == "initial" or has_generated_name(node) else node.name,
        f"«decisionInput» {labels.name(behaviour)}" if behaviour is not None else "",
        f"{{joinSpec = {node.attrs['join_spec']}}}" if node.attrs.get("join_spec") else "",
    ]
    return "\n".join(part for part in parts if part)


def _look_of_object(graph: Graph, node: Element) -> Look:
    words = {Kind.DATA_STORE: ("datastore",), Kind.OBJECT_NODE: ("centralBuffer",)}
    if node.subkind == "expansion":
        words[Kind.OBJECT_NODE] = ("expansionNode",)
    direction = node.attrs.get("direction")
    applied = labels.list_stereotypes(graph, node)
    # A node without a name has the name of the parameter or state that it refers to.
    typed = next((t for t in (node, *graph.targets(node, Edge.REFERENCES)) if t.name), node)
    text = labels.format_typed(graph, node)
    if node.kind is Kind.ACTIVITY_PARAMETER:
        parameter = graph.target(node, Edge.REFERENCES)
        source = parameter if parameter is not None else node
        text = labels.format_typed(graph, source, node.name or typed.name)
        words = {Kind.ACTIVITY_PARAMETER: (f"parameter {direction}" if direction else "parameter",)}
    shape = "store" if node.kind is Kind.DATA_STORE else "object"
    return Look(
        shape, format_label(text), applied or words.get(node.kind, ()), _format_states(graph, node)
    )


def _format_states(graph: Graph, node: Element) -> tuple[str, ...]:
    """Return the row with the states of the objects in this node."""
    names = [s.name for s in graph.targets(node, Edge.REFERENCES) if s.kind is Kind.STATE]
    return wrap_lines(f"[{', '.join(names)}]") if names else ()


def _look_of_action(graph: Graph, node: Element) -> Look:
    pins = [item for item in graph.owned(node) if item.kind is Kind.PIN]
    behaviours = graph.targets(node, Edge.CALLS)
    details = [item for item in graph.owned(node) if item.kind in (Kind.TRIGGER, Kind.CONSTRAINT)]
    rows = [
        *_iter_body_rows(node),
        *_iter_called_rows(node, behaviours),
        *_iter_detail_rows(graph, node, details),
    ]
    rows += [row for pin in pins for row in _format_pin(graph, pin)]
    allocations, ids = list_node_allocations(graph, node)
    return Look(
        _SHAPES.get(node.subkind, "structured" if node.kind is Kind.STRUCTURED else "action"),
        format_label(_format_title(graph, node, behaviours)),
        _list_keywords(graph, node),
        (*rows, *allocations),
        pins=tuple(pin.id for pin in pins),
        shows=(*(item.id for item in details), *ids),
    )


def _format_title(graph: Graph, node: Element, behaviours: list[Element]) -> str:
    if node.name:
        return node.name
    if behaviours:
        return ", ".join(labels.name(item) for item in behaviours)
    if "collection" in node.attrs:
        variables = (feature.name for feature in graph.owned(node) if feature.subkind == "variable")
        return f"for each {next(variables, 'one')} of {node.attrs['collection']}"
    return labels.literal(node.attrs.get("value")) if "value" in node.attrs else labels.name(node)


def _list_keywords(graph: Graph, node: Element) -> tuple[str, ...]:
    applied = labels.list_stereotypes(graph, node)
    if node.subkind == "expansion":
        return (str(node.attrs.get("mode") or "parallel"), *applied)
    if node.kind is Kind.STRUCTURED:
        return (node.subkind or "structured", *applied)
    # State diagrams of PlantUML have no shapes for accept and send actions (decision 10).
    kind = _KEYWORDS.get(node.subkind, node.subkind.replace("-", " "))
    return (
        applied
        if node.subkind in _WITHOUT_KEYWORD and applied
        else tuple(w for w in (kind, *applied) if w)
    )


def _iter_body_rows(node: Element) -> Iterator[str]:
    """Yield the body of an opaque action, or the value of a value action."""
    if node.attrs.get("body"):
        for part in labels.literal(node.attrs["body"]).splitlines():
            yield from wrap_lines(part, _ROW_WIDTH)
    if "value" in node.attrs and node.name:
        yield from wrap_lines(f"= {labels.literal(node.attrs['value'])}", _ROW_WIDTH)


def _iter_called_rows(node: Element, behaviours: list[Element]) -> Iterator[str]:
    for item in behaviours:
        if node.name and item.name.lower() != node.name.lower():
            yield from wrap_lines(f"calls {labels.name(item)}", _ROW_WIDTH)


def _iter_detail_rows(graph: Graph, node: Element, details: list[Element]) -> Iterator[str]:
    for item in details:
        if item.kind is Kind.TRIGGER:
            text = format_trigger(graph, item)
            yield from wrap_lines(text, _ROW_WIDTH) if text != node.name else ()
        else:
            yield from wrap_lines(labels.condition(item), _ROW_WIDTH)


def _format_pin(graph: Graph, pin: Element) -> tuple[str, ...]:
    """Return the rows ``in name : Type = value unit``."""
    direction = str(pin.attrs.get("direction", ""))
    name = pin.name or (pin.subkind if not graph.targets(pin, Edge.TYPED_BY) else "")
    value = f" = {labels.literal(pin.attrs['value'])}" if "value" in pin.attrs else ""
    unit = name_value_unit(graph, pin, "value")
    text = f"{direction} {labels.format_typed(graph, pin, name)}{value} {unit}".strip()
    return wrap_lines(text, _ROW_WIDTH)
