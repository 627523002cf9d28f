"""Constraints and requirements, and what satisfies and verifies requirements."""

from sysmlc.frontends.sysml import annotations, nodes, values
from sysmlc.frontends.sysml.definitions import (
    connect_generals,
    declaration_attributes,
    read_kind,
    visibility_attributes,
)
from sysmlc.frontends.sysml.features import lower_property
from sysmlc.frontends.sysml.lowering import Lowering
from sysmlc.frontends.sysml.trees import Trees
from sysmlc.ir import AttrValue, Edge, Element, Graph, Kind
from sysmlc.ir.expressions import ExpressionText, Unary
from sysmlc.language.library import SHIPPED
from sysmlc.language.tree import Node, Reference

_PACKAGES = (Kind.PACKAGE, Kind.PROFILE)
_CONDITION_SUBKINDS = {
    "Precondition": "precondition",
    "Postcondition": "postcondition",
    "BodyCondition": "body",
    "Invariant": "invariant",
}
"""Subkinds of constraints by the keyword of our library."""
_SATISFACTION_KIND = "SatisfyRequirementUsage"
_SATISFACTION: dict[str, AttrValue] = {"role": "satisfy", "subkind": "abstraction"}
_NEGATED_SATISFACTION: dict[str, AttrValue] = {"role": "not satisfy", "subkind": "abstraction"}
_VERIFICATION: dict[str, AttrValue] = {"role": "verify", "subkind": "abstraction"}


# -- constraints -------------------------------------------------------------------------------


def lower_constraint(lowering: Lowering, node: Node, owner: Element | None) -> None:
    """Lower a constraint with a condition, or the usage of a constraint definition."""
    result = nodes.result_of(node)
    if result is None and owner is not None and lowering.trees.types_of(node):
        _lower_constraint_usage(lowering, node, owner)
        return
    constraint = lowering.add_element(
        node, Kind.CONSTRAINT, nodes.name_of(node), owner, subkind=_constraint_subkind(node)
    )
    lowering.set_attributes(constraint, **visibility_attributes(node))
    if result is not None:
        lowering.queue.defer_until_elements(lambda: _set_body(lowering, node, constraint, result))
        if _is_unasserted(lowering.trees, node):
            lowering.graph.set(constraint, asserted=False)
            construct = "a constraint that nothing asserts"
            lowering.verdicts.mark_approximated(node, construct, "one that holds")
    for reference in nodes.list_references(node, "ReferenceSubsetting"):
        lowering.connect_reference(Edge.REFERENCES, constraint, reference)
    annotations.lower_only_annotations(lowering, node, constraint, "a constraint")


def _constraint_subkind(node: Node) -> str:
    for keyword in nodes.shipped_metadata_of(node):
        if keyword in _CONDITION_SUBKINDS:
            return _CONDITION_SUBKINDS[keyword]
    name = annotations.metadata_value(node, "Kind", "name")
    return str(name or read_kind(node, Kind.CONSTRAINT)[1])


def _is_unasserted(trees: Trees, node: Node) -> bool:
    """Whether a constraint only names a condition, which may hold or not (SysML 2.0, 7.20.1)."""
    is_usage = node.kind == "ConstraintUsage" and node.membership == "FeatureMembership"
    document = trees.document_of(node)
    return is_usage and document is not None and not document.path.startswith(SHIPPED)


def _set_body(lowering: Lowering, node: Node, constraint: Element, result: Node) -> None:
    text = values.expression_text(result, lowering)
    body = f"not ({text})" if node.attributes.get("isNegated") else text
    if isinstance(text, ExpressionText) and body is not text:
        body = ExpressionText(body, Unary("not", text.tree))
    lowering.set_attributes(constraint, body=body)


def lower_result(lowering: Lowering, node: Node, owner: Element) -> None:
    """Lower the condition of a constraint definition to a constraint without a name."""
    constraint = lowering.add_element(node, Kind.CONSTRAINT, "", owner)
    values.defer_expression(lowering, constraint, "body", node)


