"""Effective and qualified names of elements whose references are resolved (KerML 1.0, 8.3.2.1)."""

from collections.abc import Callable, Sequence

from sysmlc.language.metaclasses import kinds_of
from sysmlc.language.names.symbols import find_payload
from sysmlc.language.tree import Node, Reference

_PERFORMANCES = kinds_of("PerformActionUsage")
_NAMED_BY_REFERENCE = kinds_of("RequirementConstraintMembership") | {"VariantMembership"}
_FEATURES = kinds_of("Feature")
_DEEPEST = 100


def shown(node: Node) -> str:
    """What a message calls the element: its name, else its metaclass."""
    return node.name or node.short_name or node.kind


class Naming:
    """Names of elements, each computed once."""

    def __init__(self) -> None:
        self._qualified: dict[Node, tuple[str, ...]] = {}

    def qualified(self, node: Node) -> tuple[str, ...]:
        """The names from the top of its document down to the element.

        What has no name counts by its position: ``#3`` is the third member of its owner, ``#``
        the top itself.
        """
        above: list[Node] = []
        while node not in self._qualified and node.owner is not None:
            above.append(node)
            node = node.owner
        names = self._qualified.setdefault(node, ())
        for below in reversed(above):
            names = (*names, effective(below) or _position(below))
            self._qualified[below] = names
        return names or ("#",)


Redefined = Callable[[Node], Sequence[Node]]
"""What a feature redefines though its text does not say so."""


def nothing(_: Node) -> Sequence[Node]:
    """For trees of which only the text is known."""
    return ()


def effective(node: Node, redefined: Redefined = nothing, depth: int = 0) -> str:
    """The name of an element, else that of the feature which names it, else nothing.

    A feature without a name is called as the first that it redefines (KerML 1.0, 8.3.3.3.4);
    performances, variants and constraints of requirements as what they reference, the payload of
    a transition as what its trigger accepts (SysML 2.0, 8.3.6.4, 8.3.17.15, 8.3.20.6, 8.2.2.18.3).
    """
    if node.name or node.short_name:
        return node.name or node.short_name or ""
    if node.kind not in _FEATURES or depth > _DEEPEST:
        return ""
    accepted = accepted_by(node)
    if accepted is not None:
        return effective(accepted, redefined, depth + 1)
    kinds = _naming_relations(node)
    named = next(
        (relation for kind in kinds for relation in node.relations if relation.kind == kind), None
    )
    target = named.reference.target if named else next(iter(redefined(node)), None)
    if target is None:
        return _last(named.reference) if named else ""
    return effective(target, redefined, depth + 1)


def accepted_by(node: Node) -> Node | None:
    """What the trigger of a transition accepts, for the parameter of the transition that has it."""
    owner = node.owner
    if owner is None or owner.kind != "TransitionUsage" or node.membership != "ParameterMembership":
        return None
    payload, accepted = find_payload(owner)
    return accepted if node is payload and accepted is not node else None


def _last(reference: Reference) -> str:
    """The name by which a reference that is not resolved calls its target; none for an id."""
    name = reference.chain[-1][-1] if reference.chain and reference.chain[-1] else ""
    return "" if "#" in name else name


def _naming_relations(node: Node) -> tuple[str, ...]:
    by_reference = node.kind in _PERFORMANCES or node.membership in _NAMED_BY_REFERENCE
    return ("ReferenceSubsetting", "Redefinition") if by_reference else ("Redefinition",)


def _position(node: Node) -> str:
    owner = node.owner
    return f"#{owner.members.index(node) + 1}" if owner and node in owner.members else "#"
