"""Effective and qualified names of elements whose references are resolved (KerML 8.3.2.1)."""

from collections.abc import Callable, Sequence

from sysmlc.language.metaclasses import kinds_of
from sysmlc.language.names.symbols import find_payload
from sysmlc.language.tree import Node, Reference

_PERFORMANCES = kinds_of("PerformActionUsage")
_NAMED_BY_REFERENCE = kinds_of("RequirementConstraintMembership") | {"VariantMembership"}
_FEATURES = kinds_of("Feature")
_MAX_DEPTH = 100


def describe_node(node: Node) -> str:
    """Return what messages call an element: its name, else its metaclass."""
    return node.name or node.short_name or node.kind


class QualifiedNames:
    """Memoised qualified names of elements."""

    def __init__(self) -> None:
        self._qualified: dict[Node, tuple[str, ...]] = {}

    def find_qualified_name(self, node: Node) -> tuple[str, ...]:
        """Return the names from the root of the document down to the element.

        An element without a name is represented by its position: ``#3`` is the third member of its
        owner, ``#`` the root itself.
        """
        ancestors: list[Node] = []
        while node not in self._qualified and node.owner is not None:
            ancestors.append(node)
            node = node.owner
        names = self._qualified.setdefault(node, ())
        for descendant in reversed(ancestors):
            names = (*names, find_effective_name(descendant) or _position(descendant))
            self._qualified[descendant] = names
        return names or ("#",)


RedefinitionQuery = Callable[[Node], Sequence[Node]]
"""Returns the features that a feature redefines without stating it."""


def redefine_nothing(_: Node) -> Sequence[Node]:
    """Return no redefined features: the answer for trees without resolved names."""
    return ()


def find_effective_name(
    node: Node, redefined: RedefinitionQuery = redefine_nothing, depth: int = 0
) -> str:
    """Return the name of an element, else that of its naming feature, else an empty string.

    A feature without a name has the name of the first feature that it redefines (KerML 1.0,
    8.3.3.3.4). Performances, variants and constraints of requirements have the name of what they
    reference, the payload of a transition that of what its trigger accepts (SysML 2.0, 8.3.6.4,
    8.3.17.15, 8.3.20.6, 8.2.2.18.3).
    """
    if node.name or node.short_name:
        return node.name or node.short_name or ""
    if node.kind not in _FEATURES or depth > _MAX_DEPTH:
        return ""
    accepted = find_accepted(node)
    if accepted is not None:
        return find_effective_name(accepted, redefined, depth + 1)
    by_reference = node.kind in _PERFORMANCES or node.membership in _NAMED_BY_REFERENCE
    naming = node.find_relation("ReferenceSubsetting") if by_reference else None
    naming = naming or node.find_relation("Redefinition")
    target = naming.reference.target if naming else next(iter(redefined(node)), None)
    if target is None:
        return _last_name(naming.reference) if naming else ""
    return find_effective_name(target, redefined, depth + 1)


def find_accepted(node: Node) -> Node | None:
    """Return the payload of the trigger if ``node`` is the payload parameter of a transition."""
    owner = node.owner
    if owner is None or owner.kind != "TransitionUsage" or node.membership != "ParameterMembership":
        return None
    payload, accepted = find_payload(owner)
    return accepted if node is payload and accepted is not node else None


def _last_name(reference: Reference) -> str:
    """Return the last name of an unresolved reference; empty for an id."""
    name = reference.chain[-1][-1] if reference.chain and reference.chain[-1] else ""
    return "" if "#" in name else name


def _position(node: Node) -> str:
    owner = node.owner
    return f"#{owner.members.index(node) + 1}" if owner and node in owner.members else "#"
