"""Syntax of infix formula languages: operator tables, tokens, and a cursor over the tokens.

``infix`` parses formulas with these tables. Each format of ``logic.formats`` defines a ``Syntax``.
"""

import re
from collections.abc import Mapping
from typing import NamedTuple, NoReturn

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.logic.formula import Op

PRECEDENCE = {
    Op.IFF: 1,
    Op.IMPLIES: 2,
    Op.OR: 3,
    Op.AND: 4,
    **dict.fromkeys((Op.UNTIL, Op.RELEASE, Op.WEAK_UNTIL, Op.SINCE), 5),
    **dict.fromkeys((Op.NOT, Op.NEXT, Op.ALWAYS, Op.EVENTUALLY), 6),
    **dict.fromkeys((Op.PREVIOUS, Op.ONCE, Op.HISTORICALLY), 6),
    **dict.fromkeys((Op.EQ, Op.NE, Op.LT, Op.LE, Op.GT, Op.GE), 7),
    **dict.fromkeys((Op.ADD, Op.SUB), 8),
    **dict.fromkeys((Op.MUL, Op.DIV, Op.MOD), 9),
}
"""Precedence of the operators in the neutral form; a higher number binds more strongly."""
RIGHT_ASSOCIATIVE = frozenset([Op.IMPLIES, Op.UNTIL, Op.RELEASE, Op.WEAK_UNTIL])

COMPARISONS = frozenset([Op.EQ, Op.NE, Op.LT, Op.LE, Op.GT, Op.GE])
ORDERINGS = COMPARISONS - {Op.EQ, Op.NE}
ARITHMETIC = frozenset([Op.ADD, Op.SUB, Op.MUL, Op.DIV, Op.MOD])

TEMPORAL_WORDS = {"G": Op.ALWAYS, "F": Op.EVENTUALLY, "X": Op.NEXT}
TEMPORAL_SIGNS = {"[]": Op.ALWAYS, "<>": Op.EVENTUALLY}
UNTIL_WORDS = {"U": Op.UNTIL, "R": Op.RELEASE, "V": Op.RELEASE, "W": Op.WEAK_UNTIL}
PAST_WORDS = {"Y": Op.PREVIOUS, "O": Op.ONCE, "H": Op.HISTORICALLY}
CONNECTIVE_SIGNS = {
    "<->": Op.IFF,
    "->": Op.IMPLIES,
    "|": Op.OR,
    "||": Op.OR,
    "&": Op.AND,
    "&&": Op.AND,
}
CONNECTIVE_WORDS = {"and": Op.AND, "or": Op.OR, "implies": Op.IMPLIES, "iff": Op.IFF}
CONNECTIVE_SPELLINGS = {"=>": Op.IMPLIES, "<=>": Op.IFF, "→": Op.IMPLIES, "↔": Op.IFF}
CONNECTIVE_SPELLINGS |= {"∧": Op.AND, "/\\": Op.AND, "∨": Op.OR, "\\/": Op.OR}
CONNECTIVE_SPELLINGS |= {"≠": Op.NE, "≤": Op.LE, "≥": Op.GE}
"""Signs for operators that authors take from other languages and from textbooks."""
NEGATION_SPELLINGS = {"not": Op.NOT, "~": Op.NOT, "¬": Op.NOT}
COMPARISON_SIGNS = {"=": Op.EQ, "==": Op.EQ, "!=": Op.NE} | {str(op): op for op in ORDERINGS}
ARITHMETIC_SIGNS = {str(op): op for op in ARITHMETIC}
BOOLEANS = {"true": True, "false": False, "TRUE": True, "FALSE": False}

_MAX_DIGITS = 18
"""Most digits of a number, so that it fits into 64 bits."""


class FormulaError(ValueError):
    """Text that is not a formula over the variables; ``offset`` counts its characters from 0."""

    def __init__(self, reason: str, offset: int = 0) -> None:
        super().__init__(reason)
        self.offset = offset


