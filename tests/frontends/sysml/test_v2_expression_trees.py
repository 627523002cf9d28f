"""Texts of expressions have the syntax trees that the front end has read."""

from reading_v2 import read

from sysmlc.ir.expressions import (
    EffectText,
    ExpressionText,
    Name,
    ParsedText,
    element_of,
    walk_tree,
)
from sysmlc.logic.expressions.parsing import parse_effect, parse_expression

MODEL = """
package Plant {
    private import ScalarValues::*;
    enum def Mode { enum auto; enum hand; }
    attribute limit : Integer = 9;
    attribute def Go { attribute amount : Integer; }
    part def Tank {
        attribute level : Integer = -2 + 3 * limit;
        attribute open : Boolean = false;
        attribute mode : Mode = Mode::auto;
        assert not constraint { level - 1 < 0 }
        action fill { assign level := level + 1; then assign open := not open; }
        state run {
            entry; then idle;
            state idle { entry action { assign open := true; } }
            state full;
            transition first idle accept Go if level >= limit or mode == Mode::hand then full;
            transition first full accept when (if open ? level else 0) > 3 do send Go(2) to self
                then idle;
        }
    }
}
"""


def test_each_tree_is_that_of_the_text():
    graph = read(MODEL).graph
    values = [v for e in graph for v in e.attrs.values() if isinstance(v, ParsedText)]
    for value in values:
        parse = parse_effect if isinstance(value, EffectText) else parse_expression
        assert parse(value) == value.tree
    assert "level >= limit or mode == Mode::hand" in values
    assert "(if open ? level else 0) > 3" in values
    assert "not (level - 1 < 0)" in values
    assert "level := level + 1; open := not open" in values
    assert "send Go(2) to self" in values


def test_names_carry_the_elements_that_they_denote_also_later_ones():
    graph = read(MODEL).graph
    values = [v for e in graph for v in e.attrs.values() if isinstance(v, ParsedText)]
    names = [n for v in values for n in walk_tree(v.tree) if isinstance(n, Name) and n.element]
    assert {(n.path, graph.qualified_name(graph[n.element])) for n in names} == {
        (("limit",), "Plant::limit"),
        (("level",), "Plant::Tank::level"),
        (("open",), "Plant::Tank::open"),
        (("mode",), "Plant::Tank::mode"),
        (("Mode", "hand"), "Plant::Mode::hand"),
        (("Go",), "Plant::Go"),
    }


def test_each_step_of_a_chain_carries_the_element_that_it_denotes():
    graph = read(
        """
        package Plant {
            part def Cell { attribute full : ScalarValues::Boolean; }
            part def Line {
                part cell : Cell;
                action clear { assign cell.full := not cell.full; }
            }
        }
        """
    ).graph
    (effect,) = (v for e in graph for v in e.attrs.values() if isinstance(v, EffectText))
    ids = filter(None, map(element_of, walk_tree(effect.tree)))
    full, cell = "Plant::Cell::full", "Plant::Line::cell"
    assert [graph.qualified_name(graph[id]) for id in ids] == [full, cell, full, cell]


def test_an_expression_that_is_nested_too_deeply_has_no_tree():
    graph = read("part def P { attribute a = b" + " + b" * 200 + "; attribute b; }").graph
    defaults = [element.attrs["default"] for element in graph if "default" in element.attrs]
    assert defaults
    assert not any(isinstance(value, ExpressionText) for value in defaults)


def test_an_imported_constant_that_another_one_hides_is_written_with_its_package():
    """A reader of the text alone, such as that of UML, takes the constant around the block."""
    guards = {"Plant::Cold": "level < MAX", "Plant::Inner::Tank": "level < Limits::MAX"}
    graph = read(
        """
        package Limits { attribute MAX : ScalarValues::Natural = 5; }
        package Plant {
            item def Go;
            attribute MAX : ScalarValues::Natural = 3;
            part def Cold {
                attribute level : ScalarValues::Natural;
                exhibit state s { entry; then A; state A; accept Go if level < MAX then A; }
            }
            package Inner {
                private import Limits::MAX;
                part def Tank {
                    attribute level : ScalarValues::Natural;
                    exhibit state s { entry; then A; state A; accept Go if level < MAX then A; }
                }
            }
        }
        """
    ).graph
    for block, guard in guards.items():
        elements = graph.subtree(graph[block])
        assert [e.attrs["guard"] for e in elements if "guard" in e.attrs] == [guard]
