"""Expressions written from their trees are parsed to the same trees again."""

import pytest
from tree_outlines import list_node_values

from sysmlc.diagnostics import Sink
from sysmlc.language.notation import write_expression
from sysmlc.language.text import parse
from sysmlc.language.text.lexer import quote_name, unquote

SAME = [
    "1 + 2 * 3",
    "(1 + 2) * 3",
    "1 - (2 - 3)",
    "2**3**4",
    "(2**3)**4",
    "-(1 + x)",
    "not a and b or c implies d",
    "not (a or b)",
    "if a > b ? a else b",
    "(if a ? b else c) + 1",
    "a.b.c#(2)",
    "(1, 2, 3)",
    "((1, 2), 3)",
    "5 [SI::kg]",
    "Functions::f(1, (2, 3), x = 4)",
    "new Sig(1, 'a b'::c)",
    "x istype T and x as T == null",
    '"a\\"b"',
    "1..n",
    "T.metadata",
    "a ?? b",
    "true",
    "1.5",
    "all T",
]


def parse_value(text):
    """Return the tree of an expression that is the value of an attribute."""
    sink = Sink()
    root = parse(f"attribute v = {text};", "m.sysml", "sysml", sink).root
    assert [diagnostic.message for diagnostic in sink] == []
    expression = root.members[0].members[0]
    expression.role = ""
    return expression


@pytest.mark.parametrize("text", SAME)
def test_expressions_are_written_as_they_are_read(text):
    expression = parse_value(text)
    assert write_expression(expression) == text
    assert list_node_values(parse_value(text)) == list_node_values(expression)


@pytest.mark.parametrize(
    ("text", "canonical"),
    [("((1))", "1"), ("a->f(b)", "f(a, b)"), ("(1, (2, 3))", "(1, 2, 3)"), ("()", "null")],
)
def test_an_expression_with_two_notations_is_written_in_one(text, canonical):
    assert write_expression(parse_value(text)) == canonical


def test_a_body_expression_with_declarations_is_not_written():
    assert write_expression(parse_value("a->collect {in x; x + 1}")) == ""


def test_a_conditional_operand_is_written_in_parentheses():
    for text in (
        "(if a ? b else c) ?? d",
        "a + (if b ? c else d)",
        "if a ?? b ? c else d ?? e",
        "(if a ? b else c, d)",
    ):
        assert write_expression(parse_value(text)) == text


@pytest.mark.parametrize(
    ("name", "written"),
    [
        ("a'b", r"'a\'b'"),
        ("a\\b", r"'a\\b'"),
        ("a\nb", r"'a\nb'"),
        ("a\tb", r"'a\tb'"),
        ("a\rb", r"'a\rb'"),
        ("a\fb", r"'a\fb'"),
        ("a\bb", r"'a\bb'"),
        ("a b", "'a b'"),
        ("a_1", "a_1"),
    ],
)
def test_a_name_is_written_with_the_escapes_of_the_language(name, written):
    assert quote_name(name) == written
    assert name in (written, unquote(written))
