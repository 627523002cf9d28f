"""Structured requirements; a direct evaluation of their intervals on infinite runs is the judge."""

import itertools
import random

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from long_runs import examples
from sysmlc.logic import formula as f
from sysmlc.logic.contract import BooleanDomain, EnumerationDomain, IntegerDomain
from sysmlc.logic.evaluate import evaluate_on_lasso, is_true
from sysmlc.logic.formal_texts import is_formal
from sysmlc.logic.formula import PAST, Apply, Op
from sysmlc.logic.printing import print_formula
from sysmlc.logic.reduction.formula_reduction import reduce_formula
from sysmlc.logic.reduction.history import History
from sysmlc.logic.sentences import read_requirement
from sysmlc.logic.syntax import FormulaError, line_and_column

BOOLEANS = "mwcrs"
"""Mode, restriction of the scope, condition, response, stop condition."""
DOMAINS = {
    **{name: BooleanDomain() for name in BOOLEANS},
    "n": IntegerDomain(0, 3),
    "state": EnumerationDomain(("Open", "Closed")),
}
SCOPES = {
    "": "",
    "in": "in m, ",
    "notin": "when not in m, ",
    "before": "before m, ",
    "after": "after m, ",
    "only in": "only in m, ",
    "only before": "only before m, ",
    "only after": "only after m, ",
}
CONDITIONS = {"null": "", "upon": "upon c, ", "whenever": "whenever c, ", "unless": "unless c, "}
TIMINGS = {
    "immediately": "immediately",
    "next": "at the next timepoint",
    "eventually": "",
    "always": "always",
    "never": "never",
    "within": "within {n} ticks",
    "for": "for {n} ticks",
    "after": "after {n} ticks",
    "until": "until s",
    "before": "before s",
    "finally": "finally",
}
NEVER_ENDING = ("", "after", "only before")
"""Scopes without a last step, in which 'finally' has no meaning."""


# -- the meaning of a sentence on a run ------------------------------------------------------------


class Run:
    """An infinite run: *steps*, of which those from *loop* on are repeated for ever."""

    def __init__(self, steps, loop):
        self.steps, self.loop = steps, loop
        period = len(steps) - loop
        # Four rounds of the loop contain each trigger, and each answer within the fifth.
        self.triggers = range(len(steps) + 3 * period)
        self.horizon = len(steps) + 6 * period + 8

    def is_true(self, name, step):
        period = len(self.steps) - self.loop
        index = step if step < len(self.steps) else self.loop + (step - self.loop) % period
        return self.steps[index][name]

    def list_intervals(self, holds):
        """Return first and last step of each maximal interval; the last is None without an end."""
        steps = [index for index in range(self.horizon) if holds(index)]
        starts = [index for index in steps if index == 0 or not holds(index - 1)]
        intervals = []
        for start in starts:
            end = start
            while end < self.horizon and holds(end):
                end += 1
            intervals.append((start, None if end == self.horizon else end - 1))
        return intervals


def list_scope_intervals(run, scope, has_restriction):
    """Return the intervals in which a sentence is examined; FRET's definition of the scopes."""
    modes = run.list_intervals(lambda step: run.is_true("m", step))
    first, last = modes[0] if modes else (None, None)
    selections = {
        "": lambda step: True,
        "in": lambda step: any(a <= step and (b is None or step <= b) for a, b in modes),
        "before": lambda step: first is None or step < first,
        "after": lambda step: last is not None and step > last,
    }
    kind = scope.removeprefix("only ")
    if kind == "notin":
        selected = lambda step: not selections["in"](step)  # noqa: E731
    elif kind != scope:
        selected = lambda step: not selections[kind](step)  # noqa: E731
    else:
        selected = selections[kind]
    if not has_restriction:
        return run.list_intervals(selected)
    return run.list_intervals(lambda step: selected(step) and run.is_true("w", step))


def list_triggers(run, interval, condition):
    start, end = interval
    stop = run.horizon if end is None else end + 1
    steps = [step for step in range(start, stop) if step in run.triggers]
    if condition == "null":
        return [start]
    holds = lambda step: run.is_true("c", step) != (condition == "unless")  # noqa: E731
    if condition == "whenever":
        return [step for step in steps if holds(step)]
    return [step for step in steps if holds(step) and (step == start or not holds(step - 1))]


