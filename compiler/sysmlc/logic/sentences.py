"""Reader of structured requirement sentences, and what it shares with other sentences in English.

``structured_sentences`` states the grammar and the meaning. Conditions are formulas about the
present in the neutral form.
"""

from collections.abc import Collection, Mapping
from typing import NoReturn

from msgspec.structs import replace

from sysmlc.logic import domains
from sysmlc.logic import formula as f
from sysmlc.logic.contract import Domain, EnumerationDomain
from sysmlc.logic.formula import Formula, Op, has_future, has_primes
from sysmlc.logic.infix import BOOLEAN, FormulaReader, Term
from sysmlc.logic.structured_sentences import (
    Sentence,
    Timing,
    find_inside,
    formalize,
    formalize_occurred,
    formalize_persisted,
)
from sysmlc.logic.syntax import AUTHOR_SYNTAX, Cursor, FormulaError, Token, tokenize
from sysmlc.support.suggestions import find_similar
from sysmlc.support.units import Duration, find_time_unit

SENTENCE_SYNTAX = replace(AUTHOR_SYNTAX, signs=(",", "."))


QUALIFIERS = ("when", "if", "upon", "where", "whenever", "unless")
"""Words in front of the condition of a structured requirement."""
MAX_STEPS = 64
"""Most steps of a duration; the formula has an X or a Y for each."""
_MAX_DURATION = 10**9
_PREDICATES = {"persisted": formalize_persisted, "occurred": formalize_occurred}
_NO_PREDICATES = {
    "persists": "write a timing, 'for 3 ticks', or persisted(3, p) about the past",
    "occurs": "write a timing, 'within 3 ticks', or occurred(3, p) about the past",
    "prebool": "write the requirement in LTL, where Y p is p one step ago",
    "preint": "write the requirement in LTL, with the next value x'",
    "prereal": "write the requirement in LTL, with the next value x'",
}
"""Predicates of FRET that are not read, in small letters, with advice."""


class ConditionReader(FormulaReader):
    """Reader of conditions about the present: no temporal operators, no primes.

    In a structured requirement, ``inside`` is the condition that a step is in its scope:
    ``persisted`` and ``occurred`` do not look farther back. In other sentences it is None.
    """

    inside: Formula | None = None
    is_before_and = False
    """Whether ``and`` outside of brackets ends the condition, as in ``between P and Q``."""

    def _peek_operator(self, min_precedence: int) -> Op | None:
        token, follower = self.cursor.next, self.cursor.after_next
        if token.kind == "name" and follower.text.lower() in QUALIFIERS:
            return None  # when P and if Q
        if self.is_before_and and token.text.lower() == "and":
            return None
        return super()._peek_operator(min_precedence)

    def _read_brackets(self) -> Term:
        is_before_and, self.is_before_and = self.is_before_and, False
        term = super()._read_brackets()
        self.is_before_and = is_before_and
        return term

    def resolve_name(self, token: Token) -> Term:
        if self.inside is None or not self.cursor.is_next("("):
            return super().resolve_name(token)
        if token.text.lower() in _NO_PREDICATES:
            advice = _NO_PREDICATES[token.text.lower()]
            raise FormulaError(f"'{token.text}' cannot be read: {advice}", token.offset)
        predicate = _PREDICATES.get(token.text.lower())
        if predicate is None:
            return super().resolve_name(token)
        self.cursor.expect("(")
        steps = read_number(self.cursor, MAX_STEPS)
        self.cursor.expect(",")
        condition = self.read_formula()
        self.cursor.expect(")")
        return Term(predicate(steps, condition, self.inside), BOOLEAN, token.offset)

    def read_formula(self, min_precedence: int = 0) -> Formula:
        offset = self.cursor.next.offset
        formula = super().read_formula(min_precedence)
        if has_primes(formula) or has_future(formula):
            reason = "a condition of a sentence is about the present"
            advice = "write G, F, X, U and x' with the language 'ltl'"
            raise FormulaError(f"{reason}; {advice}", offset)
        return formula


