"""Definitions, usages by keyword, and what may stand before them (SysML 8.2.2.6 to 8.2.2.27)."""

from functools import partial

from sysmlc.language.text.build.features import Part, give, specialize
from sysmlc.language.text.build.names import Names, call
from sysmlc.language.text.build.owning import FEATURE, OWNING, made, own
from sysmlc.language.text.scan import Remark, Tokens
from sysmlc.language.tree import Node, Reference, Relation

_STEMS = {
    "attribute": "Attribute",
    "enum": "Enumeration",
    "occurrence": "Occurrence",
    "item": "Item",
    "part": "Part",
    "port": "Port",
    "connection": "Connection",
    "interface": "Interface",
    "allocation": "Allocation",
    "flow": "Flow",
    "action": "Action",
    "calc": "Calculation",
    "state": "State",
    "constraint": "Constraint",
    "requirement": "Requirement",
    "concern": "Concern",
    "case": "Case",
    "analysis": "AnalysisCase",
    "verification": "VerificationCase",
    "use": "UseCase",
    "view": "View",
    "viewpoint": "Viewpoint",
    "rendering": "Rendering",
    "metadata": "Metadata",
}
USAGES = {keyword: (f"{stem}Usage", FEATURE) for keyword, stem in _STEMS.items()} | {
    "message": ("FlowUsage", FEATURE),
    "succession flow": ("SuccessionFlowUsage", FEATURE),
    "binding": ("BindingConnectorAsUsage", FEATURE),
    "succession": ("SuccessionAsUsage", FEATURE),
    "merge": ("MergeNode", FEATURE),
    "decide": ("DecisionNode", FEATURE),
    "join": ("JoinNode", FEATURE),
    "fork": ("ForkNode", FEATURE),
    "subject": ("ReferenceUsage", "SubjectMembership"),
    "actor": ("PartUsage", "ActorMembership"),
    "stakeholder": ("PartUsage", "StakeholderMembership"),
    "objective": ("RequirementUsage", "ObjectiveMembership"),
}
"""Keyword of a usage: its metaclass, the membership by which it is owned."""
_CONTROL = {"merge", "decide", "join", "fork"}
Keyword = int | str


def _use_case(_tokens: Tokens, _at: int, _begin: int, use: int, _case: int) -> int:
    return use


def _succession_flow(_tokens: Tokens, _at: int, _begin: int, _first: int, _second: int) -> str:
    return "succession flow"


def _definition(
    tokens: Tokens,
    at: int,
    begin: int,
    keyword: Keyword,
    names: Names | None,
    general: list[Reference] | None,
    body: list[Node],
) -> Node:
    kind = f"{_STEMS.get(_word(tokens, keyword), '')}Definition"
    return _defined(kind, tokens, at, begin, names, general, body)


def _defined(
    kind: str,
    tokens: Tokens,
    at: int,
    begin: int,
    names: Names | None,
    general: list[Reference] | None,
    body: list[Node],
) -> Node:
    node = call(made(kind, OWNING, tokens, begin, at), names, tokens)
    node.relations += [Relation("Subclassification", name) for name in general or ()]
    if isinstance(body, Parallel):
        _make_parallel(node, tokens)
    if kind == "EnumerationDefinition":
        tokens.special.append(node)
    return own(node, body)


def _word(tokens: Tokens, keyword: Keyword) -> str:
    return keyword if isinstance(keyword, str) else tokens[keyword]


class Parallel(list[Node]):
    """The members of a body that begins with `parallel`."""


def _make_parallel(node: Node, tokens: Tokens) -> None:
    node.facts["isParallel"] = True
    if "State" not in node.kind:
        text = "'parallel' goes with states, not with this declaration"
        remark = Remark("combination", node.start, text, "take 'parallel' away")
        tokens.remarks.append(remark)


def _parallel(_tokens: Tokens, _at: int, _begin: int, body: list[Node]) -> Parallel:
    return Parallel(body)


def _declared(
    tokens: Tokens,
    at: int,
    begin: int,
    keyword: Keyword,
    names: Names | None,
    parts: list[Part] | None,
    value: Node | None,
) -> Node:
    word = _word(tokens, keyword)
    kind, membership = USAGES[word]
    node = call(made(kind, membership, tokens, begin, at), names, tokens)
    if word == "message":
        node.facts["isAbstract"] = True
    if membership != FEATURE or word in _CONTROL:
        tokens.special.append(node)
    if parts is not None:
        specialize(node, parts, tokens)
    return give(node, value)


def _declared_with_metadata(
    tokens: Tokens,
    at: int,
    begin: int,
    keyword: Keyword,
    metadata: list[Node],
    names: Names | None,
    parts: list[Part] | None,
    value: Node | None,
) -> Node:
    node = _declared(tokens, at, begin, keyword, names, parts, value)
    return lead(node, metadata)


def lead(node: Node, members: list[Node]) -> Node:
    """Give the node members before its others."""
    for member in members:
        member.owner = node
    node.members[:0] = members
    return node


def whole(node: Node, tokens: Tokens, at: int, body: list[Node]) -> Node:
    """The node with its body, after which it ends."""
    node.end = tokens.ends[at - 1]
    if isinstance(body, Parallel):
        _make_parallel(node, tokens)
    return own(node, body) if body else node


def _usage(tokens: Tokens, at: int, _begin: int, node: Node, body: list[Node]) -> Node:
    return whole(node, tokens, at, body)


def loose(
    tokens: Tokens,
    at: int,
    begin: int,
    names: Names | None,
    parts: list[Part] | None,
    value: Node | None,
    body: list[Node],
) -> Node:
    """A usage without keyword (SysML 8.2.2.6.3)."""
    node = call(made("ReferenceUsage", FEATURE, tokens, begin, at), names, tokens)
    specialize(node, parts, tokens)
    return own(give(node, value), body)


def _loose_nameless(
    tokens: Tokens, at: int, begin: int, parts: list[Part], value: Node | None, body: list[Node]
) -> Node:
    return loose(tokens, at, begin, None, parts, value, body)


def _loose_value(tokens: Tokens, at: int, begin: int, value: Node, body: list[Node]) -> Node:
    return loose(tokens, at, begin, None, None, value, body)


ACTIONS = {
    "use_case": _use_case,
    "succession_flow": _succession_flow,
    "definition": _definition,
    "metadata_definition": partial(_defined, "MetadataDefinition"),
    "bare_definition": partial(_defined, "Definition"),
    "parallel": _parallel,
    "declared": _declared,
    "declared_with_metadata": _declared_with_metadata,
    "usage": _usage,
    "loose": loose,
    "loose_nameless": _loose_nameless,
    "loose_value": _loose_value,
}
