"""Where a space stands between two tokens of a statement, and where a long one may be broken."""

from msgspec import Struct

from sysmlc.language.formatter.statements import Sort, Token

_NO_SPACE_BEFORE = {";", ",", ")", "]", ".", "::", "..", ".?", "->"}
_NO_SPACE_AFTER = {"(", "[", ".", "::", "..", ".?", "->", "$", "~"}
_TIGHT = {"^", "**"}
_ARITHMETIC = {"+", "-", "*", "/", "%"}
_SIGNS = {"+", "-"}
_PREFIXES = {"@", "#", "~", "-", "+"}
_VALUES = {"=", ":=", "default", "if", "while", "until", "when", "at", "after", "filter", "assign"}
"""Tokens after which a declaration has an expression."""
_OPERATORS = (
    {"and", "or", "xor", "implies", "??", "==", "!=", "===", "!==", "<", ">", "<=", ">="}
    | {"|", "&", "?", "else"}
    | _ARITHMETIC
)
_CLAUSE_WORDS = (
    "specializes subsets redefines references crosses conjugates chains unions intersects"
    " differences disjoint inverse featured typed defined connect to from of by via accept do"
    " then first about default allocate bind for :> :>> ::> =>"
)
_CLAUSES = _CLAUSE_WORDS.split()
_FREE, _COMMA, _OPERATION, _ARROW, _PARENTHESIS, _SPACE = range(6)
_DEEPER = 10


class Piece(Struct, frozen=True):
    """A token of a line: what is between it and the one before, how well a line breaks there.

    ``rank`` is lower where a break is better; None where none may be.
    """

    text: str
    space: str
    rank: int | None


class Spacing:
    """Spaces within one statement, token after token."""

    def __init__(self) -> None:
        self._before: Token | None = None
        self._is_sign = False
        self._open: list[str] = []
        self._has_value = False
        self._short_name = 0

    def piece(self, token: Token) -> Piece:
        """The next token of the statement."""
        before = self._before
        space = " " if before is not None and self._is_spaced(before, token) else ""
        rank = self._rank(before, token, space) if before is not None else None
        self._enter(token)
        return Piece(token.text, space, rank)

    def _enter(self, token: Token) -> None:
        before = self._before
        self._is_sign = token.text in _PREFIXES and not (before is not None and before.is_operand)
        self._is_sign = self._is_sign or (token.text == "#" and self._is_prefix(before))
        if token.text in ("(", "[", "{"):
            self._open.append(token.text)
        elif token.text in (")", "]", "}") and self._open:
            self._open.pop()
        if token.text in _VALUES:
            self._has_value = True
        elif token.text in (";", "{"):
            self._has_value = False
        if self._short_name:
            self._short_name -= 1
        elif token.text == "<" and self._begins_short_name(before):
            self._short_name = 2
        self._before = token

    def _is_prefix(self, before: Token | None) -> bool:
        return before is None or not before.is_operand

    def _begins_short_name(self, before: Token | None) -> bool:
        return before is None or not before.is_operand

    def _is_spaced(self, before: Token, token: Token) -> bool:
        if self._is_sign or self._in_short_name(before, token):
            return False
        if token.text in _NO_SPACE_BEFORE:
            return token.text in ("->", "..") and before.text == ","
        if before.text in _NO_SPACE_AFTER:
            return before.text == "~" and before.sort is Sort.KEYWORD
        return self._is_spaced_here(before, token)

    def _in_short_name(self, before: Token, token: Token) -> bool:
        """Within ``<name>``: two tokens follow the opening bracket without a space."""
        return self._short_name > 0

    def _is_spaced_here(self, before: Token, token: Token) -> bool:
        if token.text == "(":
            return before.sort is not Sort.NAME and before.text not in (")", "]", "#")
        if token.text == "[":
            return self._is_quantity(before)
        if token.text == "#" and before.is_operand and self._has_operand_index(before):
            return False
        if before.text == "{" or token.text == "}":
            return False
        if before.text == "*" and token.text == "*":
            return True
        is_tight = self._is_tight(token) or self._is_tight(before)
        return not is_tight or (before.sort in _WORDS and token.sort in _WORDS)

    def _has_operand_index(self, before: Token) -> bool:
        return before.sort is Sort.NAME or before.text in (")", "]")

    def _is_quantity(self, before: Token) -> bool:
        """A unit has a space before its bracket, a multiplicity after a name has none."""
        if before.sort is Sort.NAME:
            return self._has_value
        return before.text not in ("]", "*", "**") or self._has_value

    def _is_tight(self, token: Token) -> bool:
        if token.text in _TIGHT:
            return True
        in_brackets = bool(self._open) and self._open[-1] == "["
        return in_brackets and token.text in _ARITHMETIC

    def _rank(self, before: Token, token: Token, space: str) -> int | None:
        """How well a line may be broken before the token; None where it may not."""
        depth = len(self._open) * _DEEPER
        if token.text == "->":
            return depth + _ARROW
        if before.text == "(" and token.text != ")":
            return depth + _PARENTHESIS
        if not space or token.text == "{":
            return None
        return depth + (_COMMA if before.text == "," else self._goodness(token))

    def _goodness(self, token: Token) -> int:
        """How well a line may be broken before a token that has a space before it."""
        if token.text in ("=", ":="):
            return _PARENTHESIS
        if token.text in _CLAUSES:
            return _OPERATION if self._has_value and self._open else _FREE
        return _OPERATION if token.text in _OPERATORS else _SPACE


_WORDS = (Sort.KEYWORD, Sort.NAME, Sort.LITERAL)
