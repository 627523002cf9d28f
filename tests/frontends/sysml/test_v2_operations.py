"""Composite operations of the library DIN8580: usages have contracts, and machines perform them."""

from itertools import takewhile
from pathlib import Path

import pytest
from reading_v2 import read

from refinement import run_all
from sysmlc.diagnostics import Sink
from sysmlc.logic.composition.derivation import compose_blocks
from sysmlc.logic.contract import Contract, Owner
from sysmlc.logic.printing import print_formula
from sysmlc.synthesis import composition_check as together
from sysmlc.synthesis.contract_checks import check_contracts
from sysmlc.synthesis.decision import Options

STEPS = {
    "Dismantling": ["decompose"],
    "Emptying": ["pick", "turn", "place"],
    "Shifting": ["pick", "move", "place"],
    "Screwing": ["turn"],
    "Clamping": ["pick", "move", "turn", "place"],
    "Embedding": ["pick", "move", "place"],
}
"""Thesis, section 5.2.1."""
ACTIONS = {
    "pick": "action pick : Pick; bind pick.command = command; bind pick.executed = pick_executed;",
    "place": """action place : Place { out attribute :>> grip := false; }
        bind place.command = command; bind place.executed = place_executed;""",
    "move": """action move : CoordinatedMove {
            constant attribute :>> columns = 2;
            constant attribute :>> rows = 2;
        }
        bind move.command = command; bind move.moved = move_executed; bind move.grip = grip;""",
    "turn": """constant attribute :>> positions = 4;
        action turn : CoordinatedTurn { constant attribute :>> positions = 4; }
        bind turn.command = command; bind turn.turned = turn_executed; bind turn.grip = grip;
        bind turn.angle = angle; bind turn.desired = desired;""",
}
KINDS = {"pick": "Supplied", "place": "Operating", "move": "Moving", "turn": "Turning"}
JOINED = """
        bind place.executed = pick.placed;
        bind pick.executed = place.picked;
        bind pick.pos = piece;
        bind place.pos = space;
"""


def write_machine(able, operation):
    """Return the text of a machine with some actions and a coordinator."""
    kinds, actions = (
        ", ".join(KINDS[name] for name in able),
        "\n".join(ACTIONS[action_name] for action_name in able),
    )
    return f"""package Cells {{
    private import DIN8580::*;
    part def Machine :> {kinds} {{ {actions} {JOINED} {operation} }}
}}"""


BOUND = {
    "move": "bind clamp.move.executed = move.moved;",
    "turn": "bind clamp.turn.executed = turn.turned;",
}
"""Being at the target persists: one notification ends a step."""
CLAMPS = "\n".join(["action clamp : Clamping;", "bind clamp.asked = asked;", *BOUND.values()])
DISMANTLES = """
package Cells {
    private import DIN8580::*;
    part def Opener :> Dismounting, Operating {
        action decompose : CoordinatedDecompose;
        action dismantle : Dismantling;
        bind decompose.command = command;
        bind decompose.decomposed = decompose_executed;
        bind decompose.part1 = piece;
        bind dismantle.asked = asked;
        bind dismantle.decompose.executed = decompose.decomposed;
    }
}
"""
MOUNTS = """
package Cells {
    private import DIN8580::*;
    part def Mounter :> Mounting {
        action compose : CoordinatedCompose;
        bind compose.command = command;
        bind compose.composed = compose_executed;
        bind compose.part1 = part1;
        bind compose.part2 = part2;
    }
}
"""


def compile_text(text):
    reading = read(text)
    run_all(reading.graph, reading.sink)
    assert [diagnostic.message for diagnostic in reading.sink] == []
    return reading.graph


def list_contracts(text):
    return {contract.component: contract for contract in compile_text(text).derived(Contract)}


def check_composition(text):
    graph, sink = compile_text(text), Sink()
    compositions = list(compose_blocks(graph, graph.derived(Contract), sink))
    place = lambda id: graph.subject(graph[id])  # noqa: E731
    (result,) = together.check_compositions(compositions, place, sink, Options())
    return result.text(), [(diagnostic.rule.code, diagnostic.message) for diagnostic in sink]


@pytest.mark.parametrize("operation", STEPS)
def test_a_usage_asks_for_its_steps_one_after_the_other(operation):
    text = f"package P {{ part def Cell {{ action work : DIN8580::{operation}; }} }}"
    contracts = list_contracts(text)
    assert list(contracts) == ["P::Cell.work"]
    contract, steps = contracts["P::Cell.work"], STEPS[operation]
    sides = {
        side: [variable.name for variable in contract.variables if variable.owner is side]
        for side in Owner
    }
    assert sides[Owner.ENVIRONMENT] == ["start_work", *(f"done_{step}" for step in steps)]
    assert {"asked", *(f"run_{step}" for step in steps)} <= set(sides[Owner.SYSTEM])
    assert [print_formula(assumption.formula) for assumption in contract.assumptions] == [
        f"!run_{step} | done_{step}" for step in steps
    ]
    promised = [print_formula(guarantee.formula) for guarantee in contract.guarantees]
    for step in steps:
        assert f"asked={step} <-> run_{step} & !done_{step}" in promised


@pytest.mark.parametrize("operation", STEPS)
def test_a_usage_can_be_kept_and_nothing_is_suspicious_in_it(operation):
    text = f"package P {{ part def Cell {{ action work : DIN8580::{operation}; }} }}"
    graph, sink = compile_text(text), Sink()
    contracts = graph.derived(Contract)
    (result,) = check_contracts(
        contracts, contracts, lambda id: graph.subject(graph[id]), sink, Options()
    )
    assert result.verdict.is_realizable
    assert [diagnostic.message for diagnostic in sink] == []


