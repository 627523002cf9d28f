"""What a use of a behaviour says about the plant: who does its steps, what its parameters are."""

from typing import TYPE_CHECKING

from sysmlc.frontends.sysml import nodes
from sysmlc.frontends.sysml.connections import steps_of_value
from sysmlc.ir import Edge, Element, Kind
from sysmlc.language.tree import Node

if TYPE_CHECKING:
    from sysmlc.frontends.sysml.lowering import Lowering


def assign_steps(low: "Lowering", node: Node, owner: Element) -> None:
    """Steps that a usage binds to actions of the plant are allocated to them.

    ``action :>> place references cell.place`` says who does the step of the definition.
    """
    for one in node.walk():
        step = nodes.target(one, "Redefinition")
        found = nodes.reference(one, "ReferenceSubsetting")
        if one is not node and step is not None and found is not None:
            made = _allocation(low, one, owner, step, list(found.targets or ()))
            low.refer(Edge.SUPPLIER, made, found)
        elif one is not node and _says_nothing(one):
            low.repeated.add(id(one))


def _says_nothing(node: Node) -> bool:
    """Whether a member only leads to its own members; a value that nothing reads is told."""
    is_other = nodes.is_text(node) or node.kind in nodes.EXPRESSIONS
    return not is_other and nodes.value_of(node) is None


def arguments(low: "Lowering", node: Node, owner: Element) -> None:
    """Parameters that a usage binds to features of the plant are allocated to them.

    ``in :>> machine = cell.robot`` says what the parameter of the definition is.
    """
    for one in nodes.body_of(node):
        parameter, value = nodes.target(one, "Redefinition"), nodes.value_of(one)
        if parameter is None or value is None or "direction" not in one.attributes:
            continue
        found = steps_of_value(value)
        steps = [step for step in found if step is not None]
        if len(steps) == len(found) and _is_of_plant(steps):
            made = _allocation(low, one, owner, parameter, steps)
            low.later(lambda made=made, to=steps[-1]: low.lead(Edge.SUPPLIER, made, to))  # type: ignore[misc]


def _is_of_plant(steps: list[Node]) -> bool:
    return bool(steps) and all(one.kind.endswith("Usage") for one in steps)


def _allocation(
    low: "Lowering", node: Node, owner: Element, of: Node, steps: list[Node]
) -> Element:
    """An allocation of a feature to the last of the steps, in the context of the owner."""
    made = low.add(node, Kind.DEPENDENCY, "", owner, role="allocate", subkind="abstraction")
    low.later(lambda: low.lead(Edge.CLIENT, made, _first(low, of)))
    if len(steps) > 1:
        low.later(lambda: _in_context(low, made, owner, steps[:-1]))
    return made


def _in_context(low: "Lowering", made: Element, owner: Element, steps: list[Node]) -> None:
    """The path of a DirectedRelationshipPropertyPath (SysML 1.6, 8.3.2.4)."""
    found = [low.element(one) for one in steps]
    path = tuple(one.id for one in found if one is not None)
    low.set(made, target_context=owner.id, target_path=path)


def _first(low: "Lowering", feature: Node) -> Node:
    """The feature with an element that a redefinition leads to in the end."""
    seen = set()
    while low.elements.get(id(feature)) is None and id(feature) not in seen:
        seen.add(id(feature))
        feature = nodes.target(feature, "Redefinition") or feature
    return feature
