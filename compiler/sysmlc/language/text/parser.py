"""The parser of KerML and SysML v2: text becomes a syntax tree, also where it has syntax errors."""

import gc
import re
from collections.abc import Iterator
from functools import cache

from sysmlc.diagnostics import Sink
from sysmlc.language.text import nesting
from sysmlc.language.text.builders import ACTIONS
from sysmlc.language.text.builders.namespaces import build_root
from sysmlc.language.text.errors import Errors
from sysmlc.language.text.lalr import Rules, Stack, Tables, bind_actions, load_tables, run
from sysmlc.language.text.lexer import Tokens, tokenize
from sysmlc.language.text.recovery import Recovery
from sysmlc.language.text.syntax_checks import check_syntax
from sysmlc.language.tree import Document, Node
from sysmlc.sources import Source

_AFTER_EXPRESSION = (
    "} ?? or and implies xor | & == != === !== < > <= >= .. + - * / % ^ ** istype hastype @ as @@ "
    "meta . .? -> # ("
)
"""Tokens that continue an expression, or end the body whose result it is."""


def parse(
    text: str, path: str, language: str, sink: Sink, source: Source | None = None
) -> Document:
    """Return the tree of a text in ``language``: ``kerml`` or ``sysml``.

    Syntax errors are reported, and the tree has everything that could be parsed.
    """
    # A tree has hundreds of thousands of objects and no garbage: collections only cost time.
    is_collecting = gc.isenabled()
    gc.disable()
    try:
        return _parse(text, path, language, sink, source)
    finally:
        if is_collecting:
            gc.enable()


def _parse(text: str, path: str, language: str, sink: Sink, source: Source | None) -> Document:
    tables = load_tables(language)
    tokens = tokenize(text, tables.types)
    _mark_index_brackets(tables, tokens)
    too_deep = nesting.find_too_deep(tables, tokens)
    if too_deep >= 0:
        tokens.truncate(too_deep, tables.types.end)
    rules = _bind_rules(language)
    stack: Stack = [None, 0, tables.start]
    failed = run(tables, rules, tokens, stack, 0) if len(tokens.types) > 1 else -1
    errors = Errors(tokens, path, language, sink, source)
    # Builders add faults too (numbers that are too large), so faults are reported after the run.
    if too_deep >= 0 or tokens.faults:
        errors.report_faults(too_deep)
    if failed >= 0:
        recovery = Recovery(tables, rules, tokens, errors)
        while failed >= 0 and (next_index := recovery.recover(stack, failed)) >= 0:
            failed = run(tables, rules, tokens, stack, next_index)
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
    for index in _find_opening_brackets(tables, tokens):
        following = _find_after_bracket(tokens, index, words["["], words["]"])
        if tokens.types[following] in _types_after_expression(tables):
            tokens.types[index] = tables.index


def _find_opening_brackets(tables: Tables, tokens: Tokens) -> Iterator[int]:
    for match in _member_bracket_pattern(tables).finditer(tokens.types):
        yield match.end() - 1


@cache
def _member_bracket_pattern(tables: Tables) -> re.Pattern[bytes]:
    words, types = tables.types.words, tables.types
    before_member = bytes([words[";"], words["{"], words["}"], types.body])
    name, bracket = bytes([types.name]), bytes([words["["]])
    return re.compile(b"(?<=[" + re.escape(before_member) + b"])" + re.escape(name + bracket))


@cache
def _types_after_expression(tables: Tables) -> frozenset[int]:
    return frozenset(tables.types.words[word] for word in _AFTER_EXPRESSION.split())


def _find_after_bracket(tokens: Tokens, index: int, opening: int, closing: int) -> int:
    """Return the index after the bracket that closes the one at ``index``, else the last index."""
    depth = 0
    for position in range(index, len(tokens.types) - 1):
        token_type = tokens.types[position]
        depth += (token_type == opening) - (token_type == closing)
        if depth == 0:
            return position + 1
    return len(tokens.types) - 1
