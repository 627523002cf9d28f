"""Rules about blocks with parts, and the texts of the verdicts."""

import pytest
from reading_v2 import read

from refinement import run_all
from sysmlc.diagnostics import Sink, catalogue
from sysmlc.logic.composition.derivation import compose_blocks
from sysmlc.logic.contract import Contract
from sysmlc.synthesis import Limits
from sysmlc.synthesis import composition_check as together
from sysmlc.synthesis import composition_check as together_rules
from sysmlc.synthesis.contract_checks import check_contracts
from sysmlc.synthesis.decision import Options

CODES = ("SM506", "SM548", "SM595", "SM596", "SM597", "SM598")


def check_model(text, limits=None):
    reading = read(text)
    run_all(reading.graph, reading.sink, verify_each=True)
    graph, sink = reading.graph, Sink()
    options = Options("", limits or Limits())
    compositions = list(compose_blocks(graph, graph.derived(Contract), sink))
    results = together.check_compositions(
        compositions, lambda id_: graph.subject(graph[id_]), sink, options
    )
    return list(results), list(sink)


@pytest.mark.parametrize("code", CODES)
def test_rule_reports_its_wrong_model_and_not_its_right_one(code):
    rule = catalogue()[code]
    assert code in [diagnostic.rule.code for diagnostic in check_model(rule.read_page().wrong)[1]]
    assert check_model(rule.read_page().right)[1] == []


def test_an_assumption_that_nothing_guarantees_is_reported_with_a_run():
    (result,), diagnostics = check_model(together_rules.OPEN.read_page().wrong)
    assert result.text() == "Line::Cell: its 2 parts together violate its contract"
    assert [diagnostic.rule.code for diagnostic in diagnostics] == ["SM595", "SM597"]
    assert diagnostics[0].message == (
        "part 'picker' of 'Line::Cell' assumes 'feeder.ready', which neither the other parts "
        "nor the block's assumptions guarantee "
        "('Takes' assumes it)"
    )
    assert diagnostics[0].notes[0].startswith("step 1: feeder.ready=false")
    not_used = "the guarantees of 'picker' were not used, because they depend on open assumptions"
    assert diagnostics[1].notes[-1] == not_used
    assert [witness.broken.text for witness in result.witnesses] == [
        "'Takes' assumes it.",
        "'Works' demands it.",
    ]


def test_parts_of_a_block_that_promises_nothing_fit_or_do_not():
    for rule, words in ((together_rules.OPEN, "do not fit"), (together_rules.BREAK, "fit")):
        silent = (
            rule.read_page()
            .wrong.replace("subject cell : Cell", "subject cell : Other")
            .replace(
                "part def Cell",
                "part def Other { out attribute taken : Boolean; }\n    part def Cell",
            )
        )
        (result,), _ = check_model(silent)
        assert result.text() == f"Line::Cell: its 2 parts {words} together"


def test_a_check_beyond_the_limits_is_not_decided():
    (result,), (diagnostic,) = check_model(together_rules.BREAK.read_page().right, Limits(nodes=1))
    reason = "the limit of 1 node was reached"
    assert result.text() == f"Line::Cell: the composition of its parts is not decided: {reason}"
    assert diagnostic.message == (
        f"the composition of the parts of 'Line::Cell' is not decided: {reason}"
    )


def check_requirements(text):
    reading = read(text)
    run_all(reading.graph, reading.sink, verify_each=True)
    graph, sink = reading.graph, Sink()
    contracts = graph.derived(Contract)
    list(
        check_contracts(
            contracts, contracts, lambda id_: graph.subject(graph[id_]), sink, Options()
        )
    )
    return {diagnostic.rule.code: diagnostic for diagnostic in sink}


def test_requirements_that_lean_on_one_another():
    rule = catalogue()["SM599"]
    diagnostic = check_requirements(rule.read_page().wrong)["SM599"]
    assert diagnostic.notes == ("'Shines' demands 'lit'", "'Shines' demands 'lit -> power'")
    assert "SM599" not in check_requirements(rule.read_page().right)


APART = together_rules.OPEN.read_page().right.replace("bind feeder.ready = picker.ready;", "")


def test_parts_that_share_no_variable_are_not_reported_as_fitting():
    silent = APART.replace("subject cell : Cell", "subject cell : Other").replace(
        "part def Cell", "part def Other { out attribute taken : Boolean; }\n    part def Cell"
    )
    (result,), diagnostics = check_model(silent)
    assert result.text() == "Line::Cell: its 2 parts share no variables"
    assert diagnostics == []


def test_connected_parts_without_a_message_in_their_contracts_are_not_called_unconnected():
    """What a do behaviour sends is in no contract of the sender, although a connector exists."""
    (result,), _ = check_model(
        """package P {
        item def Go;
        port def Out { out item go : Go; }
        part def Sender {
            port p : Out;
            exhibit state States { entry; then On; state On { do send Go() via p; } }
        }
        part def Receiver {
            port q : ~Out;
            exhibit state States {
                entry; then Off;
                state Off;
                transition first Off accept Go via q then On;
                state On;
            }
        }
        part def Cell { part s : Sender; part r : Receiver; connect s.p to r.q; }
    }"""
    )
    assert result.text() == "P::Cell: its 2 parts share no variables"


def test_a_part_alone_keeps_what_the_block_promises_and_the_others_do_not_matter():
    """Nothing tells the picker that a part is ready, and the block does not assume it."""
    (result,), diagnostics = check_model(APART)
    assert result.text() == "Line::Cell: its 2 parts together violate its contract"
    assert [diagnostic.rule.code for diagnostic in diagnostics] == ["SM595", "SM597"]


def test_a_guarantee_about_a_variable_of_no_part_is_not_checked():
    nobody = together_rules.OPEN.read_page().right.replace("bind picker.taken = taken;", "")
    (result,), diagnostics = check_model(nobody)
    reason = "no part decides 'taken', which guarantees of the block are about"
    assert result.text() == f"Line::Cell: the composition of its parts is not decided: {reason}"
    assert [diagnostic.message for diagnostic in diagnostics] == [
        f"the composition of the parts of 'Line::Cell' is not decided: {reason}"
    ]


def test_two_that_send_the_same_lose_one_of_it():
    wrong = together_rules.LOST.read_page().wrong.replace("do send off()", "do send on()")
    _, diagnostics = check_model(wrong)
    assert [diagnostic.message for diagnostic in diagnostics] == [
        "in 'Room::Room' two messages are sent in one step, and one of them is lost ('on' by 'one' "
        "and 'on' by 'other' are sent to 'lamp')"
    ]
    assert diagnostics[0].notes[-1] == "then again from step 4"
