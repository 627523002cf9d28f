"""Corrections of members with a slip, so that the parser reads what is meant.

A correction makes one finding of a slip, at the token to change: the rest of the member is read,
and names that it declares are known.
"""

from collections.abc import Iterator
from typing import NamedTuple

from sysmlc.language.text import hints
from sysmlc.language.text.lexer import Tokens
from sysmlc.language.text.spelling import RESERVED

_CONDITION_HEADS = frozenset({"constraint", "assert", "assume", "require"})
_ORDER_HEADS = frozenset({"first", "succession", "transition"})
_PAIR_HEADS = frozenset({"connect", "connection", "flow", "interface", "message"})
_SUBACTIONS = frozenset({"entry", "do", "exit"})
_VISIBILITIES = frozenset({"private", "protected", "public"})
_PREFIXES = _VISIBILITIES | hints.DIRECTIONS | {"abstract", "derived", "constant", "ref", "end"}
_FIRST_STATE = "the first state follows the entry action: entry; then a;"
_MAX_HEAD = 200
"""Tokens before a member in which the head of its body is searched for."""


class Correction(NamedTuple):
    """Tokens of a member that the parser reads as others: ``length`` of them from ``position``.

    ``words`` are the keywords and symbols in their place. ``expected`` is what the message says
    to be expected there.
    """

    position: int
    length: int
    words: tuple[str, ...]
    expected: str
    advice: str


def list_corrections(tokens: Tokens, start: int, index: int) -> Iterator[Correction]:
    """Yield the corrections that may mend a member that begins at ``start`` and fails at ``index``.

    The parser applies the first with which it accepts the member up to ``index``.
    """
    member = [tokens[position] for position in range(start, index + 1)]
    yield from _correct_first_tokens(tokens, member, start, index)
    is_condition = not _CONDITION_HEADS.isdisjoint(_read_body_head(tokens, start))
    for position, symbol in enumerate(member, start):
        if is_condition and symbol == "=":
            yield _replace_by("==", position, hints.COMPARISON)
        elif is_condition and symbol in ("=>", "->"):
            yield _replace_by("implies", position, "an implication is written: a implies b")
        elif symbol in ("::", ":"):
            yield from _correct_colon(tokens, member, start, position)
        elif symbol in hints.ARROWS and not _ORDER_HEADS.isdisjoint(member):
            yield _replace_by("then", position, "an order is written: first a then b")
        elif symbol in (*hints.ARROWS, "and") and not _PAIR_HEADS.isdisjoint(member):
            yield _replace_by("to", position, hints.JOINED_BY_TO)
        elif symbol == "on" and "satisfy" in member:
            yield _replace_by("by", position, "write 'by' before what satisfies it")
    yield from _correct_operators(tokens, member, index)
    yield from _correct_keywords(tokens, member, start, index)
    yield from _correct_steps(tokens, member, start, index)


# -- the beginning of a member -------------------------------------------------------------------


def _correct_first_tokens(
    tokens: Tokens, member: list[str], start: int, index: int
) -> Iterator[Correction]:
    """Yield corrections of notes, stereotypes and words of other languages before a declaration."""
    length = _count_note(tokens, start)
    if length:
        yield Correction(start, length, (), "'//'", hints.NOTE)
    following = [tokens[at] for at in range(start, min(start + 5, len(tokens.types)))]
    if following[:2] == ["<", "<"] and following[3:] == [">", ">"]:
        yield Correction(start, 5, (), "a declaration", hints.STEREOTYPE)
    if member[0] == "@" and tokens.is_in_line(index - 1, index):
        advice = f"metadata before a declaration is written with '#': #{following[1]} {member[-1]}"
        yield Correction(start, 1, ("#",), "'#'", advice)
    if following[:3] == ["[", "*", "]"]:
        length = 4 if following[3:4] == ["->"] else 5
        yield Correction(start, length, ("entry", ";", "then"), "'entry; then'", _FIRST_STATE)
    position = start
    while position < index and tokens[position] in _PREFIXES:
        position += 1
    yield from _correct_first_word(tokens, position)


def _count_note(tokens: Tokens, start: int) -> int:
    """Return how many tokens belong to a note of another language: ``# a``, ``-- a``, ``% a``."""
    text, begin = tokens.text, tokens.starts[start]
    if not text.startswith(("# ", "#\t", "% ", "%\t", "--"), begin):
        return 0
    end = start + 1
    while end < len(tokens.types) - 1 and tokens.is_in_line(start, end):
        end += 1
    return end - start


def _correct_first_word(tokens: Tokens, position: int) -> Iterator[Correction]:
    """Yield the keywords for a word or type of another language: ``class A``, ``int x``."""
    following = "".join(hints.list_next_tokens(tokens, position)[:1])
    if not following[:1].isalnum() and following[:1] not in ("_", "'", '"'):
        return
    keywords, advice = hints.translate_first_word(tokens[position], following)
    if keywords is not None:
        expected = f"'{keywords.replace(' ;', ';') or following}'"
        yield Correction(position, 1, tuple(keywords.split()), expected, advice)


# -- symbols -------------------------------------------------------------------------------------


