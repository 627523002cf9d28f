"""Spaces between the tokens of a statement, and ranks of the places where a long one may break."""

from msgspec import Struct

from sysmlc.language.formatter.statements import Sort, Token

_NO_SPACE_BEFORE = {";", ",", ")", "]", ".", "::", "..", ".?", "->"}
_NO_SPACE_AFTER = {"(", "[", ".", "::", "..", ".?", "->", "$", "~"}
_TIGHT_OPERATORS = {"^", "**"}
_ARITHMETIC = {"+", "-", "*", "/", "%"}
_SIGNS = {"+", "-"}
_PREFIXES = {"@", "#", "~", "-", "+"}
_BEFORE_VALUE = {
    "=",
    ":=",
    "default",
    "if",
    "while",
    "until",
    "when",
    "at",
    "after",
    "filter",
    "assign",
}
"""Tokens that an expression follows."""
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
_RANKS_PER_LEVEL = 10


class Piece(Struct, frozen=True):
    """A token of a line: its text, the space before it, and the rank of a line break there.

    A lower ``rank`` is better. It is None where no break is allowed.
    """

    text: str
    space: str
    rank: int | None


class Spacing:
    """The spaces within one statement, token by token."""

    def __init__(self) -> None:
        self._before: Token | None = None
        self._is_sign = False
        self._open_brackets: list[str] = []
        self._has_value = False
        self._short_name_tokens = 0

    def add_token(self, token: Token) -> Piece:
        """Return the piece of the next token of the statement."""
        before = self._before
        space = " " if before is not None and self._is_spaced(before, token) else ""
        rank = self._rank_break(before, token, space) if before is not None else None
        self._update_state(token)
        return Piece(token.text, space, rank)

    def _update_state(self, token: Token) -> None:
        before = self._before
        self._is_sign = token.text in _PREFIXES and not (before is not None and before.is_operand)
        self._is_sign = self._is_sign or (token.text == "#" and self._is_prefix(before))
        if token.text in ("(", "[", "{"):
            self._open_brackets.append(token.text)
        elif token.text in (")", "]", "}") and self._open_brackets:
            self._open_brackets.pop()
        if token.text in _BEFORE_VALUE:
            self._has_value = True
        elif token.text in (";", "{"):
            self._has_value = False
        if self._short_name_tokens:
            self._short_name_tokens -= 1
        elif token.text == "<" and self._begins_short_name(before):
            self._short_name_tokens = 2
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
        return self._is_spaced_by_context(before, token)

    def _in_short_name(self, before: Token, token: Token) -> bool:
        """Whether the token is in ``<name>``: two tokens follow the bracket without a space."""
        return self._short_name_tokens > 0

    def _is_spaced_by_context(self, before: Token, token: Token) -> bool:
        if token.text == "(":
            return before.sort is not Sort.NAME and before.text not in (")", "]", "#")
        # `x[4]` is a multiplicity or an index, `5 [kg]` a quantity.
        if token.text == "[":
            return self._is_unit_bracket(before)
        if token.text == "#" and before.is_operand and self._has_operand_index(before):
            return False
        if before.text == "{" or token.text == "}":
            return False
        # `**` would be another token.
        if before.text == "*" and token.text == "*":
            return True
        is_tight = self._is_tight(token) or self._is_tight(before)
        return not is_tight or (before.sort in _WORD_SORTS and token.sort in _WORD_SORTS)

    def _has_operand_index(self, before: Token) -> bool:
        return before.sort is Sort.NAME or before.text in (")", "]")

    def _is_unit_bracket(self, before: Token) -> bool:
        """Whether a bracket has a unit: it has a space before it, a multiplicity has none."""
        if before.sort is Sort.NAME:
            return self._has_value
        return before.text not in ("]", "*", "**") or self._has_value

    def _is_tight(self, token: Token) -> bool:
        if token.text in _TIGHT_OPERATORS:
            return True
        is_in_brackets = bool(self._open_brackets) and self._open_brackets[-1] == "["
        return is_in_brackets and token.text in _ARITHMETIC

    def _rank_break(self, before: Token, token: Token, space: str) -> int | None:
        """Return the rank of a line break before the token; None if it is not allowed."""
        depth = len(self._open_brackets) * _RANKS_PER_LEVEL
        if token.text == "->":
            return depth + _ARROW
        if before.text == "(" and token.text != ")":
            return depth + _PARENTHESIS
        if not space or token.text == "{":
            return None
        return depth + (_COMMA if before.text == "," else self._rank_by_token(token))

    def _rank_by_token(self, token: Token) -> int:
        """Return the rank of a break before a token that has a space before it."""
        if token.text in ("=", ":="):
            return _PARENTHESIS
        if token.text in _CLAUSES:
            return _OPERATION if self._has_value and self._open_brackets else _FREE
        return _OPERATION if token.text in _OPERATORS else _SPACE


_WORD_SORTS = (Sort.KEYWORD, Sort.NAME, Sort.LITERAL)
