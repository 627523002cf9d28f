"""Syntax errors, reported at their location with the expected tokens and advice."""

import re
from bisect import bisect_left
from collections.abc import Collection
from functools import cached_property

from sysmlc.diagnostics import Place, Rule, Sink, Subject
from sysmlc.language.text import hints, rules
from sysmlc.language.text.builders.operators import PRECEDENCE
from sysmlc.language.text.corrections import Correction
from sysmlc.language.text.lexer import LexicalFault, Tokens, TokenTypes
from sysmlc.language.text.nesting import MAX_DEPTH
from sysmlc.language.tree import ByteOffsets
from sysmlc.sources import Source

_MAX_ERRORS = 100
"""Errors that are reported for one file."""
_LAST_NOTE = f"of one file no more than {_MAX_ERRORS} syntax errors are reported"
_MAX_MARGIN = 1_000
"""Characters before a brace in which its line begins; a line of megabytes has no indentation."""
_LANGUAGES = {"kerml": "KerML", "sysml": "SysML"}
_COMMENT_ADVICE = (
    "a comment /* */ is an element of the model and stands between members, or after `doc` or "
    "`comment`; a note anywhere is written //* ... */ or // ..."
)
_LEXICAL_FAULTS = {
    "comment": ("this comment", "put */ where it ends"),
    "quote": ("this name in quotes", "put ' where it ends, in the same line"),
    "string": ("this string", 'put " where it ends'),
    "encoding": (
        "the file is not text in UTF-8",
        "save it in UTF-8; if it is not a model, rename or remove it",
    ),
    "typography": (
        "{} is a typographic quotation mark",
        "write straight quotation marks: 'name' or \"text\"",
    ),
    "stereotype": ("unexpected {}", hints.STEREOTYPE),
    "operator": ("'{char}' is no operator", "write {}"),
    "number": ("{} is too large a number", "write it with an exponent below 308"),
    "negation": ("{} is no operator", "write 'not' for a negation"),
    "character": (
        "unexpected {}",
        "take it away, or put the name that it belongs to in single quotes: 'Größe'",
    ),
}
"""What is wrong and the advice, for each kind of lexical fault."""