def _lower_constraint_usage(lowering: Lowering, node: Node, owner: Element) -> None:
    """Lower a usage to a constraint property, and values of its parameters to bindings."""
    arguments = [
        (member, value) for member in node.members if (value := nodes.value_of(member)) is not None
    ]
    lowering.verdicts.skipped.update(id(parameter) for parameter, _ in arguments)
    usage = lower_property(lowering, node, owner)
    for parameter, value in arguments:
        _defer_argument(lowering, usage, parameter, value)


def _defer_argument(lowering: Lowering, usage: Element, parameter: Node, value: Node) -> None:
    """Add a binding connector between a parameter of a usage and the features of its value."""

    def add_binding() -> None:
        path = [lowering.elements.find(step) for step in nodes.path_of_expression(value)]
        features = [feature for feature in path if feature is not None]
        formal = lowering.elements.find(nodes.find_target(parameter, "Redefinition"))
        if not path or len(features) < len(path) or formal is None:
            construct = "a value of a constraint's parameter"
            lowering.verdicts.mark_approximated(parameter, construct, "nothing")
            return
        graph, owner = lowering.graph, lowering.graph.owner(usage)
        binding = lowering.add_derived(
            parameter, Kind.CONNECTOR, "", owner, role="binding connector"
        )
        for *outer, role in ([usage, formal], features):
            end = lowering.add_derived(parameter, Kind.CONNECTOR_END, "", binding)
            graph.connect(Edge.END, binding, end)
            graph.connect(Edge.ROLE, end, role)
            for feature in outer:
                graph.connect(Edge.PATH, end, feature)

    lowering.queue.defer_until_edges(add_binding)


# -- requirements ------------------------------------------------------------------------------


def lower_requirement(lowering: Lowering, node: Node, owner: Element | None) -> None:
    """Lower a requirement: its short name is the id, its first documentation the text."""
    if node.membership == "RequirementVerificationMembership":
        _lower_verification(lowering, node, owner)
        return
    if node.membership == "ObjectiveMembership":
        lower_objective(lowering, node, owner)
        return
    documentation = next(nodes.iter_by_metaclass(node, "Documentation"), None)
    text = "" if documentation is None else str(documentation.attributes.get("body", ""))
    id_ = annotations.metadata_value(node, "Requirement", "id") or node.short_name or ""
    attributes: dict[str, AttrValue] = {
        "req_id": str(id_),
        "text": text.strip(),
        **declaration_attributes(node),
    }
    name = node.name or nodes.name_of(node)
    requirement = lowering.add_element(
        node, Kind.CLASS, name, owner, role="requirement", **attributes
    )
    connect_generals(lowering, node, requirement)
    if documentation is not None:
        lowering.verdicts.skipped.add(id(documentation))
    for member in nodes.body_of(node):
        _lower_member(lowering, member, requirement)


def _lower_member(lowering: Lowering, node: Node, requirement: Element) -> None:
    if node.membership == "SubjectMembership":
        lower_subject(lowering, node, requirement)
        lowering.elements.own[id(node)] = requirement
    elif node.membership == "RequirementConstraintMembership":
        lower_constraint(lowering, node, requirement)
        constraint = lowering.elements.find(node)
        # A constraint that is no assumption is required without an edge.
        if constraint is not None and node.role == "assumption":
            lowering.graph.connect(Edge.ASSUMES, requirement, constraint)
    else:
        lowering.lower(node, requirement)


def lower_subject(lowering: Lowering, node: Node, element: Element) -> None:
    """Connect a requirement or a use case to the types of its subject."""
    for type_ in lowering.trees.types_of(node):
        lowering.defer_edges(Edge.SUBJECT, element, [type_])
    if node.name:
        lowering.graph.set(element, subject_name=node.name)
    if nodes.value_of(node) is not None:
        lowering.verdicts.mark_approximated(node, "the value of a subject", "its type")


