"""The lexer of KerML and SysML v2 (KerML 8.2.2): one regular expression, one pass."""

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

from msgspec import Struct

from sysmlc.language.tree import Node

# The possessive `*+` keeps long runs of notes from backtracking.
_SKIPPED = r"(?:[ \t\r\n\f\v\ufeff]+|//\*(?s:.)*?\*/|//(?!\*)[^\r\n]*)*+"
_COMMENT = r"/\*(?s:.)*?\*/"
_WORD = r"[^\W\d]\w*"
# Longer symbols come first, because an alternation takes the first match. `.5` is a number, and
# `/*` begins a comment.
_SYMBOLS = (
    r"===|!==|:>>|::>|\*\*|::|:>|:=|==|!=|<=|>=|=>|->|\.\.|\.\?|\?\?|@@"
    r"|/(?!\*)|\.(?!\d)|[~}|{^\]\[@?>=<;:,+*)(&%$#-]"
)
_QUOTED = r"'(?:[^'\\\r\n]|\\.)*'"
_STRING = r'"(?:[^"\\]|\\(?s:.))*"'
_NUMBER = r"\d+(?:\.\d+)?(?:[eE][+-]?\d+)?|\.\d+(?:[eE][+-]?\d+)?"
TOKEN = re.compile(
    rf"{_SKIPPED}(?:({_WORD}|{_SYMBOLS})|({_NUMBER})|({_COMMENT})|({_QUOTED})|({_STRING})|(.)|\Z)"
)
"""Blanks and notes, then a token; the number of the matching group gives its type."""
INVALID_GROUP = 6
"""The group of a character that begins no token; at the end of the text no group matches."""
MAX_INTEGER_DIGITS = 1_000
"""Digits of the longest natural number that is read exactly."""
_PROBE_LENGTH = 64
"""A file in UTF-16 has a zero among so many first characters."""
_TYPOGRAPHIC = re.compile(
    "(?P<string>[\u201c\u201d\u201e][^\u201c\u201d\u201e\r\n]*[\u201c\u201d])"
    "|(?P<name>[\u2018\u2019\u201a][^\u2018\u2019\u201a\r\n]*[\u2018\u2019])"
    "|[\u201c\u201d\u201e\u2018\u2019\u201a]"
)
"""A string or name in typographic quotation marks, or one such mark."""
_STEREOTYPE = re.compile("\u00ab[^\u00ab\u00bb\r\n]*\u00bb")
_QUOTATION_MARKS = "'\"\u201c\u201d\u201e\u2018\u2019\u201a"
_FOREIGN_SYMBOLS = {"≥": ">=", "≤": "<=", "≠": "!=", "∧": "and", "∨": "or", "×": "*"}
"""Characters that are read as operators."""
_CONTROL_CHARACTER = re.compile(r"[\x00-\x08\x0e-\x1f\x7f]")
_CONTROL_SHARE = 0.05
"""A file is binary if more than this share of its first characters are control characters."""
_REST_OF_LITERAL = re.compile(r"[\w ]*")
_COMMENT_START = re.compile(r"\A[ \t\f\v]*(?:(?:\r\n|\r|\n)[ \t\f\v]*\*? ?)?")
_LINE_START = re.compile(r"(\r\n|\r|\n)[ \t\f\v]*\*? ?")
_ESCAPE = re.compile(r"\\(.)", re.DOTALL)
_ESCAPES = {"n": "\n", "t": "\t", "r": "\r", "f": "\f", "v": "\v", "b": "\b"}


class LexicalFault(Struct, frozen=True):
    """A part of a text that is not a token.

    ``what`` is the kind of fault: ``comment``, ``quote`` or ``string`` for an unterminated comment,
    quoted name or string, ``character`` for a character that no token contains, ``negation`` for
    `!`, ``operator`` for another character that is read as an operator, ``typography`` for a
    typographic quotation mark, ``stereotype`` for a stereotype in guillemets, ``number`` for a
    number that is too large, ``encoding`` for a text that is not UTF-8.
    """

    what: str
    start: int
    text: str


class BuildFault(Struct, frozen=True):
    """A fault that a builder found: a ``prefix`` or a ``combination``, with message and advice."""

    what: str
    start: int
    text: str
    advice: str


Span = tuple[int, int]
"""The index of the first token, and the index after the last one."""
Action = Callable[..., Any]
"""A build action: a function of the tokens and the values of the symbols of a rule."""


