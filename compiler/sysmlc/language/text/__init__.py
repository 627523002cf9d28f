"""The parser of the textual notations of KerML and SysML v2: text becomes a tree.

A text with syntax errors becomes a tree too. Checks of the tree report errors that the grammars
leave out because the tree allows better messages.
"""

import re
from bisect import bisect_left
from functools import cache

from sysmlc.diagnostics import Sink
from sysmlc.language.metaclasses import kinds_of
from sysmlc.language.text import nesting, rules
from sysmlc.language.text.builders import ACTIONS
from sysmlc.language.text.builders.namespaces import build_root
from sysmlc.language.text.builders.operators import PRECEDENCE
from sysmlc.language.text.errors import Errors
from sysmlc.language.text.lalr import Rules, Stack, Tables, bind_actions, load_tables, run
from sysmlc.language.text.lexer import Tokens, tokenize
from sysmlc.language.text.recovery import Recovery
from sysmlc.language.tree import Document, Node
from sysmlc.sources import Source
from sysmlc.support.interpreter import pause_garbage_collection

_AFTER_EXPRESSION = {"}", ".", ".?", "->", "#", "(", *PRECEDENCE}
"""Tokens that continue an expression, or end the body whose result it is."""


def parse(
    text: str, path: str, language: str, sink: Sink, source: Source | None = None
) -> Document:
    """Return the tree of a text in ``language``: ``kerml`` or ``sysml``.

    Syntax errors are reported, and the tree has everything that could be parsed.
    """
    # A tree has hundreds of thousands of objects and no garbage: collections only cost time.
    with pause_garbage_collection():
        return _parse(text, path, language, sink, source)


def _parse(text: str, path: str, language: str, sink: Sink, source: Source | None) -> Document:
    tables = load_tables(language)
    tokens = tokenize(text, tables.types)
    _mark_index_brackets(tables, tokens)
    too_deep = nesting.find_too_deep(tables, tokens)
    if too_deep >= 0:
        tokens.truncate(too_deep, tables.types.end)
    bound_rules = _bind_rules(language)
    stack: Stack = [None, 0, tables.start]
    failed = run(tables, bound_rules, tokens, stack, 0) if len(tokens.types) > 1 else -1
    errors = Errors(tokens, tables.types, path, language, sink, source)
    # Builders add faults too (numbers that are too large), so faults are reported after the run.
    if too_deep >= 0 or tokens.faults:
        errors.report_faults(too_deep)
    if failed >= 0:
        recovery = Recovery(tables, bound_rules, tokens, errors)
        while failed >= 0 and (next_index := recovery.recover(stack, failed)) >= 0:
            failed = run(tables, bound_rules, tokens, stack, next_index)
    members: list[Node] = stack[3] if len(stack) > 3 and isinstance(stack[3], list) else []
    root = build_root(tokens, members)
    if tokens.restricted_nodes or tokens.build_faults:
        check_syntax(tokens, errors)
    if nesting.has_long_expression(tables, tokens):
        for expression in nesting.remove_deep_expressions(root):
            errors.report_depth(expression.start)
    return Document(path, language, root, text, source)


@cache
def _bind_rules(language: str) -> Rules:
    return bind_actions(load_tables(language), ACTIONS[language])


# -- brackets after a name at the start of a member ----------------------------------------------


def _mark_index_brackets(tables: Tables, tokens: Tokens) -> None:
    """Give the bracket of ``x [kg]`` its own token type where ``x`` starts a member.

    ``x [`` may begin a declaration with a multiplicity or a result expression with a unit. One
    token of lookahead does not decide this, but the token after the closing bracket does.
    """
    words = tables.types.words
    for match in _member_bracket_pattern(tables).finditer(tokens.types):
        index = match.end() - 1
        following = _find_after_bracket(tokens, index, words["["], words["]"])
        if tokens.types[following] in _types_after_expression(tables):
            tokens.types[index] = tables.index


