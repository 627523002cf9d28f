"""Property patterns in structured English: ``[scope,] pattern`` (after Konrad and Cheng, 2005).

Scopes: globally; before R; after Q; between Q and R; after Q until R. Conditions are formulas in
the neutral form about the present.
"""

from collections.abc import Callable, Mapping
from typing import NoReturn

from msgspec.structs import replace

from sysmlc.logic import formula as f
from sysmlc.logic.contract import Domain
from sysmlc.logic.formula import Apply, Formula
from sysmlc.logic.infix import Reader
from sysmlc.logic.spelling import NEUTRAL, TEMPORAL, Cursor, FormulaError, tokens
from sysmlc.logic.texts import patterns
from sysmlc.logic.texts.patterns import Scope

SYNTAX = replace(NEUTRAL, signs=(",", "."))
MOST_TIMES = 32
"""Phases that a bounded existence counts, one history bit each."""


def read_sentence(text: str, variables: Mapping[str, Domain]) -> Formula:
    """The formula that a sentence says. Raises FormulaError, which knows the place."""
    cursor = Cursor(tokens(text, SYNTAX))
    found = _Sentence(cursor, variables).formula()
    cursor.took(".")
    if cursor.next.kind != "end":
        cursor.fail("the end of the sentence is expected")
    return found


class _Sentence:
    """Reads a sentence: ``[scope,] pattern``."""

    def __init__(self, cursor: Cursor, variables: Mapping[str, Domain]) -> None:
        self._cursor = cursor
        self._reader = _Condition(cursor, SYNTAX, variables)

    def formula(self) -> Formula:
        scope = self._scope()
        if self._words("it", "is"):
            word = self._one_of("always", "never", "eventually")
            self._need("the", "case", "that")
            return self._of_word(scope, word)
        for word in ("always", "never", "eventually"):
            if self._words(word):
                return self._of_word(scope, word)
        return self._about(scope)

    def _scope(self) -> Scope:
        if self._words("globally"):
            return self._comma(Scope("globally"))
        if self._words("before"):
            return self._comma(Scope("before", end=self._condition()))
        if self._words("between"):
            start = self._condition()
            self._need("and")
            return self._comma(Scope("between", start, self._condition()))
        if not self._words("after"):
            return Scope("globally")
        start = self._condition()
        if not self._words("until"):
            return self._comma(Scope("after", start))
        return self._comma(Scope("until", start, self._condition()))

    def _comma(self, scope: Scope) -> Scope:
        self._cursor.took(",")
        return scope

    def _of_word(self, scope: Scope, word: str) -> Formula:
        if self._words("if"):
            if word != "always":
                self._fail("'if' follows 'always' only; a condition")
            return self._if(scope)
        condition = self._condition()
        self._words("holds")
        if word == "always" and self._words("again", "and", "again"):
            return patterns.response(scope, f.TRUE, condition)
        return _ENDINGS[f"{word} holds"](scope, condition)

    def _if(self, scope: Scope) -> Formula:
        trigger = self._condition()
        self._words("holds")
        self._cursor.took(",")
        self._words("then")
        if self._words("previously"):
            return patterns.precedence(scope, self._held(), trigger)
        if self._words("eventually"):
            return patterns.response(scope, trigger, self._held())
        return self._answered(scope, trigger, self._condition())

    def _answered(self, scope: Scope, trigger: Formula, answer: Formula) -> Formula:
        if self._words("previously", "held"):
            return patterns.precedence(scope, answer, trigger)
        if self._words("eventually", "holds") or self._words("holds", "eventually"):
            return patterns.response(scope, trigger, answer)
        if self._words("holds", "within"):
            steps = self._number("steps", "step")
            return patterns.within_steps(scope, trigger, answer, steps)
        self._words("holds")
        if self._cursor.next.kind == "end" or self._cursor.has("."):
            return patterns.universality(scope, f.implies(trigger, answer))
        return self._fail("'eventually holds', 'previously held' or 'holds within N steps'")

    def _held(self) -> Formula:
        condition = self._condition()
        if not self._words("holds"):
            self._words("held")
        return condition

    def _about(self, scope: Scope) -> Formula:
        """Sentences that begin with a condition."""
        first = self._condition()
        for words, make in _ENDINGS.items():
            if self._words(*words.split()):
                return make(scope, first)
        if self._words("responds", "to"):
            return patterns.response(scope, self._condition(), first)
        if self._words("precedes"):
            return patterns.precedence(scope, first, self._condition())
        if self._words("holds", "at", "most"):
            return patterns.bounded_existence(scope, first, self._number("times", "time"))
        endings = "', '".join([*_ENDINGS, "responds to", "precedes"])
        return self._fail(f"'{endings}' or 'holds at most N times'")

    def _fail(self, wanted: str) -> NoReturn:
        self._cursor.fail(f"{wanted} is expected")

    def _condition(self) -> Formula:
        return self._reader.formula()

    def _number(self, *units: str) -> int:
        words = {"once": 1, "twice": 2}
        token = self._cursor.next
        if token.text.lower() in words:
            self._cursor.take()
            return words[token.text.lower()]
        number = self._cursor.integer()
        if not 0 <= number <= MOST_TIMES:
            raise FormulaError(f"a number from 0 to {MOST_TIMES} is expected", token.at)
        self._one_of(*units)
        return number

    def _one_of(self, *words: str) -> str:
        for word in words:
            if self._words(word):
                return word
        return self._fail(" or ".join(f"'{word}'" for word in words))

    def _need(self, *words: str) -> None:
        for word in words:
            self._one_of(word)

    def _words(self, *words: str) -> bool:
        """Whether the words come next, in any case of letters; then they are read."""
        start = self._cursor.mark()
        for word in words:
            if self._cursor.next.text.lower() != word:
                self._cursor.back_to(start)
                return False
            self._cursor.take()
        return True


class _Condition(Reader):
    """Conditions about the present: no temporal operators, no primes."""

    def formula(self, weakest: int = 0) -> Formula:
        at = self.cursor.next.at
        made = super().formula(weakest)
        if any(variable.primed for variable in f.variables(made)) or _is_temporal(made):
            raise FormulaError("a condition of a pattern is about the present", at)
        return made


def _is_temporal(formula: Formula) -> bool:
    if not isinstance(formula, Apply):
        return False
    return formula.op in TEMPORAL or any(map(_is_temporal, formula.args))


_ENDINGS: dict[str, Callable[[Scope, Formula], Formula]] = {
    "always holds": patterns.universality,
    "never holds": patterns.absence,
    "eventually holds": patterns.existence,
    "holds again and again": lambda scope, wanted: patterns.response(scope, f.TRUE, wanted),
}
