"""Machines as files: JSON by its schema, diagrams that can be read."""

import json

import jsonschema
import made_machines as machines
import small_games
from contracts_in_lines import contract

from sysmlc import resources
from sysmlc.diagnostics import Sink, Subject
from sysmlc.synthesis import synthesise
from sysmlc.synthesis.decide import Options
from sysmlc.synthesis.machine_text import files, json_of, plantuml_of
from sysmlc.synthesis.minimise import minimised
from sysmlc.synthesis.synthesise import synthesised
from sysmlc.synthesis.verify import Fault

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
SCHEMA = json.loads(resources.text("metamodels", "sysmlc-machine.schema.json"))


def made(contract):
    sink = Sink()
    return synthesised(contract, lambda origin: Subject(), sink, Options()), list(sink)


def test_a_machine_as_json():
    machine = minimised(machines.machine(LAMP))
    text = json_of(machine, LAMP)
    read = json.loads(text)
    jsonschema.validate(read, SCHEMA)
    assert [read["name"], len(read["states"])] == ["Plant::Lamp", machine.size]
    assert '{"input": [false, false], "output": ["off"], "next": 1}' in text
    moves = [{tuple(one["input"]): one for one in state} for state in read["states"]]
    assert moves[0][(True, False)]["output"] == ["off"]
    assert moves[1][(True, False)]["output"] == ["on"]


def test_json_of_random_machines_is_valid():
    for seed in range(60):
        made = small_games.contract(seed)
        machine = machines.machine(made)
        if machine:
            jsonschema.validate(json.loads(json_of(machine, made)), SCHEMA)


def test_a_diagram_tells_only_the_inputs_that_matter():
    text = plantuml_of(minimised(machines.machine(LAMP)), LAMP)
    assert text.splitlines()[:3] == ["@startuml", "title Plant::Lamp", "hide empty description"]
    assert "S0 --> S1 : any\\n/ lamp=off" in text
    assert "S1 --> S2 : press=true\\n/ lamp=on" in text
    assert "S1 --> S1 : press=false\\n/ lamp=off" in text
    assert "dark" not in text


def test_conditions_have_as_few_words_as_they_need():
    both = contract("env a: bool\nenv b: bool\nsys x: bool\npromise always x' <-> a' & b'")
    text = plantuml_of(minimised(machines.machine(both)), both)
    assert "S1 --> S1 : b=false\\na=false\\n/ x=false" in text
    assert "S1 --> S1 : a=true b=true\\n/ x=true" in text


def test_many_conditions_are_cut():
    wide = contract("env n: 0..15\nsys x: bool\npromise always x' <-> n' mod 2 = 0")
    text = plantuml_of(minimised(machines.machine(wide)), wide)
    assert "S1 --> S1 : n=0\\nn=2\\nn=4\\nor more\\n/ x=true" in text


def test_small_machines_have_a_diagram_large_ones_do_not():
    lamp = minimised(machines.machine(LAMP))
    assert [name for name, _ in files([(lamp, LAMP)])] == [
        "Plant.Lamp.machine.json",
        "Plant.Lamp.machine.puml",
    ]
    counting = contract(
        "env a: bool\nsys n: 0..20\npromise at first n=0\npromise always n<20 -> n'=n+1"
    )
    large = minimised(machines.machine(counting))
    assert [name for name, _ in files([(large, counting)])] == ["c.machine.json"]


def test_a_machine_that_is_made_has_its_figures():
    result, told = made(LAMP)
    assert told == []
    assert result.exit_code == 0
    assert result.text().endswith("; machine: 3 states, 12 moves, checked")


def test_history_bits_are_outputs_of_the_machine():
    remembering = contract("env a: bool\nsys x: bool\npromise G (a -> F x)")
    result, told = made(remembering)
    assert told == []
    assert len(result.machine.outputs) == 2


def test_a_machine_that_fails_the_check_is_none(monkeypatch):
    fault = Fault(LAMP.guarantees[0])
    monkeypatch.setattr(synthesise, "faults", lambda *_: iter([fault]))
    result, (told,) = made(LAMP)
    assert [result.machine, result.exit_code, told.rule.code] == [None, 2, "SM543"]
    assert told.message == (
        "the contract of 'Plant::Lamp' can be kept, but no machine is written: "
        "the one that was made does not keep 'lamp=off'"
    )


def test_a_machine_beyond_limits_is_none(monkeypatch):
    explored = synthesise.explored
    monkeypatch.setattr(synthesise, "explored", lambda one: explored(one, most_states=2))
    wide = contract("env a: bool\nsys n: 0..9\npromise at first n=0\npromise always n<9 -> n'=n+1")
    result, (told,) = made(wide)
    assert result.machine is None
    assert told.message.endswith("the limit of 2 states of the machine was reached")
