"""Expressions of TLSF as trees: definitions are evaluated when they are called.

Source: "A high-level LTL synthesis format: TLSF v1.1" (Jacobs, Klein, Schirmer), precedences
included: U, R and W bind more weakly than the Boolean connectives.
"""

from collections.abc import Callable

from msgspec import Struct

from sysmlc.logic.infix import DEEPEST
from sysmlc.logic.spelling import Cursor, FormulaError

INFIX = {
    "R": (1, "left"),
    "U": (2, "right"),
    "W": (3, "right"),
    "->": (4, "right"),
    "IMPLIES": (4, "right"),
    "<->": (4, "right"),
    "EQUIV": (4, "right"),
    "||": (5, "left"),
    "OR": (5, "left"),
    "&&": (6, "left"),
    "AND": (6, "left"),
    **dict.fromkeys(("==", "!=", "<", "<=", ">", ">=", "EQ", "NEQ", "LE", "LEQ"), (8, "left")),
    **dict.fromkeys(("+", "-", "PLUS", "MINUS"), (9, "left")),
    **dict.fromkeys(("*", "/", "%", "MUL", "DIV", "MOD"), (10, "left")),
}
"""Operators between two operands: how strongly they bind, and from which side they group."""
SAME = {
    "IMPLIES": "->",
    "EQUIV": "<->",
    "OR": "||",
    "AND": "&&",
    "NOT": "!",
    "EQ": "==",
    "NEQ": "!=",
    "LE": "<",
    "LEQ": "<=",
    "PLUS": "+",
    "MINUS": "-",
    "MUL": "*",
    "DIV": "/",
    "MOD": "%",
    "FORALL": "&&",
    "EXISTS": "||",
}
"""Words for signs."""
PREFIX = ("!", "NOT", "X", "F", "G", "SIZEOF", "-")
_UNARY = 7
_NO_SETS = "sets are not read; a range is, as 0 <= i < n"
QUANTIFIERS = ("&&", "||", "FORALL", "EXISTS", "AND", "OR")


class Tree(Struct, frozen=True):
    """An operator, ``name``, ``number``, ``call``, ``index`` or ``range`` with its operands."""

    kind: str
    text: str
    at: int
    args: tuple["Tree", ...] = ()


def expression(cursor: Cursor, weakest: int = 0, depth: int = 0) -> Tree:
    """The expression that comes next. Raises FormulaError."""
    if depth > DEEPEST:
        raise FormulaError(f"it is nested more than {DEEPEST} deep", cursor.next.at)
    left = _operand(cursor, depth)
    steps = depth
    while (token := cursor.next).text in INFIX and token.kind in ("sign", "name"):
        own, group = INFIX[token.text]
        if own < weakest:
            break
        steps += 1
        if steps > DEEPEST * 8:
            raise FormulaError("it has too many operands", token.at)
        cursor.take()
        right = expression(cursor, own + (group == "left"), depth + 1)
        left = _joined(SAME.get(token.text, token.text), token.at, left, right)
    return left


def _joined(text: str, at: int, left: Tree, right: Tree) -> Tree:
    """And, or: one tree for a whole chain."""
    if text in ("&&", "||") and left.kind == "chain" and left.text == text:
        return Tree("chain", text, at, (*left.args, right))
    kind = "chain" if text in ("&&", "||") else "infix"
    return Tree(kind, text, at, (left, right))


def _operand(cursor: Cursor, depth: int) -> Tree:
    token = cursor.next
    if token.text in QUANTIFIERS and cursor.after_next.text == "[":
        return _quantified(cursor, depth)
    if token.text in PREFIX and token.kind in ("sign", "name"):
        cursor.take()
        inner = expression(cursor, _UNARY, depth + 1)
        return Tree("prefix", SAME.get(token.text, token.text), token.at, (inner,))
    if cursor.took("("):
        inner = expression(cursor, 0, depth + 1)
        cursor.expect(")")
        return Tree("group", "(", token.at, (inner,))
    if token.kind == "number":
        return Tree("number", str(cursor.integer()), token.at)
    if cursor.has("{"):
        raise FormulaError(_NO_SETS, token.at)
    name = cursor.expect_kind("name", "an operand")
    return _indexed(cursor, _named(cursor, name.text, name.at, depth), depth)


def _named(cursor: Cursor, name: str, at: int, depth: int) -> Tree:
    if not cursor.took("("):
        return Tree("name", name, at)
    args = _list(cursor, ")", lambda: expression(cursor, 0, depth + 1))
    return Tree("call", name, at, args)


def _indexed(cursor: Cursor, tree: Tree, depth: int) -> Tree:
    while cursor.took("["):
        inner = expression(cursor, 0, depth + 1)
        cursor.expect("]")
        tree = Tree("index", tree.text, tree.at, (tree, inner))
    return tree


def _list(cursor: Cursor, end: str, read: Callable[[], Tree]) -> tuple[Tree, ...]:
    found = [read()]
    while cursor.took(","):
        found.append(read())
    cursor.expect(end)
    return tuple(found)


def _quantified(cursor: Cursor, depth: int) -> Tree:
    token = cursor.take()
    cursor.expect("[")
    ranges = _list(cursor, "]", lambda: _range(cursor, depth))
    body = expression(cursor, _UNARY, depth + 1)
    return Tree("every", SAME.get(token.text, token.text), token.at, (*ranges, body))


def _range(cursor: Cursor, depth: int) -> Tree:
    """``0 <= i < n``: the operands are the bounds, the text is ``<= i <``."""
    low = expression(cursor, 9, depth + 1)
    if cursor.has("IN"):
        raise FormulaError(_NO_SETS, cursor.next.at)
    first = cursor.expect("<", "<=")
    name = cursor.expect_kind("name", "a name")
    second = cursor.expect("<", "<=")
    high = expression(cursor, 9, depth + 1)
    return Tree("range", f"{first.text} {name.text} {second.text}", name.at, (low, high))