class UnknownNameError(FormulaError):
    """A name that denotes nothing; ``has_advice`` tells whether the message has a similar name."""

    def __init__(self, name: str, similar: str, offset: int) -> None:
        advice = f"; did you mean '{similar}'?" if similar else ""
        super().__init__(f"'{name}' is neither a variable nor a literal{advice}", offset)
        self.name = name
        self.has_advice = bool(similar)


class Token(NamedTuple):
    """A token of kind name, number, string, sign or unknown; the last of a text is an ``end``."""

    kind: str
    text: str
    offset: int


class Syntax(Struct, frozen=True):
    """Operators, constants, brackets and tokens of a formula language."""

    prefix: Mapping[str, Op]
    infix: Mapping[str, Op]
    booleans: Mapping[str, bool]
    brackets: Mapping[str, str]
    """Opening brackets, each with its closing bracket."""
    precedence: Mapping[Op, int]
    signs: tuple[str, ...] = ()
    """Further signs, which statements of the language use."""
    # Regular expressions of the tokens. The default of `comment` matches nothing.
    comment: str = r"(?!)"
    name: str = r"[^\W\d]\w*"
    string: str = r'"(?:[^"\\\n]|\\.)*"'
    right_associative: frozenset[Op] = RIGHT_ASSOCIATIVE
    ignores_case: bool = False
    """Whether operators of two letters or more, and constants, may be in any letter case."""

    def find_prefix(self, token: Token) -> Op | None:
        """Return the prefix operator that a token is, or None."""
        return self.prefix.get(self._spell(token)) if token.kind in ("sign", "name") else None

    def find_infix(self, token: Token) -> Op | None:
        """Return the infix operator that a token is, or None."""
        return self.infix.get(self._spell(token)) if token.kind in ("sign", "name") else None

    def find_boolean(self, token: Token) -> bool | None:
        """Return the Boolean constant that a token is, or None."""
        return self.booleans.get(self._spell(token))

    def _spell(self, token: Token) -> str:
        """Return the text of a token as the tables spell it; ``g`` and ``G`` remain different."""
        is_folded = self.ignores_case and len(token.text) > 1
        return token.text.lower() if is_folded else token.text


NEUTRAL = Syntax(
    {"!": Op.NOT, **TEMPORAL_WORDS, **TEMPORAL_SIGNS},
    {**CONNECTIVE_SIGNS, **UNTIL_WORDS, **COMPARISON_SIGNS, **ARITHMETIC_SIGNS},
    BOOLEANS,
    {"(": ")", "{": "}"},
    PRECEDENCE,
)
"""The neutral form of corpus/gr1, which ``printing`` writes, extended by the operators of LTL and
by their spelling in SPIN.
"""


AUTHOR_SYNTAX = replace(
    NEUTRAL,
    prefix={**NEUTRAL.prefix, **NEGATION_SPELLINGS},
    infix={**NEUTRAL.infix, **CONNECTIVE_WORDS, **CONNECTIVE_SPELLINGS},
    ignores_case=True,
)
"""The neutral form as authors write it in models, with words and other spellings of operators."""


def tokenize(text: str, syntax: Syntax) -> list[Token]:
    """Split *text* into tokens; white space and comments are dropped, an ``end`` is appended."""
    tokens = [
        Token(match.lastgroup, match.group(), match.start())
        for match in _compile_tokens(syntax).finditer(text)
        if match.lastgroup
    ]
    return [*tokens, Token("end", "", len(text.rstrip()))]


_patterns: dict[int, tuple[Syntax, re.Pattern[str]]] = {}
# The keys are identities, since a syntax holds dictionaries and so has no hash. The entry holds
# its syntax, so that the identity cannot be reused.


def _compile_tokens(syntax: Syntax) -> re.Pattern[str]:
    """Return the regular expression whose groups are the kinds of tokens."""
    if id(syntax) not in _patterns:
        signs = "|".join(map(re.escape, _list_signs(syntax)))
        pattern = (
            rf"\s+|{syntax.comment}|(?P<name>{syntax.name})|(?P<number>\d+)"
            rf"|(?P<string>{syntax.string})|(?P<sign>{signs})|(?P<unknown>.)"
        )
        _patterns[id(syntax)] = (syntax, re.compile(pattern))
    return _patterns[id(syntax)][1]


