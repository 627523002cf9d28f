"""A text in KerML or SysML v2 becomes tokens (KerML 8.2.2): one regular expression, one pass."""

import re
from collections.abc import Mapping

from msgspec import Struct

from sysmlc.language.tree import Node

_SKIPPED = r"(?:[ \t\r\n\f\v\ufeff]+|//\*(?s:.)*?\*/|//(?!\*)[^\r\n]*)*+"
_BODY = r"/\*(?s:.)*?\*/"
_WORD = r"[^\W\d]\w*"
_SYMBOLS = (
    r"===|!==|:>>|::>|\*\*|::|:>|:=|==|!=|<=|>=|=>|->|\.\.|\.\?|\?\?|@@"
    r"|/(?!\*)|\.(?!\d)|[~}|{^\]\[@?>=<;:,+*)(&%$#-]"
)
_QUOTED = r"'(?:[^'\\\r\n]|\\.)*'"
_STRING = r'"(?:[^"\\]|\\(?s:.))*"'
_NUMBER = r"\d+(?:\.\d+)?(?:[eE][+-]?\d+)?|\.\d+(?:[eE][+-]?\d+)?"
TOKEN = re.compile(
    rf"{_SKIPPED}(?:({_WORD}|{_SYMBOLS})|({_NUMBER})|({_BODY})|({_QUOTED})|({_STRING})|(.)|\Z)"
)
"""Blanks and notes, then a token; the number of the group that matched tells its kind."""
BAD = 6
"""The group of what is no token; the end of the text is no group."""
DIGITS = 1_000
"""Digits of the longest natural number that is taken."""
_HEAD = 64
"""Characters in which a file of another encoding, UTF-16 or a binary one, has a zero."""
_REST = re.compile(r"[\w ]*")
_OPENING = re.compile(r"\A[ \t\f\v]*(?:(?:\r\n|\r|\n)[ \t\f\v]*\*? ?)?")
_LINE_START = re.compile(r"(\r\n|\r|\n)[ \t\f\v]*\*? ?")
_ESCAPE = re.compile(r"\\(.)", re.DOTALL)
_ESCAPES = {"n": "\n", "t": "\t", "r": "\r", "f": "\f", "v": "\v", "b": "\b"}


class Fault(Struct, frozen=True):
    """What cannot be read: a ``comment``, ``quote`` or ``string`` that is never closed, a
    ``character`` of no token, a ``number`` that is too large, the ``encoding`` of all.
    """

    what: str
    start: int
    text: str


class Remark(Struct, frozen=True):
    """What the builder found wrong: a ``prefix`` or a ``combination``, said in words."""

    what: str
    start: int
    text: str
    advice: str


class Tokens(Struct, frozen=True, eq=False):
    """The tokens of ``text``: their types by number, where each starts and ends.

    The last one is the end of the text. ``faults`` has what is no token. ``referential`` is for
    the builder: usages that say `ref`; whether that adds anything is known when owners are.
    ``special`` has nodes that not every body takes, ``remarks`` what is wrong otherwise.
    """

    text: str
    types: bytearray
    starts: list[int]
    ends: list[int]
    faults: list[Fault]
    referential: list[Node]
    special: list[Node]
    remarks: list[Remark]

    def __getitem__(self, index: int) -> str:
        return self.text[self.starts[index] : self.ends[index]]

    def insert(self, index: int, kind: int) -> None:
        """Put in a token that the text lacks; it is empty."""
        place = self.ends[index - 1] if index else 0
        self.types.insert(index, kind)
        self.starts.insert(index, place)
        self.ends.insert(index, place)

    def end_at(self, index: int, end: int) -> None:
        """Let the text end before a token."""
        self.types[index:] = bytes([end])
        self.ends[index:] = [self.starts[index]]
        del self.starts[index + 1 :]

    def name(self, index: int) -> str:
        """The name that a token writes, quotes and escapes undone (KerML 8.2.2.3)."""
        written = self.text[self.starts[index] : self.ends[index]]
        return unquoted(written) if written[0] == "'" else written


