"""The pass ``expressions``: texts of expressions and effects get their syntax trees."""

from sysmlc.diagnostics import Sink
from sysmlc.ir.expressions import EffectText, ExpressionText, ParsedText, list_names
from sysmlc.ir.text import parse_text, print_text
from sysmlc.logic.expressions.parsing import parse_effect, parse_expression
from sysmlc.passes import pipeline

MODEL = """\
Class c "Tank"
  Property c.p "level" default=" 2 * limit" default_language="OCL"
  Property c.s "label" default="x + 1"
  Constraint c.k body="level <= 9"
  Constraint c.w body="the level is low"
  Activity c.e subkind="opaque" body="self.level := 3; send Go to 'other tank'"
  Activity c.j subkind="opaque" body="if (level > 3) { stop(); }"
  Activity c.d "fill"
    Action c.a "step" subkind="call-behavior"
      Pin c.i "in" direction="in" value="level"
    Control c.q subkind="decision"
    ControlFlow c.f guard="level > 3"
    ControlFlow c.g guard="else"
  Comment c.c body="level > 3"
  Trigger c.t subkind="change" condition="level > 3"
"""


def run_pass():
    graph = parse_text(MODEL)
    pipeline.load("expressions").run(graph, Sink())
    return graph


def test_expressions_and_effects_get_trees_and_other_texts_do_not():
    trees = {
        f"{element.id} {key}": type(value)
        for element in run_pass()
        for key, value in element.attrs.items()
        if isinstance(value, ParsedText)
    }
    assert trees == {
        "c.p default": ExpressionText,
        "c.k body": ExpressionText,
        "c.e body": EffectText,
        "c.i value": ExpressionText,
        "c.f guard": ExpressionText,
        "c.t condition": ExpressionText,
    }


def test_a_tree_is_that_of_the_text_and_the_text_is_that_of_the_author():
    graph = run_pass()
    default, effect = graph["c.p"].attrs["default"], graph["c.e"].attrs["body"]
    assert default == " 2 * limit"
    assert str(default).strip().tree == default.tree == parse_expression("2 * limit")
    assert effect.tree == parse_effect("self.level := 3; send Go to 'other tank'")
    assert graph["c.f"].attrs["guard"] is graph["c.t"].attrs["condition"]
    assert print_text(graph) == print_text(parse_text(MODEL))


def test_the_names_of_a_text_are_those_of_its_tree_or_the_words_of_an_opaque_text():
    graph = run_pass()
    assert list_names(graph["c.e"].attrs["body"]) == ["level", "self", "Go", "other tank"]
    assert list_names(graph["c.j"].attrs["body"]) == ["if", "level", "stop"]