def is_response_due(run, trigger, last, timing, n, is_negated):
    """Whether the response comes as the timing demands from *trigger* to the end of the interval.

    With *is_negated* whether it does not; the truth is None if the interval is too short to tell.
    """
    end = run.horizon if last is None else last + 1
    interval = range(trigger, end)
    response = lambda step: run.is_true("r", step)  # noqa: E731
    stops = [step for step in interval if run.is_true("s", step)]
    window = [step for step in interval if step <= trigger + n]
    is_complete = len(window) == n + 1
    match timing:
        case "immediately":
            truth = response(trigger)
        case "next":
            truth = response(trigger + 1) if trigger + 1 in interval else None
        case "eventually":
            truth = any(map(response, interval))
        case "always":
            truth = all(map(response, interval))
        case "never":
            truth = not any(map(response, interval))
        case "within":
            truth = any(map(response, window))
            truth = truth if is_complete or is_negated else None
        case "for":
            truth = all(map(response, window))
            truth = truth if is_complete or not is_negated else None
        case "after":
            is_quiet = not any(map(response, window))
            has_last = trigger + n + 1 in interval
            truth = is_quiet and (not has_last or response(trigger + n + 1))
            truth = truth if has_last or not is_negated else None
        case "until":
            stop = stops[0] if stops else end
            truth = all(map(response, range(trigger, stop)))
            truth = truth if stops or not is_negated else None
        case "before":
            stop = stops[0] if stops else end
            truth = any(map(response, range(trigger, stop)))
            truth = truth if stops or is_negated else None
        case "finally":
            truth = None if last is None else response(last)
    return True if truth is None else truth != is_negated


def is_satisfied(run, scope, condition, timing, n, has_restriction=False):
    return all(
        is_response_due(run, trigger, interval[1], timing, n, scope.startswith("only"))
        for interval in list_scope_intervals(run, scope, has_restriction)
        if interval[0] in run.triggers
        for trigger in list_triggers(run, interval, condition)
    )


# -- the formula of a sentence on a run ------------------------------------------------------------


def evaluate(formula, run):
    """Return whether a formula with operators of the past holds on a run.

    What the past operators state repeats with the loop after one round for each of them.
    """
    period = len(run.steps) - run.loop
    rounds = 12
    steps = run.steps + run.steps[run.loop :] * rounds
    loop = len(steps) - period
    columns = [dict(step) for step in steps]
    return evaluate_on_lasso(replace_past(formula, columns), columns, loop)[0]


def replace_past(formula, columns):
    if not isinstance(formula, Apply):
        return formula
    args = [replace_past(arg, columns) for arg in formula.args]
    if formula.op not in PAST:
        return Apply(formula.op, tuple(args))
    name = f"past_{len(columns[0])}"
    before = formula.op is Op.HISTORICALLY
    for step, column in enumerate(columns):
        *_, value = (is_true(arg, column) for arg in args)
        match formula.op:
            case Op.ONCE:
                before = before or value
            case Op.HISTORICALLY:
                before = before and value
            case Op.PREVIOUS:
                before = step > 0 and is_true(args[0], columns[step - 1])
            case Op.SINCE:
                before = value or (before and is_true(args[0], column))
        column[name] = before
    return f.var(name)


def make_run(draw):
    length = draw.randint(1, 7)
    # Runs in which little changes reach the corners of the intervals.
    weights = {name: draw.choice((0.15, 0.5, 0.85)) for name in BOOLEANS}
    steps = [{name: draw.random() < weights[name] for name in BOOLEANS} for _ in range(length)]
    return Run(steps, draw.randrange(length))


CASES = list(itertools.product(SCOPES, CONDITIONS))


@pytest.mark.parametrize(("scope", "condition"), CASES)
def test_the_formula_is_true_on_the_runs_that_satisfy_the_sentence(scope, condition):
    draw = random.Random(f"{scope} {condition}")
    for timing, words in TIMINGS.items():
        if timing == "finally" and scope in NEVER_ENDING:
            continue
        verdicts = set()
        for index in range(600):
            if index >= 24 and len(verdicts) == 2:
                break
            n, has_restriction = draw.randrange(4), bool(scope) and index % 4 == 3
            restriction = "while w, " if has_restriction else ""
            text = f"{SCOPES[scope]}{restriction}{CONDITIONS[condition]}the gate shall "
            text += f"{words.format(n=n)} satisfy r"
            run = make_run(draw)
            expected = is_satisfied(run, scope, condition, timing, n, has_restriction)
            formula = read_requirement(text, DOMAINS)
            assert evaluate(formula, run) == expected, (text, run.steps, run.loop)
            verdicts.add(expected)
        assert verdicts == {True, False}, (scope, condition, timing)


PREDICATES = {
    "persisted": lambda values, n: len(values) > n and all(values[-n - 1 :]),
    "occurred": lambda values, n: any(values[-n - 1 :]),
}


UNLIMITED = [scope for scope in SCOPES if not scope.startswith("only")]


