"""``sysmlc synth``: verdicts, figures, machines, counter-strategies, limits and deadlines."""

import json
import re

import pytest

from sysmlc.synthesis import controller_synthesis, rules
from sysmlc.synthesis.bdd.limits import LimitError
from sysmlc.synthesis.counterstrategy import counter_machine

MACHINE = """
StateMachine gate "Gate"
  Region r
    Pseudostate i subkind="initial"
    State open "Open"
    Transition t
      -> flow-source i
      -> flow-target open
"""


def test_a_contract_is_decided_with_figures(workspace):
    workspace.write("lamp.gr1.json", rules.UNREALIZABLE.read_page().right)
    result = workspace.sysmlc("synth", "lamp.gr1.json", "--realizable")
    assert result.exit_code == 0
    figures = r"lamp: realizable \(2 variables, 2 bits, 1 conjunct; .* nodes, .* s\)\n"
    assert re.fullmatch(figures, result.stdout)


def test_an_unrealizable_contract_is_an_error_and_exit_code_1(workspace):
    workspace.write("lamp.gr1.json", rules.UNREALIZABLE.read_page().wrong)
    result = workspace.sysmlc("synth", "lamp.gr1.json", "--realizable")
    assert result.exit_code == 1
    assert "error[SM532 contract-unrealizable]: no system can satisfy the contract" in result.stderr
    assert result.stdout.startswith("lamp: unrealizable (")


def test_a_conjunct_outside_gr1_is_located_and_exit_code_2(workspace):
    workspace.write("lamp.gr1.json", rules.OUTSIDE_GR1.read_page().wrong)
    result = workspace.sysmlc("synth", "lamp.gr1.json", "--realizable")
    assert [result.exit_code, result.stdout] == [2, "lamp: not decided\n"]
    assert "error[SM530 conjunct-outside-gr1]: '!lamp' of 'lamp' is outside" in result.stderr
    assert "--> lamp.gr1.json:2:" in result.stderr


def test_every_conjunct_outside_gr1_is_named(workspace):
    contract = "NAME: n;\nCONTRACT c: output boolean variable a; Assumptions: true; Guarantees: {};"
    workspace.write("c.ltl", contract.format("F G a & G F a & (G F a -> F G !a)"))
    conjuncts = re.findall(r"SM530 .*: ('.*') of 'n.c'", workspace.sysmlc("synth", "c.ltl").stderr)
    assert conjuncts == ["'F G a'", "'G F a -> F G !a'"]


def test_the_right_example_of_each_rule_is_decided(workspace):
    for rule in (rules.OUTSIDE_GR1, rules.UNREALIZABLE):
        workspace.write("right.gr1.json", rule.read_page().right)
        assert workspace.sysmlc("synth", "right.gr1.json", "--realizable").exit_code == 0


ONE_READABLE_CONTRACT = """NAME: line;
CONTRACT good: output boolean variable lamp; Assumptions: true; Guarantees: G F(lamp);
CONTRACT bad: output boolean variable lamp; Assumptions: true; Guarantees: G F(lamp));
"""


@pytest.mark.parametrize("command", [["synth"], ["synth", "--realizable"], ["contracts", "check"]])
def test_an_unreadable_contract_is_exit_code_2_even_beside_a_realizable_one(workspace, command):
    workspace.write("line.ltl", ONE_READABLE_CONTRACT)
    result = workspace.sysmlc(*command, "line.ltl")
    assert result.exit_code == 2
    assert result.stdout.startswith("line.good: realizable")
    assert "--> line.ltl:3:85" in result.stderr


WIDE_NUMBERS = {
    "variables": {
        **{f"a{n}": {"owner": "env", "type": [0, 30]} for n in range(4)},
        **{f"x{n}": {"owner": "sys", "type": [0, 30]} for n in range(4)},
    },
    "guarantees": {"safety": [f"x{n}' * x{n}' > a{n}' * a{3 - n}'" for n in range(4)]},
}


def test_a_reached_limit_is_named(workspace):
    workspace.write("wide.gr1.json", json.dumps(WIDE_NUMBERS))
    result = workspace.sysmlc("synth", "wide.gr1.json", "--realizable", "--nodes", "10")
    assert [result.exit_code, result.stdout] == [2, "wide: not decided\n"]
    message = "error[SM531 synthesis-limit]: 'wide' is undecided: the limit of 10 nodes"
    assert message in result.stderr


