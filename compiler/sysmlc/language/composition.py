"""Which usages are composite when nothing is said (SysML 2.0, 8.2.2.6.2, note 1)."""

from sysmlc.language.metaclasses import is_a, kinds_of
from sysmlc.language.tree import Node

USAGES = kinds_of("Usage")
_REFERENTIAL = (
    kinds_of("ReferenceUsage")
    | kinds_of("AttributeUsage")
    | kinds_of("EventOccurrenceUsage")
    | kinds_of("BindingConnectorAsUsage")
    | kinds_of("SuccessionAsUsage")
)
_FEATURE_MEMBERSHIPS = kinds_of("FeatureMembership")
_PARAMETERS = kinds_of("ParameterMembership")
_PORT_OWNERS = kinds_of("PortDefinition") | kinds_of("PortUsage")
_ATTRIBUTES = kinds_of("AttributeDefinition") | kinds_of("AttributeUsage")


def is_composite(node: Node) -> bool:
    """Whether a usage is a composite feature: not ``ref``, and nothing makes it referential.

    Referential are attributes, events and performances, binding and succession connectors,
    parameters, ends, what no type owns as a feature, and ports except within ports.
    """
    if node.kind in _REFERENTIAL or node.facts.get("isReference") or is_end(node):
        return False
    if node.membership not in _FEATURE_MEMBERSHIPS or node.membership in _PARAMETERS:
        return False
    if "direction" in node.facts:
        return False
    owner = node.owner.kind if node.owner else ""
    if is_a(node.kind, "PortUsage"):
        return owner in _PORT_OWNERS
    return owner not in _ATTRIBUTES


def is_end(node: Node) -> bool:
    """Whether a feature is an end: it says so, or its membership does."""
    return node.membership == "EndFeatureMembership" or node.facts.get("isEnd") is True
