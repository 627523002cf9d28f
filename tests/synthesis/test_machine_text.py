"""Controllers as files: JSON by its schemas, gr1c's form, diagrams that can be read."""

import json
from functools import partial

import jsonschema
import made_machines as machines
import pytest
import small_games
from contracts_in_lines import contract

from sysmlc.diagnostics import Sink, Subject
from sysmlc.support import resources
from sysmlc.synthesis import LimitError, controller_files
from sysmlc.synthesis import controller_synthesis as synthesise
from sysmlc.synthesis.controller_files import (
    FORMS,
    gr1c_json,
    has_diagram,
    machine_diagram,
    machine_json,
    table_json,
    write_controllers,
)
from sysmlc.synthesis.controller_synthesis import Form, synthesise_controller
from sysmlc.synthesis.controllers.verification import Fault
from sysmlc.synthesis.decision import Options

LAMP = contract(
    """
    env press: bool
    env dark: bool
    sys lamp: off on
    promise at first lamp=off
    promise always press' -> lamp'!=lamp
    promise always !press' -> lamp'=lamp
    """,
    "Plant::Lamp",
)
COUNTER = contract(
    """
    env go: bool
    sys n: 0..20
    promise at first n=0
    promise always go' & n<20 -> n'=n+1
    promise always !(go' & n<20) -> n'=n
    """
)
MACHINE = json.loads(resources.read_text("metamodels", "sysmlc-machine.schema.json"))
TABLE = json.loads(resources.read_text("metamodels", "sysmlc-controller.schema.json"))


def made(contract, form=Form.ANY):
    sink = Sink()
    return synthesise_controller(contract, lambda origin: Subject(), sink, Options(), form), list(
        sink
    )


def names(contract, form):
    result, _ = made(contract)
    sink = Sink()
    return [
        name for name, _ in write_controllers([result], lambda origin: Subject(), sink, form).files
    ]


def test_a_machine_as_json():
    machine = machines.controller(LAMP)
    text = machine_json(machine, LAMP)
    read = json.loads(text)
    jsonschema.validate(read, MACHINE)
    assert [read["name"], len(read["states"]), read["registers"]] == ["Plant::Lamp", 3, []]
    assert '{"when": "true", "output": ["off"], "next": 1}' in text
    assert '{"when": "press", "output": ["on"], "next": 2}' in text


def test_registers_have_names_and_are_counted_with():
    read = json.loads(machine_json(machines.controller(COUNTER), COUNTER))
    jsonschema.validate(read, MACHINE)
    assert read["registers"] == [{"name": "last_n", "of": "n"}]
    moves = {json.dumps(one["output"]): one["when"] for one in read["states"][1]}
    assert moves == {
        '[{"value": "last_n"}]': "!go | last_n>=20",
        '[{"value": "last_n + 1"}]': "last_n<=19 & go",
    }


def test_a_register_gives_way_to_a_variable_of_its_name():
    taken = contract(
        """
        env last_n: bool
        sys n: 0..20
        promise at first n=0
        promise always last_n' & n<20 -> n'=n+1
        promise always !(last_n' & n<20) -> n'=n
        """
    )
    read = json.loads(machine_json(machines.controller(taken), taken))
    assert read["registers"] == [{"name": "last_n_", "of": "n"}]


def test_a_table_as_json():
    table = machines.controller(LAMP, Form.TABLE)
    read = json.loads(table_json(table, LAMP))
    jsonschema.validate(read, TABLE)
    assert read["bits"] == [
        {"variable": "lamp", "bit": 0, "step": "before"},
        {"variable": "press", "bit": 0, "step": "now"},
    ]
    assert read["first"] == {"outputs": [0], "next": [1]}
    (mode,) = read["modes"]
    assert evaluated(read, mode["outputs"][0], {("press", "now"): 1, ("lamp", "before"): 0})
    assert not evaluated(read, mode["outputs"][0], {("press", "now"): 1, ("lamp", "before"): 1})