@cache
def _member_bracket_pattern(tables: Tables) -> re.Pattern[bytes]:
    words, types = tables.types.words, tables.types
    before_member = bytes([words[";"], words["{"], words["}"], types.body])
    name, bracket = bytes([types.name]), bytes([words["["]])
    return re.compile(b"(?<=[" + re.escape(before_member) + b"])" + re.escape(name + bracket))


@cache
def _types_after_expression(tables: Tables) -> frozenset[int]:
    return frozenset(tables.types.words[word] for word in _AFTER_EXPRESSION)


def _find_after_bracket(tokens: Tokens, index: int, opening: int, closing: int) -> int:
    """Return the index after the bracket that closes the one at ``index``, else the last index."""
    depth = 0
    for position in range(index, len(tokens.types) - 1):
        token_type = tokens.types[position]
        depth += (token_type == opening) - (token_type == closing)
        if depth == 0:
            return position + 1
    return len(tokens.types) - 1


# -- syntax checks on the tree -----------------------------------------------------------------

_REQUIREMENT = ("RequirementDefinition", "RequirementUsage")
_CASE = ("CaseDefinition", "CaseUsage")
_CALCULATION = ("Function", "Expression")
_ACTION = ("ActionDefinition", "ActionUsage", "ConstraintDefinition", "ConstraintUsage", "Behavior")
_STATE = ("StateDefinition", "StateUsage", "ExhibitStateUsage")
_VIEW = ("ViewDefinition", "ViewUsage")
# The grammars have one rule for members of all bodies: a rule for each kind of body would multiply
# their states, and the message would only name a token.
_ALLOWED_OWNERS: dict[str, tuple[str, tuple[str, ...], str]] = {
    "SubjectMembership": ("a subject", _REQUIREMENT + _CASE, "requirements and cases"),
    "ActorMembership": ("an actor", _REQUIREMENT + _CASE, "requirements and cases"),
    "StakeholderMembership": ("a stakeholder", _REQUIREMENT, "requirements"),
    "ObjectiveMembership": ("an objective", _CASE, "cases"),
    "RequirementConstraintMembership": (
        "an 'assume' or 'require' constraint",
        _REQUIREMENT,
        "requirements",
    ),
    "FramedConcernMembership": ("'frame'", _REQUIREMENT, "requirements"),
    "RequirementVerificationMembership": ("'verify'", _REQUIREMENT, "requirements"),
    "ViewRenderingMembership": ("'render'", _VIEW, "views"),
    "StateSubactionMembership": ("an 'entry', 'do' or 'exit' action", _STATE, "states"),
    "ElementFilterMembership": ("a filter", ("Package", *_VIEW), "packages and views"),
    "ResultExpressionMembership": ("an expression", _CALCULATION, "calculations and constraints"),
    "ReturnParameterMembership": ("'return'", _CALCULATION, "calculations and cases"),
    "MembershipExpose": ("'expose'", ("ViewUsage",), "usages of views"),
    "NamespaceExpose": ("'expose'", ("ViewUsage",), "usages of views"),
    "action": ("a step of an action", _ACTION, "actions"),
    "TransitionUsage": ("a transition", (*_ACTION, *_STATE), "states and actions"),
}
"""For a kind or a membership: its name, the kinds of owners, and these in words."""
_STEPS = {
    "AcceptActionUsage",
    "SendActionUsage",
    "AssignmentActionUsage",
    "TerminateActionUsage",
    "IfActionUsage",
    "WhileLoopActionUsage",
    "ForLoopActionUsage",
    "MergeNode",
    "DecisionNode",
    "JoinNode",
    "ForkNode",
    "Membership",
}
_ENUMERATED_VALUE = ("EnumerationUsage", "VariantMembership")
"""The metaclasses of a value and of its membership."""
_MEMBER_BORDERS = (";", "{", "}")
_IMPORTS = ("MembershipImport", "NamespaceImport")


