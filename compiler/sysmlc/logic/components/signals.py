"""Events and signals of the objects of a component.

All behaviours of an object see the same event in a step, at most one. What a part sends is visible
in the step after the reaction, and is the event of the receiver in that same step. A port that is
connected receives from its connections only; of several signals for one receiver one occurs.
"""

from collections.abc import Mapping
from typing import TYPE_CHECKING

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.ir import Edge, Kind
from sysmlc.logic import formula as f
from sysmlc.logic.components.objects import ComponentError, ComponentObject
from sysmlc.logic.composition.members import Block, Member
from sysmlc.logic.composition.messages import derive_wiring
from sysmlc.logic.composition.naming import Wire
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
from sysmlc.logic.formula import Const
from sysmlc.logic.machines.machine import NO_EVENT

if TYPE_CHECKING:
    from sysmlc.logic.components.component import Component

_RECEIVE = "receive_"


class Wiring(Struct, frozen=True):
    """The variables of events, and what restricts them."""

    variables: list[Variable]
    conjuncts: list[Conjunct]
    gaps: Mapping[str, str]


def derive_events(component: "Component") -> Wiring:
    """Return the events of all objects and how they follow from what others send."""
    variables: list[Variable] = []
    conjuncts: list[Conjunct] = []
    members: list[Member] = []
    wires: list[Wire] = []
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
                formula = f.iff(f.var(variable), f.eq(f.var(name), Const(message)))
                conjuncts.append(Conjunct(formula, Class.SAFETY, origin, source=Source.DERIVED))
            _add_member(component, object_, members, wires, [(replace(event, name="event"), name)])
        _add_member(component, object_, members, wires, _list_outputs(component, object_))
    block = Block(component.graph, component.tree.root.type_, {})
    block.members = members
    block.channels = component.tree.channels
    wiring = [
        replace(conjunct, source=Source.DERIVED)
        for conjunct in derive_wiring(block, members, wires)
    ]
    return Wiring(variables, [*conjuncts, *wiring], _find_unwired(members, wires, wiring))


def check_signal_names(component: "Component") -> None:
    """Raise ComponentError if an object reacts to two signals of one name.

    Its behaviours would wrongly see them as one event.
    """
    graph = component.graph
    behaviours = [(machine.owner, machine.element) for machine in component.machines]
    behaviours += [
        (copy.caller.owner, copy.activity) for copy in component.performances.copies.values()
    ]
    signals: dict[tuple[str, str], str] = {}
    for object_, behaviour in behaviours:
        for trigger in graph.subtree(behaviour):
            signal = graph.target(trigger, Edge.TYPED_BY)
            if trigger.kind is not Kind.TRIGGER or signal is None:
                continue
            if signals.setdefault((object_.path, signal.name), signal.id) != signal.id:
                raise ComponentError(f"'{object_.type_.name}' reacts to two '{signal.name}'")


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


def _add_member(
    component: "Component",
    object_: ComponentObject,
    members: list[Member],
    wires: list[Wire],
    pairs: list[tuple[Variable, str]],
) -> None:
    """Add the variables of an object as a member; a wire gives each its name in the component."""
    if not pairs:
        return
    by_name = {variable.name: variable for variable, _ in pairs}
    contract = Contract(object_.path, object_.type_.id, tuple(by_name.values()), (), ())
    # Members are compared by identity, so that each has the variables of one object.
    member = Member(object_.path, object_.path, object_.type_.id, contract, {})
    members.append(member)
    wires += (Wire(name, ((member, variable),)) for variable, name in pairs)


def _find_unwired(
    members: list[Member], wires: list[Wire], wiring: list[Conjunct]
) -> dict[str, str]:
    """Return the sent messages that some other object could receive but that lead nowhere."""
    read = {variable.name for conjunct in wiring for variable in f.variables(conjunct.formula)}
    gaps: dict[str, str] = {}
    for wire in wires:
        ((member, variable),) = wire.ends
        message = variable.name.removeprefix("send_").rpartition("_")[2]
        if variable.owner is not Owner.SYSTEM or wire.name in read:
            continue
        for other in members:
            for event in other.contract.variables:
                literals = getattr(event.domain, "literals", ())
                if other.path != member.path and message in literals:
                    gaps[wire.name] = f"no connection leads '{message}' from '{member.name}'"
    return gaps
