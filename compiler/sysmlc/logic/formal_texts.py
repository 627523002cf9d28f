"""Readers of formal texts in models: temporal logic with the past, and sentences of patterns.

Sentences are structured English, ``[scope,] pattern`` (after Konrad and Cheng, 2005). Scopes:
globally; before R; after Q; between Q and R; after Q until R. Conditions are formulas about the
present in the neutral form. For formulas that other languages write differently, the advice is the
nearest form that can be read.
"""

import re
from collections.abc import Callable, Collection, Mapping

from msgspec.structs import replace

from sysmlc.ir import Element
from sysmlc.logic import formula as f
from sysmlc.logic import property_patterns as patterns
from sysmlc.logic.contract import Domain
from sysmlc.logic.formula import PAST, Formula, Op, has_future, has_primes
from sysmlc.logic.infix import FormulaReader, Term
from sysmlc.logic.property_patterns import Scope
from sysmlc.logic.sentences import SENTENCE_SYNTAX, WordReader, read_requirement
from sysmlc.logic.syntax import (
    AUTHOR_SYNTAX,
    PAST_WORDS,
    Cursor,
    FormulaError,
    Token,
    line_and_column,
    tokenize,
)
from sysmlc.support.units import list_time_words

_BOUND = "write 'always if P then Q holds within 5 steps' with the language 'pattern'"
_CALLS = (
    (r"(?:done|ended|completed|terminated)\s*\(", "write 'finished(P)' where an action ends"),
    (r"(?:active|executing|performing|runs)\s*\(", "write 'running(P)' while an action runs"),
    (r"(?:received?|accept(?:s|ed)?|occurs|sent)\b", "write 'event=P' for an event that occurs"),
    (r"in\s*\(", "write 'state=P' for an active state"),
)
"""Functions and words of other languages that are about actions, events and states."""
_ADVICE = (
    *_CALLS,
    (r"is\s+always\b", "write 'P always holds'"),
    (r"is\s+never\b", "write 'P never holds'"),
    (r"is\b", "write '=' for 'is'"),
    (r"<(?<==<)", "write '<=' for '=<'"),
    (r"=(?<=/=)", "write '!=' for '/='"),
    (r"[\w.]+\s*<>", "write '!=' for '<>', which means 'eventually'"),
    (r":\s*=|:", "write '=' for ':='"),
    (r"xor\b|\^(?!\s*\d)", "write 'P != Q' for one of two conditions"),
    (r"\^|\[\s*\d|<=?\s*\d+\s+\w", f"write 'X' for each step, or {_BOUND}"),
    (r"within\b", _BOUND),
    (r"be\b", "write 'shall always satisfy P' or 'shall eventually satisfy P'"),
    (r"never\b", "write 'G !(P)'"),
    (r"(?:AG|AF|AX|AU)\b", "formulas are about all runs: write 'G', 'F', 'X' or 'U' without 'A'"),
    (r"(?:EG|EF|EX|EU)\b", "formulas are about all runs: none can say that some run exists"),
    (r"only\b", "write 'P -> Q' for 'P only if Q'"),
    (r"if\b", "write 'P -> Q' for 'if P then Q'"),
    (r"(?:whenever|when|upon)\b", "write 'G (P -> Q)' for 'whenever P, Q'"),
    (r"infinitely\b", "write 'G F P'"),
    (r"unless\b", "write 'P W Q' for 'P unless Q'"),
    (r"before\b", "write 'P precedes Q' with the language 'pattern'"),
    (r"after\b", "write 'after Q, P always holds' with the language 'pattern'"),
    (r"follows\b", "write 'P responds to Q'"),
    (r"between\b", "write 'a <= x & x <= b'"),
    (r"mode\b", "write 'in P mode' at the start of the sentence"),
    (r"(?:else|otherwise)\b", "write '(P -> Q) & (!P -> R)' for 'if P then Q else R'"),
    (r"then\b", "write 'P -> Q' for 'if P then Q'"),
    (r"in\b", "write 'state=A | state=B', one comparison for each value"),
    (r"\?", "write '(P -> Q) & (!P -> R)' for 'P ? Q : R'"),
    (r"(?:forall|exists|∀|∃)", "write the condition once for each part, joined by '&' or '|'"),
    (r"'(?<=\)')", "write 'X (P)' for the next value of a condition"),
    (r";", "remove the ';'"),
    (r"[\"']", "write names and values without quotation marks"),
    (r"\.\s*\d", "write whole numbers, in a smaller unit if need be"),
    (r"<|<=|>|>=|==?", "write 'a < b & b < c' for 'a < b < c'"),
)
"""Regular expressions for the text at a fault, with the advice; the first match counts."""
_ENTRIES = tuple((re.compile(pattern, re.IGNORECASE), advice) for pattern, advice in _ADVICE)