def evaluated(read, place, values):
    """A node of a table, as the schema tells how to follow it."""
    while place > 1:
        bit, low, high = read["nodes"][place - 2]
        tested = read["bits"][bit]
        place = high if values[tested["variable"], tested["step"]] else low
    return place


def test_json_of_random_controllers_is_valid():
    for seed in range(60):
        contract = small_games.contract(seed)
        if machine := machines.controller(contract):
            jsonschema.validate(json.loads(machine_json(machine, contract)), MACHINE)
            table = machines.controller(contract, Form.TABLE)
            jsonschema.validate(json.loads(table_json(table, contract)), TABLE)


def test_gr1c_lists_steps_with_the_ones_that_may_follow():
    read = json.loads(gr1c_json(machines.controller(LAMP), LAMP))
    assert read["version"] == 1
    assert read["ENV"] == [{"press": "boolean"}, {"dark": "boolean"}]
    assert read["SYS"] == [{"lamp": [0, 1]}]
    states = {name: tuple(node["state"]) for name, node in read["nodes"].items()}
    first = {states[name] for name, node in read["nodes"].items() if node["initial"]}
    assert first == {(0, 0, 0), (0, 1, 0), (1, 0, 0), (1, 1, 0)}
    for name, node in read["nodes"].items():
        lit = states[name][2]
        after = {states[one] for one in node["trans"]}
        assert after == {(a, b, lit ^ a) for a in (0, 1) for b in (0, 1)}
        assert node["rgrad"] == -1


def test_gr1c_lists_only_what_the_assumptions_allow():
    for seed in range(60):
        told = small_games.contract(seed)
        controller = machines.controller(told)
        if controller is None:
            continue
        nodes = json.loads(gr1c_json(controller, told))["nodes"]
        judge = machines.Closed(controller, told)
        assert len(nodes) == len(judge.graph)
        assert sum(len(node["trans"]) for node in nodes.values()) == judge.graph.size()
        assert sum(node["initial"] for node in nodes.values()) == len(set(judge.starts))


def test_gr1c_of_a_table_is_that_of_the_machine():
    texts = [gr1c_json(machines.controller(LAMP, form), LAMP) for form in (Form.ANY, Form.TABLE)]
    nodes = [json.loads(text)["nodes"] for text in texts]
    assert len({len(one) for one in nodes}) == 1


def test_what_is_too_large_for_gr1c_is_said():
    machine = machines.controller(COUNTER)
    with pytest.raises(LimitError, match="the limit of 10 steps of the strategy"):
        gr1c_json(machine, COUNTER, max_steps=10)


def test_a_form_that_cannot_say_a_controller_is_told(monkeypatch):
    monkeypatch.setattr(controller_files, "gr1c_json", partial(gr1c_json, max_steps=10))
    result, _ = made(COUNTER)
    sink = Sink()
    told = write_controllers([result], lambda origin: Subject(), sink, "gr1c")
    assert [told.files, [one.exit_code for one in told.results]] == [(), [2]]
    assert [one.rule.code for one in sink] == ["SM543"]


@pytest.mark.parametrize("form", FORMS)
def test_files_have_the_name_of_the_component_and_of_the_form(form):
    kinds = {"own": ["machine.json", "machine.puml"], "table": ["machine.json", "machine.puml"]}
    known = kinds.get(form, ["gr1c.json"])
    assert names(LAMP, form) == [f"Plant.Lamp.{kind}" for kind in known]


def test_a_diagram_tells_only_the_inputs_that_matter():
    text = machine_diagram(machines.controller(LAMP), LAMP)
    assert text.splitlines()[:3] == ["@startuml", "title Plant::Lamp", "hide empty description"]
    assert "S0 --> S1 : any\\n/ lamp=off" in text
    assert "S1 --> S2 : press\\n/ lamp=on" in text
    assert "S1 --> S1 : !press\\n/ lamp=off" in text
    assert "dark" not in text