def _list_signs(syntax: Syntax) -> list[str]:
    """Return the operators and brackets that are not words, longest first."""
    words = {*syntax.prefix, *syntax.infix, *syntax.signs, *syntax.brackets, "'"}
    words |= set(syntax.brackets.values())
    signs = {word for word in words if not word[0].isalpha()}
    # The first alternative of a regular expression wins: "<->" must stand before "<".
    return sorted(signs, key=lambda sign: (-len(sign), sign))


class Cursor:
    """A position in a list of tokens; ``next`` is the first token that is not yet consumed."""

    __slots__ = ("_index", "_tokens", "next")

    def __init__(self, tokens: list[Token]) -> None:
        self._tokens = tokens
        self.reset(0)

    @property
    def after_next(self) -> Token:
        """The token that follows ``next``."""
        return self._tokens[min(self._index + 1, len(self._tokens) - 1)]

    @property
    def is_at_end(self) -> bool:
        """Whether all tokens before the ``end`` are consumed."""
        return self.next.kind == "end"

    def mark(self) -> int:
        """Return the position, for ``reset``."""
        return self._index

    def reset(self, mark: int) -> None:
        """Move to a position that ``mark`` returned."""
        self._index = mark
        self.next = self._tokens[mark]

    def list_names(self, mark: int, end: str) -> list[str]:
        """Return the names between a position that ``mark`` returned and the next *end*."""
        names: list[str] = []
        while self._tokens[mark].text != end and self._tokens[mark].kind != "end":
            if self._tokens[mark].kind == "name":
                names.append(self._tokens[mark].text)
            mark += 1
        return names

    def is_next(self, *texts: str) -> bool:
        """Whether the next token is one of the texts."""
        return self.next.text in texts and self.next.kind not in ("string", "end")

    def take(self) -> Token:
        """Consume and return the next token; the ``end`` is never consumed."""
        token = self.next
        if token.kind != "end":
            self._index += 1
            self.next = self._tokens[self._index]
        return token

    def accept(self, *texts: str) -> bool:
        """Consume the next token if it is one of the texts; return whether it is."""
        return self.is_next(*texts) and bool(self.take())

    def expect(self, *texts: str) -> Token:
        """Consume the next token, which must be one of the texts. Raises FormulaError."""
        if not self.is_next(*texts):
            self.fail(f"{' or '.join(map(repr, texts))} is expected")
        return self.take()

    def expect_kind(self, kind: str, description: str) -> Token:
        """Consume the next token, which must have the kind. Raises FormulaError.

        *description* is the kind in the words of the message.
        """
        if self.next.kind != kind:
            self.fail(f"{description} is expected")
        return self.take()

    def expect_end(self) -> None:
        """Raise FormulaError unless all tokens are consumed."""
        if not self.is_at_end:
            self.fail()

    def read_integer(self) -> int:
        """Consume a number with an optional minus sign. Raises FormulaError."""
        is_negative = self.accept("-")
        token = self.expect_kind("number", "a number")
        if len(token.text) > _MAX_DIGITS:
            raise FormulaError(f"a number has at most {_MAX_DIGITS} digits", token.offset)
        return -int(token.text) if is_negative else int(token.text)

    def skip_to(self, *texts: str) -> None:
        """Consume the tokens before the next one of the texts, or all tokens."""
        while not self.is_at_end and not self.is_next(*texts):
            self.take()

    def skip_past(self, *texts: str) -> None:
        """Consume the tokens up to and including the next one of the texts, or all tokens."""
        while not self.is_at_end and not self.accept(*texts):
            self.take()

    def fail(self, wanted: str = "") -> NoReturn:
        """Raise FormulaError about the next token; *wanted* is the first part of the message."""
        token = self.next
        actual = "the end" if token.kind == "end" else f"'{token.text}'"
        reason = f"{wanted}, not {actual}" if wanted else f"{actual} is not expected here"
        raise FormulaError(reason, token.offset)


def line_and_column(text: str, offset: int) -> tuple[int, int]:
    """Return line and column of a character, both counted from 1."""
    before = text[:offset]
    return before.count("\n") + 1, offset - (before.rfind("\n") + 1) + 1
