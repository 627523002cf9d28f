"""``sysmlc synth``: verdicts, figures, what is said when there is no verdict."""

import json
import re

import pytest

from sysmlc.synthesis import rules
from sysmlc.synthesis.counterstrategy import counter_machine as machine

MACHINE = """
StateMachine gate "Gate"
  Region r
    Pseudostate i subkind="initial"
    State open "Open"
    Transition t
      -> flow-source i
      -> flow-target open
"""


def test_a_contract_is_decided_with_figures(here):
    here.write("lamp.gr1.json", rules.UNREALIZABLE.read_page().right)
    made = here.sysmlc("synth", "lamp.gr1.json", "--realizable")
    assert made.exit_code == 0
    figures = r"lamp: realizable \(2 variables, 2 bits, 1 conjuncts; .* nodes, .* s\)\n"
    assert re.fullmatch(figures, made.stdout)


def test_unrealizable_is_an_error_and_exit_code_1(here):
    here.write("lamp.gr1.json", rules.UNREALIZABLE.read_page().wrong)
    made = here.sysmlc("synth", "lamp.gr1.json", "--realizable")
    assert made.exit_code == 1
    assert "error[SM532 contract-unrealizable]: no system can satisfy the contract" in made.stderr
    assert made.stdout.startswith("lamp: unrealizable (")


def test_what_is_outside_gr1_has_its_place_and_exit_code_2(here):
    here.write("lamp.gr1.json", rules.OUTSIDE_GR1.read_page().wrong)
    made = here.sysmlc("synth", "lamp.gr1.json", "--realizable")
    assert [made.exit_code, made.stdout] == [2, "lamp: not decided\n"]
    assert "error[SM530 conjunct-outside-gr1]: '!lamp' of 'lamp' is outside" in made.stderr
    assert "--> lamp.gr1.json:2:" in made.stderr


def test_all_that_is_outside_gr1_is_named(here):
    chase = "NAME: n;\nCONTRACT c: output boolean variable a; Assumptions: true; Guarantees: {};"
    here.write("c.ltl", chase.format("F G a & G F a & (G F a -> F G !a)"))
    told = re.findall(r"SM530 .*: ('.*') of 'n.c'", here.sysmlc("synth", "c.ltl").stderr)
    assert told == ["'F G a'", "'G F a -> F G !a'"]


def test_the_right_example_of_each_rule_is_decided(here):
    for rule in (rules.OUTSIDE_GR1, rules.UNREALIZABLE):
        here.write("right.gr1.json", rule.read_page().right)
        assert here.sysmlc("synth", "right.gr1.json", "--realizable").exit_code == 0


CHASE = """NAME: line;
CONTRACT good: output boolean variable lamp; Assumptions: true; Guarantees: G F(lamp);
CONTRACT bad: output boolean variable lamp; Assumptions: true; Guarantees: G F(lamp));
"""


@pytest.mark.parametrize("words", [["synth"], ["synth", "--realizable"], ["contracts", "check"]])
def test_a_contract_that_cannot_be_read_is_exit_code_2_though_others_are_kept(here, words):
    here.write("line.ltl", CHASE)
    made = here.sysmlc(*words, "line.ltl")
    assert made.exit_code == 2
    assert made.stdout.startswith("line.good: realizable")
    assert "--> line.ltl:3:85" in made.stderr


WIDE = {
    "variables": {
        **{f"a{n}": {"owner": "env", "type": [0, 30]} for n in range(4)},
        **{f"x{n}": {"owner": "sys", "type": [0, 30]} for n in range(4)},
    },
    "guarantees": {"safety": [f"x{n}' * x{n}' > a{n}' * a{3 - n}'" for n in range(4)]},
}


def test_a_limit_says_what_was_reached(here):
    here.write("wide.gr1.json", json.dumps(WIDE))
    made = here.sysmlc("synth", "wide.gr1.json", "--realizable", "--nodes", "10")
    assert [made.exit_code, made.stdout] == [2, "wide: not decided\n"]
    assert "error[SM531 synthesis-limit]: 'wide' is undecided: the limit of 10 nodes" in made.stderr


def test_contracts_of_a_model_are_decided_by_component(here, monkeypatch):
    from sysmlc.driver import registry
    from sysmlc.passes import pipeline

    monkeypatch.setattr(
        registry, "load_passes", lambda options: [pipeline.load(name) for name in pipeline.NAMES]
    )
    here.write("gate.ir", MACHINE)
    made = here.sysmlc("synth", "gate.ir", "--realizable", "-c", "Gate")
    assert [made.exit_code, made.stdout.split(" (")[0]] == [0, "Gate: realizable"]
    wrong = here.sysmlc("synth", "gate.ir", "--realizable", "-c", "Gat")
    assert [wrong.exit_code, "did you mean 'Gate'" in wrong.stderr] == [2, True]


def test_what_history_bits_can_say_is_decided(here):
    text = rules.UNREALIZABLE.read_page().right.replace(
        '"safety": ["lamp\' <-> go\'"]', '"liveness": ["go -> lamp\'"]'
    )
    here.write("lamp.gr1.json", text)
    made = here.sysmlc("synth", "lamp.gr1.json", "--realizable")
    assert made.stdout.startswith("lamp: realizable (3 variables")


