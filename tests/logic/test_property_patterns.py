"""Property patterns; Spot compares them with the published formulas, in every scope."""

import pytest
import spot
from hypothesis import given, settings
from hypothesis import strategies as st

from long_runs import examples
from spot_formulas import conjoin, conjoin_parts, print_for_spot
from sysmlc.logic.contract import BooleanDomain, IntegerDomain
from sysmlc.logic.formal_texts import read_sentence
from sysmlc.logic.infix import parse_formula
from sysmlc.logic.reduction.formula_reduction import NotReducibleError, reduce_formula
from sysmlc.logic.reduction.history import History
from sysmlc.logic.syntax import FormulaError, line_and_column

DOMAINS = {name: BooleanDomain() for name in "pqrs"} | {"n": IntegerDomain(0, 3)}
SCOPES = {
    "globally": "Globally, ",
    "before": "Before r, ",
    "after": "After q, ",
    "between": "Between q and r, ",
    "until": "After q until r, ",
}
DWYER = {
    "it is never the case that p holds": {
        "globally": "G !p",
        "before": "F r -> (!p U r)",
        "after": "G (q -> G !p)",
        "between": "G ((q & !r & F r) -> (!p U r))",
        "until": "G (q & !r -> (!p W r))",
    },
    "it is always the case that p holds": {
        "globally": "G p",
        "before": "F r -> (p U r)",
        "after": "G (q -> G p)",
        "between": "G ((q & !r & F r) -> (p U r))",
        "until": "G (q & !r -> (p W r))",
    },
    "p eventually holds": {
        "globally": "F p",
        "before": "!r W (p & !r)",
        "after": "G !q | F (q & F p)",
        "between": "G (q & !r -> (!r W (p & !r)))",
        "until": "G (q & !r -> (!r U (p & !r)))",
    },
    "p holds at most 1 time": {
        "globally": "!p W (p W G !p)",
        "before": "F r -> ((!p & !r) U (r | ((p & !r) U (r | (!p U r)))))",
        "after": "F q -> (!q U (q & (!p W (p W G !p))))",
        "between": "G ((q & !r & F r) -> ((!p & !r) U (r | ((p & !r) U (r | (!p U r))))))",
        "until": "G (q & !r -> ((!p & !r) W (r | ((p & !r) W (r | (!p W r))))))",
    },
    "it is always the case that if p holds then s previously held": {
        "globally": "!p W s",
        "before": "F r -> (!p U (s | r))",
        "after": "G !q | (!q U (q & (!p W s)))",
        "between": "G ((q & !r & F r) -> (!p U (s | r)))",
        "until": "G (q & !r -> (!p W (s | r)))",
    },
    "it is always the case that if p holds then s eventually holds": {
        "globally": "G (p -> F s)",
        "before": "F r -> ((p -> (!r U (s & !r))) U r)",
        "after": "G (q -> G (p -> F s))",
        "between": "G ((q & !r & F r) -> ((p -> (!r U (s & !r))) U r))",
        "until": "G (q & !r -> ((p -> (!r U (s & !r))) W r))",
    },
}
CASES = [
    (text, scope, formula)
    for text, formulas in DWYER.items()
    for scope, formula in formulas.items()
]


def reduce_sentence(text):
    """Return the rules of the history bits and the reduced sentence, both for Spot."""
    history = History(DOMAINS)
    parts = reduce_formula(read_sentence(text, DOMAINS), history)
    return print_for_spot(conjoin(history.conjuncts)), print_for_spot(conjoin_parts(parts))


@pytest.mark.parametrize(("text", "scope", "published"), CASES)
def test_a_sentence_means_the_published_formula(text, scope, published):
    rules, formula = reduce_sentence(SCOPES[scope] + text)
    assert not spot.translate(spot.formula(rules)).is_empty()
    difference = spot.formula(f"({rules}) & !(({published}) <-> ({formula}))")
    assert spot.translate(difference).accepting_word() is None


