"""Events and signals of the objects of a component.

All behaviours of an object see the same event in a step, at most one. What a part sends is visible
in the step after the reaction, and is the event of the receiver in that same step. A port that is
connected receives from its connections only; of several signals for one receiver one occurs.
"""

from collections.abc import Iterator, Mapping, Set
from typing import TYPE_CHECKING

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.ir import Edge, Element, Graph, Kind, query
from sysmlc.ir.expressions import ExpressionError, Send, name_of, print_expression
from sysmlc.logic import formula as f
from sysmlc.logic.components.objects import ComponentError, ComponentObject
from sysmlc.logic.composition.members import Block, Member, Wire, name_in_composite
from sysmlc.logic.composition.messages import (
    Receipt,
    derive_wiring,
    find_message_name,
    is_reachable_from_outside,
    iter_listeners,
    iter_unsent,
)
from sysmlc.logic.composition.structure import ITSELF
from sysmlc.logic.contract import (
    BooleanDomain,
    Class,
    Conjunct,
    Contract,
    EnumerationDomain,
    Owner,
    Source,
    Variable,
)
from sysmlc.logic.expressions.parsing import statements_of
from sysmlc.logic.formula import Const
from sysmlc.logic.identifiers import identifier
from sysmlc.logic.machines.machine import NO_EVENT
from sysmlc.logic.machines.supported_constructs import collect_submachines

if TYPE_CHECKING:
    from sysmlc.logic.components.component import Component

_RECEIVE = "receive_"


class Delivery(Struct, frozen=True):
    """A message that connections lead to an object: a literal of its event, and the senders.

    ``outputs`` are the variables that are true when the message is sent. ``is_open`` is true if the
    message may come from outside the component, too.
    """

    event: str
    message: str
    outputs: tuple[str, ...]
    is_open: bool


class Wiring(Struct, frozen=True):
    """The variables of events, and what restricts them.

    ``accepted`` has the event and its literal for each variable of an acceptance.
    """

    variables: list[Variable]
    conjuncts: list[Conjunct]
    gaps: Mapping[str, str]
    accepted: Mapping[str, tuple[str, str]]
    deliveries: list[Delivery]

    def list_internal(self) -> set[str]:
        """Return the variables of the acceptances that only parts of the component can end."""
        sent = {(item.event, item.message) for item in self.deliveries if not item.is_open}
        return {variable for variable, receipt in self.accepted.items() if receipt in sent}


def derive_events(component: "Component") -> Wiring:
    """Return the events of all objects and how they follow from what others send."""
    variables: list[Variable] = []
    conjuncts: list[Conjunct] = []
    members: list[Member] = []
    wires: list[Wire] = []
    acceptances: dict[str, tuple[str, str]] = {}
    for object_ in component.tree.objects:
        literals: dict[str, None] = {}
        origin = object_.type_.id
        for machine in component.machines:
            if machine.owner is object_:
                literals |= dict.fromkeys(machine.events)
        accepted = _list_accepted(component, object_)
        literals |= dict.fromkeys(accepted.values())
        literals.pop(NO_EVENT, None)
        if literals:
            name = component.events.setdefault(
                object_.path,
                component.names.new(f"{object_.path}_event") if object_.path else "event",
            )
            domain = EnumerationDomain((NO_EVENT, *literals))
            event = Variable(name, Owner.ENVIRONMENT, domain, origin)
            variables.append(event)
            for variable, message in accepted.items():
                acceptances[variable] = name, message
                formula = f.iff(f.var(variable), f.eq(f.var(name), Const(message)))
                conjuncts.append(Conjunct(formula, Class.SAFETY, origin, source=Source.DERIVED))
            pairs = [(replace(event, name="event"), name)]
            _add_member(object_, members, wires, pairs, _find_ports(component, object_, sent=False))
        ports = _find_ports(component, object_, sent=True)
        _add_member(object_, members, wires, _list_outputs(component, object_), ports)
    block = Block(component.graph, component.tree.root.type_, {})
    block.members = members
    block.channels = component.tree.channels
    wiring = [
        replace(conjunct, source=Source.DERIVED)
        for conjunct in derive_wiring(block, members, wires)
    ]
    gaps = _find_unwired(block, wires, wiring, acceptances)
    deliveries = list(_iter_deliveries(block, members, wires))
    for receipt, port in iter_unsent(block, members, tuple(wires)):
        if _is_port_closed(component, block, receipt, port):
            text = f"No part that is connected with '{port}' sends '{receipt.message}'."
            never = f.negate(receipt.occurs)
            wiring.append(
                Conjunct(never, Class.SAFETY, receipt.origin, text, source=Source.DERIVED)
            )
            (occurring,) = f.variables(receipt.occurs)
            deliveries.append(Delivery(occurring.name, receipt.message, (), False))
    sent = {(item.event, item.message) for item in deliveries if not item.is_open}
    variables = [_find_decider(event, sent) for event in variables]
    return Wiring(variables, [*conjuncts, *wiring], gaps, acceptances, deliveries)