@pytest.mark.parametrize(
    ("args", "words"),
    [
        (["none.gr1.json", "--realizable"], "cannot read 'none.gr1.json'"),
        (["plant.ir", "--realizable", "-o", "out"], "--realizable decides only"),
        (["plant.ir", "--realizable", "--from", "cobol"], "'cobol' is not a supported format"),
        (["plant.ir", "--realizable"], "no behaviour and no requirement that gives a contract"),
    ],
)
def test_what_cannot_be_done_is_a_sentence_and_exit_code_2(here, args, words):
    made = here.sysmlc("synth", *args)
    assert made.exit_code == 2
    assert words in made.stderr


def test_findings_as_json_leave_standard_output_to_them(here):
    here.write("lamp.gr1.json", rules.UNREALIZABLE.read_page().wrong)
    made = here.sysmlc("synth", "lamp.gr1.json", "--realizable", "--format", "json")
    assert [one["code"] for one in json.loads(made.stdout)["diagnostics"]] == ["SM532"]


def test_the_engine_can_be_chosen(here):
    here.write("lamp.gr1.json", rules.UNREALIZABLE.read_page().right)
    assert (
        here.sysmlc("synth", "lamp.gr1.json", "--realizable", "--engine", "autoref").exit_code == 0
    )


def test_machines_are_written_when_asked_for(here):
    here.write("lamp.gr1.json", rules.UNREALIZABLE.read_page().right)
    made = here.sysmlc("synth", "lamp.gr1.json", "-o", "out")
    assert made.exit_code == 0
    assert made.stdout.endswith("; machine: 2 states, 3 moves, checked\n")
    assert here.files() == ["lamp.machine.json", "lamp.machine.puml"]


def test_no_machine_is_written_of_what_cannot_be_kept_and_the_core_is_named(here):
    here.write("lamp.gr1.json", rules.UNREALIZABLE.read_page().wrong)
    made = here.sysmlc("synth", "lamp.gr1.json", "-o", "out")
    assert made.exit_code == 1
    assert not any(name.endswith(".machine.json") for name in here.files())
    assert "always: lamp <-> go'" in made.stderr


def test_what_defeats_a_contract_is_written(here):
    here.write("lamp.gr1.json", rules.UNREALIZABLE.read_page().wrong)
    made = here.sysmlc("synth", "lamp.gr1.json", "-o", "out")
    assert made.exit_code == 1
    assert here.files("out") == ["lamp.counter-run.puml", "lamp.counter.puml", "lamp.counter.sysml"]
    assert here.sysmlc("check", "out/lamp.counter.sysml").exit_code == 0


def test_the_reader_plays_the_component(here):
    here.write("lamp.gr1.json", rules.UNREALIZABLE.read_page().wrong)
    made = here.sysmlc("synth", "lamp.gr1.json", "--play", text="lamp=true\nlamp=false\n\n")
    assert made.exit_code == 1
    assert made.stdout.startswith("You are 'lamp'.")
    assert "You have lost." in made.stdout


def test_there_is_nothing_to_play_when_a_contract_can_be_kept(here):
    here.write("lamp.gr1.json", rules.UNREALIZABLE.read_page().right)
    made = here.sysmlc("synth", "lamp.gr1.json", "--play")
    assert [made.exit_code, made.stdout] == [0, "lamp: realizable, nothing defeats it\n"]


def test_what_is_too_large_to_be_listed_is_told(here, monkeypatch):
    monkeypatch.setattr(machine.build_counterstrategy, "__defaults__", (0,))
    here.write("lamp.gr1.json", rules.UNREALIZABLE.read_page().wrong)
    made = here.sysmlc("synth", "lamp.gr1.json", "-o", "out")
    assert "warning[SM549 counter-strategy-not-written]" in made.stderr
    assert not (here.folder / "out").exists()


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
    ("form", "name", "start"),
    [
        ("own", "lamp.machine.json", '{\n  "format": "sysmlc-machine/2",'),
        ("table", "lamp.controller.json", '{\n  "format": "sysmlc-controller/1",'),
        ("gr1c", "lamp.gr1c.json", '{\n  "version": 1,'),
    ],
)
def test_machines_have_the_form_that_is_asked_for(here, form, name, start):
    here.write("lamp.gr1.json", rules.UNREALIZABLE.read_page().right)
    made = here.sysmlc("synth", "lamp.gr1.json", "-o", "out", "--machine", form)
    assert made.exit_code == 0
    assert here.read(f"out/{name}").startswith(start)


def test_what_gr1c_cannot_list_is_said_and_not_written(here):
    wide = COUNTER["variables"] | {f"a{n}": {"owner": "env", "type": [0, 60]} for n in range(3)}
    here.write("wide.gr1.json", json.dumps(COUNTER | {"variables": wide}))
    made = here.sysmlc("synth", "wide.gr1.json", "-o", "out", "--machine", "gr1c")
    assert made.exit_code == 2
    assert "error[SM543 machine-not-written]" in made.stderr
    assert "the limit of 50,000 steps of the strategy was reached" in made.stderr
    assert here.files() == []


