"""Which part of the lowering reads which metaclass; what a usage is depends on its owner."""

from importlib import import_module

from sysmlc.frontends.sysml import (
    actions,
    activities,
    annotations,
    connections,
    definitions,
    loops,
    nodes,
    objectflows,
    relations,
    states,
    usages,
)
from sysmlc.frontends.sysml.definitions import marked
from sysmlc.frontends.sysml.features import in_classifier
from sysmlc.frontends.sysml.kinds import ACTIVITIES, BEHAVIOURS, CLASSIFIERS, STRUCTURAL
from sysmlc.frontends.sysml.lowering import Handler, Lowering
from sysmlc.frontends.sysml.objects import in_behaviour
from sysmlc.ir import Element, Kind
from sysmlc.language.tree import Node

_PACKAGES = frozenset({Kind.PACKAGE, Kind.PROFILE})
_STEPPED = ACTIVITIES
_BEHAVING = frozenset({Kind.OPERATION, Kind.STATE_MACHINE, Kind.STATE, Kind.REGION, Kind.RECEPTION})


def _late(module: str, name: str) -> Handler:
    """A reader of what many models do not have, imported with the first that is there."""

    def read(low: Lowering, node: Node, owner: Element | None) -> None:
        getattr(import_module(f"sysmlc.frontends.sysml.{module}"), name)(low, node, owner)

    return read


def _feature(low: Lowering, node: Node, owner: Element | None) -> None:
    """A structural usage by what owns it."""
    if node.kind == "OccurrenceUsage" and marked(node, Kind.CLASS)[0] is Kind.INTERACTION:
        definitions.define(low, node, owner, Kind.INTERACTION, "")
    elif owner is None or owner.kind in _PACKAGES:
        usages.in_package(low, node, owner)
    elif owner.kind in STRUCTURAL:
        in_classifier(low, node, owner)
    elif owner.kind in _STEPPED or owner.kind in _BEHAVING:
        in_behaviour(low, node, owner)
    elif owner.kind in _INTERACTING:
        _late("interactions", "member")(low, node, owner)
    else:
        low.unsupported(node)


_INTERACTING = frozenset({Kind.INTERACTION, Kind.FRAGMENT, Kind.OPERAND})


def _action(low: Lowering, node: Node, owner: Element | None) -> None:
    if owner is None or owner.kind in _PACKAGES:
        activities.activity(low, node, owner)
    elif owner.kind in _STEPPED and "direction" in node.attributes:
        in_behaviour(low, node, owner)
    elif owner.kind in _STEPPED:
        actions.action(low, node, owner)
    elif owner.kind in STRUCTURAL and node.kind == "PerformActionUsage":
        activities.perform(low, node, owner)
    elif owner.kind in STRUCTURAL:
        activities.operation(low, node, owner)
    elif owner.kind in _BEHAVING:
        activities.activity(low, node, owner)
    else:
        low.unsupported(node)


def _step(inside: "Handler") -> Handler:
    """What only stands among the steps of an activity."""

    def read(low: Lowering, node: Node, owner: Element | None) -> None:
        if owner is not None and owner.kind in _STEPPED:
            inside(low, node, owner)
        else:
            _action(low, node, owner)

    return read


def _connection(low: Lowering, node: Node, owner: Element | None) -> None:
    if relations.is_derivation(node):
        relations.derivation(low, node, owner)
    elif owner is not None and connections.linking(node):
        connections.connector(low, node, owner)
    elif owner is not None and owner.kind in STRUCTURAL:
        in_classifier(low, node, owner)
    else:
        low.unsupported(node)


def _binding(low: Lowering, node: Node, owner: Element | None) -> None:
    if owner is not None and owner.kind in _STEPPED:
        objectflows.binding(low, node, owner)
    elif owner is not None:
        connections.connector(low, node, owner, "binding connector")
    else:
        low.unsupported(node)


def _flow(low: Lowering, node: Node, owner: Element | None) -> None:
    if owner is not None and owner.kind in _INTERACTING:
        _late("interactions", "message")(low, node, owner)
    elif owner is not None and owner.kind in _STEPPED:
        objectflows.flow(low, node, owner)
    elif nodes.is_message(node) and (owner is None or not nodes.events_of(node)):
        low.unsupported(node)
    else:
        connections.item_flow(low, node, owner)


def _event(low: Lowering, node: Node, owner: Element | None) -> None:
    if owner is not None and owner.kind in _INTERACTING:
        _late("interactions", "event")(low, node, owner)
    elif owner is not None and owner.kind is Kind.USE_CASE:
        _late("usecases", "extension_point")(low, node, owner)
    else:
        low.unsupported(node)


def _succession(low: Lowering, node: Node, owner: Element | None) -> None:
    if owner is not None and owner.kind in _INTERACTING:
        _late("interactions", "order")(low, node, owner)
    else:
        low.unsupported(node)


def _state(low: Lowering, node: Node, owner: Element | None) -> None:
    if owner is not None and owner.kind is Kind.REGION:
        states.state(low, node, owner)
    elif owner is not None and owner.kind in _STEPPED:
        actions.action(low, node, owner)
    else:
        states.machine(low, node, owner)


def _exhibit(low: Lowering, node: Node, owner: Element | None) -> None:
    if owner is not None and owner.kind in STRUCTURAL:
        states.exhibit(low, node, owner)
    else:
        _state(low, node, owner)


