"""Values of what a behaviour deals with, by dotted names: arguments, payloads, results of steps."""

from collections.abc import Iterable, Iterator

from sysmlc.ir import Edge, Element, Graph, Kind, query

_STEPS = (Kind.ACTION, Kind.STRUCTURED)
_OBJECTS = (Kind.CLASS, Kind.COMPONENT, Kind.SIGNAL, Kind.DATA_TYPE)
_CALLED = (Kind.OPERATION, Kind.ACTIVITY)


def of_objects(graph: Graph, behaviour: Element) -> dict[str, Element]:
    """Features by the names that expressions of the behaviour have for them.

    ``machine.busy`` is a value of an argument, ``fault.severity`` one of what a trigger accepts,
    ``weigh.mass`` an output pin of a step, ``look.image.sharp`` a value of what such a pin holds,
    ``p.number`` one of what a structured node calls p.
    """
    arguments = [one for one in query.parameters(graph, behaviour) if one.name]
    found = dict(_values_of_all(graph, ((one.name, one) for one in arguments)))
    found |= _values_of_all(graph, _payloads(graph, behaviour))
    if behaviour.kind is Kind.ACTIVITY and _has_dotted_guard(graph, behaviour):
        pins = list(_pins(graph, behaviour, ""))
        objects = [*pins, *_variables(graph, behaviour)]
        found |= dict(pins) | dict(_values_of_all(graph, objects))
    return found


def of_ports(graph: Graph, classifier: Element) -> dict[str, Element]:
    """What flows through the ports of a classifier, by the name of the port before its own.

    ``level.value`` is a flow property of the type of port ``level`` (SysML 1.6 clause 9.3.2.7).
    """
    found: dict[str, Element] = {}
    for port in query.ports(graph, classifier):
        type_ = query.type_of(graph, port) if port.name else None
        for one in () if type_ is None or type_.kind not in _OBJECTS else _items(graph, type_):
            found.setdefault(f"{port.name}.{one.name}", one)
    return found


def _items(graph: Graph, type_: Element) -> Iterator[Element]:
    for one in query.features(graph, type_):
        if one.name and (query.is_flow_property(one) or one.role == "value"):
            yield one


def direction_at(graph: Graph, classifier: Element, name: str, element: Element) -> str:
    """Direction of a feature as the classifier has it: a conjugated port turns round what flows
    through it (SysML 1.6 clause 9.3.2.15). Empty when it has none.
    """
    given = element.attrs.get("direction")
    direction = given if isinstance(given, str) else ""
    head, dot, _ = name.partition(".")
    if not dot or not direction:
        return direction
    port = next((one for one in query.ports(graph, classifier) if one.name == head), None)
    turned = port is not None and port.attrs.get("conjugated")
    return (query.opposite(direction) or direction) if turned else direction


def _values_of_all(
    graph: Graph, objects: Iterable[tuple[str, Element]]
) -> Iterator[tuple[str, Element]]:
    for name, typed in objects:
        type_ = query.type_of(graph, typed)
        if type_ is not None and type_.kind in (*_OBJECTS, *_CALLED):
            for one in _values(graph, type_):
                yield f"{name}.{one.name}", one


def _values(graph: Graph, type_: Element) -> Iterator[Element]:
    """Values of an object, parameters of a call."""
    if type_.kind in _CALLED:
        yield from (one for one in graph.owned(type_) if one.kind is Kind.PARAMETER)
        return
    general = (one for above in query.generals(graph, type_) for one in graph.owned(above))
    for one in (*query.features(graph, type_), *general):
        if one.kind is Kind.PROPERTY and one.role == "value":
            yield one


def _payloads(graph: Graph, behaviour: Element) -> Iterator[tuple[str, Element]]:
    """Triggers by the names that they give to what they accept."""
    if behaviour.kind is not Kind.STATE_MACHINE:
        return
    for one in graph.subtree(behaviour):
        if one.kind is Kind.TRIGGER and "payload" in one.attrs:
            yield str(one.attrs["payload"]), one


def _pins(graph: Graph, owner: Element, prefix: str) -> Iterator[tuple[str, Element]]:
    """Output pins of steps; steps of a structured node with and without its name before them."""
    for step in graph.owned(owner):
        if step.kind not in _STEPS:
            continue
        if step.kind is Kind.STRUCTURED:
            yield from _pins(graph, step, prefix)
            yield from _pins(graph, step, f"{prefix}{step.name}.") if step.name else ()
        for pin in graph.owned(step) if step.name else ():
            if pin.kind is Kind.PIN and pin.name and pin.attrs.get("direction") == "out":
                yield f"{prefix}{step.name}.{pin.name}", pin


def _variables(graph: Graph, owner: Element) -> Iterator[tuple[str, Element]]:
    """Variables of structured nodes (the element that a loop is at)."""
    for one in graph.owned(owner):
        if one.kind is Kind.STRUCTURED:
            yield from _variables(graph, one)
        elif one.kind is Kind.PROPERTY and one.subkind == "variable" and one.name:
            yield one.name, one


def _has_dotted_guard(graph: Graph, owner: Element) -> bool:
    """Whether a guard or a change condition may speak of a step; it seldom does."""
    for one in graph.owned(owner):
        if "." in str(one.attrs.get("guard", "")):
            return True
        if one.kind is Kind.STRUCTURED and _has_dotted_guard(graph, one):
            return True
        if one.kind is Kind.ACTION and _has_dotted_trigger(graph, one):
            return True
    return False


def _has_dotted_trigger(graph: Graph, action: Element) -> bool:
    found = graph.targets(action, Edge.TRIGGER)
    return any("." in str(one.attrs.get("condition", "")) for one in found)