def _find_decider(event: Variable, sent: Set[tuple[str, str]]) -> Variable:
    """Return an event, which the component decides if its parts send all its messages."""
    assert isinstance(event.domain, EnumerationDomain), "events are enumerated"
    messages = {(event.name, literal) for literal in event.domain.literals if literal != NO_EVENT}
    return replace(event, owner=Owner.SYSTEM) if messages <= sent else event


def _is_port_closed(component: "Component", block: Block, receipt: Receipt, port: str) -> bool:
    """Whether a message that no part sends cannot arrive at a port of a part.

    The port is connected, and only with parts whose behaviour is in the model. A part without
    behaviour may send anything, and a specialisation of the message would be accepted, too.
    """
    path = receipt.member.path
    reached = {end for end, _ in component.tree.channels.list_reached((path, port))}
    senders = {machine.owner.path for machine in component.machines}
    senders |= {copy.caller.owner.path for copy in component.performances.copies.values()}
    relays = {
        end for end in reached if any(inner.startswith(f"{end}.") for inner in (path, *reached))
    }
    signals = (
        signal
        for signal in component.graph.of_kind(Kind.SIGNAL)
        if identifier(signal.name) == receipt.message
    )
    has_special = any(component.graph.sources(signal, Edge.SPECIALIZES) for signal in signals)
    is_complete = ITSELF not in reached and reached - relays and reached - relays <= senders
    return bool(path and is_complete and not has_special and not component.performances.gaps)


def _iter_deliveries(block: Block, members: list[Member], wires: list[Wire]) -> Iterator[Delivery]:
    names = {id(member): wire.name for wire in wires for member, _ in wire.ends}
    for member, receipts in iter_listeners(block, members, tuple(wires)):
        is_open = is_reachable_from_outside(block, member)
        for receipt, sendings in receipts:
            outputs = [v.name for sending in sendings for v in f.variables(sending.is_sent)]
            yield Delivery(names[id(member)], receipt.message, tuple(outputs), is_open)


def check_signal_names(component: "Component") -> None:
    """Raise ComponentError if signals of one name, or the ports of a signal, cannot be told apart.

    Behaviours would wrongly see them as one event. What a part sends is not followed to a port of
    another part at which an object waits.
    """
    graph = component.graph
    signals: dict[str, Element] = {}
    sent: set[str] = set()
    paths: dict[str, str] = {}
    for object_ in component.tree.objects:
        _find_ports(component, object_, sent=True)
        _find_ports(component, object_, sent=False)
        for behaviour in _list_behaviours(component, object_):
            for element in graph.subtree(behaviour):
                sent |= {name for name, _ in _iter_sent_signals(graph, element)}
                received = _iter_received_signals(graph, element)
                paths |= {name: path for name, path in received if "." in path}
                for signal in _iter_signals(graph, element):
                    if signals.setdefault(signal.name, signal) is not signal:
                        raise ComponentError(f"two signals are called '{signal.name}'")
    for name in paths:
        if name in sent:
            raise ComponentError(f"'{name}' is sent, and received via '{paths[name]}'")