def test_a_usage_with_constraints_of_its_own_has_the_steps_of_its_definition():
    text = """package P { part def Cell { action work : DIN8580::Screwing {
        constraint { language "ltl" /* G F asked=turn */ }
    } } }"""
    (contract,) = list_contracts(text).values()
    assert contract.component == "P::Cell.work"
    assert "asked=turn" in [print_formula(guarantee.formula) for guarantee in contract.guarantees]
    assert "run_turn" in [variable.name for variable in contract.variables]


@pytest.mark.parametrize("operation", [step for step in STEPS if step != "Dismantling"])
def test_actions_a_coordinator_and_an_operation_fit_together(operation):
    able = [action for action in ACTIONS if action in {"pick", "place", *STEPS[operation]}]
    lines = [f"action work : {operation};", "bind work.asked = asked;"]
    lines += [BOUND[action].replace("clamp", "work") for action in BOUND if action in able]
    verdict, diagnostics = check_composition(write_machine(able, "\n".join(lines)))
    assert verdict == f"Cells::Machine: its {len(able) + 2} behaviours fit together"
    assert diagnostics == []


def test_two_arms_dismantle_what_comes():
    assert check_composition(DISMANTLES) == ("Cells::Opener: its 3 behaviours fit together", [])


def test_two_arms_mount_what_comes():
    assert check_composition(MOUNTS) == ("Cells::Mounter: its 2 behaviours fit together", [])


def test_a_step_ends_when_the_one_action_that_performs_it_is_executed():
    graph = compile_text(write_machine(ACTIONS, CLAMPS))
    (composition,) = compose_blocks(graph, graph.derived(Contract), Sink())
    (clamp,) = (part.contract for part in composition.parts if part.name == "clamp")
    inputs = [variable.name for variable in clamp.variables if variable.owner is Owner.ENVIRONMENT]
    assert inputs == ["pick_executed", "move_executed", "turn_executed", "place_executed"]


def test_a_binding_selects_one_of_two_actions_that_could_perform_a_step():
    two = CLAMPS + "        action other : Pick;\n"
    for bound, name in (("", "clamp.done_pick"), ("bind clamp.pick = other;", "other.executed")):
        graph = compile_text(write_machine(ACTIONS, two + bound))
        (composition,) = compose_blocks(graph, graph.derived(Contract), Sink())
        (clamp,) = (part.contract for part in composition.parts if part.name == "clamp")
        assert name in [variable.name for variable in clamp.variables]


@pytest.mark.long
def test_an_operation_whose_requests_nothing_reads_is_reported():
    """Its steps end when the actions are executed, which nobody asks for."""
    text = write_machine(ACTIONS, CLAMPS.replace("bind clamp.asked = asked;", ""))
    verdict, diagnostics = check_composition(text)
    assert verdict == "Cells::Machine: its 6 behaviours do not fit together"
    assert {code for code, _ in diagnostics} == {"SM595", "SM596"}


PAGE = (Path(__file__).parents[3] / "docs" / "elementary-actions.md").read_text(encoding="utf-8")


def read_page_example(start):
    """A part of the page: from a line to the next that is not indented."""
    lines = PAGE[PAGE.index(start) :].splitlines()
    return "\n".join(takewhile(lambda line: not line or line.startswith(" "), lines))


def test_the_machine_of_the_page_fits_together_and_not_without_pieces():
    text = (
        "package Cells { private import DIN8580::*;\n"
        + read_page_example("    part def Loader")
        + "}"
    )
    assert check_composition(text) == ("Cells::Loader: its 4 behaviours fit together", [])
    waiting = text.replace("Supplied", "Picking, Placing")
    waiting = waiting.replace("bind pick.pos = piece;", "").replace("bind place.pos = space;", "")
    verdict, diagnostics = check_composition(waiting)
    assert verdict == "Cells::Loader: its 4 behaviours do not fit together"
    assert {code for code, _ in diagnostics} == {"SM596"}


def test_an_operation_of_ones_own_is_performed_as_those_of_the_library_are():
    swap = read_page_example("    action def Swapping")
    able = [action for action in ACTIONS if action in ("pick", "place")]
    lines = write_machine(able, "action swap : Swapping; bind swap.asked = asked;")
    text = lines.replace("part def Machine", f"{swap}\n    part def Machine")
    assert check_composition(text) == ("Cells::Machine: its 4 behaviours fit together", [])


def test_an_operation_inside_another_has_no_end_of_its_own_which_is_reported():
    swap = read_page_example("    action def Swapping")
    lines = write_machine(
        [action for action in ACTIONS if action in ("pick", "place")],
        "action twice : Twice; bind twice.asked = asked;",
    )
    twice = """
    action def Twice :> Operation {
        out attribute :>> asked : Command := Command::none;
        first start;
        then action swap : Swapping;
        then action pick : Pick;
        constraint { language "ltl" /* G (asked=pick <-> run_pick & !done_pick) */ }
        constraint { language "ltl" /* G (asked=none | asked=pick) */ }
    }
"""
    text = lines.replace("part def Machine", f"{swap}{twice}\n    part def Machine")
    verdict, diagnostics = check_composition(text)
    assert verdict == "Cells::Machine: its 4 behaviours fit together"
    assert diagnostics == [
        (
            "SM508",
            "no behaviour of 'Machine' determines when step 'swap' of 'twice' ends; the "
            "environment of the block decides it",
        )
    ]