def read_number(cursor: Cursor, largest: int) -> int:
    """Read a number from 0 to *largest*. Raises FormulaError."""
    token = cursor.next
    number = cursor.read_integer()
    if not 0 <= number <= largest:
        raise FormulaError(f"a number from 0 to {largest} is expected", token.offset)
    return number


class WordReader:
    """Reads words in any letter case, and conditions, from a cursor."""

    def __init__(
        self, cursor: Cursor, variables: Mapping[str, Domain], tick_seconds: float = 1.0
    ) -> None:
        self._cursor = cursor
        self._variables = variables
        self._tick_seconds = tick_seconds
        self._conditions = ConditionReader(cursor, SENTENCE_SYNTAX, variables)

    def read_end(self) -> None:
        """Read the optional full stop. Raises FormulaError if the text goes on."""
        has_stop = self._cursor.accept(".")
        if has_stop and not self._cursor.is_at_end:
            advice = "a formula is one sentence; write the next in a constraint of its own"
            raise FormulaError(advice, self._cursor.next.offset)
        if not self._cursor.is_at_end:
            self._cursor.fail("the end of the sentence is expected")

    def _read_condition(self) -> Formula:
        return self._conditions.read_formula()

    def _read_count(self, largest: int, *units: str) -> int:
        """Read a number from 0 to *largest* and one of the *units*."""
        number = read_number(self._cursor, largest)
        self._expect_one_of(*units)
        return number

    def _read_duration(self, most_steps: int = MAX_STEPS) -> int:
        """Read a number and a unit of time; return the number of steps."""
        start = self._cursor.next.offset
        number = read_number(self._cursor, _MAX_DURATION)
        steps = self._count_steps(number, start)
        if steps > most_steps:
            reason = f"a duration has at most {most_steps} steps of {self._tick_seconds:g} s"
            raise FormulaError(f"{reason}, not {steps}; increase tick_seconds", start)
        return steps

    def _count_steps(self, number: int, start: int) -> int:
        """Read a unit; return the number of steps in *number* of these units."""
        token = self._cursor.next
        unit = find_time_unit(token.text)
        if unit is None:
            self._fail("a unit of time such as 'ticks', 'ms', 'seconds' or 'minutes'")
        self._cursor.take()
        steps = Duration(str(number), unit).count_steps(self._tick_seconds)
        if steps.denominator != 1:
            reason = (
                f"{number} {token.text} are no whole number of steps of {self._tick_seconds:g} s: "
                "write ticks, or change tick_seconds"
            )
            raise FormulaError(reason, start)
        return int(steps)

    def _expect(self, *words: str) -> None:
        for word in words:
            self._expect_one_of(word)

    def _expect_one_of(self, *words: str) -> str:
        for word in words:
            if self._accept(word):
                return word
        return self._fail(" or ".join(f"'{word}'" for word in words))

    def _accept(self, *words: str) -> bool:
        """Consume the words if they come next, in any letter case; return whether they do."""
        start = self._cursor.mark()
        for word in words:
            if self._cursor.next.text.lower() != word:
                self._cursor.reset(start)
                return False
            self._cursor.take()
        return True

    def _fail(self, expected: str) -> NoReturn:
        self._cursor.fail(f"{expected} is expected")


# -- structured requirements -----------------------------------------------------------------------

_SCOPES = ("in", "during", "while", "before", "after", "only", "except", "not")
_TIMINGS = {
    "immediately": "immediately",
    "initially": "immediately",
    "at the first timepoint": "immediately",
    "at the same timepoint": "immediately",
    "at the next timepoint": "next",
    "at the next step": "next",
    "eventually": "eventually",
    "always": "always",
    "never": "never",
    "finally": "finally",
    "at the last timepoint": "finally",
}
_TIMING_WORDS = (*_TIMINGS, "within", "for", "after", "until", "before")


