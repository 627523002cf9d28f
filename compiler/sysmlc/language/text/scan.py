"""A text in KerML or SysML v2 becomes tokens (KerML 8.2.2): one regular expression, one pass."""

import re
from collections.abc import Mapping

from sysmlc.language.tree import Node
from sysmlc.values import dataclass

_SKIPPED = r"(?:[ \t\r\n\f\v\ufeff]+|//\*(?s:.)*?\*/|//(?!\*)[^\r\n]*)*+"
_BODY = r"/\*(?s:.)*?\*/"
_WORD = r"[^\W\d]\w*"
_SYMBOLS = r"===|!==|:>>|::>|\*\*|::|:>|:=|==|!=|<=|>=|=>|->|\.\.|\.\?|\?\?|@@|/(?!\*)|\.(?!\d)|[~}|{^\]\[@?>=<;:,+*)(&%$#-]"
_QUOTED = r"'(?:[^'\\\r\n]|\\.)*'"
_STRING = r'"(?:[^"\\]|\\(?s:.))*"'
_NUMBER = r"\d+(?:\.\d+)?(?:[eE][+-]?\d+)?|\.\d+(?:[eE][+-]?\d+)?"
_TOKEN = re.compile(
    rf"{_SKIPPED}(?:({_WORD}|{_SYMBOLS})|({_NUMBER})|({_BODY})|({_QUOTED})|({_STRING})|(.)|\Z)"
)
_ESCAPE = re.compile(r"\\(.)", re.DOTALL)
_ESCAPES = {"n": "\n", "t": "\t", "r": "\r", "f": "\f", "v": "\v", "b": "\b"}


@dataclass(frozen=True, slots=True, eq=False)
class Tokens:
    """The tokens of ``text``: their types by number, where each starts and ends.

    The last one is the end of the text. ``bad`` has the numbers of those that are no token of
    the language; they have the type 0. ``referential`` is for the builder: usages that say
    `ref`; whether that adds anything is known when their owners are.
    """

    text: str
    types: bytearray
    starts: list[int]
    ends: list[int]
    bad: list[int]
    referential: list[Node]

    def __getitem__(self, index: int) -> str:
        return self.text[self.starts[index] : self.ends[index]]

    def name(self, index: int) -> str:
        """The name that a token writes, quotes and escapes undone (KerML 8.2.2.3)."""
        written = self.text[self.starts[index] : self.ends[index]]
        return unquoted(written) if written[0] == "'" else written


@dataclass(frozen=True, slots=True)
class Types:
    """Numbers of the types: of words and symbols by their text, and of what texts vary in."""

    words: Mapping[str, int]
    name: int
    string: int
    number: int
    body: int
    end: int


def scan(text: str, types: Types) -> Tokens:
    """All tokens of ``text``; never fails."""
    kinds, starts, ends = bytearray(), [], []
    words, name = types.words, types.name
    by_group = (types.end, name, types.number, types.body, name, types.string, 0)
    for found in _TOKEN.finditer(text):
        group = found.lastindex or 0
        start, end = found.span(group) if group else (found.end(), found.end())
        kinds.append(words.get(found[1], name) if group == 1 else by_group[group])
        starts.append(start)
        ends.append(end)
        if not group:
            break
    bad = [index for index, kind in enumerate(kinds) if kind == 0] if 0 in kinds else []
    return Tokens(text, kinds, starts, ends, bad, [])


def unquoted(written: str) -> str:
    """What stands between the quotes, escapes undone (KerML 8.2.2.3, Table 4)."""
    inner = written[1:-1]
    return _ESCAPE.sub(_escaped, inner) if "\\" in inner else inner


def _escaped(found: re.Match[str]) -> str:
    return _ESCAPES.get(found[1], found[1])
