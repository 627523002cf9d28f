"""Definitions, usages by keyword, and what may stand before them (SysML 8.2.2.6 to 8.2.2.27)."""

from functools import partial

from sysmlc.language.text.builders.declarations import (
    Names,
    SpecializationPart,
    apply_names,
    apply_specializations,
    apply_value,
)
from sysmlc.language.text.builders.nodes import (
    FEATURE,
    OWNING,
    add_members,
    make_node,
    prepend_members,
)
from sysmlc.language.text.lexer import BuildFault, Tokens
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
USAGE_KINDS = {keyword: (f"{stem}Usage", FEATURE) for keyword, stem in _STEMS.items()} | {
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
"""The metaclass and the membership of a usage by its keyword."""
_CONTROL_NODES = {"merge", "decide", "join", "fork"}
Keyword = int | str


def _build_use_case_keyword(_tokens: Tokens, _stop: int, _begin: int, use: int, _case: int) -> int:
    return use


def _build_succession_flow_keyword(
    _tokens: Tokens, _stop: int, _begin: int, _first: int, _second: int
) -> str:
    return "succession flow"


def _build_definition(
    tokens: Tokens,
    stop: int,
    begin: int,
    keyword: Keyword,
    names: Names | None,
    general: list[Reference] | None,
    body: list[Node],
) -> Node:
    kind = f"{_STEMS.get(read_keyword(tokens, keyword), '')}Definition"
    return _make_definition(kind, tokens, stop, begin, names, general, body)


def _make_definition(
    kind: str,
    tokens: Tokens,
    stop: int,
    begin: int,
    names: Names | None,
    general: list[Reference] | None,
    body: list[Node],
) -> Node:
    node = apply_names(make_node(kind, OWNING, tokens, begin, stop), names, tokens)
    node.relations += [Relation("Subclassification", name) for name in general or ()]
    if isinstance(body, ParallelBody):
        _mark_parallel(node, tokens)
    if kind in ("EnumerationDefinition", "Definition"):
        tokens.restricted_nodes.append(node)
    return add_members(node, body)


def read_keyword(tokens: Tokens, keyword: Keyword) -> str:
    """Return the text of a keyword: several words are a text already, a single one is a token."""
    return keyword if isinstance(keyword, str) else tokens[keyword]


class ParallelBody(list[Node]):
    """The members of a body that begins with `parallel`."""


def _mark_parallel(node: Node, tokens: Tokens) -> None:
    node.attributes["isParallel"] = True
    if "State" not in node.kind:
        text = "'parallel' goes with states, not with this declaration"
        remark = BuildFault("combination", node.start, text, "take 'parallel' away")
        tokens.build_faults.append(remark)


def _build_parallel_body(
    _tokens: Tokens, _stop: int, _begin: int, body: list[Node]
) -> ParallelBody:
    return ParallelBody(body)


def _build_declaration(
    tokens: Tokens,
    stop: int,
    begin: int,
    keyword: Keyword,
    names: Names | None,
    parts: list[SpecializationPart] | None,
    value: Node | None,
) -> Node:
    word = read_keyword(tokens, keyword)
    kind, membership = USAGE_KINDS[word]
    node = apply_names(make_node(kind, membership, tokens, begin, stop), names, tokens)
    # A message is an abstract flow (SysML 8.2.2.16.2).
    if word == "message":
        node.attributes["isAbstract"] = True
    if membership != FEATURE or word in _CONTROL_NODES:
        tokens.restricted_nodes.append(node)
    if parts is not None:
        apply_specializations(node, parts, tokens)
    return apply_value(node, value)


def _build_declaration_with_metadata(
    tokens: Tokens,
    stop: int,
    begin: int,
    keyword: Keyword,
    metadata: list[Node],
    names: Names | None,
    parts: list[SpecializationPart] | None,
    value: Node | None,
) -> Node:
    node = _build_declaration(tokens, stop, begin, keyword, names, parts, value)
    return prepend_members(node, metadata)


def finish_usage(node: Node, tokens: Tokens, stop: int, body: list[Node]) -> Node:
    """Set the end of a usage and add the members of its body."""
    node.end = tokens.ends[stop - 1]
    if isinstance(body, ParallelBody):
        _mark_parallel(node, tokens)
    return add_members(node, body) if body else node


def _build_usage(tokens: Tokens, stop: int, _begin: int, node: Node, body: list[Node]) -> Node:
    return finish_usage(node, tokens, stop, body)


def build_keywordless_usage(
    tokens: Tokens,
    stop: int,
    begin: int,
    names: Names | None,
    parts: list[SpecializationPart] | None,
    value: Node | None,
    body: list[Node],
) -> Node:
    """Build a usage without keyword (SysML 8.2.2.6.3)."""
    node = apply_names(make_node("ReferenceUsage", FEATURE, tokens, begin, stop), names, tokens)
    apply_specializations(node, parts, tokens)
    return add_members(apply_value(node, value), body)


def _build_nameless_usage(
    tokens: Tokens,
    stop: int,
    begin: int,
    parts: list[SpecializationPart],
    value: Node | None,
    body: list[Node],
) -> Node:
    return build_keywordless_usage(tokens, stop, begin, None, parts, value, body)


def _build_value_usage(
    tokens: Tokens, stop: int, begin: int, value: Node, body: list[Node]
) -> Node:
    return build_keywordless_usage(tokens, stop, begin, None, None, value, body)


ACTIONS = {
    "use_case": _build_use_case_keyword,
    "succession_flow": _build_succession_flow_keyword,
    "definition": _build_definition,
    "metadata_definition": partial(_make_definition, "MetadataDefinition"),
    "bare_definition": partial(_make_definition, "Definition"),
    "parallel": _build_parallel_body,
    "declared": _build_declaration,
    "declared_with_metadata": _build_declaration_with_metadata,
    "usage": _build_usage,
    "loose": build_keywordless_usage,
    "loose_nameless": _build_nameless_usage,
    "loose_value": _build_value_usage,
}
