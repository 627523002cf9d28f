"""Definitions, usages by keyword, and what may stand before them (SysML 8.2.2.6 to 8.2.2.27)."""

from functools import partial

from sysmlc.language.text.builders.declarations import Names, Parts, make_element
from sysmlc.language.text.builders.nodes import (
    FEATURE,
    OWNING,
    add_members,
    omit_first,
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
    "use case": "UseCase",
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


def read_keyword(tokens: Tokens, keyword: Keyword) -> str:
    """Return the text of a keyword: several words are a text already, a single one is a token."""
    return keyword if isinstance(keyword, str) else tokens[keyword]


def join_words(tokens: Tokens, *words: int) -> str:
    """Build a keyword of several words."""
    return " ".join(tokens[word] for word in words)


def _build_definition(
    tokens: Tokens,
    keyword: Keyword,
    names: Names | None,
    general: list[Reference] | None,
    body: list[Node],
) -> Node:
    kind = f"{_STEMS.get(read_keyword(tokens, keyword), '')}Definition"
    return _make_definition(kind, tokens, names, general, body)


def _make_definition(
    kind: str,
    tokens: Tokens,
    names: Names | None,
    general: list[Reference] | None,
    body: list[Node],
) -> Node:
    node = make_element(kind, OWNING, tokens, names)
    node.relations += [Relation("Subclassification", name) for name in general or ()]
    if isinstance(body, ParallelBody):
        _mark_parallel(node, tokens)
    if kind in ("EnumerationDefinition", "Definition"):
        tokens.restricted_nodes.append(node)
    return add_members(node, body)


class ParallelBody(list[Node]):
    """The members of a body that begins with `parallel`."""


def _build_parallel_body(_tokens: Tokens, body: list[Node]) -> ParallelBody:
    return ParallelBody(body)


def _mark_parallel(node: Node, tokens: Tokens) -> None:
    node.attributes["isParallel"] = True
    if "State" not in node.kind:
        text = "'parallel' goes with states, not with this declaration"
        remark = BuildFault("combination", node.start, text, "take 'parallel' away")
        tokens.build_faults.append(remark)


def build_declaration(
    tokens: Tokens,
    keyword: Keyword,
    names: Names | None = None,
    parts: Parts = None,
    value: Node | None = None,
) -> Node:
    """Build a usage by its keyword, without its body."""
    word = read_keyword(tokens, keyword)
    kind, membership = USAGE_KINDS[word]
    node = make_element(kind, membership, tokens, names, parts, value)
    # A message is an abstract flow (SysML 8.2.2.16.2).
    if word == "message":
        node.attributes["isAbstract"] = True
    if membership != FEATURE or word in _CONTROL_NODES:
        tokens.restricted_nodes.append(node)
    return node


def _build_declaration_with_metadata(
    tokens: Tokens,
    keyword: Keyword,
    metadata: list[Node],
    names: Names | None,
    parts: Parts,
    value: Node | None,
) -> Node:
    return prepend_members(build_declaration(tokens, keyword, names, parts, value), metadata)


def finish_usage(tokens: Tokens, node: Node, body: list[Node] | None) -> Node:
    """Set the end of a usage and add the members of its body."""
    node.end = tokens.ends[tokens.stop - 1]
    if isinstance(body, ParallelBody):
        _mark_parallel(node, tokens)
    return add_members(node, body) if body else node


def build_keywordless(
    kind: str,
    tokens: Tokens,
    names: Names | None,
    parts: Parts,
    value: Node | None,
    body: list[Node],
) -> Node:
    """Build a usage or feature without keyword (SysML 8.2.2.6.3)."""
    return add_members(make_element(kind, FEATURE, tokens, names, parts, value), body)


_build_keywordless_usage = partial(build_keywordless, "ReferenceUsage")
ACTIONS = {
    "use_case": join_words,
    "succession_flow": join_words,
    "definition": _build_definition,
    "metadata_definition": partial(_make_definition, "MetadataDefinition"),
    "bare_definition": partial(_make_definition, "Definition"),
    "parallel": _build_parallel_body,
    "declared": build_declaration,
    "declared_with_metadata": _build_declaration_with_metadata,
    "usage": finish_usage,
    "loose": _build_keywordless_usage,
    "loose_nameless": omit_first(_build_keywordless_usage),
    "loose_value": omit_first(_build_keywordless_usage, 2),
}
