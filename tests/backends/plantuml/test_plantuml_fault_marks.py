"""Marks on elements with errors."""

import pytest

import backend_runs
from sysmlc.backends.base import EmitOptions
from sysmlc.backends.plantuml import BACKEND
from sysmlc.ir.text import parse_text

MODEL = """
Package p "P"
  Class line "Line"
    Property line.belt "belt" aggregation="composite"
      -> typed-by belt
  Class belt "Belt"
    Port belt.out "out" direction="out"
    StateMachine modes "Modes"
      Region r ""
        State on "On"
        State off "Off"
        Transition t
          -> flow-source on
          -> flow-target off
"""


def draw_with_errors(*faulty):
    """Return the lines with a mark, by diagram."""
    options = EmitOptions(faulty=frozenset(faulty))
    files, _ = backend_runs.emit(BACKEND, parse_text(MODEL), options)
    assert all(file.marks_faults for file in files.values())
    return {
        path.removeprefix("diagrams/"): [line for line in file.text.splitlines() if "⚠" in line]
        for path, file in files.items()
        if "⚠" in file.text
    }


def test_without_errors_nothing_is_marked():
    assert draw_with_errors() == {}


def test_a_shape_is_marked_in_each_diagram_that_shows_its_element():
    marked = draw_with_errors("belt")
    assert '"<color:#C53030>⚠</color> ' in marked["P.bdd.puml"][0]
    assert "**Belt**" in marked["P.bdd.puml"][0]


@pytest.mark.parametrize("faulty", ["on", "t"])
def test_states_and_transitions_are_marked(faulty):
    (line,) = draw_with_errors(faulty)["P.Belt.Modes.stm.puml"]
    assert ("On" in line) == (faulty == "on")


def test_the_frame_is_marked_where_an_owner_has_the_error():
    (frame,) = draw_with_errors("belt")["P.Belt.Modes.stm.puml"]
    assert frame == "mainframe <color:#C53030>⚠</color> stm Modes"


def test_diagrams_of_other_elements_have_no_mark():
    assert "P.Belt.Modes.stm.puml" not in draw_with_errors("line")