@dataclass(slots=True, eq=False)
class Tokens:
    """The tokens of ``text``: the number of their types, and where each starts and ends.

    The last token is the end of the text. ``faults`` has the parts of the text that are no tokens.
    ``begin`` and ``stop`` are the span of the rule whose builder is running.
    Builders collect nodes and faults in the other lists: ``ref_usages`` has usages with the keyword
    `ref`, which is redundant or not depending on their owners; ``restricted_nodes`` has members
    that only some bodies may have; ``build_faults`` has other faults. ``corrections`` has the
    keywords that stand for misspelt and missing words, by the offsets of the words.
    """

    text: str
    types: bytearray = field(default_factory=bytearray)
    starts: list[int] = field(default_factory=list)
    ends: list[int] = field(default_factory=list)
    faults: list[LexicalFault] = field(default_factory=list)
    ref_usages: list[Node] = field(default_factory=list)
    restricted_nodes: list[Node] = field(default_factory=list)
    build_faults: list[BuildFault] = field(default_factory=list)
    corrections: dict[Span, str] = field(default_factory=dict)
    begin: int = 0
    stop: int = 0

    def __getitem__(self, index: int) -> str:
        start, end = self.starts[index], self.ends[index]
        return self.corrections.get((start, end)) or self.text[start:end]

    def append(self, kind: int, start: int, end: int) -> None:
        """Append a token."""
        self.types.append(kind)
        self.starts.append(start)
        self.ends.append(end)

    def insert(self, index: int, kind: int, word: str = "") -> None:
        """Insert an empty token that the text lacks, a keyword if *word* is given."""
        place = self.ends[index - 1] if index else 0
        if word:
            self.corrections[place, place] = word
        self.types.insert(index, kind)
        self.starts.insert(index, place)
        self.ends.insert(index, place)

    def replace(self, index: int, length: int, words: Mapping[str, int]) -> None:
        """Replace tokens by keywords or symbols, given with their types.

        Keywords for which there are too few tokens are inserted as empty tokens.
        """
        surplus = slice(index + len(words), index + length)
        for position, (word, kind) in enumerate(words.items(), index):
            if position < index + length:
                self.types[position] = kind
                self.corrections[self.starts[position], self.ends[position]] = word
            else:
                self.insert(position, kind, word)
        del self.types[surplus], self.starts[surplus], self.ends[surplus]

    def forget_from(self, start: int) -> None:
        """Forget what builders found from a character on: the text from there is parsed again."""
        self.ref_usages[:] = [node for node in self.ref_usages if node.start < start]
        self.restricted_nodes[:] = [node for node in self.restricted_nodes if node.start < start]
        self.build_faults[:] = [fault for fault in self.build_faults if fault.start < start]

    def truncate(self, index: int, end: int) -> None:
        """Let the text end before token ``index``."""
        self.types[index:] = bytes([end])
        self.ends[index:] = [self.starts[index]]
        del self.starts[index + 1 :]

    def read_name(self, index: int) -> str:
        """Return the name that a token writes, without quotes and escapes (KerML 8.2.2.3)."""
        written = self.text[self.starts[index] : self.ends[index]]
        # Recovery reads a string as a name.
        return unquote(written) if written[0] in _QUOTATION_MARKS else written

    def is_in_line(self, index: int, other: int) -> bool:
        """Whether the second token begins in the line in which the first one begins."""
        gap = self.text[self.starts[index] : self.starts[other]]
        return "\n" not in gap and "\r" not in gap


class TokenTypes(Struct, frozen=True):
    """Numbers of token types: of keywords and symbols by their text, and of the other tokens."""

    words: Mapping[str, int]
    name: int
    string: int
    number: int
    body: int
    end: int


def tokenize(text: str, types: TokenTypes) -> Tokens:
    """Return all tokens of ``text``; never fails. A text that is not UTF-8 has no tokens."""
    tokens = Tokens(text)
    position = 0
    # Decoded as UTF-8, such a file would give thousands of faults instead of one.
    if "\0" in text[:_PROBE_LENGTH] or _is_binary(text):
        tokens.faults.append(LexicalFault("encoding", 0, ""))
        position = len(text)
    while position >= 0:
        position = _tokenize_valid(tokens, types, position)
    # The word pattern accepts all letters, so that a name such as Größe is one token with one
    # fault.
    if not text.isascii():
        _check_name_characters(tokens, types)
    return tokens


def _is_binary(text: str) -> bool:
    """Whether a text is the content of a binary file that was decoded as UTF-8."""
    head = text[:4_096]
    return len(_CONTROL_CHARACTER.findall(head)) > max(3, _CONTROL_SHARE * len(head))


