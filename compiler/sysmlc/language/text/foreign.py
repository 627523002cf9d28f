"""What may help where a symbol or word of another language stands."""

from collections.abc import Callable, Collection

from sysmlc.language.text.scan import Tokens
from sysmlc.support.suggestions import did_you_mean

_SHORTEST = 5
"""Letters of a word that may be a keyword with a slip in it; shorter ones are names."""
_TWICE = {"&": "'and'", "|": "'or'"}
_ARROWS = ("-", "->", "=>", "~", ",")


def foreign(tokens: Tokens, at: int, expected: Collection[str]) -> str:
    """What may help with token ``at``, in place of which ``expected`` may stand; or nothing."""
    said = (about(tokens, at, expected) for about in _ABOUT)
    return next((words for words in said if words), "")


def direction(tokens: Tokens, before: int, at: int, beginnings: Collection[str]) -> str:
    """A direction behind the kind of a feature: ``port in p``."""
    word, kind = tokens[at], tokens[before]
    if word not in ("in", "out", "inout") or kind not in beginnings or not kind.isalpha():
        return ""
    return f"the direction stands before the kind: {word} {kind} ..."


def _joined(tokens: Tokens, at: int, _expected: Collection[str]) -> str:
    """``&&`` and ``||``, which are two operators each."""
    symbol = tokens[at]
    is_twice = at > 0 and tokens[at - 1] == symbol and symbol in _TWICE
    return f"conditions are joined by {_TWICE[symbol]}" if is_twice else ""


def _compared(tokens: Tokens, at: int, expected: Collection[str]) -> str:
    is_binding = tokens[at] == "=" and "==" in expected and "=" not in expected
    return "'==' compares two values, '=' binds one" if is_binding else ""


def _asked(tokens: Tokens, at: int, expected: Collection[str]) -> str:
    is_question = tokens[at] == "?" and "?" not in expected
    return "an expression that chooses begins with 'if': if a ? b else c" if is_question else ""


def _ended(tokens: Tokens, at: int, expected: Collection[str]) -> str:
    """A `;` behind the expression that is the result of a body."""
    is_result = tokens[at] == ";" and list(expected) == ["}"]
    return "the result is an expression without ';' at the end of the body" if is_result else ""


def _documented(tokens: Tokens, at: int, expected: Collection[str]) -> str:
    is_text = tokens[at].startswith('"') and "BODY" in expected
    return "what is said stands between /* and */" if is_text else ""


def _linked(tokens: Tokens, at: int, expected: Collection[str]) -> str:
    is_arrow = tokens[at] in _ARROWS and "to" in expected
    return "ends are joined by 'to': a to b" if is_arrow else ""


def _misspelt(tokens: Tokens, at: int, expected: Collection[str]) -> str:
    word = tokens[at]
    if len(word) < _SHORTEST or not word.isalpha():
        return ""
    said = did_you_mean(word, [known for known in expected if len(known) >= _SHORTEST])
    return said if said.startswith("did") and word not in said else ""


_ABOUT: tuple[Callable[[Tokens, int, Collection[str]], str], ...] = (
    _joined,
    _compared,
    _asked,
    _ended,
    _documented,
    _linked,
    _misspelt,
)