def test_contracts_of_a_model_are_decided_by_component(workspace, all_passes):
    workspace.write("gate.ir", MACHINE)
    result = workspace.sysmlc("synth", "gate.ir", "--realizable", "-c", "Gate")
    assert [result.exit_code, result.stdout.split(" (")[0]] == [0, "Gate: realizable"]
    misspelt = workspace.sysmlc("synth", "gate.ir", "--realizable", "-c", "Gat")
    assert [misspelt.exit_code, "did you mean 'Gate'" in misspelt.stderr] == [2, True]


def test_a_conjunct_that_needs_a_history_bit_is_decided(workspace):
    text = rules.UNREALIZABLE.read_page().right.replace(
        '"safety": ["lamp\' <-> go\'"]', '"liveness": ["go -> lamp\'"]'
    )
    workspace.write("lamp.gr1.json", text)
    result = workspace.sysmlc("synth", "lamp.gr1.json", "--realizable")
    assert result.stdout.startswith("lamp: realizable (3 variables")


@pytest.mark.parametrize(
    ("args", "sentence"),
    [
        (["none.gr1.json", "--realizable"], "cannot read 'none.gr1.json'"),
        (["plant.ir", "--realizable", "-o", "out"], "--realizable decides only"),
        (["plant.ir", "--realizable", "--from", "cobol"], "'cobol' is not a supported format"),
        (["plant.ir", "--realizable"], "no behaviour and no requirement that gives a contract"),
    ],
)
def test_a_wrong_argument_of_synth_is_one_sentence_and_exit_code_2(workspace, args, sentence):
    result = workspace.sysmlc("synth", *args)
    assert result.exit_code == 2
    assert sentence in result.stderr


def test_standard_output_contains_only_the_diagnostics_as_json(workspace):
    workspace.write("lamp.gr1.json", rules.UNREALIZABLE.read_page().wrong)
    result = workspace.sysmlc("synth", "lamp.gr1.json", "--realizable", "--format", "json")
    assert [diagnostic["code"] for diagnostic in json.loads(result.stdout)["diagnostics"]] == [
        "SM532"
    ]


def test_the_engine_can_be_chosen(workspace):
    workspace.write("lamp.gr1.json", rules.UNREALIZABLE.read_page().right)
    result = workspace.sysmlc("synth", "lamp.gr1.json", "--realizable", "--engine", "autoref")
    assert result.exit_code == 0


def test_machines_are_written_to_the_output_folder(workspace):
    workspace.write("lamp.gr1.json", rules.UNREALIZABLE.read_page().right)
    result = workspace.sysmlc("synth", "lamp.gr1.json", "-o", "out")
    assert result.exit_code == 0
    assert result.stdout.endswith("; machine: 2 states, 3 moves, checked\n")
    assert workspace.list_files() == [
        "lamp.machine.json",
        "lamp.machine.puml",
        "manifest.results.json",
    ]


def test_an_unrealizable_contract_has_no_machine_but_an_unrealizable_core(workspace):
    workspace.write("lamp.gr1.json", rules.UNREALIZABLE.read_page().wrong)
    result = workspace.sysmlc("synth", "lamp.gr1.json", "-o", "out")
    assert result.exit_code == 1
    assert not any(name.endswith(".machine.json") for name in workspace.list_files())
    assert "always: lamp <-> go'" in result.stderr


def test_a_counter_strategy_is_written_and_is_a_valid_model(workspace):
    workspace.write("lamp.gr1.json", rules.UNREALIZABLE.read_page().wrong)
    result = workspace.sysmlc("synth", "lamp.gr1.json", "-o", "out")
    assert result.exit_code == 1
    assert workspace.list_files("out") == [
        "lamp.counter-run.puml",
        "lamp.counter.puml",
        "lamp.counter.sysml",
        "manifest.results.json",
    ]
    assert workspace.sysmlc("check", "out/lamp.counter.sysml").exit_code == 0


def test_the_user_can_play_the_component_against_the_counter_strategy(workspace):
    workspace.write("lamp.gr1.json", rules.UNREALIZABLE.read_page().wrong)
    result = workspace.sysmlc("synth", "lamp.gr1.json", "--play", text="lamp=true\nlamp=false\n\n")
    assert result.exit_code == 1
    assert result.stdout.startswith("You play 'lamp'.")
    assert "You have lost." in result.stdout


def test_a_realizable_contract_cannot_be_played(workspace):
    workspace.write("lamp.gr1.json", rules.UNREALIZABLE.read_page().right)
    result = workspace.sysmlc("synth", "lamp.gr1.json", "--play")
    assert [result.exit_code, result.stdout] == [
        0,
        "lamp: realizable, so no environment defeats it\n",
    ]