@pytest.mark.parametrize(("scope", "predicate"), list(itertools.product(UNLIMITED, PREDICATES)))
def test_predicates_about_the_past_look_back_to_the_begin_of_the_interval(scope, predicate):
    draw = random.Random(f"{scope} {predicate}")
    verdicts = set()
    for index in range(300):
        n, run, has_restriction = draw.randrange(4), make_run(draw), bool(scope) and index % 4 == 3
        restriction = "while w, " if has_restriction else ""
        text = f"{SCOPES[scope]}{restriction}the gate shall always satisfy {predicate}({n}, r) | s"
        expected = all(
            PREDICATES[predicate]([run.is_true("r", i) for i in range(start, step + 1)], n)
            or run.is_true("s", step)
            for start, end in list_scope_intervals(run, scope, has_restriction)
            for step in range(start, run.horizon if end is None else end + 1)
            if step in run.triggers
        )
        formula = read_requirement(text, DOMAINS)
        assert evaluate(formula, run) == expected, (text, run.steps, run.loop)
        verdicts.add(expected)
    assert verdicts == {True, False}


@pytest.mark.parametrize(
    ("duration", "tick_seconds", "steps"),
    [
        ("3 seconds", 1.0, 3),
        ("1 minute", 20.0, 3),
        ("300 milliseconds", 0.1, 3),
        ("1 sec", 0.5, 2),
        ("2 hours", 3600.0, 2),
        ("2 ticks", 0.5, 2),
    ],
)
def test_durations_are_numbers_of_steps(duration, tick_seconds, steps):
    text = "Whenever c, the gate shall for {} satisfy r"
    expected = read_requirement(text.format(f"{steps} ticks"), DOMAINS)
    assert read_requirement(text.format(duration), DOMAINS, (), tick_seconds) == expected


# -- readers and results ---------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("sentence", "formula"),
    [
        ("The gate shall always satisfy r.", "G r"),
        ("the Gate shall satisfy r", "F r"),
        ("In Closed mode, the gate shall never satisfy r", "G (state=Closed -> !r)"),
        ("During mode Closed the gate shall never r", "G (state=Closed -> !r)"),
        ("While state=Closed the gate shall never r", "G (state=Closed -> !r)"),
        ("Except while m the gate shall always satisfy r", "G (!m -> r)"),
        ("Unless in m the gate shall always satisfy r", "G (!m -> r)"),
        ("Only in m shall the gate eventually satisfy r", "G (!m -> !r)"),
        ("Whenever c, then the gate shall immediately satisfy r", "G (c -> r)"),
        (
            "Upon c and when n < 2 is false, the gate shall until s satisfy r",
            "G (c & !n<2 & !Y (c & !n<2) -> r W s)",
        ),
        (
            "When c or if w the gate shall initially satisfy if r then s",
            "G ((c | w) & !Y (c | w) -> r -> s)",
        ),
        ("Whenever c the gate shall, within 1 step, satisfy r", "G (c -> r | X r)"),
        ("The bay gate shall always satisfy r", "G r"),
        ("In m, the gate shall finally satisfy r", "G (!m & Y m -> Y r)"),
        ("Before m, the gate shall at the last timepoint satisfy r", "G (m & Y !O m -> Y r)"),
        ("The gate shall always satisfy persisted(1, r) -> s", "G (r & Y r -> s)"),
        ("In m, the gate shall always satisfy occurred(1, r)", "G (m -> m & r | m & Y (m & r))"),
    ],
)
def test_sentences_in_other_words(sentence, formula):
    read = read_requirement(sentence, DOMAINS, ("Gate", "BayGate"))
    assert print_formula(read) == formula