def suggest_form(text: str, offset: int) -> str:
    """Return advice on what is written at the offset of a fault; empty if there is none."""
    return next((advice for pattern, advice in _ENTRIES if pattern.match(text, offset)), "")


def is_foreign_call(text: str, offset: int) -> bool:
    """Whether a function of another language stands at the offset, which is no mistyped name."""
    return any(re.compile(call, re.IGNORECASE).match(text, offset) for call, _ in _CALLS)


# -- readers ---------------------------------------------------------------------------------------


_LANGUAGES = ("ltl", "spin", "promela", "pattern", "fret")
_SENTENCE = re.compile(
    r"\s*globally\s*,|.*\bit\s+is\s+(always|never|eventually)\s+the\s+case\s+that\b",
    re.IGNORECASE | re.DOTALL,
)
"""The start of a sentence that no informal text contains: tools label any prose as English."""
_ENDING = re.compile(
    r"\bholds\s++(at\s++most\s++(once|twice|\d++\s++times)|again\s++and\s++again"
    r"|within\s++\d++\s*+\w++)\s*+\.?\s*+\Z",
    re.IGNORECASE,
)
"""The end of such a sentence."""
_PATTERN_WORD = re.compile(
    r"\b(always|never|eventually|holds|held|responds|precedes)\b", re.IGNORECASE
)
_REQUIREMENT = re.compile(
    r"\bshall(?:\s+the\s+\w+)?(?:\s+|\s*,\s*)(always|never|immediately|eventually|finally|until|before"
    r"|at\s+the\s+(next|last)\s+timepoint"
    rf"|(within|for|after)\s+\d+\s*({'|'.join(list_time_words())}))\b",
    re.IGNORECASE,
)
"""Words that only a structured requirement contains, before the word "satisfy"."""
_SATISFY = re.compile(r"\bsatisfy\b", re.IGNORECASE)
_MAX_TIMES = 32
"""Most phases and steps of a pattern; each needs a history bit."""


def is_formal(language: str, text: str) -> bool:
    """Whether a text in a language is meant as a formula or as a sentence of a pattern.

    Unmistakable sentences count under any name of a language, since tools offer few of them.
    """
    name = language.lower()
    if any(part in name for part in _LANGUAGES):
        return True
    return _is_sentence(text) or _is_requirement(text)


def is_formal_constraint(constraint: Element) -> bool:
    """Whether the text of a constraint is meant as a formula or as a sentence of a pattern."""
    language, body = (str(constraint.attrs.get(key, "")) for key in ("language", "body"))
    return is_formal(language, body)


def _is_sentence(text: str) -> bool:
    """Whether a text is a sentence of a pattern that no informal text resembles."""
    return _SENTENCE.match(text) is not None or _ENDING.search(text) is not None


def has_pattern_word(text: str) -> bool:
    """Whether a text may be a sentence of a pattern, if its other words are conditions."""
    return _PATTERN_WORD.search(text) is not None


def _is_requirement(text: str) -> bool:
    """Whether a text in English is a structured requirement."""
    # Two searches take linear time; one expression for both searches the rest at each "shall".
    start = _REQUIREMENT.search(text)
    return start is not None and _SATISFY.search(text, start.end()) is not None


def read_formal(
    text: str,
    language: str,
    variables: Mapping[str, Domain],
    components: Collection[str] = (),
    tick_seconds: float = 1.0,
) -> Formula:
    """Return the formula of a formal text; it may have operators of the past.

    *components* are names of the component, which a structured requirement states, and
    *tick_seconds* is the length of a step, for durations in a structured requirement. Raises
    FormulaError, which ``describe_error`` shows with its location.
    """
    if not text.strip():
        raise FormulaError("it is empty", 0)
    name = language.lower()
    is_requirement = _is_requirement(text) or ("fret" in name and not _is_sentence(text))
    if is_requirement and "pattern" not in name:
        return read_requirement(text, variables, components, tick_seconds)
    if "pattern" in name or _is_sentence(text):
        return read_sentence(text, variables, tick_seconds)
    return read_temporal_logic(text, variables)


