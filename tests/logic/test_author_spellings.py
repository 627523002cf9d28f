"""Spellings of formulas and sentences that engineers bring along, and advice for the others."""

import pytest

from sysmlc.logic.contract import BooleanDomain, EnumerationDomain, IntegerDomain
from sysmlc.logic.formal_texts import describe_error, is_formal, read_formal
from sysmlc.logic.syntax import FormulaError

VARIABLES = {
    "p": BooleanDomain(),
    "q": BooleanDomain(),
    "n": IntegerDomain(0, 7),
    "state": EnumerationDomain(("A", "B", "Not", "always")),
}


def read(text, language="LTL"):
    return read_formal(text, language, VARIABLES, ("Press",))


@pytest.mark.parametrize(
    ("text", "formula"),
    [
        ("not p and q or p implies q", "!p & q | p -> q"),
        ("NOT p AND q OR p IMPLIES q", "!p & q | p -> q"),
        ("p iff Not q", "p <-> !q"),
        ("always (p)", "G p"),
        ("Always (p => eventually (q))", "G (p -> F q)"),
        ("always p", "G p"),
        ("not eventually p", "!F p"),
        ("next (p) and p until q", "X p & (p U q)"),
        ("q since p", "q S p"),
        ("p <=> ~q", "p <-> !q"),
        ("state == B && p || q", "state=B & p | q"),
        ("p == true & q = FALSE", "p=true & q=false"),
        ("n ≥ 3 ∧ ¬p", "n>=3 & !p"),
        ("p /\\ q \\/ p", "p & q | p"),
        ("□ (p → ◇ q)", "[] (p -> <> q)"),
        ("n' = n+1", "n'=n + 1"),
        ("state=Not & state=always", "state=Not & state=always"),
        ("not p & state=Not", "!p & state=Not"),
    ],
)
def test_words_and_signs_of_other_languages_are_read(text, formula):
    assert read(text) == read(formula)


@pytest.mark.parametrize("word", ["always", "eventually", "Always"])
@pytest.mark.parametrize("rest", ["p implies q", "p and q", "not p or q", "(p) implies q"])
def test_a_word_with_an_unclear_extent_needs_parentheses(word, rest):
    with pytest.raises(FormulaError, match=rf"how far '{word}' reaches; write '{word} \(P "):
        read(f"{word} {rest}")


SENTENCES = [
    ("Globally, it is always the case that not (p and q) holds.", "G !(p & q)"),
    ("globally, never p or q", "G !(p | q)"),
    ("It is always the case that if p and not q holds then n=1 holds.", "G (p & !q -> n=1)"),
    ("p holds at most twice.", None),
    ("p holds again and again", "G F p"),
    ("always if p then q holds within 1 step", None),
    ("Always if p then q holds within 2 seconds.", None),
]


@pytest.mark.parametrize("language", ["pattern", "English", "ltl", "FRET", "OCL", "", "text"])
@pytest.mark.parametrize(("text", "formula"), SENTENCES)
def test_a_sentence_is_read_under_any_language(text, formula, language):
    assert is_formal(language, text)
    expected = read(text, "pattern")
    assert read(text, language) == expected
    if formula:
        assert str(expected) == str(read(formula)) or "S" in str(expected)


@pytest.mark.parametrize("language", ["FRET", "English", "ltl", "OCL"])
def test_a_structured_requirement_has_words_and_minutes(language):
    text = "When p and not q, the Press shall within {} satisfy not (p and state=A)."
    assert is_formal(language, text.format("1 minute"))
    minute = read(text.format("60 ticks"), "FRET")
    for unit in ("1 minute", "1 min", "1 MINUTES", "60 s", "60 seconds", "60000 ms", "1min"):
        assert read(text.format(unit), language) == minute


def test_and_separates_the_ends_of_a_scope_outside_of_brackets():
    expected = read("Between (p & q) and q, never n=1", "pattern")
    assert read("Between (p and q) and q, never n=1", "pattern") == expected


def test_and_before_a_condition_word_joins_conditions():
    joined = read("When p and if q or n=1, the Press shall satisfy q", "FRET")
    assert joined == read("When p & (q | n=1), the Press shall satisfy q", "FRET")


@pytest.mark.parametrize("text", ["The door closes.", "Robots respond to commands", "p always"])
def test_prose_is_no_sentence(text):
    assert not is_formal("english", text)


