"""Triggers of accept actions and transitions: signals, calls, times and changes."""

from collections.abc import Iterable
from fractions import Fraction

from sysmlc.frontends.sysml import nodes, values
from sysmlc.frontends.sysml.expressions import write_expression
from sysmlc.frontends.sysml.lowering import Lowering
from sysmlc.frontends.sysml.quantities import read_unit
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.language.tree import Node
from sysmlc.support.units import find_unit

_CALL = "SysMLC::Call"


def lower_trigger(lowering: Lowering, accept: Node, owner: Element) -> Element:
    """Lower the trigger of an accept action; *owner* is the action or transition that waits."""
    parameters = list(nodes.iter_by_membership(accept, "ParameterMembership"))
    payload = parameters[0] if parameters else None
    port = nodes.value_of(parameters[1]) if len(parameters) > 1 else None
    trigger = lowering.add_derived(payload or accept, Kind.TRIGGER, "", owner)
    lowering.graph.connect(Edge.TRIGGER, owner, trigger)
    value = None if payload is None else nodes.value_of(payload)
    if value is not None and value.kind == "TriggerInvocationExpression":
        _describe_invocation(lowering, trigger, value)
    elif payload is not None:
        _describe_payload(lowering, trigger, payload)
    if port is not None:
        lowering.queue.defer_until_elements(lambda: _set_port(lowering, trigger, port))
    return trigger


def _describe_invocation(lowering: Lowering, trigger: Element, invocation: Node) -> None:
    """Describe a trigger by ``after``, ``at`` or ``when``."""
    kind = str(invocation.attributes.get("kind", ""))
    argument = next(iter(nodes.list_arguments(invocation)), None)
    if kind in ("after", "at"):
        when = "" if argument is None else _write_time(lowering, argument)
        lowering.set_attributes(trigger, subkind="time", when=when, relative=kind == "after")
        return
    lowering.set_attributes(trigger, subkind="change", immediate=True)
    values.defer_expression(lowering, trigger, "condition", argument)


def _write_time(lowering: Lowering, expression: Node) -> str:
    """Return a point in time or a duration as text: ``5 s``."""
    unit, factor = read_unit(lowering.trees, expression)
    number = values.constant_of(expression)
    known_unit = find_unit(unit)
    if isinstance(number, int | float) and known_unit and known_unit.quantity == "time":
        return f"{number if factor == 1 else float(Fraction(str(number)) * factor)} {unit}"
    return values.expression_text(expression, lowering)


def _describe_payload(lowering: Lowering, trigger: Element, payload: Node) -> None:
    """Set the kind of a trigger by the type of its payload: a call, any event or a signal."""
    types = lowering.trees.types_of(payload)
    names = [nodes.qualified_name_of(type_) for type_ in types]
    if _CALL in names:
        lowering.set_attributes(trigger, subkind="call")
        operation = nodes.name_of(payload)
        lowering.queue.defer_until_elements(
            lambda: _connect_operation(lowering.graph, trigger, operation)
        )
    elif names == ["Base::Anything"] or not payload.relations:
        lowering.set_attributes(trigger, subkind="any")
    else:
        name = nodes.name_of(payload)
        lowering.set_attributes(trigger, subkind="signal", payload=name)
        lowering.defer_edges(Edge.TYPED_BY, trigger, types)
        if not types:
            lowering.connect_node(Edge.TYPED_BY, trigger, None)
        lowering.queue.defer_until_elements(lambda: _mark_call(lowering, trigger))


def _mark_call(lowering: Lowering, trigger: Element) -> None:
    """Set the subkind ``call`` of a trigger whose payload type is an activity or an operation."""
    type_ = lowering.graph.target(trigger, Edge.TYPED_BY)
    if type_ is not None and type_.kind in (Kind.ACTIVITY, Kind.OPERATION):
        lowering.set_attributes(trigger, subkind="call")


def _connect_operation(graph: Graph, trigger: Element, name: str) -> None:
    """Connect a call to the operation *name* of the nearest classifier that has one.

    If none has, the operation may be that of any classifier, unless several have the name.
    """
    for ancestor in graph.ancestors(trigger):
        for operation in _list_operations(graph, ancestor):
            if operation.name == name:
                graph.connect(Edge.TYPED_BY, trigger, operation)
                return
    operations = [
        operation for operation in graph.of_kind(Kind.OPERATION) if operation.name == name
    ]
    if len(operations) == 1:
        graph.connect(Edge.TYPED_BY, trigger, operations[0])
    else:
        graph.set(trigger, unresolved=("typed-by",))


def _list_operations(graph: Graph, classifier: Element) -> list[Element]:
    """Return the operations of a classifier and of its generals."""
    visited, stack = {classifier.id}, [classifier]
    operations: list[Element] = []
    while stack:
        current = stack.pop()
        owned = graph.owned(current)
        operations += [member for member in owned if member.kind is Kind.OPERATION]
        for general in graph.targets(current, Edge.SPECIALIZES):
            if general.id not in visited:
                visited.add(general.id)
                stack.append(general)
    return operations


def _set_port(lowering: Lowering, trigger: Element, expression: Node) -> None:
    """Set the port at which an event arrives, and the parts and ports that lead to it."""
    path = nodes.path_of_expression(expression)
    *links, port = map(lowering.elements.find, path)
    if port is not None:
        lowering.graph.set(trigger, port=port.id)
        connect_links(lowering.graph, trigger, links)
    if None in path:
        lowering.graph.set(trigger, port_path=write_expression(expression))
        construct = "a path to a port that is no chain of features"
        lowering.verdicts.mark_approximated(expression, construct, "its text")


def connect_links(graph: Graph, holder: Element, links: Iterable[Element | None]) -> None:
    """Connect a trigger or an action to the parts and ports that lead to its port."""
    for link in links:
        if link is not None:
            graph.connect(Edge.PATH, holder, link)
