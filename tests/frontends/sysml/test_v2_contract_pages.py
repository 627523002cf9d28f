"""Pages of contracts contain the documentation of the model, the guarantees and their origin."""

import pytest
from reading_v2 import read

from refinement import run_all
from sysmlc.analyses.contracts import Contracts
from sysmlc.backends.contract_pages import print_page
from sysmlc.diagnostics import Sink
from sysmlc.logic.contract import Contract
from sysmlc.logic.printing import print_formula

LINE = """
package Plant {
    private import LineMachines::*;
    private import DIN8580::*;
    part def Line {
        action carry : Convey;
        action clamp : Clamping;
        action screw : Screwing { doc /* Two turns.

            The rest is for the worker. */ }
    }
}
"""


@pytest.fixture(scope="module")
def pages():
    reading = read(LINE)
    run_all(reading.graph, reading.sink)
    graph = reading.graph
    return {contract.component: print_page(graph, contract) for contract in graph.derived(Contract)}


def test_a_page_begins_with_the_documentation_in_the_library(pages):
    lines = pages["Plant::Line.carry"].splitlines()
    assert lines[:3] == [
        "# Contract of Plant::Line.carry",
        "",
        "A belt with one piece carries it from the first place to the last, and waits there.",
    ]


def test_the_nearest_comment_goes_before_and_its_first_paragraph_is_enough(pages):
    assert pages["Plant::Line.screw"].splitlines()[2] == "Two turns."


def test_conjuncts_of_a_requirement_have_its_name(pages):
    text = pages["Plant::Line.carry"]
    assert "- Only a free belt is loaded. *(requirement 'ConveyContract')*\n  `loaded' ->" in text
    assert "demands it" not in text


GATE = """
package Plant {
    private import ScalarValues::*;
    part def Gate { in attribute open : Boolean; out attribute locked : Boolean; }
    requirement def Lock {
        subject gate : Gate;
        require constraint { language "fret"
            /* When open, the Gate shall immediately satisfy !locked. */ }
    }
    requirement def Keep {
        doc /* A closed gate is locked */
        subject gate : Gate;
        require constraint { language "ltl" /* G (!open -> locked) */ }
    }
}
"""


def test_a_demand_has_the_sentence_of_the_author():
    """It is that of the constraint, or else the text of the requirement."""
    reading = read(GATE)
    run_all(reading.graph, reading.sink)
    (contract,) = reading.graph.derived(Contract)
    page = print_page(reading.graph, contract)
    assert "- A closed gate is locked. 'Keep' demands it. " in page
    assert "- When open, the Gate shall immediately satisfy !locked. 'Lock' demands it. " in page


@pytest.mark.parametrize(
    ("language", "text", "reason"),
    [
        ("fret", "", "it is empty"),
        ("ltl", "", "it is empty"),
        ("ltl", "G gate.marks", "'gate.marks' has several values (column 3)"),
        ("fret", "The Gate shall always satisfy marks.", "'marks' has several values (column 31)"),
        ("fret", "The Gate shall always satisfy open.", ""),
    ],
)
def test_a_formula_without_meaning_is_reported_with_the_reason(language, text, reason):
    formula = f'{{ language "{language}" /* {text} */ }}'
    reading = read(f"""package Plant {{
        private import ScalarValues::*;
        part def Gate {{ attribute open : Boolean; attribute marks : Boolean[3]; }}
        requirement def Lock {{ subject gate : Gate; require constraint {formula} }}
    }}""")
    run_all(reading.graph, reading.sink)
    messages = [item.message for item in reading.sink if item.rule.code == "SM522"]
    start = "the formula of 'the constraint' in requirement 'Lock' is not understood: "
    assert messages == ([start + reason] if reason else [])


TIMED = """package Plant {
    private import ScalarValues::*;
    part def Gate { in attribute open : Boolean; out attribute shut : Boolean; }
    requirement def Shuts { subject gate : Gate; require constraint { language "fret"
        /* Whenever open, the Gate shall within 2 seconds satisfy shut. */ } }
}"""


def test_a_duration_in_seconds_depends_on_the_length_of_a_step():
    reading = read(TIMED)
    run_all(reading.graph, Sink())
    Contracts(tick_seconds=2.0).run(reading.graph, Sink())
    (contract,) = reading.graph.derived(Contract)
    assert [print_formula(item.formula) for item in contract.guarantees] == ["open -> shut | shut'"]


def test_a_duration_between_two_steps_is_reported():
    reading, sink = read(TIMED), Sink()
    run_all(reading.graph, Sink())
    Contracts(tick_seconds=1.5).run(reading.graph, sink)
    (finding,) = sink
    assert finding.message.endswith(
        "2 seconds are no whole number of steps of 1.5 s: write ticks, or change tick_seconds "
        "(column 38)"
    )


def test_an_empty_formula_of_a_constraint_is_reported():
    reading = read("""package Plant { part def Gate {
        exhibit state S { entry; then A; state A; }
        constraint calm { language "ltl" /* */ }
    } }""")
    run_all(reading.graph, reading.sink)
    assert [item.message for item in reading.sink if item.rule.code == "SM501"] == [
        "the formula of 'calm' is not understood: it is empty"
    ]


def test_conjuncts_of_a_constraint_have_its_name_and_steps_that_of_the_diagram(pages):
    text = pages["Plant::Line.clamp"]
    assert "- Asks for pick. *(constraint of 'Clamping')*\n  `asked=pick <->" in text
    assert "- Action 'pick' runs from when all its flows have brought a token until" in text


def test_markup_of_tools_is_not_copied():
    reading = read(LINE.replace("Two turns.", "<p>Two turns</p>"))
    run_all(reading.graph, reading.sink)
    (page,) = (
        print_page(reading.graph, contract)
        for contract in reading.graph.derived(Contract)
        if contract.component.endswith("screw")
    )
    assert "<p>" not in page
    assert page.splitlines()[2] == "A screw is turned in."