class Types(Struct, frozen=True):
    """Numbers of the types: of words and symbols by their text, and of what texts vary in."""

    words: Mapping[str, int]
    name: int
    string: int
    number: int
    body: int
    end: int


def scan(text: str, types: Types) -> Tokens:
    """All tokens of ``text``; never fails. Of what was no text in UTF-8 it has none."""
    tokens = Tokens(text, bytearray(), [], [], [], [], [], [])
    position = 0
    if "\0" in text[:_HEAD]:
        tokens.faults.append(Fault("encoding", 0, ""))
        position = len(text)
    while position >= 0:
        position = _scan(tokens, types, position)
    if not text.isascii():
        _check_names(tokens, types)
    return tokens


def _scan(tokens: Tokens, types: Types, position: int) -> int:
    """Take tokens up to the end, then -1, or up to what is none, then where to go on."""
    kinds, starts, ends = tokens.types, tokens.starts, tokens.ends
    words, name = types.words, types.name
    by_group = (types.end, name, types.number, types.body, name, types.string)
    for found in TOKEN.finditer(tokens.text, position):
        group = found.lastindex or 0
        if group == BAD:
            return _fault(tokens, types, found.start(BAD))
        start, end = found.span(group) if group else (found.end(), found.end())
        kinds.append(words.get(found[1], name) if group == 1 else by_group[group])
        starts.append(start)
        ends.append(end)
        if not group:
            break
    return -1


def _fault(tokens: Tokens, types: Types, start: int) -> int:
    """Note what is no token; where to go on behind it."""
    text = tokens.text
    char = text[start]
    if text.startswith("/*", start) or text.startswith("//*", start):
        tokens.faults.append(Fault("comment", start, char))
        return len(text)
    if char in "'\"":
        found = _REST.match(text, start + 1)
        end = found.end() if found else len(text)
        tokens.faults.append(Fault("quote" if char == "'" else "string", start, char))
        tokens.types.append(types.name if char == "'" else types.string)
        tokens.starts.append(start)
        tokens.ends.append(end)
        return end
    if all(char != fault.text for fault in tokens.faults):
        tokens.faults.append(Fault("character", start, char))
    return start + 1


def _check_names(tokens: Tokens, types: Types) -> None:
    """Names without quotes have letters a to z only."""
    for index, kind in enumerate(tokens.types):
        if kind == types.name and not (name := tokens[index]).isascii() and name[0] != "'":
            char = next(char for char in name if not char.isascii())
            if all(char != fault.text for fault in tokens.faults):
                start = tokens.starts[index] + name.index(char)
                tokens.faults.append(Fault("character", start, char))


def join_tokens(text: str, start: int, end: int) -> str:
    """Return part of a text in one line, without notes: one blank where tokens are apart."""
    pieces: list[str] = []
    last_end = -1
    for match in TOKEN.finditer(text, start, end):
        group = match.lastindex or 0
        if not group:
            break
        if last_end >= 0 and match.start(group) > last_end:
            pieces.append(" ")
        pieces.append(match[group])
        last_end = match.end(group)
    return "".join(pieces)


def body_text(written: str) -> str:
    """The body of a comment as KerML 8.2.3.3.2, note 1, takes it from the text."""
    inner = written[2:-2]
    return _LINE_START.sub(r"\1", _OPENING.sub("", inner, count=1))


def unquoted(written: str) -> str:
    """What stands between the quotes, escapes undone (KerML 8.2.2.3, Table 4)."""
    is_closed = len(written) > 1 and written[-1] == written[0]
    inner = written[1:-1] if is_closed else written[1:]
    return _ESCAPE.sub(_escaped, inner) if "\\" in inner else inner


def _escaped(found: re.Match[str]) -> str:
    return _ESCAPES.get(found[1], found[1])
