"""How languages spell formulas: their operators, and texts in tokens."""

import re
from collections.abc import Mapping
from typing import NamedTuple, NoReturn

from msgspec import Struct

from sysmlc.logic.formula import Op

STRENGTH = {
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
"""How strongly operators bind in the neutral form, from weak to strong."""
FROM_THE_RIGHT = frozenset([Op.IMPLIES, Op.UNTIL, Op.RELEASE, Op.WEAK_UNTIL])
COMPARISONS = frozenset([Op.EQ, Op.NE, Op.LT, Op.LE, Op.GT, Op.GE])
ORDERS = COMPARISONS - {Op.EQ, Op.NE}
ARITHMETIC = frozenset([Op.ADD, Op.SUB, Op.MUL, Op.DIV, Op.MOD])
TEMPORAL = frozenset([Op.NEXT, Op.ALWAYS, Op.EVENTUALLY, Op.UNTIL, Op.RELEASE, Op.WEAK_UNTIL])
_DIGITS = 18
PAST = frozenset([Op.PREVIOUS, Op.ONCE, Op.HISTORICALLY, Op.SINCE])
TRUTHS = {"true": True, "false": False, "TRUE": True, "FALSE": False}


class FormulaError(ValueError):
    """Text that is no formula over the variables; ``at`` counts characters of it from 0."""

    def __init__(self, reason: str, at: int = 0) -> None:
        super().__init__(reason)
        self.at = at


class Token(NamedTuple):
    """One word, number, string or sign of a text; the last one of a text has kind ``end``."""

    kind: str
    text: str
    at: int


class Syntax(Struct, frozen=True):
    """How a language spells formulas: operators, truths, brackets, comments."""

    prefix: Mapping[str, Op]
    infix: Mapping[str, Op]
    truths: Mapping[str, bool]
    brackets: Mapping[str, str]
    strength: Mapping[Op, int]
    signs: tuple[str, ...] = ()
    """Further signs that tokens of the language are made of."""
    comment: str = r"(?!)"
    name: str = r"[^\W\d]\w*"
    string: str = r'"(?:[^"\\\n]|\\.)*"'
    from_the_right: frozenset[Op] = FROM_THE_RIGHT


TEMPORAL_WORDS = {"G": Op.ALWAYS, "F": Op.EVENTUALLY, "X": Op.NEXT}
TEMPORAL_SIGNS = {"[]": Op.ALWAYS, "<>": Op.EVENTUALLY}
UNTIL_WORDS = {"U": Op.UNTIL, "R": Op.RELEASE, "V": Op.RELEASE, "W": Op.WEAK_UNTIL}
PAST_WORDS = {"Y": Op.PREVIOUS, "O": Op.ONCE, "H": Op.HISTORICALLY}
CONNECTIVES = {
    "<->": Op.IFF,
    "->": Op.IMPLIES,
    "|": Op.OR,
    "||": Op.OR,
    "&": Op.AND,
    "&&": Op.AND,
}
COMPARING = {"=": Op.EQ, "==": Op.EQ, "!=": Op.NE} | {str(op): op for op in ORDERS}
COUNTING = {str(op): op for op in ARITHMETIC}
NEUTRAL = Syntax(
    {"!": Op.NOT, **TEMPORAL_WORDS, **TEMPORAL_SIGNS},
    {**CONNECTIVES, **UNTIL_WORDS, **COMPARING, **COUNTING},
    TRUTHS,
    {"(": ")", "{": "}"},
    STRENGTH,
)
"""The form of corpus/gr1, which ``printing`` writes, with LTL's operators and SPIN's spelling."""


def tokens(text: str, syntax: Syntax) -> list[Token]:
    """The text in tokens, with one of kind ``end`` behind them."""
    found = [
        Token(match.lastgroup, match.group(), match.start())
        for match in _pattern(syntax).finditer(text)
        if match.lastgroup
    ]
    return [*found, Token("end", "", len(text.rstrip()))]


_patterns: dict[int, tuple[Syntax, re.Pattern[str]]] = {}
"""By the identity of syntaxes, which are few and made once."""


def _pattern(syntax: Syntax) -> re.Pattern[str]:
    if id(syntax) not in _patterns:
        signs = "|".join(map(re.escape, _signs(syntax)))
        text = (
            rf"\s+|{syntax.comment}|(?P<name>{syntax.name})|(?P<number>\d+)"
            rf"|(?P<string>{syntax.string})|(?P<sign>{signs})|(?P<unknown>.)"
        )
        _patterns[id(syntax)] = (syntax, re.compile(text))
    return _patterns[id(syntax)][1]


def _signs(syntax: Syntax) -> list[str]:
    spelt = {*syntax.prefix, *syntax.infix, *syntax.signs, *syntax.brackets, "'"}
    signs = {one for one in spelt | set(syntax.brackets.values()) if not one[0].isalpha()}
    return sorted(signs, key=lambda sign: (-len(sign), sign))


class Cursor:
    """Tokens of a text that are taken one after the other.

    ``next`` is the token that comes next; at the end that of kind ``end``.
    """

    __slots__ = ("_index", "_tokens", "next")

    def __init__(self, found: list[Token]) -> None:
        self._tokens = found
        self.back_to(0)

    @property
    def after_next(self) -> Token:
        """The token behind the next one."""
        return self._tokens[min(self._index + 1, len(self._tokens) - 1)]

    def mark(self) -> int:
        """Where the cursor stands, for ``back_to``."""
        return self._index

    def back_to(self, mark: int) -> None:
        """Go back to where the cursor stood, or on to where it will stand."""
        self._index = mark
        self.next = self._tokens[mark]

    def has(self, *texts: str) -> bool:
        """Whether one of the texts comes next."""
        return self.next.text in texts and self.next.kind not in ("string", "end")

    def take(self) -> Token:
        """The next token, which is read by that."""
        token = self.next
        if token.kind != "end":
            self._index += 1
            self.next = self._tokens[self._index]
        return token

    def took(self, *texts: str) -> bool:
        """Whether one of the texts came next; then it is read."""
        return self.has(*texts) and bool(self.take())

    def expect(self, *texts: str) -> Token:
        """The next token, which must be one of the texts. Raises FormulaError."""
        if not self.has(*texts):
            self.fail(f"{' or '.join(map(repr, texts))} is expected")
        return self.take()

    def expect_kind(self, kind: str, what: str) -> Token:
        """The next token, which must be of a kind, told as ``what``. Raises FormulaError."""
        if self.next.kind != kind:
            self.fail(f"{what} is expected")
        return self.take()

    def integer(self) -> int:
        """The number that comes next, with its sign. Raises FormulaError."""
        is_negative = self.took("-")
        token = self.expect_kind("number", "a number")
        if len(token.text) > _DIGITS:
            raise FormulaError(f"a number has at most {_DIGITS} digits", token.at)
        return -int(token.text) if is_negative else int(token.text)

    def skip_to(self, *texts: str) -> None:
        """Go on to the next of the texts, or to the end."""
        while self.next.kind != "end" and not self.has(*texts):
            self.take()

    def skip_behind(self, *texts: str) -> None:
        """Go on behind the next of the texts, or to the end."""
        while self.next.kind != "end" and not self.took(*texts):
            self.take()

    def fail(self, wanted: str = "") -> NoReturn:
        """Raise FormulaError about the next token."""
        token = self.next
        found = "the end" if token.kind == "end" else f"'{token.text}'"
        reason = f"{wanted}, not {found}" if wanted else f"{found} is not expected here"
        raise FormulaError(reason, token.at)


def line_and_column(text: str, at: int) -> tuple[int, int]:
    """Line and column of a character, both counted from 1."""
    before = text[:at]
    return before.count("\n") + 1, at - (before.rfind("\n") + 1) + 1
