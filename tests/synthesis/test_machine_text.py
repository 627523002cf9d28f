"""Controllers as files: JSON according to the schemas, the format of gr1c, and diagrams."""

import json
from functools import partial

import controller_plays as machines
import jsonschema
import pytest
import small_games
from contracts_in_lines import parse_contract

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
from sysmlc.synthesis.decision import Options
from sysmlc.synthesis.strategies.verification import Fault

LAMP = parse_contract(
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
COUNTER = parse_contract(
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


def synthesise_with_diagnostics(contract, form=Form.ANY):
    sink = Sink()
    return synthesise_controller(contract, lambda origin: Subject(), sink, Options(), form), list(
        sink
    )


def list_file_names(contract, form):
    result, _ = synthesise_with_diagnostics(contract)
    sink = Sink()
    return [
        name for name, _ in write_controllers([result], lambda origin: Subject(), sink, form).files
    ]


def test_a_machine_as_json():
    machine = machines.build_controller(LAMP)
    text = machine_json(machine, LAMP)
    read = json.loads(text)
    jsonschema.validate(read, MACHINE)
    assert [read["name"], len(read["states"]), read["registers"]] == ["Plant::Lamp", 3, []]
    assert '{"when": "true", "output": ["off"], "next": 1}' in text
    assert '{"when": "press", "output": ["on"], "next": 2}' in text


def test_registers_are_named_and_used_in_expressions():
    read = json.loads(machine_json(machines.build_controller(COUNTER), COUNTER))
    jsonschema.validate(read, MACHINE)
    assert read["registers"] == [{"name": "last_n", "of": "n"}]
    moves = {json.dumps(move["output"]): move["when"] for move in read["states"][1]}
    assert moves == {
        '[{"value": "last_n"}]': "!go | last_n>=20",
        '[{"value": "last_n + 1"}]': "last_n<=19 & go",
    }


def test_a_register_with_the_name_of_a_variable_is_renamed():
    contract = parse_contract(
        """
        env last_n: bool
        sys n: 0..20
        promise at first n=0
        promise always last_n' & n<20 -> n'=n+1
        promise always !(last_n' & n<20) -> n'=n
        """
    )
    read = json.loads(machine_json(machines.build_controller(contract), contract))
    assert read["registers"] == [{"name": "last_n_", "of": "n"}]


def test_a_table_as_json():
    table = machines.build_controller(LAMP, Form.TABLE)
    read = json.loads(table_json(table, LAMP))
    jsonschema.validate(read, TABLE)
    assert read["bits"] == [
        {"variable": "lamp", "bit": 0, "step": "before"},
        {"variable": "press", "bit": 0, "step": "now"},
    ]
    assert read["first"] == {"outputs": [0], "next": [1]}
    (mode,) = read["modes"]
    assert follow_node(read, mode["outputs"][0], {("press", "now"): 1, ("lamp", "before"): 0})
    assert not follow_node(read, mode["outputs"][0], {("press", "now"): 1, ("lamp", "before"): 1})


def follow_node(read, place, values):
    """Follow the nodes of a table from *place* to a value, as the schema defines it."""
    while place > 1:
        bit, low, high = read["nodes"][place - 2]
        tested = read["bits"][bit]
        place = high if values[tested["variable"], tested["step"]] else low
    return place


def test_json_of_random_controllers_is_valid():
    for seed in range(60):
        contract = small_games.random_contract(seed)
        if machine := machines.build_controller(contract):
            jsonschema.validate(json.loads(machine_json(machine, contract)), MACHINE)
            table = machines.build_controller(contract, Form.TABLE)
            jsonschema.validate(json.loads(table_json(table, contract)), TABLE)


def test_gr1c_lists_steps_with_their_successors():
    read = json.loads(gr1c_json(machines.build_controller(LAMP), LAMP))
    assert read["version"] == 1
    assert read["ENV"] == [{"press": "boolean"}, {"dark": "boolean"}]
    assert read["SYS"] == [{"lamp": [0, 1]}]
    states = {name: tuple(node["state"]) for name, node in read["nodes"].items()}
    first = {states[name] for name, node in read["nodes"].items() if node["initial"]}
    assert first == {(0, 0, 0), (0, 1, 0), (1, 0, 0), (1, 1, 0)}
    for name, node in read["nodes"].items():
        lit = states[name][2]
        successors = {states[successor] for successor in node["trans"]}
        assert successors == {(a, b, lit ^ a) for a in (0, 1) for b in (0, 1)}
        assert node["rgrad"] == -1


def test_gr1c_lists_only_steps_that_the_assumptions_allow():
    compared = 0
    for seed in range(60):
        contract = small_games.random_contract(seed)
        controller = machines.build_controller(contract)
        if controller is None:
            continue
        nodes = json.loads(gr1c_json(controller, contract))["nodes"]
        closed_loop = machines.ClosedLoop(controller, contract)
        # A step without successors is a dead end of the environment, which a play avoids.
        if not all(node["trans"] for node in nodes.values()):
            assert len(nodes) >= len(closed_loop.graph)
            continue
        compared += 1
        assert len(nodes) == len(closed_loop.graph)
        assert sum(len(node["trans"]) for node in nodes.values()) == closed_loop.graph.size()
        assert sum(node["initial"] for node in nodes.values()) == len(set(closed_loop.starts))
    assert compared > 20


def test_gr1c_of_a_table_is_that_of_the_machine():
    texts = [
        gr1c_json(machines.build_controller(LAMP, form), LAMP) for form in (Form.ANY, Form.TABLE)
    ]
    nodes = [json.loads(text)["nodes"] for text in texts]
    assert len({len(steps) for steps in nodes}) == 1


def test_a_controller_too_large_for_gr1c_raises():
    machine = machines.build_controller(COUNTER)
    with pytest.raises(LimitError, match="the limit of 10 steps of the strategy"):
        gr1c_json(machine, COUNTER, max_steps=10)


def test_a_controller_that_a_format_cannot_express_is_reported(monkeypatch):
    monkeypatch.setattr(controller_files, "gr1c_json", partial(gr1c_json, max_steps=10))
    result, _ = synthesise_with_diagnostics(COUNTER)
    sink = Sink()
    written = write_controllers([result], lambda origin: Subject(), sink, "gr1c")
    assert [written.files, [result.exit_code for result in written.results]] == [(), [2]]
    assert [diagnostic.rule.code for diagnostic in sink] == ["SM543"]


@pytest.mark.parametrize("form", FORMS)
def test_files_have_the_name_of_the_component_and_of_the_form(form):
    suffixes_by_form = {
        "own": ["machine.json", "machine.puml"],
        "table": ["machine.json", "machine.puml"],
    }
    suffixes = suffixes_by_form.get(form, ["gr1c.json"])
    assert list_file_names(LAMP, form) == [f"Plant.Lamp.{kind}" for kind in suffixes]


def test_a_diagram_shows_only_inputs_that_matter():
    text = machine_diagram(machines.build_controller(LAMP), LAMP)
    assert text.splitlines()[:3] == ["@startuml", "title Plant::Lamp", "hide empty description"]
    assert "S0 --> S1 : any\\n/ lamp=off" in text
    assert "S1 --> S2 : press\\n/ lamp=on" in text
    assert "S1 --> S1 : !press\\n/ lamp=off" in text
    assert "dark" not in text


def test_conditions_of_a_diagram_are_minimal():
    conjunction = parse_contract(
        "env a: bool\nenv b: bool\nsys x: bool\npromise always x' <-> a' & b'"
    )
    text = machine_diagram(machines.build_controller(conjunction), conjunction)
    assert "S1 --> S1 : !b\\n!a\\n/ x=false" in text
    assert "S1 --> S1 : a & b\\n/ x=true" in text


def test_bounds_in_conditions_are_as_wide_as_possible():
    wide = parse_contract("env n: 0..15\nsys x: bool\npromise always x' <-> n'>=3 & n'!=9")
    text = machine_diagram(machines.build_controller(wide), wide)
    assert "S1 --> S1 : n>=3 & n<=8\\nn>=10\\n/ x=true" in text
    assert "S1 --> S1 : n<=2\\nn=9\\n/ x=false" in text


def test_many_conditions_are_cut():
    wide = parse_contract("env n: 0..15\nsys x: bool\npromise always x' <-> n' mod 2 = 0")
    text = machine_diagram(machines.build_controller(wide), wide)
    assert "S1 --> S1 : n<=0\\nn=2\\nn=4\\nor more\\n/ x=true" in text


def test_a_diagram_explains_its_registers():
    text = machine_diagram(machines.build_controller(COUNTER), COUNTER)
    assert "S1 --> S1 : last_n<=19 & go\\n/ n=last_n + 1" in text
    assert "/ unchanged" in text
    assert "  last_n is the value of n in the previous step" in text


def test_large_machines_have_no_diagram():
    machine = machines.build_controller(COUNTER, Form.LISTED)
    assert machine.size > 20
    assert not has_diagram(machine)


def test_the_result_shows_the_size_of_the_controller():
    result, diagnostics = synthesise_with_diagnostics(LAMP)
    assert diagnostics == []
    assert result.exit_code == 0
    assert result.text().endswith("; machine: 3 states, 5 moves, checked")
    counting, _ = synthesise_with_diagnostics(COUNTER)
    assert counting.text().endswith("; machine: 2 states, 3 moves, 1 register, checked")
    table, _ = synthesise_with_diagnostics(COUNTER, Form.TABLE)
    assert "; controller: " in table.text()
    assert table.text().endswith(" nodes, 1 mode, checked")


def test_history_bits_are_outputs_of_the_machine():
    remembering = parse_contract("env a: bool\nsys x: bool\npromise G (a -> F x)")
    result, diagnostics = synthesise_with_diagnostics(remembering)
    assert diagnostics == []
    assert len(result.machine.outputs) == 2


def test_a_machine_that_fails_the_check_is_none(monkeypatch):
    fault = Fault(LAMP.guarantees[0])
    monkeypatch.setattr(synthesise, "find_faults", lambda *_: iter([fault]))
    result, (diagnostic,) = synthesise_with_diagnostics(LAMP)
    assert [result.machine, result.exit_code, diagnostic.rule.code] == [None, 2, "SM543"]
    assert diagnostic.message == (
        "the contract of 'Plant::Lamp' is realizable, but no controller is written: "
        "the one that was made does not keep 'lamp=off'"
    )


def test_a_controller_beyond_limits_is_none(monkeypatch):
    build_table = synthesise.build_table
    monkeypatch.setattr(synthesise, "build_table", lambda plan: build_table(plan, 2))
    result, (diagnostic,) = synthesise_with_diagnostics(COUNTER, Form.TABLE)
    assert result.machine is None
    assert diagnostic.message.endswith("the limit of 2 nodes of the controller was reached")


def test_a_machine_that_cannot_be_enumerated_becomes_a_table(monkeypatch):
    enumerate_states = partial(synthesise.enumerate_states, max_states=1)
    monkeypatch.setattr(synthesise, "enumerate_states", enumerate_states)
    result, diagnostics = synthesise_with_diagnostics(LAMP)
    assert diagnostics == []
    assert "; controller: " in result.text()
    sink = Sink()
    (name, text), *_ = write_controllers([result], lambda origin: Subject(), sink).files
    assert name == "Plant.Lamp.controller.json"
    jsonschema.validate(json.loads(text), TABLE)