def test_a_limit_in_the_making_of_a_machine_leaves_no_file(here, monkeypatch):
    from sysmlc.synthesis import controller_synthesis as synthesise
    from sysmlc.synthesis.bdd.limits import LimitError

    def beyond(*given):
        raise LimitError("of CPU time", "1 s")

    for step in ("explore_strategy", "enumerate_states", "build_machine", "find_faults"):
        with monkeypatch.context() as patch:
            patch.setattr(synthesise, step, beyond)
            here.write("counter.gr1.json", json.dumps(COUNTER))
            made = here.sysmlc("synth", "counter.gr1.json", "-o", "out", "--time-limit", "1")
        assert made.exit_code == 2
        assert "no controller is written: the limit of 1 s of CPU time was reached" in made.stderr
        assert here.files() == []


def test_few_nodes_are_a_limit_for_machines_too(here):
    here.write("counter.gr1.json", json.dumps(COUNTER))
    made = here.sysmlc("synth", "counter.gr1.json", "-o", "out", "--nodes", "30")
    assert made.exit_code == 2
    assert "the limit of 30 nodes was reached" in made.stderr
    assert here.files() == []


def test_a_formula_of_spot_has_its_owners_from_the_file_beside_it(here):
    here.write("lamp.spot.ltl", "G (press <-> X lamp)\n")
    made = here.sysmlc("synth", "lamp.spot.ltl", "--realizable")
    assert made.exit_code == 2
    assert "(lines below it, or in the .part file beside it)" in made.stderr
    here.write("lamp.spot.part", ".inputs press\n.outputs lamp\n")
    assert here.sysmlc("synth", "lamp.spot.ltl", "--realizable").exit_code == 0
    here.write("lamp.spot.part", ".inputs lamp\n.outputs press\n")
    assert here.sysmlc("synth", "lamp.spot.ltl", "--realizable").exit_code == 1


def test_a_formula_that_was_reduced_to_gr1_is_shown_as_it_was_written(here):
    chase = "NAME: n;\nCONTRACT c: input boolean variable go; output boolean variable done;"
    chase += " Assumptions: true; Guarantees: G(go -> F(done)) & G(!done);"
    here.write("c.ltl", chase)
    said = here.sysmlc("synth", "c.ltl", "-o", "out").stderr
    assert "these 2 of 2 guarantees cannot be satisfied together" in said
    assert "note: G (go -> F done)\n" in said
    run = here.read("out/n.c.counter-run.puml")
    assert "title n.c\\ncannot keep its contract\\nnot kept: G (go -<U+003E> F done)\n" in run


@pytest.mark.parametrize(
    "word", ["--time-limit=-1", "--memory-limit=-1", "--memory-limit=inf", "--nodes=-1"]
)
def test_limits_are_amounts(here, word):
    here.write("lamp.gr1.json", rules.UNREALIZABLE.read_page().right)
    made = here.sysmlc("synth", "lamp.gr1.json", word)
    assert made.exit_code == 2
    assert "Error: Invalid value for '--" in made.stderr


def test_a_wide_number_is_no_list_of_its_values(here):
    wide = {
        "variables": {
            "y": {"owner": "env", "type": [0, 100_000_000]},
            "x": {"owner": "sys", "type": [1, 100_000_001]},
        },
        "guarantees": {"safety": ["x' = y' + 1"]},
    }
    here.write("wide.gr1.json", json.dumps(wide))
    made = here.sysmlc("synth", "wide.gr1.json", "--time-limit", "60")
    assert made.exit_code == 0
    assert made.stdout.endswith("2 modes, checked\n")


def test_bounds_of_a_wide_number_are_looked_for_not_listed(here):
    wide = {
        "variables": {
            "y": {"owner": "env", "type": [0, 10**21]},
            "x": {"owner": "sys", "type": [0, 10**21 - 1]},
        },
        "guarantees": {"safety": ["x' != y'"]},
    }
    here.write("wide.gr1.json", json.dumps(wide))
    made = here.sysmlc("synth", "wide.gr1.json", "--time-limit", "60")
    assert made.stdout.endswith("machine: 2 states, 3 moves, checked\n")


def test_a_counter_strategy_in_sysml_keeps_ranges(here):
    stuck = {
        "variables": {
            "go": {"owner": "env", "type": "bool"},
            "at": {"owner": "sys", "type": [-2, 3]},
        },
        "guarantees": {"safety": ["at' = at"], "liveness": ["at = 3", "at = -2"]},
    }
    here.write("stuck.gr1.json", json.dumps(stuck))
    here.sysmlc("synth", "stuck.gr1.json", "-o", "out")
    assert "assert constraint { -2 <= 'at' and 'at' <= 3 }" in here.read("out/stuck.counter.sysml")
    checked = here.sysmlc("check", "out/stuck.counter.sysml")
    assert [checked.exit_code, checked.stderr] == [0, "no findings\n"]