def test_conditions_have_as_few_words_as_they_need():
    both = contract("env a: bool\nenv b: bool\nsys x: bool\npromise always x' <-> a' & b'")
    text = machine_diagram(machines.controller(both), both)
    assert "S1 --> S1 : !b\\n!a\\n/ x=false" in text
    assert "S1 --> S1 : a & b\\n/ x=true" in text


def test_bounds_are_as_far_as_they_can_be():
    wide = contract("env n: 0..15\nsys x: bool\npromise always x' <-> n'>=3 & n'!=9")
    text = machine_diagram(machines.controller(wide), wide)
    assert "S1 --> S1 : n>=3 & n<=8\\nn>=10\\n/ x=true" in text
    assert "S1 --> S1 : n<=2\\nn=9\\n/ x=false" in text


def test_many_conditions_are_cut():
    wide = contract("env n: 0..15\nsys x: bool\npromise always x' <-> n' mod 2 = 0")
    text = machine_diagram(machines.controller(wide), wide)
    assert "S1 --> S1 : n<=0\\nn=2\\nn=4\\nor more\\n/ x=true" in text


def test_a_diagram_tells_what_registers_are():
    text = machine_diagram(machines.controller(COUNTER), COUNTER)
    assert "S1 --> S1 : last_n<=19 & go\\n/ n=last_n + 1" in text
    assert "/ as before" in text
    assert "  last_n is what n was in the step before" in text


def test_large_machines_have_no_diagram():
    machine = machines.controller(COUNTER, Form.LISTED)
    assert machine.size > 20
    assert not has_diagram(machine)


def test_a_machine_that_is_made_has_its_figures():
    result, told = made(LAMP)
    assert told == []
    assert result.exit_code == 0
    assert result.text().endswith("; machine: 3 states, 5 moves, checked")
    counting, _ = made(COUNTER)
    assert counting.text().endswith("; machine: 2 states, 3 moves, 1 register, checked")
    table, _ = made(COUNTER, Form.TABLE)
    assert "; controller: " in table.text()
    assert table.text().endswith(" nodes, 1 mode, checked")


def test_history_bits_are_outputs_of_the_machine():
    remembering = contract("env a: bool\nsys x: bool\npromise G (a -> F x)")
    result, told = made(remembering)
    assert told == []
    assert len(result.machine.outputs) == 2


def test_a_machine_that_fails_the_check_is_none(monkeypatch):
    fault = Fault(LAMP.guarantees[0])
    monkeypatch.setattr(synthesise, "find_faults", lambda *_: iter([fault]))
    result, (told,) = made(LAMP)
    assert [result.machine, result.exit_code, told.rule.code] == [None, 2, "SM543"]
    assert told.message == (
        "the contract of 'Plant::Lamp' is realizable, but no controller is written: "
        "the one that was made does not keep 'lamp=off'"
    )


def test_a_controller_beyond_limits_is_none(monkeypatch):
    tabled = synthesise.build_table
    monkeypatch.setattr(synthesise, "build_table", lambda one: tabled(one, 2))
    result, (told,) = made(COUNTER, Form.TABLE)
    assert result.machine is None
    assert told.message.endswith("the limit of 2 nodes of the controller was reached")


def test_a_machine_that_cannot_be_listed_is_a_table(monkeypatch):
    enumerate_states = partial(synthesise.enumerate_states, max_states=1)
    monkeypatch.setattr(synthesise, "enumerate_states", enumerate_states)
    result, told = made(LAMP)
    assert told == []
    assert "; controller: " in result.text()
    sink = Sink()
    (name, text), *_ = write_controllers([result], lambda origin: Subject(), sink).files
    assert name == "Plant.Lamp.controller.json"
    jsonschema.validate(json.loads(text), TABLE)