class Errors:
    """Reports the syntax errors of one text, up to a maximum.

    ``beginnings`` are the tokens with which a member may begin. ``recovery.Recovery`` sets them.
    """

    def __init__(
        self,
        tokens: Tokens,
        types: TokenTypes,
        path: str,
        language: str,
        sink: Sink,
        source: Source | None,
    ) -> None:
        self._tokens = tokens
        self._types = types
        self._path = path
        self._language = language
        self._sink = sink
        self._source = source
        self._remaining = _MAX_ERRORS
        self._is_unclosed_reported = False
        self._unclosed_lines: set[int] = set()
        self.beginnings: list[str] = []
        self.is_quiet = False
        """Whether errors are consequences of the one before, and not reported."""

    def report(self, rule: Rule, offset: int, **facts: object) -> None:
        """Report an error at a character of the text, unless the maximum is reached.

        A syntax error in a line with an unclosed quotation is a consequence of it.
        """
        is_syntax = rule in (rules.SYNTAX, rules.MISSING)
        if self.is_quiet:
            return
        if is_syntax and self._unclosed_lines and self._find_line(offset) in self._unclosed_lines:
            return
        self._remaining -= 1
        if self._remaining < 0:
            return
        place = Place(self._path, offset=self._byte_offsets.byte_of(offset))
        facts.setdefault("advice", "")
        notes = () if self._remaining else (_LAST_NOTE,)
        self._sink.report(rule, Subject(place=place), help="", notes=notes, cause="", **facts)

    def _find_line(self, offset: int) -> int:
        """Return the offset of the line break before a character, or -1."""
        return self._tokens.text.rfind("\n", 0, offset)

    @cached_property
    def _byte_offsets(self) -> ByteOffsets:
        return ByteOffsets(self._tokens.text, self._source)

    def report_depth(self, start: int) -> None:
        """Report that the text is nested too deep, and suppress the errors that follow from it."""
        self.report(rules.DEEP, start, limit=MAX_DEPTH)
        # Everything after the limit is unread, and would give errors about closing brackets.
        self._remaining = 0

    def report_faults(self, too_deep: int) -> None:
        """Report the faults of the lexer, and the token that is nested too deep unless it is -1."""
        if too_deep >= 0:
            self.report_depth(self._tokens.starts[too_deep])
        for fault in self._tokens.faults:
            is_unclosed = fault.what in ("comment", "quote", "string")
            rule = rules.UNCLOSED if is_unclosed else rules.CHARACTER
            if is_unclosed:
                self._unclosed_lines.add(self._find_line(fault.start))
            what, advice = _LEXICAL_FAULTS[fault.what]
            written, char = _quote_fault(fault), self._tokens.text[fault.start : fault.start + 1]
            facts = {"what": what.format(written, char=char), "advice": advice.format(written)}
            self.report(rule, fault.start, **facts)

    def report_unexpected(self, index: int, expected: list[str]) -> None:
        """Report a token in a place where only ``expected`` tokens are valid."""
        if index > 1 and self._tokens[index - 2] == "->" and self._tokens[index] in (";", "}"):
            # `a -> b` calls a function with arguments, so that the parser fails behind it.
            self._report_syntax(index - 2, "'then'", hints.ARROW)
            return
        advice = hints.advise_unexpected(self._tokens, index, expected, self.beginnings)
        self._report_syntax(index, _describe_expected(expected, self.beginnings), advice)

    def _report_syntax(self, index: int, expected: str, advice: str) -> None:
        token, start = self._describe_token(index), self._tokens.starts[index]
        self.report(rules.SYNTAX, start, found=token, expected=expected, advice=advice)

    def report_comment(self, index: int) -> None:
        """Report a comment in a place where no comment is valid."""
        self._report_syntax(index, "a note (// or //*)", _COMMENT_ADVICE)

    def report_substitution(self, index: int, substitute: str) -> None:
        """Report a token that is parsed as another one: a keyword as a name, `=` as `:=`."""
        start, word = self._tokens.starts[index], self._tokens[index]
        if substitute == "NAME":
            self.report(rules.KEYWORD, start, word=word, language=_LANGUAGES[self._language])
            return
        advice = f"{hints.INITIAL}: here only '{substitute}' can stand"
        if word == "==":
            advice = f"'==' compares two values; {hints.INITIAL}"
        self._report_syntax(index, f"'{substitute}'", advice)

    def report_misspelt_keyword(self, index: int, keyword: str) -> None:
        """Report a word that is parsed as the keyword that it resembles."""
        start, word = self._tokens.starts[index], self._tokens[index]
        advice = f"'{word}' is not a keyword: did you mean '{keyword}'?"
        self.report(rules.SYNTAX, start, found=f"'{word}'", expected=f"'{keyword}'", advice=advice)

    def report_correction(self, correction: Correction) -> None:
        """Report a token that the parser replaces, removes or lacks, as in ``part a :: A``."""
        self._report_syntax(correction.position, correction.expected, correction.advice)

    def report_missing_after(self, end: int, words: str) -> None:
        """Report a token that is missing after the one that ends at a character of the text."""
        self.report_missing(bisect_left(self._tokens.ends, end) + 1, words)

    def report_missing(self, index: int, words: str) -> None:
        """Report a missing token before ``index``, where the token before it ends."""
        before = self._find_written_before(index)
        end = self._tokens.ends[before]
        text = self._tokens[before]
        found = "the string" if text.startswith('"') else _quote_text(text)
        advice = f"put {words} there"
        if words == "';'":
            hint = hints.advise_missing(self._tokens, before, index, self.beginnings)
            advice = hint or "put ';' there, or a body in braces"
        self.report(rules.MISSING, max(end - 1, 0), missing=words, before=found, advice=advice)

    def _find_written_before(self, index: int) -> int:
        """Return the last token before ``index`` that recovery did not insert."""
        before = index - 1
        while before > 0 and self._tokens.starts[before] == self._tokens.ends[before]:
            before -= 1
        return max(before, 0)

    def report_stray(self, index: int) -> None:
        """Report a superfluous `;` or `}`."""
        expected, advice = "a declaration", "no '{' is open here: one of both is too much"
        if self._tokens[index] == ";":
            expected, advice = "a declaration or '}'", "take it away"
        self._report_syntax(index, expected, advice)

    def report_unclosed(self) -> None:
        """Report, once, the innermost brace that is open at the end of the text."""
        # An open comment contains the rest of the text.
        has_open_comment = any(fault.what == "comment" for fault in self._tokens.faults)
        if self._is_unclosed_reported or has_open_comment or self.is_quiet:
            return
        self._is_unclosed_reported = True
        open_braces: list[int] = []
        for index in range(len(self._tokens.types)):
            symbol = self._tokens[index]
            if symbol == "{":
                open_braces.append(self._tokens.starts[index])
            elif symbol == "}" and open_braces:
                # A `}` further left than its `{` closes an outer body, so that this one is open.
                if self._is_outdented(open_braces[-1], self._tokens.starts[index]):
                    break
                open_braces.pop()
        if open_braces:
            # The innermost open brace is the best guess, as the outer ones may be closed by its
            # `}`.
            advice = "put '}' after the last member of this body"
            self.report(rules.UNCLOSED, open_braces[-1], what="this '{'", advice=advice)

    def _is_outdented(self, opening: int, closing: int) -> bool:
        """Whether a `}` begins a line that is indented less than the line of a `{`."""
        margin = _read_margin(self._tokens.text, closing)
        is_first = margin == _read_line_before(self._tokens.text, closing)
        return is_first and len(margin) < len(_read_margin(self._tokens.text, opening))

    def _describe_token(self, index: int) -> str:
        text = self._tokens[index]
        if not text:
            return "end of file"
        if text.startswith("/*"):
            return "comment"
        if text.startswith('"'):
            return "string"
        token_type = self._tokens.types[index]
        kind = {self._types.name: "name ", self._types.number: "number "}.get(token_type, "")
        return f"{kind}{_quote_text(text)}"