@pytest.mark.parametrize(
    ("text", "place", "reason"),
    [
        (
            "Wenever c the gate shall satisfy r",
            (1, 1),
            "'Gate' is expected before 'shall', not 'Wenever' (did you mean 'whenever'?)",
        ),
        (
            "When c,\nthe door shall satisfy r",
            (2, 5),
            "the component 'Gate' is expected before 'shall', not 'door'",
        ),
        ("the gate should satisfy r", (1, 10), "'shall' is expected, not 'should'"),
        (
            "the gate shall alway satisfy r",
            (1, 16),
            "'always' or a condition is expected, not 'alway'",
        ),
        ("the gate shall within five ticks satisfy r", (1, 23), "a number is expected, not 'five'"),
        (
            "the gate shall within 3 weeks satisfy r",
            (1, 25),
            "a unit of time such as 'ticks', 'ms', 'seconds' or 'minutes' is expected, not 'weeks'",
        ),
        (
            "the gate shall for 65 ticks satisfy r",
            (1, 20),
            "a duration has at most 64 steps of 1 s, not 65",
        ),
        (
            "the gate shall within 1500 milliseconds satisfy r",
            (1, 23),
            "1500 milliseconds are no whole number of steps of 1 s: write ticks",
        ),
        (
            "after m, the gate shall finally satisfy r",
            (1, 25),
            "the scope has no last step: add one that ends, such as 'in m' or 'before m'",
        ),
        (
            "the gate shall always satisfy persists(2, r)",
            (1, 31),
            "'persists' cannot be read: write a timing, 'for 3 ticks', or persisted(3, p)",
        ),
        (
            "the gate shall always satisfy preBool(true, r)",
            (1, 31),
            "'preBool' cannot be read: write the requirement in LTL",
        ),
        (
            "the gate shall always satisfy occurred(65, r)",
            (1, 40),
            "a number from 0 to 64 is expected",
        ),
        (
            "the gate shall at once satisfy r",
            (1, 16),
            "'at the next timepoint' or 'at the last timepoint' is expected, not 'at'",
        ),
        (
            "the gate shall always satisfy r. It shall open.",
            (1, 34),
            "a formula is one sentence; write the next in a constraint of its own",
        ),
        ("the gate shall always satisfy q", (1, 31), "'q' is neither a variable nor a literal"),
        (
            "In Flying mode the gate shall satisfy r",
            (1, 4),
            "'Flying' is neither a state nor a variable",
        ),
        (
            "only when c the gate shall satisfy r",
            (1, 6),
            "'before' or 'after' is expected, not 'when'",
        ),
        (
            "when c, whenever w the gate shall r",
            (1, 9),
            "'whenever' cannot follow a condition with 'when'",
        ),
        (
            "the gate shall always satisfy G r",
            (1, 31),
            "a condition of a sentence is about the present",
        ),
        (
            "the gate shall always satisfy r, s",
            (1, 32),
            "the end of the sentence is expected, not ','",
        ),
        ("in m", (1, 5), "the component 'Gate' is expected before 'shall', not the end"),
        ("", (1, 1), "the component 'Gate' is expected before 'shall', not the end"),
    ],
)
def test_a_fault_is_reported_at_the_word(text, place, reason):
    with pytest.raises(FormulaError) as caught:
        read_requirement(text, DOMAINS, ("Gate",))
    assert line_and_column(text, caught.value.offset) == place
    assert reason in str(caught.value)


def test_a_component_of_very_many_words_is_a_fault():
    words = "word " * 200_000
    with pytest.raises(FormulaError, match="the component 'Gate' is expected before 'shall'"):
        read_requirement(f"the {words}shall always satisfy r", DOMAINS, ("Gate", "Gate"))


def test_prose_that_repeats_words_of_sentences_is_no_requirement():
    prose = "the gate shall always stop. " * 40_000
    assert not is_formal("English", prose)
    assert is_formal("English", f"{prose} It shall always satisfy r.")


def test_a_mode_that_two_variables_may_have_is_ambiguous():
    domains = DOMAINS | {"left": DOMAINS["state"]}
    with pytest.raises(FormulaError, match="write state=Open or left=Open"):
        read_requirement("In Open mode the gate shall satisfy r", domains)


@pytest.mark.parametrize(
    ("scope", "timing"),
    [
        (scope, timing)
        for scope, timing in itertools.product(SCOPES, TIMINGS)
        if timing != "finally" or scope not in NEVER_ENDING
    ],
)
def test_history_bits_bring_every_sentence_into_gr1(scope, timing):
    """So that synthesis and the other tools can use it."""
    for condition in CONDITIONS.values():
        text = f"{SCOPES[scope]}{condition}the gate shall {TIMINGS[timing].format(n=2)} satisfy r"
        assert reduce_formula(read_requirement(text, DOMAINS), History(DOMAINS))


WORDS = [
    *("in", "only", "before", "after", "when", "whenever", "unless", "while", "mode", "not", "and"),
    *("the", "gate", "shall", "satisfy", "always", "within", "ticks", "until", "at", "next", "if"),
    *(
        "is",
        "true",
        "m",
        "c",
        "r",
        "state",
        "Closed",
        "=",
        "n",
        "3",
        "99999999999999999999",
        "(",
        ")",
    ),
    *(",", ".", "!", "&", "->", "G", "'", '"', "\ud800"),
]


@given(st.lists(st.sampled_from(WORDS), max_size=14))
@settings(max_examples=examples(600), deadline=None)
def test_any_words_are_a_sentence_or_a_fault_with_a_location(words):
    text = " ".join(words)
    try:
        formula = read_requirement(text, DOMAINS, ("gate",))
    except FormulaError as error:
        assert 0 <= error.offset <= len(text)  # noqa: PT017
    else:
        assert print_formula(formula)