def _iter_signals(graph: Graph, element: Element) -> Iterator[Element]:
    """Yield the signals of a trigger, of an action that sends, or of the text of an effect."""
    signal = _find_signal(graph, element)
    if signal is not None:
        yield signal
    for sending in _iter_sendings(element):
        visible = (
            owned
            for scope in graph.ancestors(element)
            for owned in graph.owned(scope)
            if owned.kind in query.CLASSIFIERS and owned.name == sending.signal.path[0]
        )
        signal = next(visible, None)
        # Imported and qualified names are compared by their last part alone.
        if signal is not None and len(sending.signal.path) == 1:
            yield signal


def _find_signal(graph: Graph, element: Element) -> Element | None:
    """Return the signal of a trigger or of an action that sends one."""
    if element.kind is Kind.TRIGGER:
        return graph.target(element, Edge.TYPED_BY)
    is_sending = element.subkind in ("send", "broadcast")
    return graph.target(element, Edge.CALLS) if is_sending else None


def _iter_sendings(element: Element) -> Iterator[Send]:
    """Yield the statements in the text of an effect that send a signal."""
    body = element.attrs.get("body")
    if element.kind is not Kind.ACTIVITY or not isinstance(body, str) or "send" not in body:
        return
    try:
        statements = statements_of(body)
    except ExpressionError:
        return
    yield from (statement for statement in statements if isinstance(statement, Send))


def _list_accepted(component: "Component", object_: ComponentObject) -> dict[str, str]:
    """Return the signals that actions of an object accept, by their variables."""
    accepted: dict[str, str] = {}
    for copy in component.performances.copies.values():
        if copy.caller.owner is object_:
            for own, name in copy.variables.items():
                if own.startswith(_RECEIVE) and name in component.performances.inputs:
                    accepted[name] = own.removeprefix(_RECEIVE)
    return accepted


def _list_outputs(component: "Component", object_: ComponentObject) -> list[tuple[Variable, str]]:
    """Return what the behaviours of an object send: variables with their names in the component."""
    outputs = [
        (variable, machine.variables[variable.name])
        for machine in component.machines
        if machine.owner is object_
        for variable in machine.machine.variables
        if variable.name in machine.machine.outputs
    ]
    for copy in component.performances.copies.values():
        if copy.caller.owner is object_:
            for node in component.performances.nodes:
                if node.run in copy.variables.values() and node.run:
                    variable = Variable(node.run, Owner.SYSTEM, BooleanDomain(), node.origin)
                    outputs.append((variable, node.run))
    return outputs


def _find_ports(
    component: "Component", object_: ComponentObject, *, sent: bool
) -> Mapping[str, str]:
    """Return the port of each signal that an object sends, or else receives, if it names one.

    Raises ComponentError if it names several, or only some of the time: they are one event. A
    signal without port passes the only port that is connected; of several the port is not known.
    """
    ports: dict[str, str] = {}
    find = _iter_sent_signals if sent else _iter_received_signals
    own_ports = {port.name for port in query.ports(component.graph, object_.type_)} - {""}
    for behaviour in _list_behaviours(component, object_):
        for element in component.graph.subtree(behaviour):
            for signal, name in find(component.graph, element):
                if sent and "." in name:
                    raise ComponentError(f"'{object_.type_.name}' sends '{signal}' to '{name}'")
                port = "" if sent and name not in own_ports else name
                if ports.setdefault(identifier(signal), port) != port:
                    verb = "sends" if sent else "receives"
                    reason = f"'{object_.type_.name}' {verb} '{signal}' in several ways"
                    raise ComponentError(reason)
    connected = [
        name for name in own_ports if component.tree.channels.list_reached((object_.path, name))
    ]
    if sent and len(connected) > 1 and "" in ports.values():
        raise ComponentError(f"'{object_.type_.name}' sends a signal without naming its port")
    return {message: port for message, port in ports.items() if port in own_ports}


def _list_behaviours(component: "Component", object_: ComponentObject) -> list[Element]:
    machines = [
        machine
        for entry in component.machines
        if entry.owner is object_
        for machine in collect_submachines(component.graph, entry.element)
    ]
    copies = component.performances.copies.values()
    return machines + [copy.activity for copy in copies if copy.caller.owner is object_]