def test_a_counter_strategy_that_is_too_large_is_reported(workspace, monkeypatch):
    monkeypatch.setattr(counter_machine.build_counterstrategy, "__defaults__", (0,))
    workspace.write("lamp.gr1.json", rules.UNREALIZABLE.read_page().wrong)
    result = workspace.sysmlc("synth", "lamp.gr1.json", "-o", "out")
    assert "warning[SM549 counter-strategy-not-written]" in result.stderr
    assert not (workspace.folder / "out").exists()


COUNTER = {
    "variables": {
        "go": {"owner": "env", "type": "bool"},
        "n": {"owner": "sys", "type": [0, 200]},
    },
    "guarantees": {
        "init": ["n = 0"],
        "safety": ["go' & n < 200 -> n' = n + 1", "!(go' & n < 200) -> n' = n"],
    },
}


@pytest.mark.parametrize(
    ("form", "name", "first_line"),
    [
        ("own", "lamp.machine.json", '{\n  "format": "sysmlc-machine/2",'),
        ("table", "lamp.controller.json", '{\n  "format": "sysmlc-controller/1",'),
        ("gr1c", "lamp.gr1c.json", '{\n  "version": 1,'),
    ],
)
def test_machines_are_written_in_the_selected_format(workspace, form, name, first_line):
    workspace.write("lamp.gr1.json", rules.UNREALIZABLE.read_page().right)
    result = workspace.sysmlc("synth", "lamp.gr1.json", "-o", "out", "--machine", form)
    assert result.exit_code == 0
    assert workspace.read(f"out/{name}").startswith(first_line)


def test_a_strategy_too_large_for_gr1c_is_reported_and_not_written(workspace):
    wide = COUNTER["variables"] | {f"a{n}": {"owner": "env", "type": [0, 60]} for n in range(3)}
    workspace.write("wide.gr1.json", json.dumps(COUNTER | {"variables": wide}))
    result = workspace.sysmlc("synth", "wide.gr1.json", "-o", "out", "--machine", "gr1c")
    assert result.exit_code == 2
    assert "error[SM543 machine-not-written]" in result.stderr
    assert "the limit of 50,000 steps of the strategy was reached" in result.stderr
    assert workspace.list_files() == []


def test_a_limit_reached_in_any_step_of_the_synthesis_leaves_no_file(workspace, monkeypatch):
    def raise_limit(*arguments):
        raise LimitError("of CPU time", "1 s")

    for step in ("explore_strategy", "enumerate_states", "build_machine", "find_faults"):
        with monkeypatch.context() as patch:
            patch.setattr(controller_synthesis, step, raise_limit)
            workspace.write("counter.gr1.json", json.dumps(COUNTER))
            result = workspace.sysmlc("synth", "counter.gr1.json", "-o", "out", "--time-limit", "1")
        assert result.exit_code == 2
        assert "no controller is written: the limit of 1 s of CPU time was reached" in result.stderr
        assert workspace.list_files() == []


def test_the_limit_of_nodes_holds_for_the_machine_too(workspace):
    workspace.write("counter.gr1.json", json.dumps(COUNTER))
    result = workspace.sysmlc("synth", "counter.gr1.json", "-o", "out", "--nodes", "30")
    assert result.exit_code == 2
    assert "the limit of 30 nodes was reached" in result.stderr
    assert workspace.list_files() == []


def test_the_owners_of_variables_of_a_spot_formula_come_from_its_part_file(workspace):
    workspace.write("lamp.spot.ltl", "G (press <-> X lamp)\n")
    result = workspace.sysmlc("synth", "lamp.spot.ltl", "--realizable")
    assert result.exit_code == 2
    assert "(lines below it, or in the .part file beside it)" in result.stderr
    workspace.write("lamp.spot.part", ".inputs press\n.outputs lamp\n")
    assert workspace.sysmlc("synth", "lamp.spot.ltl", "--realizable").exit_code == 0
    workspace.write("lamp.spot.part", ".inputs lamp\n.outputs press\n")
    assert workspace.sysmlc("synth", "lamp.spot.ltl", "--realizable").exit_code == 1


def test_a_formula_reduced_to_gr1_is_shown_in_its_original_form(workspace):
    contract = "NAME: n;\nCONTRACT c: input boolean variable go; output boolean variable done;"
    contract += " Assumptions: true; Guarantees: G(go -> F(done)) & G(!done);"
    workspace.write("c.ltl", contract)
    messages = workspace.sysmlc("synth", "c.ltl", "-o", "out").stderr
    assert "these 2 of 2 guarantees cannot be satisfied together" in messages
    assert "note: G (go -> F done)\n" in messages
    run = workspace.read("out/n.c.counter-run.puml")
    assert "title n.c\\ncannot keep its contract\\nnot kept: G (go -<U+003E> F done)\n" in run