# -- satisfy and verify ------------------------------------------------------------------------


def lower_satisfaction(lowering: Lowering, node: Node, owner: Element | None) -> None:
    """Lower a satisfaction by the feature that it names, else by the element that owns it."""
    package = _find_package(lowering.graph, owner)
    facts = _NEGATED_SATISFACTION if node.attributes.get("isNegated") else _SATISFACTION
    satisfaction = lowering.add_element(node, Kind.DEPENDENCY, node.name or "", package, **facts)
    annotations.lower_only_annotations(lowering, node, satisfaction, "a satisfaction")
    requirement = (
        nodes.find_reference(node, "ReferenceSubsetting")
        or nodes.find_reference(node, "Subsetting")
        or nodes.find_reference(node, "FeatureTyping")
    )
    lowering.queue.defer_until_elements(
        lambda: lowering.connect_node(Edge.SUPPLIER, satisfaction, _find_requirement(requirement))
    )
    subject = next(nodes.iter_by_membership(node, "SubjectMembership"), None)
    value = None if subject is None else nodes.value_of(subject)
    path = None if value is None else nodes.path_of_expression(value)
    satisfying = path[-1] if path else None
    if satisfying is not None and satisfying.membership == "SubjectMembership":
        # Subjects are edges of requirements and no elements that a relation could lead to.
        substitute = "one by the requirement with this subject"
        lowering.verdicts.mark_approximated(node, "a satisfaction by a subject", substitute)
        satisfying = satisfying.owner
    if value is None and owner is not None:
        lowering.graph.connect(Edge.CLIENT, satisfaction, owner)
    else:
        lowering.defer_edges(Edge.CLIENT, satisfaction, [satisfying])


def _find_requirement(reference: Reference | None) -> Node | None:
    """Return the requirement that a satisfaction or verification names.

    A satisfaction has the name of its requirement, so that the name may lead to a satisfaction in
    the same namespace.
    """
    target, visited = None if reference is None else reference.target, set[int]()
    while target is not None and target.kind == _SATISFACTION_KIND and id(target) not in visited:
        visited.add(id(target))
        target = nodes.find_target(target, "ReferenceSubsetting") or target
    return target


def _find_package(graph: Graph, owner: Element | None) -> Element | None:
    """Return the nearest package: a relation belongs to neither of its ends."""
    while owner is not None and owner.kind not in _PACKAGES:
        owner = graph.owner(owner)
    return owner


def lower_objective(lowering: Lowering, node: Node, owner: Element | None) -> None:
    """Lower the objective of a case: the requirements that it verifies, and annotations."""
    lowering.verdicts.skipped.add(id(node))
    if nodes.find_reference(node, "FeatureTyping", "ReferenceSubsetting", "Subsetting"):
        lowering.verdicts.mark_approximated(node, "the type of an objective", "nothing")
    for member in nodes.body_of(node):
        if member.membership == "RequirementVerificationMembership":
            _lower_verification(lowering, member, owner)
        elif nodes.is_annotation(member):
            lowering.lower(member, owner)
        elif member.membership != "SubjectMembership":
            lowering.verdicts.mark_approximated(member, "a part of an objective", "nothing")


def _lower_verification(lowering: Lowering, node: Node, owner: Element | None) -> None:
    """Lower the verification of a requirement by the case that contains it."""
    package = _find_package(lowering.graph, owner)
    verification = lowering.add_element(
        node, Kind.DEPENDENCY, node.name or "", package, **_VERIFICATION
    )
    if owner is not None:
        lowering.graph.connect(Edge.CLIENT, verification, owner)
    requirement = nodes.find_reference(node, "ReferenceSubsetting", "FeatureTyping", "Subsetting")
    lowering.queue.defer_until_elements(
        lambda: lowering.connect_node(Edge.SUPPLIER, verification, _find_requirement(requirement))
    )
    annotations.lower_only_annotations(lowering, node, verification, "a verification")