def _iter_received_signals(graph: Graph, trigger: Element) -> Iterator[tuple[str, str]]:
    """Yield the signal of a trigger, and the path to its port (``left.inlet``) or ""."""
    signal = _find_signal(graph, trigger)
    if trigger.kind is Kind.TRIGGER and signal is not None:
        yield signal.name, _format_path(graph, trigger)


def _iter_sent_signals(graph: Graph, element: Element) -> Iterator[tuple[str, str]]:
    """Yield the signals that an action or the text of an effect sends, and who receives them."""
    signal = _find_signal(graph, element)
    if element.kind is not Kind.TRIGGER and signal is not None:
        yield signal.name, _format_path(graph, element)
    for statement in _iter_sendings(element):
        receiver = statement.receiver
        name = "" if receiver is None else name_of(receiver) or print_expression(receiver)
        yield statement.signal.path[-1], name


def _format_path(graph: Graph, holder: Element) -> str:
    return ".".join(query.port_names(graph, holder))


def _add_member(
    object_: ComponentObject,
    members: list[Member],
    wires: list[Wire],
    pairs: list[tuple[Variable, str]],
    ports: Mapping[str, str],
) -> None:
    """Add the variables of an object as a member; a wire gives each its name in the component."""
    if not pairs:
        return
    by_name = {variable.name: variable for variable, _ in pairs}
    contract = Contract(object_.path, object_.type_.id, tuple(by_name.values()), (), ())
    # Members are compared by identity, so that each has the variables of one object.
    member = Member(object_.path, object_.path, object_.type_.id, contract, {}, ports)
    members.append(member)
    wires += (Wire(name, ((member, variable),)) for variable, name in pairs)


def _find_unwired(
    block: Block,
    wires: list[Wire],
    wiring: list[Conjunct],
    acceptances: Mapping[str, tuple[str, str]],
) -> dict[str, str]:
    """Return the sent messages that some object could receive but that lead nowhere.

    A message through a port leads where the connectors of the port lead, if they are read. Another
    one may be for its own sender. The *acceptances* of such messages are returned, too, because the
    environment need not send them.
    """
    read = {variable.name for conjunct in wiring for variable in f.variables(conjunct.formula)}
    gaps: dict[str, str] = {}
    for wire in wires:
        ((member, variable),) = wire.ends
        sent = find_message_name(block.graph, variable)
        for receiver, event, message in _iter_receivers(block, sent):
            port = member.ports.get(message, "")
            is_followed = port and not _has_unread_connector(block, member, port)
            if variable.owner is not Owner.SYSTEM or wire.name in read or is_followed:
                continue
            reason = f"no connection leads '{message}' from '{member.name}'"
            if receiver.path == member.path:
                if message in receiver.ports:
                    continue
                sender = block.graph[member.origin].name
                reason = f"'{sender}' may send '{message}' to itself, without a port"
            receipt = name_in_composite(receiver, event, wires), message
            accepted = (name for name in acceptances if acceptances[name] == receipt)
            gaps |= dict.fromkeys((wire.name, *accepted), reason)
    return gaps


def _iter_receivers(block: Block, sent: str) -> Iterator[tuple[Member, str, str]]:
    """Yield the members with an event for a message, the event, and its literal.

    A message for a part has the name of the part before it.
    """
    for member in block.members:
        for event in member.contract.variables:
            for literal in getattr(event.domain, "literals", ()):
                if sent == literal or sent.endswith(f"_{literal}"):
                    yield member, event.name, literal


def _has_unread_connector(block: Block, member: Member, name: str) -> bool:
    """Whether connectors or flows of the model name a port of an object, and are not read."""
    if block.channels.list_reached((member.path, name)):
        return False
    edges = (Edge.ROLE, Edge.FLOW_SOURCE, Edge.FLOW_TARGET)
    ports = query.ports(block.graph, block.graph[member.origin])
    return any(
        block.graph.sources(port, edge) for port in ports if port.name == name for edge in edges
    )