@pytest.mark.parametrize(
    "option", ["--time-limit=-1", "--memory-limit=-1", "--memory-limit=inf", "--nodes=-1"]
)
def test_limits_must_be_positive_and_finite(workspace, option):
    workspace.write("lamp.gr1.json", rules.UNREALIZABLE.read_page().right)
    result = workspace.sysmlc("synth", "lamp.gr1.json", option)
    assert result.exit_code == 2
    assert "Error: Invalid value for '--" in result.stderr


def test_a_wide_range_is_not_enumerated(workspace):
    wide = {
        "variables": {
            "y": {"owner": "env", "type": [0, 100_000_000]},
            "x": {"owner": "sys", "type": [1, 100_000_001]},
        },
        "guarantees": {"safety": ["x' = y' + 1"]},
    }
    workspace.write("wide.gr1.json", json.dumps(wide))
    result = workspace.sysmlc("synth", "wide.gr1.json", "--time-limit", "60")
    assert result.exit_code == 0
    assert result.stdout.endswith("2 modes, checked\n")


def test_a_value_in_a_wide_range_is_found_without_enumeration(workspace):
    wide = {
        "variables": {
            "y": {"owner": "env", "type": [0, 10**21]},
            "x": {"owner": "sys", "type": [0, 10**21 - 1]},
        },
        "guarantees": {"safety": ["x' != y'"]},
    }
    workspace.write("wide.gr1.json", json.dumps(wide))
    result = workspace.sysmlc("synth", "wide.gr1.json", "--time-limit", "60")
    assert result.stdout.endswith("machine: 2 states, 3 moves, checked\n")


def test_a_counter_strategy_in_sysml_has_constraints_for_the_ranges(workspace):
    stuck = {
        "variables": {
            "go": {"owner": "env", "type": "bool"},
            "at": {"owner": "sys", "type": [-2, 3]},
        },
        "guarantees": {"safety": ["at' = at"], "liveness": ["at = 3", "at = -2"]},
    }
    workspace.write("stuck.gr1.json", json.dumps(stuck))
    workspace.sysmlc("synth", "stuck.gr1.json", "-o", "out")
    assert "assert constraint { -2 <= 'at' and 'at' <= 3 }" in workspace.read(
        "out/stuck.counter.sysml"
    )
    result = workspace.sysmlc("check", "out/stuck.counter.sysml")
    assert [result.exit_code, result.stderr] == [0, "no findings\n"]


# -- deadlines -------------------------------------------------------------------------------------


def test_the_smallest_bound_is_printed(workspace):
    workspace.write("lamp.gr1.json", rules.NO_DEADLINE.read_page().right)
    result = workspace.sysmlc("synth", "lamp.gr1.json", "--deadline", "late")
    assert [result.exit_code, result.stdout] == [
        0,
        "lamp: late <= 1 can be guaranteed, no smaller bound\n",
    ]


def test_no_bound_is_an_error_and_exit_code_1(workspace):
    workspace.write("lamp.gr1.json", rules.NO_DEADLINE.read_page().wrong)
    result = workspace.sysmlc("synth", "lamp.gr1.json", "--deadline", "late")
    assert result.exit_code == 1
    assert result.stdout == "lamp: late: no bound below the end of the range can be guaranteed\n"
    expected = "error[SM576 no-deadline]: 'lamp' can guarantee no bound for late: even 2 is"
    assert expected in result.stderr


def test_a_bound_of_an_unknown_timer_is_an_error_and_exit_code_2(workspace):
    workspace.write("lamp.gr1.json", rules.NO_TIMER.read_page().wrong)
    result = workspace.sysmlc("synth", "lamp.gr1.json", "--deadline", "due")
    assert [result.exit_code, result.stdout] == [2, "lamp: due: not decided\n"]
    assert "error[SM575 deadline-of-no-number]" in result.stderr
    assert "help: name one of its numeric variables: late" in result.stderr


def test_a_deadline_cannot_be_combined_with_an_output_folder(workspace):
    workspace.write("lamp.gr1.json", rules.NO_DEADLINE.read_page().right)
    result = workspace.sysmlc("synth", "lamp.gr1.json", "--deadline", "late", "-o", "out")
    assert result.exit_code == 2
    assert "--deadline decides only" in result.stderr
