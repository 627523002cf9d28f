"""Activities: behaviours whose members are steps."""

from typing import TYPE_CHECKING

from sysmlc.frontends.sysml import nodes, statements
from sysmlc.frontends.sysml.allocated import arguments, assign_steps
from sysmlc.frontends.sysml.definitions import flags, generalize, marked
from sysmlc.frontends.sysml.features import give_types
from sysmlc.frontends.sysml.kinds import BEHAVIOURS, FUNCTIONS
from sysmlc.frontends.sysml.successions import steps
from sysmlc.frontends.sysml.values import texts
from sysmlc.ir import Edge, Element, Kind
from sysmlc.ir.query import BEHAVIORS
from sysmlc.language.tree import Node

if TYPE_CHECKING:
    from sysmlc.frontends.sysml.lowering import Lowering


def activity_definition(low: "Lowering", node: Node, owner: Element | None) -> None:
    """An action definition, a calculation or a case."""
    _, role = BEHAVIOURS[node.kind]
    activity(low, node, owner, role)


def activity(low: "Lowering", node: Node, owner: Element | None, role: str = "") -> Element:
    """The activity that a definition is, or a usage that stands for itself."""
    _, subkind = marked(node, Kind.ACTIVITY)
    made = low.add(node, Kind.ACTIVITY, nodes.name_of(node), owner, role=role, subkind=subkind)
    low.set(made, **flags(node))
    generalize(low, node, made)
    fill(low, node, made)
    return made


def fill(low: "Lowering", node: Node, made: Element) -> None:
    """The members of a behaviour: a text, an expression, or nodes with flows between them."""
    body = nodes.body_of(node)
    found = statements.sequence(body)
    written = None if found is None else statements.effect(found)
    if found is not None and written is not None:
        low.set(made, subkind="opaque", body=written)
        inside = {id(one) for one in found}
        rest = (one for one in body if one.kind != "SuccessionAsUsage")
        low.lower_all((one for one in rest if id(one) not in inside), made)
        return
    result = nodes.result_of(node)
    if node.kind in FUNCTIONS:
        low.set(made, subkind="function")
    if result is not None:
        low.later(lambda: low.set(made, body=texts(result, low)))
    steps(low, (one for one in body if one is not result), made)


def perform(low: "Lowering", node: Node, owner: Element) -> None:
    """What a classifier performs: its own behaviour, or one that stands elsewhere."""
    found = nodes.reference(node, "ReferenceSubsetting")
    if found is not None and not node.name and not nodes.body_of(node):
        low.later(lambda: _performed(low, node, owner, found.target))
        return
    typed = nodes.reference(node, "FeatureTyping")
    if typed is not None and not node.name and not nodes.body_of(node):
        low.refer(Edge.CLASSIFIER_BEHAVIOR, owner, typed)
        return
    if typed is not None and is_instance(node):
        low.refer(Edge.CLASSIFIER_BEHAVIOR, owner, typed)
        arguments(low, node, owner)
        assign_steps(low, node, owner)
        return
    made = activity(low, node, owner)
    if not low.graph.targets(owner, Edge.CLASSIFIER_BEHAVIOR):
        low.graph.connect(Edge.CLASSIFIER_BEHAVIOR, owner, made)


def is_instance(node: Node) -> bool:
    """Whether a usage only says what its definition has: all members are redefinitions."""
    inside = [one for one in nodes.body_of(node) if not nodes.is_text(one)]
    return bool(inside) and all(nodes.reference(one, "Redefinition") is not None for one in inside)


def _performed(low: "Lowering", node: Node, owner: Element, target: Node | None) -> None:
    """A behaviour is run by the classifier; a step of one is allocated to it."""
    known = low.element(target)
    if known is None or known.kind in BEHAVIORS:
        low.lead(Edge.CLASSIFIER_BEHAVIOR, owner, target)
    elif known.kind in (Kind.ACTION, Kind.STRUCTURED):
        above = low.graph.owner(owner)
        made = low.add(node, Kind.DEPENDENCY, "", above, role="allocate", subkind="abstraction")
        low.graph.connect(Edge.CLIENT, made, known)
        low.graph.connect(Edge.SUPPLIER, made, owner)
    elif known.kind is Kind.OPERATION:
        low.approximated(node, "the performance of an operation", "the operation")
    else:
        low.approximated(node, "the performance of what is no action", "nothing")


# -- operations --------------------------------------------------------------------------------


def operation(low: "Lowering", node: Node, owner: Element) -> None:
    """An action of a classifier: an operation, unless it has steps of its own.

    What it specialises, or is typed by, is the behaviour that implements it.
    """
    kind, _ = marked(node, Kind.OPERATION)
    payload = node.kind == "AcceptActionUsage"
    if payload:
        _reception(low, node, owner)
    elif kind is Kind.ACTIVITY or (_has_steps(node) and not _is_operation(node)):
        activity(low, node, owner)
    else:
        _operation(low, node, owner)


def _is_operation(node: Node) -> bool:
    """Whether metadata says that it is an operation with its method."""
    return marked(node, Kind.ACTIVITY)[0] is Kind.OPERATION


def _has_steps(node: Node) -> bool:
    return any(one.kind == "TextualRepresentation" or _is_step(one) for one in nodes.body_of(node))


def _is_step(node: Node) -> bool:
    is_constraint = node.kind in ("AssertConstraintUsage", "ConstraintUsage")
    return not (nodes.is_text(node) or "direction" in node.attributes or is_constraint)


def _operation(low: "Lowering", node: Node, owner: Element) -> None:
    made = low.add(node, Kind.OPERATION, nodes.name_of(node), owner)
    given = flags(node)
    low.set(made, **given)
    methods = nodes.references(node, "FeatureTyping", "Subsetting", "ReferenceSubsetting")
    for found in nodes.references(node, "Redefinition"):
        low.refer(Edge.REDEFINES, made, found)
    for found in methods:
        low.refer(Edge.METHOD, made, found)
    if methods and methods[0].target is not None:
        definition = methods[0].target
        low.last(lambda: _inherit_parameters(low, made, definition))
    if _has_steps(node):
        low.lower_all((one for one in nodes.body_of(node) if "direction" in one.attributes), made)
        method = low.make(node, Kind.ACTIVITY, made.name, owner)
        low.graph.connect(Edge.METHOD, made, method)
        fill(low, node, method)
        return
    low.lower_all(nodes.body_of(node), made)


def _inherit_parameters(low: "Lowering", made: Element, definition: Node) -> None:
    """An operation that states no parameters has those of the behaviour that defines it."""
    if any(one.kind is Kind.PARAMETER for one in low.graph.owned(made)):
        return
    for node in definition.members:
        one = low.element(node)
        if one is not None and one.kind is Kind.PARAMETER:
            copy = low.below(made, Kind.PARAMETER, one.name)
            low.set(copy, **{key: one.attrs[key] for key in _COPIED if key in one.attrs})
            give_types(low, node, copy)


_COPIED = ("direction", "multiplicity", "ordered")


def _reception(low: "Lowering", node: Node, owner: Element) -> None:
    made = low.add(node, Kind.RECEPTION, nodes.name_of(node), owner)
    payload = next(nodes.held(node, "ParameterMembership"), None)
    for found in [] if payload is None else nodes.references(payload, "FeatureTyping"):
        low.refer(Edge.TYPED_BY, made, found)
    low.lower_texts(node, made)
