"""What is wrong with a text, said at its place."""

from codecs import BOM_UTF8

from sysmlc.diagnostics import Place, Rule, Sink, Subject
from sysmlc.language.text import rules
from sysmlc.language.text.nesting import LIMIT
from sysmlc.language.text.scan import Fault, Tokens
from sysmlc.sources import Source

_MOST = 100
"""Errors of one file that are told."""
_LAST = f"of one file no more than {_MOST} errors of syntax are told"
_LANGUAGES = {"kerml": "KerML", "sysml": "SysML"}
_WORDS = {"BODY": "the comment", "STRING": "the text"}
_COMMENT = (
    "a comment /* */ is an element of the model and stands between members, or after `doc` or "
    "`comment`; a note anywhere is written //* ... */ or // ..."
)


class Errors:
    """Reports about one text; after a hundred no more."""

    def __init__(
        self, tokens: Tokens, path: str, language: str, sink: Sink, source: Source | None
    ) -> None:
        self._tokens = tokens
        self._path = path
        self._language = language
        self._sink = sink
        marked = source is not None and source.data.startswith(BOM_UTF8)
        self._mark = len(BOM_UTF8) if marked and not tokens.text.startswith("\ufeff") else 0
        self._left = _MOST
        self._unclosed_told = False
        self.beginnings: list[str] = []

    def report(self, rule: Rule, offset: int, **facts: object) -> None:
        """Report at a character of the text."""
        self._left -= 1
        if self._left < 0:
            return
        place = Place(self._path, offset=self.byte(offset))
        facts.setdefault("advice", "")
        notes = () if self._left else (_LAST,)
        self._sink.report(rule, Subject(place=place), help="", notes=notes, **facts)

    def byte(self, offset: int) -> int:
        """The byte of the file at which a character of the text starts."""
        return self._mark + len(self._tokens.text[:offset].encode("utf-8", "replace"))

    def deep(self, start: int) -> None:
        """Something is nested too deep; what follows from that is not told."""
        self.report(rules.DEEP, start, limit=LIMIT)
        self._left = 0

    def faults(self, deep: int) -> None:
        """What the scanner could not read; the token, if not -1, where the text is too deep."""
        if deep >= 0:
            self.deep(self._tokens.starts[deep])
        for fault in self._tokens.faults:
            is_open = fault.what in ("comment", "quote", "string")
            rule = rules.UNCLOSED if is_open else rules.CHARACTER
            what, advice = _FAULTS[fault.what]
            shown = _shown(fault)
            self.report(rule, fault.start, what=what.format(shown), advice=advice)

    def unexpected(self, at: int, expected: list[str]) -> None:
        """A token does not fit."""
        from sysmlc.language.text import hints
        from sysmlc.language.text.grammar_words import expectation

        said = expectation(expected, self.beginnings)
        found = self._found(at)
        advice = hints.slip(self._tokens, at, expected, self.beginnings)
        start = self._tokens.starts[at]
        self.report(rules.SYNTAX, start, found=found, expected=said, advice=advice)

    def comment(self, at: int) -> None:
        """A comment stands where none may."""
        start = self._tokens.starts[at]
        found, expected = "a comment /* */", "something else"
        self.report(rules.SYNTAX, start, found=found, expected=expected, advice=_COMMENT)

    def substituted(self, at: int, meant: str) -> None:
        """A token is read as another one: a keyword as a name, `=` as `:=`."""
        start, word = self._tokens.starts[at], self._tokens[at]
        if meant == "NAME":
            self.report(rules.KEYWORD, start, word=word, language=_LANGUAGES[self._language])
            return
        from sysmlc.language.text import hints

        advice = f"{hints.INITIAL}: here only '{meant}' can stand"
        if word == "==":
            advice = f"'==' compares two values; {hints.INITIAL}"
        expected = f"'{meant}'"
        self.report(rules.SYNTAX, start, found=f"'{word}'", expected=expected, advice=advice)

    def missing(self, at: int, words: str) -> None:
        """Something is missing before a token; told where the one before ends."""
        before = self._before(at)
        end = self._tokens.ends[before]
        said = self._found(before)
        advice = f"put {words} there"
        if words == "';'":
            from sysmlc.language.text import hints

            about = hints.missing(self._tokens, before, at, self.beginnings)
            advice = about or "put ';' there, or a body in braces"
        self.report(rules.MISSING, max(end - 1, 0), missing=words, before=said, advice=advice)

    def _before(self, at: int) -> int:
        """The last token before one that the text really has."""
        before = at - 1
        while before > 0 and not self._tokens[before]:
            before -= 1
        return max(before, 0)

    def stray(self, at: int) -> None:
        """A `;` or `}` too much."""
        symbol = self._tokens[at]
        expected = "a declaration or '}'" if symbol == ";" else "a declaration"
        advice = "take it away" if symbol == ";" else "no '{' is open here: one of both is too much"
        start = self._tokens.starts[at]
        self.report(rules.SYNTAX, start, found=f"'{symbol}'", expected=expected, advice=advice)

    def unclosed(self) -> None:
        """The text ends in a body; told at the brace that opens it, once."""
        if self._unclosed_told:
            return
        self._unclosed_told = True
        open_ones: list[int] = []
        for index in range(len(self._tokens.types)):
            symbol = self._tokens[index]
            if symbol == "{":
                open_ones.append(index)
            elif symbol == "}" and open_ones:
                open_ones.pop()
        if open_ones:
            start = self._tokens.starts[open_ones[-1]]
            advice = "put '}' after the last member of this body"
            self.report(rules.UNCLOSED, start, what="this '{'", advice=advice)

    def _found(self, at: int) -> str:
        written = self._tokens[at]
        if not written:
            return "the end of the text"
        if written.startswith("/*"):
            return "the comment /* */"
        if written.startswith('"'):
            return "a text in quotes"
        return written if written.startswith("'") else f"'{_short(written)}'"


_FAULTS = {
    "comment": ("this comment", "put */ where it ends"),
    "quote": ("this name in quotes", "put ' where it ends, in the same line"),
    "string": ("this text in quotes", 'put " where it ends'),
    "encoding": ("the file is not written in UTF-8", "save it in UTF-8, and it is read"),
    "number": ("{} is too large a number", "write it with an exponent below 308"),
    "character": (
        "{} belongs to no name, symbol or text",
        "take it away, or put the name that it belongs to in single quotes: 'Größe'",
    ),
}


def _shown(fault: Fault) -> str:
    char = fault.text or " "
    if char == "\ufffd":
        return "what is not UTF-8 here"
    return f"'{_short(char)}'" if char.isprintable() else f"the character U+{ord(char[0]):04X}"


def _short(text: str) -> str:
    return text if len(text) <= 40 else f"{text[:40]}..."