@pytest.mark.parametrize(
    ("short", "full"),
    [
        ("always p", "Globally, it is always the case that p holds."),
        ("p responds to q", "always if q holds, then p eventually holds"),
        ("p precedes q", "It is always the case that if q holds then p previously held"),
        ("never p & n=3", "p & n=3 never holds"),
        ("p holds again and again", "it is always the case that p holds again and again"),
        ("eventually p", "p eventually holds"),
        ("p holds at most twice", "p holds at most 2 times"),
        ("after q, always if p then s", "After q, it is always the case that !p | s holds"),
    ],
)
def test_a_short_sentence_means_the_full_one(short, full):
    assert spot.are_equivalent(translate(short), translate(full))


def translate(text):
    rules, formula = reduce_sentence(text.replace("n=3", "s"))
    return spot.formula(f"({rules}) & ({formula})")


SOON = "(p -> (s | r | X (s | r | X (s | r))))"


@pytest.mark.parametrize(
    ("scope", "expected"),
    [
        ("", "G (p -> (s | X s | X X s))"),
        ("Before r, ", f"F r -> ({SOON} U r)"),
        ("After q, ", "G (q -> G (p -> (s | X s | X X s)))"),
        ("Between q and r, ", f"G ((q & !r & F r) -> ({SOON} U r))"),
        ("After q until r, ", f"G (q & !r -> ({SOON} W r))"),
    ],
)
def test_a_bounded_response_means_nested_nexts(scope, expected):
    rules, formula = reduce_sentence(f"{scope}always if p then s holds within 2 steps")
    difference = spot.formula(f"({rules}) & !(({expected}) <-> ({formula}))")
    assert spot.translate(difference).is_empty()


@pytest.mark.parametrize(
    ("text", "place", "reason"),
    [
        ("Globally, p & holds", (1, 15), "'holds' is neither a variable nor a literal"),
        ("After q until r\n  it is never the case p holds", (2, 24), "'that' is expected, not 'p'"),
        ("Between q, p never holds", (1, 10), "'and' is expected, not ','"),
        ("p sometimes holds", (1, 3), "'sometimes'"),
        ("always G p", (1, 8), "a condition of a sentence is about the present"),
        ("always p'", (1, 8), "a condition of a sentence is about the present"),
        ("p holds at most 99 times", (1, 17), "a number from 0 to 32 is expected"),
        ("always p holds forever", (1, 16), "the end of the sentence is expected, not 'forever'"),
        ("always n", (1, 8), "'n' is not Boolean"),
        ("", (1, 1), "the end is not expected here"),
        ("never if p then s", (1, 10), "'if' follows 'always' only; a condition is expected"),
    ],
)
def test_a_malformed_sentence_is_reported_with_its_location(text, place, reason):
    with pytest.raises(FormulaError) as caught:
        read_sentence(text, DOMAINS)
    assert line_and_column(text, caught.value.offset) == place
    assert reason in str(caught.value)


WORDS = [
    *("Globally", "before", "after", "between", "and", "until", "it is", "always", "never"),
    *("eventually", "the case that", "if", "then", "holds", "previously held", "within", "steps"),
    *("at most", "times", "again and again", "responds to", "precedes", "p", "q", "n=1", "n", "3"),
    *("(", ")", ",", ".", "!", "&", "->", "G", "'", "99999999999999999999", '"', "\ud800"),
]


@given(st.lists(st.sampled_from(WORDS), max_size=12))
@settings(max_examples=examples(600), deadline=None)
def test_any_words_are_a_sentence_or_a_fault_with_a_location(words):
    text = " ".join(words)
    try:
        formula = read_sentence(text, DOMAINS)
    except FormulaError as error:
        assert 0 <= error.offset <= len(text)  # noqa: PT017
    else:
        assert reduce_formula(formula, History(DOMAINS))


@pytest.mark.parametrize(
    "text", ["!(a U " * 60 + "b" + ")" * 60, "X " * 150 + "a", "X " * 30 + "a"]
)
def test_deep_formulas_do_not_exhaust_the_stack(text):
    formula = parse_formula(text, {name: BooleanDomain() for name in "ab"})
    try:
        assert reduce_formula(formula, History("ab"))
    except NotReducibleError:
        assert len(text) > 200
