"""The pass ``expressions``: texts of expressions and effects get their syntax trees."""

import pytest

from sysmlc.diagnostics import Sink
from sysmlc.ir.expressions import (
    EffectText,
    ExpressionText,
    Literal,
    Member,
    Name,
    ParsedText,
    list_names,
    walk_tree,
)
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
    assert graph["c.f"].attrs["guard"].tree == graph["c.t"].attrs["condition"].tree
    assert print_text(graph) == print_text(parse_text(MODEL))


def test_the_names_of_a_text_are_those_of_its_tree_or_the_words_of_an_opaque_text():
    graph = run_pass()
    assert list_names(graph["c.e"].attrs["body"]) == ["level", "self", "Go", "other tank"]
    assert list_names(graph["c.j"].attrs["body"]) == ["if", "level", "stop"]


NAMES = """\
Package p "Plant"
  Import p.i subkind="element"
    -> references q.m
  Import p.j subkind="package"
    -> references d
  Enumeration e "Mode"
    EnumerationLiteral e.a "auto"
  Class a "Arm"
    Property a.l "load"
  Signal g "Go"
    Property g.n "amount"
  Class m "Machine"
    Property m.l "level"
    Property m.m "mode"
      -> typed-by e
  Class t "Tank"
    -> specializes m
    Property t.a "arm" role="part"
      -> typed-by a
    Property t.b "load"
    StateMachine t.s "run"
      Region t.r
        State t.x "waiting"
        Transition t.t guard="{text}"
          -> trigger t.g
          Activity t.y "level"
          Trigger t.g payload="order"
            -> typed-by g
    Activity t.z "weigh"
    Activity t.d "fill"
      Property t.p "load"
      Action t.w "weigh"
        Pin t.o "mass" direction="out"
      ControlFlow t.f guard="{text}"
  Class h "Hall"
    Property h.t "tank"
  Association n
    -> end n.h n.t
    Property n.h "hall"
      -> typed-by h
    Property n.t "basin"
      -> typed-by t
Package d "Defaults"
  Instance d.l "LOW" value=2
  Instance d.m "load" value=4
  Import d.i subkind="package"
    -> references b
  Import d.j subkind="package" visibility="private"
    -> references k
  Import d.k subkind="element" alias="TOP"
    -> references b.t
Package q "Other"
  Instance q.m "MAX" value=9
  Enumeration s "Season"
    EnumerationLiteral s.w "winter"
  Class q.a "Arm"
    Property q.l "load"
    Property q.s "speed"
Package b "Base"
  Instance b.f "FAR" value=7
  Instance b.t "LIMIT" value=8
  Import b.i subkind="package"
    -> references d
Package k "Secrets"
  Instance k.h "HIDDEN" value=7
"""


def find_elements(text, user):
    """Return the ids of the elements of the names in a guard, in the order of the text."""
    graph = parse_text(NAMES.replace("{text}", text))
    pipeline.load("inherit").run(graph, Sink())
    pipeline.load("expressions").run(graph, Sink())
    nodes = walk_tree(graph[user].attrs["guard"].tree)
    return [node.element for node in nodes if isinstance(node, Name | Member)]


@pytest.mark.parametrize(
    ("text", "user", "elements"),
    [
        ("load > level", "t.t", ["t.b", "m.l"]),
        ("load > level", "t.f", ["t.p", "m.l"]),
        ("arm.load > 3", "t.t", ["a.l", "t.a"]),
        ("arm.size > 3", "t.t", ["", "t.a"]),
        ("self.level > 3", "t.t", ["m.l", ""]),
        ("mode == Mode::auto", "t.t", ["m.m", "e.a"]),
        ("mode == Mode.auto", "t.t", ["m.m", "e.a", "e"]),
        ("mode == auto", "t.t", ["m.m", "e.a"]),
        ("order.amount > 3", "t.t", ["g.n", "t.g"]),
        ("amount > Go.amount", "t.t", ["g.n", "g.n", "g"]),
        ("amount > 3", "t.f", [""]),
        ("weigh.mass > 3", "t.f", ["t.o", "t.w"]),
        ("hall.tank", "t.t", ["h.t", "n.h"]),
        ("Other::Arm::load > Arm::load", "t.t", ["q.l", "a.l"]),
        ("speed > 3 or winter", "t.t", ["", "s.w"]),
        ("mode == Season::winter", "t.t", ["m.m", "s.w"]),
        ("LOW < load and load < MAX", "t.t", ["d.l", "t.b", "t.b", "q.m"]),
        ("load < FAR and load < HIDDEN", "t.t", ["t.b", "b.f", "t.b", ""]),
        ("load < TOP and load < Base::FAR", "t.t", ["t.b", "b.t", "t.b", "b.f"]),
    ],
)
def test_a_name_carries_the_element_that_it_denotes(text, user, elements):
    """Package Defaults, which is imported, passes on what it imports from Base, but no secrets."""
    assert find_elements(text, user) == elements


@pytest.mark.parametrize(
    ("text", "names"),
    [
        ("Tank::load > 3", ["load"]),
        ("Plant::Tank::load > Tank::level", ["load", "level"]),
        ("Arm::load > 3", ["Arm", "load"]),
    ],
)
def test_a_qualified_name_of_an_own_feature_is_read_like_its_name(text, names):
    """'Tank::load' in a text of Tank is the load of this tank, not that of another object."""
    graph = parse_text(NAMES.replace("{text}", text))
    pipeline.load("inherit").run(graph, Sink())
    pipeline.load("expressions").run(graph, Sink())
    guard = graph["t.t"].attrs["guard"]
    assert list_names(guard) == names
    assert str(guard) == text


@pytest.mark.parametrize(
    ("elements", "tree"),
    [
        ("", Literal(True)),
        ('Property c.y "True"', Name(("True",), "c.y")),
        ('Enumeration e "E"\n    EnumerationLiteral e.t "True"', Name(("True",), "e.t")),
    ],
)
def test_the_truth_values_of_python_give_way_to_elements_of_their_name(elements, tree):
    graph = parse_text(f'Class c "C"\n  {elements}\n  Constraint c.k body="True"\n')
    pipeline.load("expressions").run(graph, Sink())
    assert graph["c.k"].attrs["body"].tree == tree
