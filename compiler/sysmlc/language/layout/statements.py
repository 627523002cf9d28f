"""Tokens grouped into statements and bodies: what stands on lines of its own."""

from collections.abc import Sequence
from dataclasses import dataclass, field

from sysmlc.language.layout.tokens import Sort, Token

_BEFORE_EXPRESSION = (
    ". .? = := ( , ? ?? == != === !== < > <= >= + - * / % ^ ** & | default and or xor implies not"
)
"""Tokens after which a brace begins an expression, not a body."""
_AFTER_BODY = {"else", "until"}


@dataclass(slots=True)
class Block:
    """What stands between braces, with them; ``is_expression`` for a body expression."""

    opening: Token
    is_expression: bool
    statements: "list[Statement]" = field(default_factory=list)
    closing: Token = field(default_factory=lambda: Token("}", Sort.SYMBOL))


Statement = list[Token | Block]
"""A member, a result expression, or what begins and ends with an entry of a body."""


def statements(found: Sequence[Token]) -> tuple[list[Statement], Token]:
    """The statements of a text, and its end with the notes before it."""
    reader = _Reader(found)
    made = reader.body()
    return made, found[reader.at]


class _Reader:
    def __init__(self, found: Sequence[Token]) -> None:
        self._found = found
        self.at = 0

    def body(self) -> list[Statement]:
        """Statements up to a closing brace or the end."""
        made: list[Statement] = []
        while not self._is_closed():
            made.append(self._statement())
        return made

    def _is_closed(self) -> bool:
        token = self._found[self.at]
        return token.sort is Sort.END or token.text == "}"

    def _statement(self) -> Statement:
        made: Statement = []
        while not self._is_closed():
            token = self._found[self.at]
            if token.text == "{":
                block = self._block(made)
                made.append(block)
                if not (block.is_expression or self._goes_on(made)):
                    break
                continue
            made.append(token)
            self.at += 1
            if token.text == ";" or token.sort is Sort.COMMENT:
                break
        return made

    def _block(self, before: Statement) -> Block:
        opening = self._found[self.at]
        self.at += 1
        made = Block(opening, _begins_expression(before), self.body())
        made.closing = self._found[self.at]
        if made.closing.sort is not Sort.END:
            self.at += 1
        return made

    def _goes_on(self, made: Statement) -> bool:
        """Whether a statement goes on after a body: else, until, the target of a transition."""
        following = self._found[self.at].text
        words = [item.text for item in made[1:] if isinstance(item, Token)]
        starts = isinstance(made[0], Token) and made[0].text == "transition"
        return following in _AFTER_BODY or (following == "then" and (starts or "do" in words))


def _begins_expression(before: Statement) -> bool:
    """Whether a brace after these tokens begins a body expression (KerML 8.2.5.8.3)."""
    if not before or isinstance(before[-1], Block):
        return False
    if before[-1].text in _BEFORE_EXPRESSION.split():
        return True
    texts = [item.text if isinstance(item, Token) else "{}" for item in before]
    if texts[-1] == "else":
        return "?" in texts
    at = len(texts) - 1
    while at > 1 and texts[at - 1] == "::":
        at -= 2
    return at > 0 and texts[at - 1] == "->"
