"""The expression grammar: spellings, errors with offsets, and printing without loss."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from long_runs import examples
from sysmlc.ir.expressions import (
    Assignment,
    Binary,
    Call,
    Conditional,
    ExpressionError,
    Index,
    Invocation,
    Literal,
    Member,
    Name,
    Send,
    Unary,
    dotted_name,
    print_effect,
    print_expression,
)
from sysmlc.logic.expressions.parsing import parse_effect, parse_expression


@pytest.mark.parametrize(
    ("text", "printed"),
    [
        ("a && b || !c", "a and b or not c"),
        ("a & b | c", "a and b or c"),
        ("x = 3", "x == 3"),
        ("x<>3", "x != 3"),
        ("a AND NOT b", "a and not b"),
        ("a implies b implies c", "a implies b implies c"),
        ("(a implies b) implies c", "(a implies b) implies c"),
        ("1 - (2 - 3) - 4", "1 - (2 - 3) - 4"),
        ("(a or b) and c xor d", "(a or b) and c xor d"),
        ("if x > 0 ? x else -x", "if x > 0 ? x else -x"),
        ("Modes::auto", "Modes::auto"),
        ("gate.sensor.value >= 2.5", "gate.sensor.value >= 2.5"),
        ("xs[i + 1]", "xs#(i + 1)"),
        ("xs#(1)", "xs#(1)"),
        ("isFree(bay, 2)", "isFree(bay, 2)"),
        ('\'bay number\' == "A \\"1\\""', '\'bay number\' == "A \\"1\\""'),
        ("iff or android", "iff or android"),
        ("not(a)", "not a"),
        ("a // remark\n and b", "a and b"),
    ],
)
def test_spellings_are_normalised(text, printed):
    assert print_expression(parse_expression(text)) == printed


def test_equality_binds_weaker_than_comparison_and_stronger_than_and():
    assert parse_expression("a == b < c and d") == Binary(
        "and",
        Binary("==", Name(("a",)), Binary("<", Name(("b",)), Name(("c",)))),
        Name(("d",)),
    )


@pytest.mark.parametrize(
    ("text", "offset"), [("a and", 5), ("a b", 2), ("", 0), ("x > 3 °C", 6), ("((a)", 4)]
)
def test_a_malformed_expression_is_rejected_with_its_offset(text, offset):
    with pytest.raises(ExpressionError) as caught:
        parse_expression(text)
    assert caught.value.offset == offset


def test_deep_nesting_is_rejected_without_a_crash():
    assert parse_expression("(" * 20_000 + "a" + ")" * 20_000) == Name(("a",))
    with pytest.raises(ExpressionError, match="nested too deeply"):
        parse_expression("not " * 20_000 + "a")


def test_effects_are_assignments_invocations_and_sent_signals():
    assert parse_effect("x := x + 1; open = true; beep(2); send done(x) to gate; stop;") == (
        Assignment(Name(("x",)), Binary("+", Name(("x",)), Literal(1))),
        Assignment(Name(("open",)), Literal(True)),
        Invocation(Call(Name(("beep",)), (Literal(2),))),
        Send(Name(("done",)), (Name(("x",)),), Name(("gate",))),
        Invocation(Name(("stop",))),
    )
    assert parse_effect("") == ()
    assert parse_effect(";;") == ()


def test_two_equal_signs_in_a_statement_have_no_meaning():
    with pytest.raises(ExpressionError, match="write ':=' to assign, or '==' to compare"):
        parse_effect("a = b = c")
    assert parse_effect("a := b = c") == parse_effect("a = b == c")


@pytest.mark.parametrize("text", ["f(x) := 2", "3", "x > 2"])
def test_an_expression_that_is_not_a_call_is_no_effect(text):
    with pytest.raises(ExpressionError):
        parse_effect(text)


def test_only_a_path_of_names_has_a_dotted_name():
    assert dotted_name(parse_expression("A::b.c")) == "A::b.c"
    assert dotted_name(parse_expression("f(x).c")) is None


_names = st.sampled_from(["a", "b", "bay number", "if", "größe", "it's", "back\\slash", "x\ny"])
_literals = st.builds(
    Literal,
    st.booleans()
    | st.integers(0, 10**12)
    | st.floats(0, 1e9, allow_nan=False).map(abs)
    | st.text("ab \"\\\n'", max_size=5),
)
_atoms = _literals | st.builds(Name, st.lists(_names, min_size=1, max_size=3).map(tuple))


_OPERATORS = ("implies", "or", "xor", "and", "==", "!=", "<", "<=", ">", ">=", *"+-*/%")


def _compound(inner):
    return st.one_of(
        st.builds(Binary, st.sampled_from(_OPERATORS), inner, inner),
        st.builds(Unary, st.sampled_from(["not", "-", "+"]), inner),
        st.builds(Conditional, inner, inner, inner),
        st.builds(Member, inner, _names),
        st.builds(Call, inner, st.lists(inner, max_size=2).map(tuple)),
        st.builds(Index, inner, inner),
    )


expressions = st.recursive(_atoms, _compound, max_leaves=12)


@given(expressions)
@settings(max_examples=examples(150), deadline=None)
def test_parsing_the_printed_text_gives_an_equal_tree(expression):
    assert parse_expression(print_expression(expression)) == expression


_features = st.builds(Name, st.lists(_names, min_size=1, max_size=2).map(tuple))
_statements = st.one_of(
    st.builds(Assignment, _features, expressions),
    st.builds(Send, _features, st.lists(expressions, max_size=2).map(tuple), st.none() | _features),
    st.builds(Invocation, st.builds(Call, _features, st.lists(expressions, max_size=2).map(tuple))),
)


@given(st.lists(_statements, max_size=3).map(tuple))
@settings(max_examples=examples(60), deadline=None)
def test_parsing_a_printed_effect_gives_an_equal_effect(effect):
    assert parse_effect(print_effect(effect)) == effect


# -- random sequences of tokens -----------------------------------------------------------------

_TOKENS = """\
a b _c 'x_y' 'it\\'s' 1 42 2.5 1e5 2.5e-3 "text" true FALSE if else implies or OR xor and AND
not NOT send to || | && & ! = == != <> < <= > >= + - * / % . .. :: : := ( ) [ ] # ( ) , ; ?
$ ' " // /* */ é ٣
"""
_token_texts = st.lists(
    st.tuples(st.sampled_from(_TOKENS.split()), st.sampled_from(["", " ", " ", "\n"])), max_size=12
).map(lambda parts: "".join(token + space for token, space in parts))


@given(_token_texts)
@settings(max_examples=examples(300), deadline=None)
def test_any_text_is_parsed_or_rejected_at_an_offset_in_it(text):
    for parse in (parse_expression, parse_effect):
        assert 0 <= _find_fault(parse, text) <= len(text)


def _find_fault(parse, text):
    """Return the offset of the fault in a text, 0 when it has none."""
    try:
        parse(text)
    except ExpressionError as error:
        return error.offset
    return 0


def test_a_boolean_equals_no_number():
    assert len({Literal(True), Literal(1), Literal(1.0)}) == 3
    assert (Literal(1) != Literal(1)) is False
    assert Binary("==", Name(("x",)), Literal(1)) != Binary("==", Name(("x",)), Literal(True))


def test_a_number_with_more_digits_than_python_reads_is_rejected():
    with pytest.raises(ExpressionError, match="too many digits"):
        parse_expression("9" * 5000)


@pytest.mark.parametrize("text", ["- " * 500 + "1", "not " * 200 + "a", "a" + " + a" * 400])
def test_nesting_deeper_than_the_limit_is_rejected(text):
    with pytest.raises(ExpressionError, match="nested too deeply"):
        parse_expression(text)


@pytest.mark.parametrize(
    "text", ["- " * 100 + "1", "a" + " + a" * 100, "max(" + "a, " * 400 + "a)"]
)
def test_a_long_but_flat_expression_is_parsed(text):
    parse_expression(text)
