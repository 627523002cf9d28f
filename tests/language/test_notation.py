"""Expressions written from their trees: what is parsed again is the same tree."""

import pytest

from sysmlc.diagnostics import Sink
from sysmlc.language.notation import write_expression
from sysmlc.language.text import parse

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


def value(text):
    sink = Sink()
    root = parse(f"attribute v = {text};", "m.sysml", "sysml", sink).root
    assert [found.message for found in sink] == []
    return root.members[0].members[0]


def shape(node):
    relations = [(one.kind, one.reference.chain) for one in node.relations]
    return (node.kind, node.attributes, relations, node.role, [shape(one) for one in node.members])


@pytest.mark.parametrize("text", SAME)
def test_expressions_are_written_as_they_are_read(text):
    node = value(text)
    node.role = ""
    again = value(write_expression(node))
    again.role = ""
    assert write_expression(node) == text
    assert shape(again) == shape(node)


@pytest.mark.parametrize(
    ("text", "written"),
    [("((1))", "1"), ("a->f(b)", "f(a, b)"), ("(1, (2, 3))", "(1, 2, 3)"), ("()", "null")],
)
def test_what_has_two_notations_has_one(text, written):
    assert write_expression(value(text)) == written


def test_a_body_has_no_notation_without_its_declarations():
    assert write_expression(value("a->collect {in x; x + 1}")) == ""


def test_a_conditional_within_an_operand_stands_in_parentheses():
    for text in (
        "(if a ? b else c) ?? d",
        "a + (if b ? c else d)",
        "if a ?? b ? c else d ?? e",
        "(if a ? b else c, d)",
    ):
        assert write_expression(value(text)) == text
