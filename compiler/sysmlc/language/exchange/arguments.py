"""Arguments of expressions, folded out of the parameters that carry them (KerML 8.2.5.8.1)."""

from sysmlc.language.tree import Node

_CONDITIONAL = {"if", "and", "or", "implies", "??"}


def fold_arguments(result: Node) -> None:
    """Let the result of a constructor own what its parameters carry (KerML 8.2.5.8.3)."""
    for index, node in enumerate(result.members):
        if node.membership == "ParameterMembership" and node.kind == "Feature":
            value = _carried(node)
            if value is not node:
                value.membership, value.role, value.owner = node.membership, "", result
                result.members[index] = value


def argument(node: Node, owner: Node) -> Node:
    """The expression that a parameter of an expression only carries, else the parameter."""
    value = _carried(node)
    if value is node:
        return node
    inner = value.members[0] if len(value.members) == 1 and not value.relations else None
    is_reference = value.kind == "FeatureReferenceExpression" and inner is not None
    if inner is not None and is_reference and _is_late(owner):
        value = inner
        value.role = "expression"
    else:
        value.role = ""
    return value


def _carried(node: Node) -> Node:
    """The value of a parameter that has nothing but a value, else the parameter."""
    carries = node.kind == "Feature" and not (node.name or node.relations)
    if not carries or [one.membership for one in node.members] != ["FeatureValue"]:
        return node
    return node.members[0]


def _is_late(owner: Node) -> bool:
    """Whether the next argument is only evaluated when others say so (KerML 1.0, 8.2.5.8.1)."""
    if owner.kind == "TriggerInvocationExpression":
        return owner.facts.get("kind", "when") == "when"
    return owner.facts.get("operator") in _CONDITIONAL and bool(owner.members)