def _correct_colon(
    tokens: Tokens, member: list[str], start: int, index: int
) -> Iterator[Correction]:
    """Yield what a colon may stand for: ``part a :: A``, ``part def B : A``, ``part b : > a``."""
    following = hints.list_next_tokens(tokens, index)
    before = member[index - start - 1] if index > start else ""
    if member[index - start] == "::":
        if index > start + 1:
            advice = "':' stands before a type, '::' joins the names of packages"
            yield _replace_by(":", index, advice)
    elif following[:2] == [">", ">"]:
        yield Correction(index, 3, (":>>",), "':>>'", "write ':>>' without blanks")
    elif following[:1] == [">"]:
        yield Correction(index, 2, (":>",), "':>'", "write ':>' without blanks")
    elif before.isdigit() and "[" in member:
        upper = following[0] if following else "*"
        yield _replace_by("..", index, f"bounds are joined by '..': [{before}..{upper}]")
    elif not {"if", "while"}.isdisjoint(member) and following[:1] == ["{"]:
        yield Correction(index, 1, (), "'{'", "the steps stand in braces: if x > 0 { ... }")
    elif "def" in member:
        advice = "':>' stands before a general type, ':' before the type of a usage"
        yield _replace_by(":>", index, advice)


def _correct_operators(tokens: Tokens, member: list[str], index: int) -> Iterator[Correction]:
    """Yield corrections of the last tokens of *member*, which ends at ``index``."""
    before, last = member[-2] if len(member) > 1 else "", member[-1]
    following = "".join(hints.list_next_tokens(tokens, index)[:1])
    if (before, last) == ("<", ">"):
        yield Correction(index - 1, 2, ("!=",), "'!='", "'!=' means that two values differ")
    if (before, last) == ("=", "<"):
        yield Correction(index - 1, 2, ("<=",), "'<='", "'<=' means at most")
    if (last, following) == ("<", "-"):
        yield Correction(index, 2, ("=",), "'='", "'=' gives the value")
    if (last, following) == ("<", ":"):
        yield Correction(index, 2, (":>",), "':>'", "':>' stands before a general type")
    if last == "<" and member[-3:-2] == [":"] and following.isidentifier():
        advice = f"several of a type are written with a multiplicity: {following}[*]"
        yield Correction(index - 1, 2, (), "a type", advice)
    if before == ",":
        yield _replace_by(";", index - 1, hints.COMMA)


def _replace_by(word: str, index: int, advice: str) -> Correction:
    return Correction(index, 1, (word,), f"'{word}'", advice)


# -- keywords and steps --------------------------------------------------------------------------


def _correct_keywords(
    tokens: Tokens, member: list[str], start: int, index: int
) -> Iterator[Correction]:
    """Yield corrections of keywords that are doubled or in the wrong order."""
    before, last = member[-2] if len(member) > 1 else "", member[-1]
    following = "".join(hints.list_next_tokens(tokens, index)[:1])
    if last in hints.DIRECTIONS and following.isidentifier():
        advice = f"write the direction before the kind: {last} {before} ..."
        yield Correction(index - 1, 2, (last, before), f"'{last}'", advice)
    if last not in RESERVED or index == start or not tokens.is_in_line(index - 1, index):
        return
    if before == "def" and last != "def":
        advice = f"'def' stands after the kind: {last} def {following}"
        yield Correction(index - 1, 2, (last, "def"), f"'{last} def'", advice)
    if before in ("def", last) and following[:1] not in (";", "{", ":>", ""):
        yield Correction(index, 1, (), "a name", "take it away")
    if (before, last) == ("flow", "port"):
        yield Correction(index - 1, 2, ("port",), "'port'", "every port is a 'port'")


def _correct_steps(
    tokens: Tokens, member: list[str], start: int, index: int
) -> Iterator[Correction]:
    """Yield corrections of steps, their order, and the actions of states."""
    before, last = member[-2] if len(member) > 1 else "", member[-1]
    if before == "then" and last == "{" and "if" in member:
        advice = "the steps follow without 'then': if x > 0 { ... }"
        yield Correction(index - 1, 1, (), "'{'", advice)
    if last == "do" and hints.list_next_tokens(tokens, index)[:1] == ["{"]:
        advice = "the steps follow without 'do': while x > 0 { ... }"
        yield Correction(index, 1, (), "'{'", advice)
    if last == "/" and before in _SUBACTIONS:
        yield Correction(index, 1, (), "an action", f"the action follows '{before}' without '/'")
    if last == "{" and before in _SUBACTIONS:
        advice = f"steps stand in an action: {before} action {{ ... }}"
        yield Correction(index, 0, ("action",), "'action'", advice)
    if last == ":=" and member[0].isidentifier() and member[0] not in RESERVED:
        advice = f"an assignment begins with 'assign': assign {''.join(member[:-1])} := ..."
        yield Correction(start, 0, ("assign",), "'assign'", advice)
    if last == "then" and member[0].isidentifier():
        advice = f"write 'first' before the source: first {member[0]} then ..."
        yield Correction(start, 0, ("first",), "'first'", advice)
    if last.isidentifier() and not _ORDER_HEADS.isdisjoint(member[:-1]):
        advice = f"write 'then' before the target: then {last}"
        yield Correction(index, 0, ("then",), "'then'", advice)


def _read_body_head(tokens: Tokens, start: int) -> list[str]:
    """Return the tokens of the member whose body has a member at ``start``."""
    depth = 0
    for position in range(start - 1, max(-1, start - _MAX_HEAD), -1):
        depth += (tokens[position] == "}") - (tokens[position] == "{")
        if depth < 0:
            return hints.list_member_before(tokens, position)
    return []
