"""The textual notations of KerML and SysML v2: text becomes a tree."""

import gc
from functools import cache
from typing import TYPE_CHECKING

from sysmlc.language.tree import Document, Node

if TYPE_CHECKING:
    from sysmlc.diagnostics import Sink
    from sysmlc.language.text.errors import Errors
    from sysmlc.language.text.machine import Rules, Stack
    from sysmlc.language.text.scan import Tokens
    from sysmlc.language.text.tables import Tables
    from sysmlc.sources import Source


def parse(
    text: str, path: str, language: str, sink: "Sink", source: "Source | None" = None
) -> Document:
    """The tree of a text in ``language``: ``kerml`` or ``sysml``.

    What is wrong in it is reported; the tree has what was understood.
    """
    collecting = gc.isenabled()
    gc.disable()
    try:
        return _parse(text, path, language, sink, source)
    finally:
        if collecting:
            gc.enable()


def _parse(text: str, path: str, language: str, sink: "Sink", source: "Source | None") -> Document:
    from sysmlc.language.text import machine, nesting, tables
    from sysmlc.language.text.brackets import settle
    from sysmlc.language.text.build.namespaces import root
    from sysmlc.language.text.check import check
    from sysmlc.language.text.errors import Errors
    from sysmlc.language.text.scan import scan

    made = tables.load(language)
    tokens = scan(text, made.types)
    settle(made, tokens)
    deep = nesting.too_deep(made, tokens)
    if deep >= 0:
        tokens.end_at(deep, made.types.end)
    stack: Stack = [None, 0, made.start]
    wrong = machine.run(made, _rules(language), tokens, stack, 0) if len(tokens.types) > 1 else -1
    errors = Errors(tokens, path, language, sink, source)
    if deep >= 0 or tokens.faults:
        errors.faults(deep)
    if wrong >= 0:
        _recover(made, language, tokens, stack, wrong, errors)
    members: list[Node] = stack[3] if len(stack) > 3 and isinstance(stack[3], list) else []
    top = root(tokens, members)
    if tokens.special or tokens.remarks:
        check(tokens, errors)
    if nesting.has_long_expression(made, tokens):
        for node in nesting.cut(top):
            errors.deep(node.start)
    return Document(path, language, top, text, source)


def _recover(
    made: "Tables", language: str, tokens: "Tokens", stack: "Stack", wrong: int, errors: "Errors"
) -> None:
    from sysmlc.language.text import machine
    from sysmlc.language.text.recover import Recovery

    recovery = Recovery(made, _rules(language), tokens, errors)
    while wrong >= 0 and (at := recovery.next(stack, wrong)) >= 0:
        wrong = machine.run(made, _rules(language), tokens, stack, at)


@cache
def _rules(language: str) -> "Rules":
    from sysmlc.language.text import machine, tables
    from sysmlc.language.text.build import ACTIONS

    return machine.rules(tables.load(language), ACTIONS[language])
