"""Members of a model that nothing has become or read: each is told, none vanishes in silence."""

from collections.abc import Iterator
from typing import TYPE_CHECKING

from sysmlc.diagnostics import Verdict
from sysmlc.frontends.sysml import nodes
from sysmlc.frontends.sysml.definitions import variant
from sysmlc.frontends.sysml.rules import APPROXIMATED, UNSUPPORTED
from sysmlc.ir import Kind
from sysmlc.language.tree import Node

if TYPE_CHECKING:
    from sysmlc.frontends.sysml.lowering import Lowering

_DEAD = frozenset({Verdict.UNSUPPORTED, Verdict.EXTERNAL, Verdict.IGNORED_NOTATION})
_STATEMENTS = """
    AssignmentActionUsage SendActionUsage AcceptActionUsage ForLoopActionUsage
    WhileLoopActionUsage IfActionUsage TransitionUsage FlowUsage SuccessionFlowUsage
"""
_PARAMETERS = frozenset(_STATEMENTS.split())
"""What reads its parameters as its own parts: targets, payloads, collections, events."""
_PARTS = {
    "TransitionUsage": frozenset({"SuccessionAsUsage", "AcceptActionUsage"}),
    "FlowEnd": frozenset({"ReferenceUsage"}),
    "FlowUsage": frozenset({"PayloadFeature"}),
    "SuccessionFlowUsage": frozenset({"PayloadFeature"}),
    "MetadataUsage": frozenset({"ReferenceUsage"}),
    "SatisfyRequirementUsage": frozenset({"ReferenceUsage"}),
}
"""Members that are facts of what owns them, by its metaclass."""
_COUNTED = frozenset(
    {
        Kind.PROPERTY,
        Kind.PORT,
        Kind.PARAMETER,
        Kind.PIN,
        Kind.CONNECTOR_END,
        Kind.FLOW_PROPERTY,
        Kind.OBJECT_NODE,
        Kind.DATA_STORE,
        Kind.ACTIVITY_PARAMETER,
    }
)
"""Elements that have a multiplicity."""
_MORE = frozenset({"isVariation", "portionKind"})
_VARIANT = "VariantMembership"
_ENDS = frozenset({"EndFeatureMembership"})


def tell(low: "Lowering") -> None:
    """Report what is not wholly in the graph, each sort with its number and its first place."""
    _find(low)
    for (said, written), found in low.told.items():
        count, subject = len(found), low.subject(found[0])
        if said == "unsupported":
            low.sink.report(UNSUPPORTED, subject, type=nodes.words(written), count=count)
        else:
            low.sink.report(APPROXIMATED, subject, count=count, said=said, written=written)


def _find(low: "Lowering") -> None:
    """Members that were not lowered and are no part of what their owner says."""
    known = low.seen.union(low.verdicts, low.skipped, low.repeated, low.elements)
    dead = {one for one, verdict in low.verdicts.items() if verdict in _DEAD}
    for root in low.roots:
        for node in _unread(low, root, known, dead):
            owner = node.owner
            assert owner is not None
            if node.kind == "MultiplicityRange":
                low.approximated(
                    node, f"the multiplicity of {_a(nodes.words(owner.kind))}", "nothing"
                )
            else:
                low.approximated(node, f"a member of {_a(nodes.words(owner.kind))}", "nothing")


def _more(low: "Lowering", node: Node) -> str:
    """What a usage is beyond its kind, and what it became does not say; empty for most."""
    is_plain = _MORE.isdisjoint(node.attributes) and node.membership != _VARIANT
    if is_plain or node.kind == "EnumerationUsage":
        return ""
    made = (low.elements.get(id(node)), low.made_for.get(id(node)))
    said = [key for key, value in variant(node).items() if value]
    lost = [key for key in said if not any(one and key in one.attrs for one in made)]
    return str(node.attributes["portionKind"]) if lost == ["portion"] else lost[0] if lost else ""


def _a(noun: str) -> str:
    return f"an {noun}" if noun[0] in "aeiou" and not noun.startswith("us") else f"a {noun}"


def _unread(low: "Lowering", root: Node, known: set[int], dead: set[int]) -> Iterator[Node]:
    found, expressions = [root], nodes.EXPRESSIONS
    while found:
        node = found.pop()
        for one in reversed(node.members):
            if one.kind in expressions:
                continue
            if id(one) not in known and not _is_read(low, one, node):
                yield one
            elif id(one) not in dead:
                if one.members:
                    found.append(one)
                if (one.attributes or one.membership == _VARIANT) and (more := _more(low, one)):
                    low.approximated(one, _a(more), "a plain usage")


def _is_read(low: "Lowering", node: Node, owner: Node) -> bool:
    if node.membership in _ENDS or node.kind in _PARTS.get(owner.kind, ()):
        return True
    if node.kind == "MultiplicityRange":
        return _is_counted(low, owner)
    if node.membership == "ParameterMembership" and owner.kind in _PARAMETERS:
        return True
    return _is_written(low, node, owner) or _is_sign(node, owner)


def _is_counted(low: "Lowering", owner: Node) -> bool:
    """Whether the multiplicity of a feature is an attribute of what it became."""
    made = low.elements.get(id(owner))
    is_end = owner.membership in _ENDS or bool(owner.attributes.get("isEnd"))
    return is_end or owner.kind == "Feature" or (made is not None and made.kind in _COUNTED)


def _is_written(low: "Lowering", node: Node, owner: Node) -> bool:
    """Whether a statement is in the text of the behaviour that it makes up."""
    above = owner
    while above.owner is not None and id(above) not in low.elements:
        above = above.owner
    made = low.elements.get(id(above))
    return made is not None and "body" in made.attrs and node.kind.endswith("ActionUsage")


def _is_sign(node: Node, owner: Node) -> bool:
    """Keywords, ends in bodies, empty actions of states, features that cross: facts of an owner."""
    if node.kind == "MetadataUsage":
        return bool(node.attributes.get("isPrefix")) and owner.kind != "MetadataUsage"
    if node.kind == "Membership":
        return not node.name
    is_cross = node is nodes.crossed(owner) or (
        node.kind == "Feature" and node.membership == "OwningMembership"
    )
    is_end = bool(node.attributes.get("isEnd")) and owner.kind == "ConnectionUsage"
    return (
        is_cross or is_end or (node.membership == "StateSubactionMembership" and not node.members)
    )