def _read_line_before(text: str, offset: int) -> str:
    """Return the part of a line before a character."""
    return re.split(r"[\r\n]", text[max(0, offset - _MAX_MARGIN) : offset])[-1]


def _read_margin(text: str, offset: int) -> str:
    """Return the blanks at the beginning of the line of a character."""
    line = _read_line_before(text, offset)
    return line[: len(line) - len(line.lstrip())]


def _quote_text(text: str) -> str:
    """Return the text of a token in quotes; a quoted name already has them."""
    return text if text.startswith("'") else f"'{_shorten(text)}'"


def _quote_fault(fault: LexicalFault) -> str:
    text, kind = fault.text or " ", "character " if fault.what == "character" else ""
    if text == "\ufffd":
        return "bytes that are not UTF-8"
    return f"{kind}'{_shorten(text)}'" if text.isprintable() else f"{kind}U+{ord(text[0]):04X}"


def _shorten(text: str) -> str:
    return text if len(text) <= 40 else f"{text[:40]}..."


# -- expected tokens in words --------------------------------------------------------------------

_TERMINALS = {
    "NAME": "a name",
    "STRING": "a string",
    "NUMBER": "a number",
    "BODY": "a comment /* ... */",
    "$END": "end of file",
}
_GROUPS = (
    (
        {"NUMBER", "null"},
        "an expression",
        "NAME STRING NUMBER null true false ( * + - ~ not new all if istype hastype @ as { $",
    ),
    (
        {":>", ":>>"},
        "what it specialises (':', ':>' or ':>>')",
        ": defined typed :> subsets :>> "
        "redefines ::> references => crosses [ ordered nonunique ~ conjugates disjoint unions "
        "intersects differences chains inverse featured specializes",
    ),
    ({"=", ":=", "default"}, "a value ('=')", "= := default"),
    (
        {"+", "xor"},
        "an operator",
        f"{' '.join(PRECEDENCE)} . .? -> # ( [ _INDEX",
    ),
)
"""Tokens that stand for one phrase: those that show its presence, the phrase, all its tokens."""
_SEPARATORS = ("';'", "'{'", "'}'")
_MAX_ALTERNATIVES = 5


def _describe_expected(expected: Collection[str], beginnings: Collection[str]) -> str:
    """Return the tokens that are valid in a place, in words.

    ``expected`` has names of token types and the texts of keywords and symbols. ``beginnings``
    has the tokens with which a member of a body may begin.
    """
    remaining = set(expected)
    phrases = []
    if {"package", "abstract"} <= remaining:
        phrases.append("a declaration")
        remaining -= set(beginnings)
    for required, phrase, group in _GROUPS:
        if required <= remaining:
            phrases.append(phrase)
            remaining -= set(group.split())
    if "NAME" in remaining:
        remaining -= {"$", "<", "~"}
    remaining -= {"_INDEX"} if len(remaining) == 1 else {"_INDEX", "parallel"}
    single = [_TERMINALS.get(name, f"'{name}'") for name in sorted(remaining)]
    return _join_alternatives(sorted(single, key=_rank_phrase) + phrases)


def _rank_phrase(phrase: str) -> tuple[bool, bool, str]:
    return phrase not in _SEPARATORS, not phrase.startswith("a "), phrase


def _join_alternatives(phrases: list[str]) -> str:
    if len(phrases) > _MAX_ALTERNATIVES:
        phrases = [*phrases[: _MAX_ALTERNATIVES - 1], "something else"]
    if len(phrases) < 2:
        return phrases[0] if phrases else "nothing"
    return f"{', '.join(phrases[:-1])} or {phrases[-1]}"
