"""Constraints: conditions on what owns them, and usages of constraint definitions."""

from typing import TYPE_CHECKING

from sysmlc.frontends.sysml import annotations, nodes, values
from sysmlc.frontends.sysml.connections import steps_of_value
from sysmlc.frontends.sysml.definitions import marked, visibility
from sysmlc.frontends.sysml.features import property_
from sysmlc.frontends.sysml.types import types_of
from sysmlc.ir import Edge, Element, Kind
from sysmlc.language.library import SHIPPED
from sysmlc.language.tree import Node

if TYPE_CHECKING:
    from sysmlc.frontends.sysml.lowering import Lowering

_SUBKINDS = {
    "Precondition": "precondition",
    "Postcondition": "postcondition",
    "BodyCondition": "body",
    "Invariant": "invariant",
}


def constraint(low: "Lowering", node: Node, owner: Element | None) -> None:
    """A constraint with a condition of its own, or the usage of a constraint definition."""
    result = nodes.result_of(node)
    if result is None and owner is not None and types_of(low, node):
        _usage(low, node, owner)
        return
    marks = annotations.ours(node)
    subkind = next((_SUBKINDS[one] for one in marks if one in _SUBKINDS), "")
    other = annotations.said(node, "Kind", "name") or marked(node, Kind.CONSTRAINT)[1]
    made = low.add(node, Kind.CONSTRAINT, nodes.name_of(node), owner, subkind=subkind or str(other))
    low.set(made, **visibility(node))
    if result is not None:
        low.later(lambda: _body(low, node, made, result))
        if _is_open(low, node):
            low.approximated(node, "a constraint that nothing asserts", "one that holds")
    for found in nodes.references(node, "ReferenceSubsetting"):
        low.refer(Edge.REFERENCES, made, found)
    annotations.texts(low, node, made, "a constraint")


def _is_open(low: "Lowering", node: Node) -> bool:
    """Whether a condition is only given a name: it may hold or not (SysML 2.0, 7.20.1)."""
    is_usage = node.kind == "ConstraintUsage" and node.membership == "FeatureMembership"
    document = low.document(node)
    return is_usage and document is not None and not document.path.startswith(SHIPPED)


def _body(low: "Lowering", node: Node, made: Element, result: Node) -> None:
    if node.attributes.get("isNegated"):
        low.set(made, body=f"not ({values.texts(result, low)})")
    else:
        values.say(low, made, "body", result)


def result(low: "Lowering", node: Node, owner: Element) -> None:
    """The condition of a constraint definition: a constraint without a name."""
    made = low.add(node, Kind.CONSTRAINT, "", owner)
    low.later(lambda: values.say(low, made, "body", node))


def _usage(low: "Lowering", node: Node, owner: Element) -> None:
    """A constraint property with bindings of its parameters to what they are given."""
    given = [one for one in node.members if nodes.value_of(one) is not None]
    low.skipped.update(id(one) for one in given)
    made = property_(low, node, owner)
    for one in given:
        value = nodes.value_of(one)
        if value is not None:
            low.last(lambda one=one, value=value: _bind(low, (made, one), value))  # type: ignore[misc]


def _bind(low: "Lowering", at: tuple[Element, Node], value: Node) -> None:
    """A binding connector between a parameter of the usage and what it is given."""
    usage, node = at
    steps = [low.element(one) for one in steps_of_value(value)]
    formal = low.element(nodes.target(node, "Redefinition"))
    if not steps or None in steps or formal is None:
        low.approximated(node, "a value of a constraint's parameter", "nothing")
        return
    owner = low.graph.owner(usage)
    made = low.make(node, Kind.CONNECTOR, "", owner, role="binding connector")
    for path in ([usage, formal], steps):
        known = [one for one in path if one is not None]
        end = low.make(node, Kind.CONNECTOR_END, "", made)
        low.graph.connect(Edge.END, made, end)
        low.graph.connect(Edge.ROLE, end, known[-1])
        for step in known[:-1]:
            low.graph.connect(Edge.PATH, end, step)