def describe_error(error: FormulaError, text: str) -> str:
    """Return the message of an error with its column, and with its line in a longer text."""
    if not text.strip():
        return str(error)
    reason = str(error)
    if is_foreign_call(text, error.offset):
        reason = reason.partition("; ")[0]
    advice = "" if "; " in reason else suggest_form(text, error.offset)
    reason = f"{reason}; {advice}" if advice else reason
    line, column = line_and_column(text, error.offset)
    location = f"line {line}, column {column}" if "\n" in text.strip() else f"column {column}"
    return f"{reason} ({location})"


# -- temporal logic ------------------------------------------------------------------------------

_TEMPORAL_WORDS = {"always": Op.ALWAYS, "eventually": Op.EVENTUALLY, "next": Op.NEXT}
_TEMPORAL_SIGNS = {"□": Op.ALWAYS, "◇": Op.EVENTUALLY, "○": Op.NEXT}
_TEMPORAL_SYNTAX = replace(
    AUTHOR_SYNTAX,
    prefix={**AUTHOR_SYNTAX.prefix, **PAST_WORDS, **_TEMPORAL_WORDS, **_TEMPORAL_SIGNS},
    infix={**AUTHOR_SYNTAX.infix, "S": Op.SINCE, "until": Op.UNTIL, "since": Op.SINCE},
)


def read_temporal_logic(text: str, variables: Mapping[str, Domain]) -> Formula:
    """Return the formula of a text in the neutral form with Y, O, H and S. Raises FormulaError."""
    reader = _TemporalReader(Cursor(tokenize(text, _TEMPORAL_SYNTAX)), _TEMPORAL_SYNTAX, variables)
    formula = reader.read_formula()
    reader.cursor.expect_end()
    return formula


class _TemporalReader(FormulaReader):
    """Reader that rejects operators of the past whose operands are about the future."""

    def _read_prefix(self, op: Op, min_precedence: int) -> Term:
        word, is_bracketed = self.cursor.next, self.cursor.after_next.text in self._syntax.brackets
        term = self._check_past(op, super()._read_prefix(op, min_precedence))
        if word.text.lower() in _TEMPORAL_WORDS:
            self._check_extent(word, is_bracketed)
        return term

    def _check_extent(self, word: Token, is_bracketed: bool) -> None:
        """Reject ``always p implies q``, which formulas and English read differently."""
        follower = self._peek_operator(0)
        if follower is None or (is_bracketed and follower not in (Op.IMPLIES, Op.IFF)):
            return
        sign = self.cursor.next.text
        reason = f"it is not clear how far '{word.text}' reaches"
        advice = f"write '{word.text} (P {sign} Q)' or '({word.text} P) {sign} Q'"
        raise FormulaError(f"{reason}; {advice}", word.offset)

    def _read_infix(self, op: Op, left: Term) -> Term:
        return self._check_past(op, super()._read_infix(op, left))

    def _check_past(self, op: Op, term: Term) -> Term:
        args = getattr(term.formula, "args", ())
        if op in PAST and any(has_future(arg) or has_primes(arg) for arg in args):
            raise FormulaError(
                f"'{op}' cannot be applied to a formula about the future", term.offset
            )
        return term


# -- sentences -----------------------------------------------------------------------------------

_ENDINGS: dict[str, Callable[[Scope, Formula], Formula]] = {
    "always holds": patterns.universality,
    "never holds": patterns.absence,
    "eventually holds": patterns.existence,
    "holds again and again": lambda scope, wanted: patterns.response(scope, f.TRUE, wanted),
}


def read_sentence(text: str, variables: Mapping[str, Domain], tick_seconds: float = 1.0) -> Formula:
    """Return the formula of a sentence. Raises FormulaError with the offset of the fault."""
    reader = _PatternReader(Cursor(tokenize(text, SENTENCE_SYNTAX)), variables, tick_seconds)
    formula = reader.read()
    reader.read_end()
    return formula


