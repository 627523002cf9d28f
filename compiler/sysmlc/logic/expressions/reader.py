"""Reader of expressions and effects: Lark runs ``grammars/expression.lark``.

Importing Lark and building its tables takes 0.1 s; the callers import this module when a model has
its first expression.
"""

import re
from functools import cache
from typing import Any

from lark import Lark, Token, Transformer, v_args
from lark.exceptions import UnexpectedInput, VisitError
from lark.tree import Meta

from sysmlc.logic.expressions.expression import (
    Assignment,
    Binary,
    Call,
    Conditional,
    Expression,
    ExpressionError,
    Index,
    Invocation,
    Literal,
    Member,
    Name,
    Send,
    Statement,
    Unary,
)
from sysmlc.support import resources

_SPELLING = {"&&": "and", "&": "and", "||": "or", "|": "or", "!": "not", "=": "==", "<>": "!="}
_ESCAPE = {"n": "\n"}
_SHOWN_CHARACTERS = 20


def read_expression(text: str) -> Expression:
    """Return the expression that *text* denotes. Raises ExpressionError and RecursionError."""
    expression: Expression = _parse(text, "expression")
    return expression


def read_effect(text: str) -> tuple[Statement, ...]:
    """Return the statements of an effect. Raises ExpressionError and RecursionError."""
    statements: tuple[Statement, ...] = _parse(text, "effect")
    return statements


def _parse(text: str, start: str) -> Any:  # noqa: ANN401 - the type depends on the start rule
    try:
        return _ExpressionBuilder().transform(_make_parser().parse(text, start=start))
    except VisitError as error:
        raise error.orig_exc from None
    except UnexpectedInput as error:
        token = getattr(error, "token", None)
        is_at_end = token is not None and token.type == "$END"
        offset = len(text) if is_at_end or error.pos_in_stream is None else error.pos_in_stream
        raise ExpressionError(_explain(text, offset), offset) from None


def _explain(text: str, offset: int) -> str:
    words = text[offset:].split()
    if not words:
        return "the text ends too early"
    return f"'{words[0][:_SHOWN_CHARACTERS]}' is not expected here"


@cache
def _make_parser() -> Lark:
    return Lark(
        resources.read_text("grammars", "expression.lark"),
        parser="lalr",
        start=["expression", "effect"],
        propagate_positions=True,
        maybe_placeholders=False,
    )


@v_args(meta=True)
class _ExpressionBuilder(Transformer[Token, Any]):
    """Builds the value of each grammar rule from the values of its parts."""

    def expression(self, _meta: Meta, children: list[Expression]) -> Expression:
        return children[0]

    def literal(self, meta: Meta, children: list[Token]) -> Literal:
        (token,) = children
        match token.type:
            case "TRUE" | "FALSE":
                return Literal(token.type == "TRUE", meta.start_pos)
            case "REAL":
                return Literal(float(token), meta.start_pos)
            case "STRING":
                return Literal(_unquote(token), meta.start_pos)
        try:
            return Literal(int(token), meta.start_pos)
        except ValueError:
            raise ExpressionError("the number has too many digits", meta.start_pos) from None

    def name(self, _meta: Meta, children: list[Token]) -> str:
        (token,) = children
        return _unquote(token) if token.type == "QUOTED_NAME" else str(token)

    def qualified(self, meta: Meta, children: list[str]) -> Name:
        return Name(tuple(children), meta.start_pos)

    def member(self, meta: Meta, children: list[Any]) -> Member:
        base, name = children
        return Member(base, name, meta.start_pos)

    def call(self, meta: Meta, children: list[Expression]) -> Call:
        function, *arguments = children
        return Call(function, tuple(arguments), meta.start_pos)

    def index(self, meta: Meta, children: list[Expression]) -> Index:
        base, index = children
        return Index(base, index, meta.start_pos)

    def unary(self, meta: Meta, children: list[Any]) -> Unary:
        operator, operand = children
        return Unary(_normalise(operator), operand, meta.start_pos)

    def binary(self, meta: Meta, children: list[Any]) -> Binary:
        left, operator, right = children
        return Binary(_normalise(operator), left, right, meta.start_pos)

    def conditional(self, meta: Meta, children: list[Expression]) -> Conditional:
        condition, then, otherwise = children
        return Conditional(condition, then, otherwise, meta.start_pos)

    def effect(self, _meta: Meta, children: list[Statement]) -> tuple[Statement, ...]:
        return tuple(children)

    def assignment(self, meta: Meta, children: list[Any]) -> Assignment:
        target, value = children[0], children[-1]
        if not isinstance(target, Name | Member | Index):
            raise ExpressionError("only a feature can be assigned to", meta.start_pos)
        return Assignment(target, value, meta.start_pos)

    def receiver(self, _meta: Meta, children: list[Expression]) -> "_Receiver":
        return _Receiver(children[0])

    def send(self, meta: Meta, children: list[Any]) -> Send:
        signal, *rest = children
        receiver = rest.pop().expression if rest and isinstance(rest[-1], _Receiver) else None
        return Send(signal, tuple(rest), receiver, meta.start_pos)

    def invocation(self, meta: Meta, children: list[Expression]) -> Invocation:
        (target,) = children
        if not isinstance(target, Name | Member | Call):
            raise ExpressionError("this is a value and does nothing", meta.start_pos)
        return Invocation(target, meta.start_pos)


class _Receiver:
    """The receiver of a send statement, told apart from its arguments."""

    def __init__(self, expression: Expression) -> None:
        self.expression = expression


def _normalise(operator: str) -> str:
    """Return the operator in the spelling of KerML."""
    word = operator.lower()
    return _SPELLING.get(word, word)


def _unquote(text: str) -> str:
    return re.sub(r"\\(.)", lambda match: _ESCAPE.get(match[1], match[1]), text[1:-1])