def read_requirement(
    text: str,
    variables: Mapping[str, Domain],
    components: Collection[str] = (),
    tick_seconds: float = 1.0,
) -> Formula:
    """Return the formula of a structured requirement, which may have operators of the past.

    *components* are the names that the component may have; if it is empty, any name is accepted.
    *tick_seconds* is the length of a step. Raises FormulaError with the offset of the fault.
    """
    cursor = Cursor(tokenize(text, SENTENCE_SYNTAX))
    reader = _RequirementReader(cursor, variables, tick_seconds)
    sentence = reader.read(components)
    reader.read_end()
    return formalize(sentence)


class _RequirementReader(WordReader):
    """Recursive-descent reader of ``[scope] [condition] [the] COMPONENT shall [timing] response``.

    In sentences with "only", the component may follow "shall".
    """

    def read(self, components: Collection[str]) -> Sentence:
        scope, mode = self._read_scope()
        restriction: Formula = f.TRUE
        self._cursor.accept(",")
        if scope and self._accept("while"):
            restriction = self._read_mode()
            self._cursor.accept(",")
        self._accept("and")
        self._conditions.inside = find_inside(scope, mode, restriction)
        condition, is_continual = self._read_conditions()
        if self._accept("shall"):
            self._read_component(components)
        else:
            self._read_component(components)
            self._expect("shall")
        self._cursor.accept(",")
        offset = self._cursor.next.offset
        timing = self._read_timing()
        may_end = scope not in ("", "after", "only before") or restriction != f.TRUE
        if timing.kind == "finally" and not may_end:
            reason = "the scope has no last step: add one that ends, such as 'in m' or 'before m'"
            raise FormulaError(reason, offset)
        self._cursor.accept(",")
        self._accept("satisfy")
        response = self._read_response()
        return Sentence(response, timing, scope, mode, restriction, condition, is_continual)

    # -- scope -------------------------------------------------------------------------------------

    def _read_scope(self) -> tuple[str, Formula]:
        if self._accept("only"):
            kind = self._read_scope_word()
            return f"only {kind}", self._read_mode()
        if self._accept("except") or self._accept("unless", "in"):
            self._read_inside_words()
            return "notin", self._read_mode()
        for words in ("not in", "when not in", "if not in"):
            if self._accept(*words.split()):
                return "notin", self._read_mode()
        if self._cursor.next.text.lower() in ("before", "after"):
            return self._cursor.take().text.lower(), self._read_mode()
        return ("in", self._read_mode()) if self._read_inside_words() else ("", f.TRUE)

    def _read_scope_word(self) -> str:
        for word in ("before", "after"):
            if self._accept(word):
                return word
        if not self._read_inside_words():
            self._fail("'in', 'during', 'while', 'before' or 'after'")
        return "in"

    def _read_inside_words(self) -> bool:
        return any(
            self._accept(*words.split()) for words in ("in", "during", "while", "when in", "if in")
        )

    def _read_mode(self) -> Formula:
        """Read a condition, or a state as in ``mode Busy`` or ``Busy mode``."""
        has_word = self._accept("mode")
        token = self._cursor.next
        is_state = has_word or self._cursor.after_next.text.lower() == "mode"
        if is_state and token.kind == "name" and token.text not in self._variables:
            self._cursor.take()
            mode = self._find_state(token.text, token.offset)
        else:
            mode = self._read_condition()
        self._accept("mode")
        return mode

    def _find_state(self, state: str, offset: int) -> Formula:
        """Return the condition that the only variable with the value *state* has it."""
        names = [
            name
            for name, domain in self._variables.items()
            if isinstance(domain, EnumerationDomain) and state in domain.literals
        ]
        if not names:
            raise FormulaError(f"'{state}' is neither a state nor a variable", offset)
        if len(names) > 1:
            choices = " or ".join(f"{name}={state}" for name in names)
            raise FormulaError(f"'{state}' is ambiguous: write {choices}", offset)
        return f.eq(f.var(names[0]), f.const(state))

    # -- conditions --------------------------------------------------------------------------------

    def _read_conditions(self) -> tuple[Formula | None, bool]:
        """Return the condition, None without one, and whether it triggers in each step."""
        word = self._cursor.next.text.lower()
        if word not in QUALIFIERS:
            return None, False
        condition = self._read_qualified_condition()
        while True:
            start = self._cursor.mark()
            self._cursor.accept(",")
            joins = f.either if self._accept("or") else f.both
            if joins is f.both:
                self._accept("and")
            if self._cursor.next.text.lower() not in QUALIFIERS:
                self._cursor.reset(start)
                break
            self._check_qualifier(word)
            condition = joins(condition, self._read_qualified_condition())
        self._cursor.accept(",")
        self._accept("then")
        return condition, word == "whenever"

    def _check_qualifier(self, first: str) -> None:
        token = self._cursor.next
        is_mixed = (token.text.lower() == "whenever") != (first == "whenever")
        if is_mixed and token.text.lower() != "unless":
            reason = f"'{token.text}' cannot follow a condition with '{first}'"
            raise FormulaError(reason, token.offset)

    def _read_qualified_condition(self) -> Formula:
        """Read ``when P [is true|false]``, or ``unless P`` for the negation."""
        is_negated = self._cursor.take().text.lower() == "unless"
        condition = self._read_condition()
        if self._accept("is"):
            is_negated ^= self._expect_one_of("true", "false") == "false"
        return f.negate(condition) if is_negated else condition

    # -- component, timing, response ---------------------------------------------------------------

    def _read_component(self, components: Collection[str]) -> None:
        """Read the name of the component, which may have several words.

        Without known names, it extends to the next word that a sentence has after it.
        """
        self._accept("the")
        first, start = self._cursor.next, self._cursor.mark()
        names, words, end = {*map(_fold, components)}, "", start
        longest = max(map(len, names), default=0)
        while self._cursor.next.kind == "name" and not self._is_after_component():
            word = self._cursor.take().text
            # Longer texts are no names; to join all words would take quadratic time.
            words += _fold(word) if len(words) <= longest else ""
            if words in names or not names:
                end = self._cursor.mark()
        self._cursor.reset(end)
        if end == start:
            self._raise_no_component(components, first)

    def _is_after_component(self) -> bool:
        return self._cursor.next.text.lower() == "shall" or self._starts_timing()

    def _raise_no_component(self, components: Collection[str], token: Token) -> NoReturn:
        """Raise an error about *token*, where a scope, a condition or the component is expected."""
        names = " or ".join(f"'{name}'" for name in dict.fromkeys(components))
        expected = f"the component {names}".strip()
        similar = find_similar(token.text, (*QUALIFIERS, *_SCOPES, *components))
        advice = f" (did you mean '{similar}'?)" if similar else ""
        actual = f"'{token.text}'" if token.kind != "end" else "the end"
        reason = f"{expected} is expected before 'shall', not {actual}{advice}"
        raise FormulaError(reason, token.offset)

    def _starts_timing(self) -> bool:
        words = {words.split()[0] for words in _TIMING_WORDS}
        return self._cursor.next.text.lower() in {*words, "satisfy", ","}

    def _read_timing(self) -> Timing:
        for words, kind in _TIMINGS.items():
            if self._accept(*words.split()):
                return Timing(kind)
        for kind in ("within", "for", "after"):
            if self._accept(kind):
                return Timing(kind, self._read_duration())
        for kind in ("until", "before"):
            if self._accept(kind):
                return Timing(kind, stop=self._read_condition())
        if self._cursor.next.text.lower() == "at":
            self._fail("'at the next timepoint' or 'at the last timepoint'")
        token = self._cursor.next
        similar = find_similar(token.text, (*_TIMING_WORDS, "satisfy"))
        is_value = any(domains.contains(domain, token.text) for domain in self._variables.values())
        if similar and token.text not in (similar, *self._variables) and not is_value:
            self._fail(f"'{similar}' or a condition")
        return Timing()

    def _read_response(self) -> Formula:
        """Read a condition, or ``if P then Q``."""
        if not self._accept("if"):
            return self._read_condition()
        condition = self._read_condition()
        self._expect("then")
        return f.implies(condition, self._read_condition())


def _fold(name: str) -> str:
    """Return the letters and digits of a name in lower case: "Bay Gate" denotes ``BayGate``."""
    return "".join(filter(str.isalnum, name)).casefold()