@pytest.mark.parametrize(
    ("text", "advice"),
    [
        ("state is A", "write '=' for 'is' (column 7)"),
        ("G (n := 3)", "write '=' for ':=' (column 6)"),
        ("n =< 3", "write '<=' for '=<' (column 4)"),
        ("n <> 3", "'n' is not Boolean; compare it: 'n=7' (column 1)"),
        ("p xor q", "write 'P != Q' for one of two conditions (column 3)"),
        ("1 < n < 3", "write 'a < b & b < c' for 'a < b < c' (column 7)"),
        ("G[0,5] p", "write 'always if P then Q holds within 5 steps' with the language 'pattern'"),
        ("G p within 5 min", "write 'always if P then Q holds within 5 steps' with the language"),
        ("G (p)'", "write 'X (P)' for the next value of a condition (column 6)"),
        ("G p;", "remove the ';' (column 4)"),
        ('state = "A"', "write names and values without quotation marks (column 9)"),
        ("if p then q", "write 'P -> Q' for 'if P then Q' (column 1)"),
        ("state in {A, B}", "write 'state=A | state=B', one comparison for each value (column 7)"),
        ("n > 1.5", "write whole numbers, in a smaller unit if need be (column 6)"),
        ("AG p", "formulas are about all runs: write 'G', 'F', 'X' or 'U' without 'A' (column 1)"),
        ("never p", "write 'G !(P)' (column 1)"),
        ("B", "did you mean 'state=B'? (column 1)"),
        ("p ? q : p", "write '(P -> Q) & (!P -> R)' for 'P ? Q : R' (column 3)"),
        ("whenever p, q", "write 'G (P -> Q)' for 'whenever P, Q' (column 1)"),
        ("p only if q", "write 'P -> Q' for 'P only if Q' (column 3)"),
        ("p unless q", "write 'P W Q' for 'P unless Q' (column 3)"),
        ("p before q", "write 'P precedes Q' with the language 'pattern' (column 3)"),
        ("p after q", "write 'after Q, P always holds' with the language 'pattern' (column 3)"),
        ("n between 1 and 3", "write 'a <= x & x <= b' (column 3)"),
        ("infinitely often p", "write 'G F P' (column 1)"),
        ("G (in(A) -> p)", "write 'state=P' for an active state (column 4)"),
        ("G (done(q) -> p)", "write 'finished(P)' where an action ends (column 4)"),
        ("G (active(q) -> p)", "write 'running(P)' while an action runs (column 4)"),
        ("G (received(Go) -> p)", "write 'event=P' for an event that occurs (column 4)"),
    ],
)
def test_another_form_is_refused_with_the_nearest_one_that_is_read(text, advice):
    with pytest.raises(FormulaError) as caught:
        read(text)
    assert advice in describe_error(caught.value, text)


@pytest.mark.parametrize(
    ("text", "advice"),
    [
        ("p is always true", "write 'P always holds' (column 3)"),
        ("p is never true", "write 'P never holds' (column 3)"),
        ("p follows q", "write 'P responds to Q' (column 3)"),
    ],
)
def test_a_sentence_in_other_words_is_refused_with_the_nearest_one(text, advice):
    with pytest.raises(FormulaError) as caught:
        read(text, "pattern")
    assert advice in describe_error(caught.value, text)


@pytest.mark.parametrize(
    ("text", "language"),
    [
        ("G (p -> q)", "LTL"),
        ("p W q", "LTL"),
        ("1 <= n & n <= 3", "LTL"),
        ("G F p", "LTL"),
        ("p != q", "LTL"),
        ("(p -> q) & (!p -> state=A)", "LTL"),
        ("p precedes q", "pattern"),
        ("after q, p always holds", "pattern"),
        ("p never holds", "pattern"),
        ("p responds to q", "pattern"),
        ("always if p then q holds within 5 steps", "pattern"),
        ("In A mode the Press shall always satisfy p", "FRET"),
    ],
)
def test_the_forms_that_advice_names_are_read(text, language):
    read(text, language)


def test_a_duration_of_too_many_steps_names_the_step():
    with pytest.raises(FormulaError, match="at most 64 steps of 1 s, not 300; increase"):
        read("The Press shall within 5 minutes satisfy p", "FRET")
