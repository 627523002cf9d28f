"""Reader of expressions and effects: grammars/expression.lark by recursive descent.

A word is a keyword only where the grammar has one: behind ``and``, ``if`` is a name. The tests
hold the reader against Lark's for the same grammar, which takes 0.1 s to get ready in every run.
"""

import re
from collections.abc import Callable
from typing import NoReturn

from sysmlc.logic.expressions.expression import (
    STRENGTH,
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
from sysmlc.patterns import pattern

_BLANK = re.compile(r"(?:\s|//[^\n]*|/\*[\s\S]*?\*/)*")
_IF, _ELSE, _SEND, _TO = (pattern(rf"{word}\b") for word in ("if", "else", "send", "to"))
_NAME = re.compile(r"[^\W\d]\w*|'(?:\\.|[^'\\\n])+'")
_LITERAL = re.compile(
    r"(?P<true>(?:true|TRUE)\b)|(?P<false>(?:false|FALSE)\b)"
    r"|(?P<real>\d+\.\d+(?:[eE][+-]?\d+)?|\d+[eE][+-]?\d+)|(?P<integer>\d+)"
    r'|(?P<string>"(?:\\.|[^"\\\n])*")'
)
_BEFORE = re.compile(r"!(?!=)|(?:not|NOT)\b|[+-]")
_BETWEEN = re.compile(
    r"implies\b|\|\|?|(?:or|OR|xor|XOR)\b|&&?|(?:and|AND)\b|==?|!=|<>|[<>]=?|[-+*/%]"
)
_BEHIND = re.compile(r"[.(\[#]")
_OPEN, _CLOSE, _END_OF_INDEX = re.compile(r"\("), re.compile(r"\)"), re.compile(r"[\])]")
_COMMA, _QUESTION, _SEMICOLON = re.compile(","), pattern(r"\?"), re.compile(";")
_COLONS, _BECOMES = re.compile("::"), re.compile(":=|=(?!=)")
_SPELLING = {"&&": "and", "&": "and", "||": "or", "|": "or", "!": "not", "=": "==", "<>": "!="}
_WEAKEST = min(STRENGTH.values())
_ESCAPE = {"n": "\n"}


def read_expression(text: str) -> Expression:
    """The expression that the text is. Raises ExpressionError and RecursionError."""
    reader = _Reader(text)
    found = reader.conditional()
    if reader.has_more():
        reader.fail()
    return found


def read_effect(text: str) -> tuple[Statement, ...]:
    """The statements of an effect. Raises ExpressionError and RecursionError."""
    reader, found = _Reader(text), []
    while reader.has_more():
        if reader.take(_SEMICOLON):
            continue
        found.append(reader.statement())
        if reader.has_more():
            reader.expect(_SEMICOLON)
    return tuple(map(_checked, found))


class _Reader:
    """The text, and how far it was read; nothing blank is ever next."""

    def __init__(self, text: str) -> None:
        self._text = text
        self._at = self._behind_blank(0)

    def has_more(self) -> bool:
        return self._at < len(self._text)

    def take(self, pattern: re.Pattern[str]) -> str:
        """What comes next if it is of the pattern, else nothing."""
        found = pattern.match(self._text, self._at)
        if found is None:
            return ""
        self._at = self._behind_blank(found.end())
        return found[0]

    def expect(self, pattern: re.Pattern[str]) -> str:
        """What comes next; it must be of the pattern."""
        return self.take(pattern) or self.fail()

    def fail(self) -> NoReturn:
        """Say that what comes next is wrong."""
        rest = self._text[self._at :].split()
        told = f"'{rest[0][:20]}' is not expected here" if rest else "the text ends too early"
        raise ExpressionError(told, self._at)

    def _behind_blank(self, at: int) -> int:
        blank = _BLANK.match(self._text, at)
        return at if blank is None else blank.end()

    # -- statements ----------------------------------------------------------------------------

    def statement(self) -> Statement:
        start = self._at
        if self.take(_SEND):
            return self._send(start)
        target = self._postfix()
        if self.take(_BECOMES):
            return Assignment(target, self.conditional(), start)
        return Invocation(target, start)

    def _send(self, start: int) -> Statement:
        signal = self._qualified()
        args = self._arguments() if self.take(_OPEN) else ()
        receiver = self._postfix() if self.take(_TO) else None
        return Send(signal, args, receiver, start)

    # -- expressions ---------------------------------------------------------------------------

    def conditional(self) -> Expression:
        start = self._at
        if not self.take(_IF):
            return self._binary(_WEAKEST)
        condition = self._binary(_WEAKEST)
        self.expect(_QUESTION)
        then = self.conditional()
        self.expect(_ELSE)
        return Conditional(condition, then, self.conditional(), start)

    def _binary(self, strength: int) -> Expression:
        """Operands between operators that bind at least so strongly."""
        start = self._at
        left = self._unary()
        while op := self._operator(strength):
            # Only "implies" is read from the right.
            right = self._binary(STRENGTH[op] + (op != "implies"))
            left = Binary(op, left, right, start)
        return left

    def _operator(self, strength: int) -> str:
        found = _BETWEEN.match(self._text, self._at)
        op = _spelling(found[0]) if found else ""
        if found is None or STRENGTH[op] < strength:
            return ""
        self._at = self._behind_blank(found.end())
        return op

    def _unary(self) -> Expression:
        start = self._at
        op = self.take(_BEFORE)
        return Unary(_spelling(op), self._unary(), start) if op else self._postfix()

    def _postfix(self) -> Expression:
        start = self._at
        found = self._primary()
        while sign := self.take(_BEHIND):
            if sign == ".":
                found = Member(found, self._name(), start)
            elif sign == "(":
                found = Call(found, self._arguments(), start)
            else:
                found = Index(found, self._index(sign), start)
        return found

    def _arguments(self) -> tuple[Expression, ...]:
        """What stands behind an opening parenthesis, up to the closing one."""
        if self.take(_CLOSE):
            return ()
        found = [self.conditional()]
        while self.take(_COMMA):
            found.append(self.conditional())
        self.expect(_CLOSE)
        return tuple(found)

    def _index(self, sign: str) -> Expression:
        if sign == "#":
            self.expect(_OPEN)
        found = self.conditional()
        self.expect(_END_OF_INDEX)
        return found

    def _primary(self) -> Expression:
        if self.take(_OPEN):
            inner = self.conditional()
            self.expect(_CLOSE)
            return inner
        found = _LITERAL.match(self._text, self._at)
        if found is None:
            return self._qualified()
        start, self._at = self._at, self._behind_blank(found.end())
        try:
            return Literal(_VALUES[str(found.lastgroup)](found[0]), start)
        except ValueError:
            raise ExpressionError("the number has too many digits", start) from None

    def _qualified(self) -> Name:
        start = self._at
        path = [self._name()]
        while self.take(_COLONS):
            path.append(self._name())
        return Name(tuple(path), start)

    def _name(self) -> str:
        name = self.expect(_NAME)
        return _unquoted(name) if name[0] == "'" else name


def _spelling(word: str) -> str:
    return _SPELLING.get(word, word.lower())


def _checked(statement: Statement) -> Statement:
    """The statement, if it does something: grammatical are also ``3`` and ``3 := x``."""
    match statement:
        case Assignment(Name() | Member() | Index()) | Invocation(Name() | Member() | Call()):
            return statement
        case Assignment():
            raise ExpressionError("only a feature can be assigned to", statement.offset)
        case Invocation():
            raise ExpressionError("this is a value and does nothing", statement.offset)
        case _:
            return statement


def _unquoted(text: str) -> str:
    return re.sub(r"\\(.)", lambda found: _ESCAPE.get(found[1], found[1]), text[1:-1])


_VALUES: dict[str, Callable[[str], bool | int | float | str]] = {
    "true": lambda _: True,
    "false": lambda _: False,
    "integer": int,
    "real": float,
    "string": _unquoted,
}