class _PatternReader(WordReader):
    """Recursive-descent reader of ``[scope,] pattern``."""

    def read(self) -> Formula:
        scope = self._read_scope()
        if self._accept("it", "is"):
            adverb = self._expect_one_of("always", "never", "eventually")
            self._expect("the", "case", "that")
            return self._read_after_adverb(scope, adverb)
        for adverb in ("always", "never", "eventually"):
            if self._accept(adverb):
                return self._read_after_adverb(scope, adverb)
        if self._accept("if"):
            return self._read_implication(scope)
        return self._read_condition_first(scope)

    def _read_scope(self) -> Scope:
        if self._accept("globally"):
            scope = Scope("globally")
        elif self._accept("before"):
            scope = Scope("before", end=self._read_condition())
        elif self._accept("between"):
            self._conditions.is_before_and = True
            start = self._read_condition()
            self._conditions.is_before_and = False
            self._expect("and")
            scope = Scope("between", start, self._read_condition())
        elif self._accept("after"):
            start = self._read_condition()
            if self._accept("until"):
                scope = Scope("until", start, self._read_condition())
            else:
                scope = Scope("after", start)
        else:
            # Only a stated scope may be followed by a comma.
            return Scope("globally")
        self._cursor.accept(",")
        return scope

    def _read_after_adverb(self, scope: Scope, adverb: str) -> Formula:
        """Read ``always|never|eventually P [holds]``, ``always if ...``, or ``always P again and
        again``.
        """
        if self._accept("if"):
            if adverb != "always":
                self._fail("'if' follows 'always' only; a condition")
            return self._read_implication(scope)
        condition = self._read_condition()
        self._accept("holds")
        if adverb == "always" and self._accept("again", "and", "again"):
            return patterns.response(scope, f.TRUE, condition)
        return _ENDINGS[f"{adverb} holds"](scope, condition)

    def _read_implication(self, scope: Scope) -> Formula:
        """Read ``P [holds][,] [then] ...`` after the word ``if``."""
        trigger = self._read_condition()
        self._accept("holds")
        self._cursor.accept(",")
        self._accept("then")
        if self._accept("previously"):
            return patterns.precedence(scope, self._read_held_condition(), trigger)
        if self._accept("eventually"):
            return patterns.response(scope, trigger, self._read_held_condition())
        return self._read_consequence(scope, trigger, self._read_condition())

    def _read_consequence(self, scope: Scope, trigger: Formula, answer: Formula) -> Formula:
        """Read the words after the second condition, which select the pattern."""
        if self._accept("previously", "held"):
            return patterns.precedence(scope, answer, trigger)
        if self._accept("eventually", "holds") or self._accept("holds", "eventually"):
            return patterns.response(scope, trigger, answer)
        if self._accept("holds", "within"):
            steps = self._read_duration(_MAX_TIMES)
            return patterns.bounded_response(scope, trigger, answer, steps)
        self._accept("holds")
        if self._cursor.is_at_end or self._cursor.is_next("."):
            return patterns.universality(scope, f.implies(trigger, answer))
        return self._fail("'eventually holds', 'previously held' or 'holds within N steps'")

    def _read_condition_first(self, scope: Scope) -> Formula:
        """Read a sentence that begins with a condition: ``P responds to Q``, ``P always holds``."""
        condition = self._read_condition()
        for words, make_pattern in _ENDINGS.items():
            if self._accept(*words.split()):
                return make_pattern(scope, condition)
        if self._accept("responds", "to"):
            return patterns.response(scope, self._read_condition(), condition)
        if self._accept("precedes"):
            return patterns.precedence(scope, condition, self._read_condition())
        if self._accept("holds", "at", "most"):
            return patterns.bounded_existence(scope, condition, self._read_times())
        endings = "', '".join([*_ENDINGS, "responds to", "precedes"])
        return self._fail(f"'{endings}' or 'holds at most N times'")

    def _read_held_condition(self) -> Formula:
        """Read ``P [holds|held]``."""
        condition = self._read_condition()
        if not self._accept("holds"):
            self._accept("held")
        return condition

    def _read_times(self) -> int:
        """Read ``once``, ``twice`` or ``3 times``."""
        for number, word in ((1, "once"), (2, "twice")):
            if self._accept(word):
                return number
        return self._read_count(_MAX_TIMES, "times", "time")
