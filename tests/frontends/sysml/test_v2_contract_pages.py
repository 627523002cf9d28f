"""Pages of contracts contain the documentation of the model, the guarantees and their origin."""

import pytest
from reading_v2 import read

from sysmlc.backends.contract_pages import print_page
from sysmlc.logic.contract import Contract
from sysmlc.passes import pipeline

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
    pipeline.run(reading.graph, reading.sink)
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


def test_conjuncts_of_a_constraint_have_its_name_and_steps_that_of_the_diagram(pages):
    text = pages["Plant::Line.clamp"]
    assert "- Asks for pick. *(constraint of 'Clamping')*\n  `asked=pick <->" in text
    assert "- Action 'pick' runs from when all its flows have brought a token until" in text


def test_markup_of_tools_is_not_copied():
    reading = read(LINE.replace("Two turns.", "<p>Two turns</p>"))
    pipeline.run(reading.graph, reading.sink)
    (page,) = (
        print_page(reading.graph, contract)
        for contract in reading.graph.derived(Contract)
        if contract.component.endswith("screw")
    )
    assert "<p>" not in page
    assert page.splitlines()[2] == "A screw is turned in."
