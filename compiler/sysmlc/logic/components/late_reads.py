"""Guards that have to read what a do behaviour assigns in the same step, which is not described.

What actions assign when they end is visible to the guards of the completion transition that their
end triggers, and to the guards behind a choice (UML 2.5.1, 14.2.3.7 and 14.2.3.8.3). The step of a
machine reads the values before. No requirement of such a component is decided.
"""

from collections.abc import Iterator, Mapping

from sysmlc.logic import formula as f
from sysmlc.logic.activities.token_graph import (
    ACTIVITY_REGION,
    Firing,
    NodeKind,
    TokenGraph,
    TokenNode,
)
from sysmlc.logic.components.component import Component
from sysmlc.logic.components.machines import PlacedMachine
from sysmlc.logic.components.objects import ComponentError, Slot
from sysmlc.logic.composition.structure import join_path
from sysmlc.logic.expressions.elaboration import elaborate_condition
from sysmlc.logic.machines.machine import Machine, Transition, Vertex
from sysmlc.logic.machines.moves import Move


def reject_late_reads(component: Component) -> None:
    """Raise ComponentError if a guard has to read what a do behaviour assigns in the same step."""
    outputs, tokens = component.arguments.outputs, component.formulas.graph
    assigned = [
        *((write.slot, write.node, write.root) for write in component.performances.writes),
        *(
            (item.target, item.node, item.root)
            for item in outputs
            if isinstance(item.target, tuple)
        ),
    ]
    for root in component.roots:
        if root.machine is None or root.state is None or root.is_entry:
            continue
        slots = [
            (slot, _can_be_last(tokens, tokens.node(node)))
            for slot, node, root_id in assigned
            if root_id == root.id
        ]
        late = {
            is_last: _list_late_reads(root.machine, root.state, is_last)
            for is_last in {is_last for _, is_last in slots}
        }
        for slot, is_last in slots:
            if slot in late[is_last]:
                raise ComponentError(
                    f"a guard reads '{join_path(*slot)}' in the step in which the do behaviour of "
                    f"state '{root.state.literal}' may assign it; end the behaviour with a further "
                    "action"
                )


def _list_late_reads(machine: PlacedMachine, state: Vertex, is_last: bool) -> set[Slot]:
    """Return the features that guards read after the do behaviour of a state in the same step.

    *is_last* is whether the do behaviour may end in the step in which it assigns.
    """
    names: set[str] = set()
    transitions = {item.id: item for item in machine.machine.list_transitions()}
    around = _index_regions(machine.machine, state.id)
    for move in machine.exploration.moves:
        is_completion = state.id in move.transition.sources and not move.transition.occurrences
        if (
            is_last
            if is_completion
            else _can_be_active_together(machine.machine, around, move.transition.source)
        ):
            for transition in _iter_late_transitions(
                machine.machine, transitions, move, is_completion
            ):
                if transition.guard is not None:
                    condition = elaborate_condition(transition.guard, machine.machine.scope)
                    names |= f.variable_names(condition)
    return {machine.slots[name] for name in names if name in machine.slots}


def _iter_late_transitions(
    machine: Machine, transitions: Mapping[str, Transition], move: Move, is_completion: bool
) -> Iterator[Transition]:
    """Yield the transitions of a move whose guards read the values after actions have ended."""
    for path in move.paths:
        is_late = is_completion
        for id in path.passed:
            transition = transitions[id]
            is_late = is_late or machine.vertices[transition.source].kind == "choice"
            if is_late:
                yield transition


def _index_regions(machine: Machine, state: str) -> dict[str, str]:
    """Return a state and the states around it by their regions."""
    states = (state, *machine.list_enclosing_states(state))
    return {machine.vertices[id].region: id for id in states}


def _can_be_active_together(machine: Machine, around: Mapping[str, str], state: str) -> bool:
    """Whether a state can be active when those of *around* are: no region has another state."""
    return all(
        around.get(region, id) == id for region, id in _index_regions(machine, state).items()
    )


def _can_be_last(graph: TokenGraph, node: TokenNode) -> bool:
    """Whether the performance around a node may end in the step in which the node is done."""
    if node.region == ACTIVITY_REGION:
        return True
    members = graph.members(node.region)
    is_followed_by_end = any(
        graph.node(edge.target).firing is Firing.END for edge in graph.outgoing(node)
    )
    has_parallel_end = bool(graph.ends(node.region)) and any(
        member.kind is NodeKind.FORK for member in members
    )
    around = graph.node(node.region)
    return (is_followed_by_end or has_parallel_end) and _can_be_last(graph, around)