def _case(low: Lowering, node: Node, owner: Element | None) -> None:
    if owner is not None and owner.kind in _STEPPED:
        actions.action(low, node, owner)
    else:
        role = "test case" if node.kind.startswith("Verification") else ""
        activities.activity(low, node, owner, role)


def _definition(role: str) -> Handler:
    """A usage that stands for itself wherever it is."""

    def read(low: Lowering, node: Node, owner: Element | None) -> None:
        definitions.define(low, node, owner, Kind.CLASS, role, usage=True)

    return read


def _expression(low: Lowering, node: Node, owner: Element | None) -> None:
    """A result expression; any other is read with what it belongs to."""
    if node.membership == "ResultExpressionMembership" and owner is not None:
        _late("constraints", "result")(low, node, owner)
    elif node.membership == "ElementFilterMembership":
        low.ignored(node)


def _ignored(low: Lowering, node: Node, owner: Element | None) -> None:
    low.ignored(node)


def _variant(low: Lowering, node: Node, owner: Element | None) -> None:
    _feature(low, node, owner)


_FEATURES = """
    AttributeUsage PartUsage ItemUsage PortUsage ReferenceUsage OccurrenceUsage EnumerationUsage
    Feature
"""
_NODES = "DecisionNode MergeNode ForkNode JoinNode"

HANDLERS: dict[str, Handler] = {
    **dict.fromkeys(CLASSIFIERS, definitions.classifier),
    **dict.fromkeys(BEHAVIOURS, activities.activity_definition),
    **dict.fromkeys(_FEATURES.split(), _feature),
    **dict.fromkeys(_NODES.split(), _step(actions.control)),  # type: ignore[arg-type]
    **dict.fromkeys(nodes.EXPRESSIONS, _expression),
    "Package": definitions.package,
    "LibraryPackage": definitions.package,
    "ItemDefinition": definitions.item,
    "OccurrenceDefinition": definitions.occurrence,
    "StateDefinition": states.machine,  # type: ignore[dict-item]
    "ConnectionDefinition": connections.association,
    "InterfaceDefinition": connections.association,
    "Association": connections.association,
    "AssociationStructure": connections.association,
    "AllocationDefinition": connections.allocation_definition,
    "FlowDefinition": connections.flow_definition,
    "UseCaseDefinition": _late("usecases", "use_case"),
    "UseCaseUsage": _late("usecases", "use_case"),
    "IncludeUseCaseUsage": _late("usecases", "include"),
    "EventOccurrenceUsage": _event,
    "SuccessionAsUsage": _succession,
    "Succession": _succession,
    "Usage": _feature,
    "RequirementDefinition": _late("requirements", "requirement"),
    "RequirementUsage": _late("requirements", "requirement"),
    "ConcernDefinition": _late("requirements", "requirement"),
    "ConcernUsage": _late("requirements", "requirement"),
    "SatisfyRequirementUsage": _late("requirements", "satisfy"),
    "ConstraintUsage": _late("constraints", "constraint"),
    "AssertConstraintUsage": _late("constraints", "constraint"),
    "Invariant": _late("constraints", "constraint"),
    "BooleanExpression": _late("constraints", "constraint"),
    "ActionUsage": _action,
    "PerformActionUsage": _action,
    "CalculationUsage": _action,
    "Step": _action,
    "Expression": _action,
    "SendActionUsage": _step(actions.send),  # type: ignore[arg-type]
    "AcceptActionUsage": _step(actions.accept),  # type: ignore[arg-type]
    "AssignmentActionUsage": _step(actions.assign),  # type: ignore[arg-type]
    "TerminateActionUsage": _step(actions.terminate),  # type: ignore[arg-type]
    "IfActionUsage": _step(loops.if_),  # type: ignore[arg-type]
    "WhileLoopActionUsage": _step(loops.while_),  # type: ignore[arg-type]
    "ForLoopActionUsage": _step(loops.for_),  # type: ignore[arg-type]
    "StateUsage": _state,
    "ExhibitStateUsage": _exhibit,
    "VerificationCaseUsage": _case,
    "AnalysisCaseUsage": _case,
    "CaseUsage": _case,
    "ViewUsage": _definition("view"),
    "ViewpointUsage": _definition("viewpoint"),
    "ConnectionUsage": _connection,
    "InterfaceUsage": _connection,
    "Connector": _connection,
    "BindingConnectorAsUsage": _binding,
    "BindingConnector": _binding,
    "FlowUsage": _flow,
    "Flow": _flow,
    "SuccessionFlowUsage": _flow,
    "SuccessionFlow": _flow,
    "AllocationUsage": relations.allocation,
    "Dependency": relations.dependency,
    "NamespaceImport": relations.import_,
    "MembershipImport": relations.import_,
    "Membership": relations.membership,
    "Documentation": annotations.documentation,
    "Comment": annotations.comment,
    "TextualRepresentation": annotations.representation,
    "MetadataUsage": annotations.metadata,
    "MetadataFeature": annotations.metadata,
    "Multiplicity": _ignored,
    "MultiplicityRange": _ignored,
    "Expose": _ignored,
    "MembershipExpose": _ignored,
    "NamespaceExpose": _ignored,
}
"""Reader of each metaclass; what is not here is reported as not read."""