def check_syntax(tokens: Tokens, errors: Errors) -> None:
    """Report members in bodies that cannot have them, and the faults that builders found."""
    for fault in tokens.build_faults:
        rule = rules.PREFIX if fault.what == "prefix" else rules.COMBINATION
        errors.report(rule, fault.start, problem=fault.text, advice=fault.advice)
    for node in tokens.restricted_nodes:
        if node.kind in _IMPORTS:
            if not node.visibility:
                errors.report(rules.VISIBILITY, node.start)
        elif node.kind == "EnumerationDefinition":
            _check_enumeration(node, errors)
        elif node.kind == "Definition":
            _check_bare_definition(tokens, node, errors)
        elif node.owner is not None:
            _check_owner(tokens, node, node.owner, errors)


def _check_bare_definition(tokens: Tokens, node: Node, errors: Errors) -> None:
    """Report ``def`` without a kind; metadata before it, such as ``#tank``, gives the kind."""
    if any(member.attributes.get("isPrefix") for member in node.members):
        return
    index = bisect_left(tokens.starts, node.start)
    # Any other token before the member is an error already: a misspelt kind.
    if index == 0 or tokens[index - 1] in _MEMBER_BORDERS or tokens[index - 1].startswith("/*"):
        problem = "'def' goes with a keyword for the kind of the definition"
        advice = "write the kind before it, such as 'part def'"
        errors.report(rules.COMBINATION, node.start, problem=problem, advice=advice)


def _check_enumeration(node: Node, errors: Errors) -> None:
    for member in node.members:
        if member.membership == "ResultExpressionMembership":
            _read_last_value(member, errors)
        elif member.kind != "EnumerationUsage" and member.membership != "OwningMembership":
            _report(member, "a member that is not an enumerated value", "other definitions", errors)
        elif member.kind.endswith("Definition"):
            _report(member, "a definition", "packages and other definitions", errors)


def _read_last_value(member: Node, errors: Errors) -> None:
    """Report a last value without its semicolon, as other languages write it, and declare it."""
    errors.report_missing_after(member.end, "';'")
    if member.kind == "FeatureReferenceExpression" and member.relations:
        member.name = member.relations[0].reference.chain[-1][-1]
        member.kind, member.membership, member.name_start = *_ENUMERATED_VALUE, member.start
        member.relations.clear()


def _check_owner(tokens: Tokens, node: Node, owner: Node, errors: Errors) -> None:
    key = node.kind if node.kind in _ALLOWED_OWNERS else node.membership
    if node.membership == "ResultExpressionMembership" and owner.kind == "EnumerationDefinition":
        return
    # The members of a file are those of a package (KerML 8.2.3.4.1).
    if node.membership == "ElementFilterMembership" and owner.owner is None:
        return
    if node.kind in _STEPS and key not in _ALLOWED_OWNERS:
        key = "action"
    what, kinds, where = _ALLOWED_OWNERS.get(key, ("", (), ""))
    is_wrong = bool(kinds) and owner.kind not in _with_special_kinds(kinds)
    if is_wrong and not _has_unread_head(tokens, owner):
        _report(node, what, where, errors)


def _has_unread_head(tokens: Tokens, owner: Node) -> bool:
    """Whether recovery read a body without the head before it, which has a syntax error."""
    first = tokens.text[owner.start : owner.start + 1]
    return owner.kind == "ReferenceUsage" and (first == "{" or first.isspace())


def _report(node: Node, what: str, where: str, errors: Errors) -> None:
    owner, here = node.owner, "outside of any body"
    if owner is not None and owner.owner is not None:
        name = owner.name or owner.short_name
        here = f"in '{name}'" if name else "in this body"
    errors.report(rules.PLACE, node.start, what=what, here=here, where=where)


@cache
def _with_special_kinds(kinds: tuple[str, ...]) -> frozenset[str]:
    return frozenset(kind for general in kinds for kind in kinds_of(general))