def _tokenize_valid(tokens: Tokens, types: TokenTypes, position: int) -> int:
    """Append tokens up to an invalid one.

    Return the offset to continue at, or -1 at the end of the text.
    """
    token_types, starts, ends = tokens.types, tokens.starts, tokens.ends
    words, name = types.words, types.name
    # Indexed by the number of the matching group; 0 is the end of the text.
    by_group = (types.end, name, types.number, types.body, name, types.string)
    for match in TOKEN.finditer(tokens.text, position):
        group = match.lastindex or 0
        if group == INVALID_GROUP:
            return _skip_invalid(tokens, types, match.start(INVALID_GROUP))
        start, end = match.span(group) if group else (match.end(), match.end())
        token_types.append(words.get(match[1], name) if group == 1 else by_group[group])
        starts.append(start)
        ends.append(end)
        if not group:
            break
    return -1


def _skip_invalid(tokens: Tokens, types: TokenTypes, start: int) -> int:
    """Record a part of the text that is not a token; return the offset to continue at."""
    text = tokens.text
    char = text[start]
    # The rest of the text is the comment, so nothing of it is read.
    if text.startswith("/*", start) or text.startswith("//*", start):
        tokens.faults.append(LexicalFault("comment", start, char))
        return len(text)
    if char in "'\"":
        match = _REST_OF_LITERAL.match(text, start + 1)
        end = match.end() if match else len(text)
        tokens.faults.append(LexicalFault("quote" if char == "'" else "string", start, char))
        tokens.append(types.name if char == "'" else types.string, start, end)
        return end
    # A pair of quotation marks is one fault, and so are all of a text from a word processor.
    if match := _TYPOGRAPHIC.match(text, start):
        if all(fault.what != "typography" for fault in tokens.faults):
            tokens.faults.append(LexicalFault("typography", start, char))
        if match.lastgroup:
            kind = types.name if match.lastgroup == "name" else types.string
            tokens.append(kind, start, match.end())
        return match.end()
    if match := _STEREOTYPE.match(text, start):
        tokens.faults.append(LexicalFault("stereotype", start, match[0]))
        return match.end()
    if symbol := _FOREIGN_SYMBOLS.get(char, ""):
        tokens.faults.append(LexicalFault("operator", start, symbol))
        tokens.append(types.words[symbol], start, start + 1)
        tokens.corrections[start, start + 1] = symbol
        return start + 1
    # Each character is reported once: a text in another script would give an error per letter.
    if all(char != fault.text for fault in tokens.faults):
        what = "negation" if char == "!" else "character"
        tokens.faults.append(LexicalFault(what, start, char))
    return start + 1


def _check_name_characters(tokens: Tokens, types: TokenTypes) -> None:
    """Record a fault for names without quotes that contain letters other than a to z."""
    for index, token_type in enumerate(tokens.types):
        if token_type == types.name and not (name := tokens[index]).isascii() and name[0] != "'":
            char = next(char for char in name if not char.isascii())
            if all(char != fault.text for fault in tokens.faults):
                start = tokens.starts[index] + name.index(char)
                tokens.faults.append(LexicalFault("character", start, char))


def join_tokens(text: str, start: int, end: int) -> str:
    """Return part of a text in one line, without notes, with one blank where tokens are apart."""
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


def strip_comment(written: str) -> str:
    """Return the body of a comment as KerML 8.2.3.3.2, note 1, takes it from the text."""
    inner = written[2:-2]
    return _LINE_START.sub(r"\1", _COMMENT_START.sub("", inner, count=1))


def unquote(written: str) -> str:
    """Return the text between quotes, without escapes (KerML 8.2.2.3, Table 4)."""
    is_closed = len(written) > 1 and (written[-1] == written[0] or not written[0].isascii())
    inner = written[1:-1] if is_closed else written[1:]
    if "\\" not in inner:
        return inner
    return _ESCAPE.sub(lambda match: _ESCAPES.get(match[1], match[1]), inner)


_BASIC_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")
_NAME_ESCAPES = str.maketrans(
    {"\\": "\\\\", "'": "\\'", "\n": "\\n", "\t": "\\t", "\r": "\\r", "\f": "\\f", "\b": "\\b"}
)


def quote_name(name: str) -> str:
    """Return a name as a text writes it: in quotes unless it is basic (KerML 8.2.2.3)."""
    return name if _BASIC_NAME.fullmatch(name) else f"'{name.translate(_NAME_ESCAPES)}'"
