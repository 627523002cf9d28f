"""Composition of parts: other parts discharge their assumptions, or a run shows why not."""

import pytest
from contracts_in_lines import parse_contract
from msgspec.structs import replace

from sysmlc.logic.composition.members import Member, Wire, has_single_type, rename_contract
from sysmlc.logic.contract import Composite, Part
from sysmlc.support.disjoint_sets import DisjointSets
from sysmlc.synthesis import Manager
from sysmlc.synthesis.algebra.composition import DriverError, compose_parts
from sysmlc.synthesis.algebra.fair_systems import Universe
from sysmlc.synthesis.algebra.instantaneous_dependencies import find_dependencies

FEEDER = """
    env taken: bool
    sys ready: bool
    promise at first !ready
    promise always ready & !taken -> ready'
    promise recurs ready
"""
PICKER = """
    env ready: bool
    sys taken: bool
    assume recurs ready
    promise at first !taken
    promise always taken' -> ready
    promise recurs taken
"""
OTHERS = {"feeder": FEEDER, "picker": PICKER}


def compose(whole="", **parts):
    composed_parts = tuple(
        Part(name, parse_contract(text, name), name) for name, text in parts.items()
    )
    stated_contract = parse_contract(whole) if whole else None
    return compose_parts(Composite("Cell", "", composed_parts, (), stated_contract), Manager())


def list_open_assumptions(composition):
    return [
        f"{assumption.part.name}: {assumption.conjunct.text}" for assumption in composition.open
    ]


def list_failures(composition):
    return [failure.conjunct.text for failure in composition.failures]


def test_a_guarantee_of_one_part_discharges_an_assumption_of_another():
    composition = compose("sys taken: bool\npromise recurs taken", **OTHERS)
    assert list_open_assumptions(composition) == []
    assert list_failures(composition) == []


def test_an_assumption_that_no_part_guarantees_stays_open_with_a_run():
    lazy = FEEDER.replace("promise recurs ready", "")
    composition = compose("sys taken: bool\npromise recurs taken", feeder=lazy, picker=PICKER)
    assert list_open_assumptions(composition) == ["picker: ready"]
    ((assumption),) = composition.open
    assert all(not step["ready"] for step in assumption.trace.steps[assumption.trace.loop :])
    assert list_failures(composition) == ["taken"]


def test_a_part_with_an_open_liveness_assumption_keeps_its_safety_guarantees():
    lazy = FEEDER.replace("promise recurs ready", "")
    composition = compose("sys taken: bool\npromise at first !taken", feeder=lazy, picker=PICKER)
    assert list_failures(composition) == []


def test_a_part_that_is_not_established_is_not_relied_upon():
    fragile = PICKER + "assume always ready'"
    composition = compose("sys taken: bool\npromise at first !taken", feeder=FEEDER, picker=fragile)
    assert list_open_assumptions(composition) == ["picker: ready'"]
    assert list_failures(composition) == ["!taken"]


def test_liveness_is_not_discharged_in_a_circle():
    first_part = "env b: bool\nsys a: bool\nassume recurs b\npromise recurs a"
    second_part = "env a: bool\nsys b: bool\nassume recurs a\npromise recurs b"
    composition = compose(one=first_part, other=second_part)
    assert list_open_assumptions(composition) == ["one: b", "other: a"]
    first, _ = composition.open
    assert first.is_circular
    assert all(not (step["a"] or step["b"]) for step in first.trace.steps)


def test_mutual_recurrence_is_discharged_when_one_part_has_to_begin():
    """Each part passes on a token; one part always has it and waits only for the other."""
    first_part = """
        env taken: bool
        sys given: bool
        assume recurs !given | taken
        promise recurs given
    """
    second_part = """
        env given: bool
        sys taken: bool
        assume recurs given
        promise recurs !given | taken
    """
    assert list_open_assumptions(compose(one=first_part, other=second_part)) == []


def test_only_the_cause_of_dependent_open_assumptions_is_reported():
    first_part = """
        env power: bool
        sys a: bool
        assume always power'
        promise recurs a
    """
    second_part = "env a: bool\nsys b: bool\nassume recurs a\npromise recurs b"
    last_part = "env b: bool\nsys c: bool\nassume recurs b\npromise recurs c"
    whole = "env power: bool\nsys c: bool\npromise recurs c"
    composition = compose(whole, one=first_part, other=second_part, last=last_part)
    assert list_open_assumptions(composition) == ["one: power'"]
    assert list_failures(composition) == ["c"]


SAFE = """
    env {it}: bool
    sys {me}: bool
    assume at first !{it}
    assume always !{it}'
    promise at first !{me}
    promise always !{me}'
"""


def test_safety_is_discharged_in_a_circle_step_by_step():
    composition = compose(one=SAFE.format(me="a", it="b"), other=SAFE.format(me="b", it="a"))
    assert list_open_assumptions(composition) == []


def test_safety_is_not_discharged_in_a_circle_of_instantaneous_dependencies():
    copy = SAFE + "\n promise always {me}' <-> {it}'\n promise at first {me} <-> {it}"
    parts = {"1": copy.format(me="a", it="b"), "2": copy.format(me="b", it="a")}
    assert list_open_assumptions(compose(**parts)) == ["1: !b", "1: !b'", "2: !a", "2: !a'"]


def list_instantaneous_dependencies(text):
    """List the outputs and the inputs that they depend on within a step after the first one."""
    contract = parse_contract(text)
    dependencies = find_dependencies(contract, Universe((contract,), Manager()))
    return [
        (sorted(dependency.outputs), sorted(dependency.inputs))
        for dependency in dependencies
        if not dependency.is_first
    ]


def test_a_relation_of_output_and_input_in_one_step_is_an_instantaneous_dependency():
    """A guarantee without primes, or two guarantees together, make ``me`` depend on ``it``."""
    twice = "promise always it=1 & me -> me'\npromise always it=1 & me -> !me'"
    for tie in ("promise always me <-> it=1", twice):
        assert list_instantaneous_dependencies(f"env it: 0..2\nsys me: bool\n{tie}") == [
            (["me"], ["it"])
        ]


def test_an_answer_in_the_next_step_is_no_instantaneous_dependency():
    text = "env it: 0..2\nsys me: 0..4\npromise always me=1 & it=2 -> me'=3"
    assert list_instantaneous_dependencies(text) == [(["me"], [])]


def test_unrelated_outputs_have_separate_dependencies():
    text = (
        "env a: bool\nsys x: bool\nsys y: bool\npromise always x' <-> a'\npromise always y' <-> x"
    )
    assert list_instantaneous_dependencies(text) == [(["x"], ["a"]), (["y"], [])]


def test_mutual_dependencies_of_different_outputs_are_no_circle():
    hand = """
        env {other}_done: bool
        sys {me}_done: bool
        sys {me}_grip: bool
        assume at first !{other}_done
        promise at first !{me}_done
        promise always {me}_grip' <-> {other}_done'
        assume always !{other}_done'
        promise always !{me}_done'
    """
    composition = compose(pick=hand.format(me="p", other="q"), place=hand.format(me="q", other="p"))
    assert list_open_assumptions(composition) == []


def test_a_chain_within_a_step_is_no_circle():
    copy = SAFE + "\n promise always {me}' <-> {it}'"
    composition = compose(one=SAFE.format(me="a", it="b"), other=copy.format(me="b", it="a"))
    assert list_open_assumptions(composition) == []


def test_the_composition_inherits_assumptions_about_the_outside():
    needing = PICKER.replace("env ready: bool", "env ready: bool\nenv power: bool")
    needing += "assume always power"
    composition = compose(feeder=FEEDER, picker=needing)
    assert list_open_assumptions(composition) == []
    whole = "env power: bool\nsys taken: bool\npromise recurs taken"
    assert list_open_assumptions(compose(whole, feeder=FEEDER, picker=needing)) == ["picker: power"]


def test_the_composition_inherits_assumptions_about_outputs_and_outside():
    asking = PICKER.replace("env ready: bool", "env ready: bool\nenv done: bool")
    asking += "assume recurs !taken | done"
    assert list_open_assumptions(compose(feeder=FEEDER, picker=asking)) == []
    waiting = asking.replace("!taken | done", "!ready | done")
    assert list_open_assumptions(compose(feeder=FEEDER, picker=waiting)) == [
        "picker: !ready | done"
    ]


def test_conjuncts_outside_gr1_are_reduced_on_both_sides():
    answering = "env ask: bool\nsys done: bool\npromise G (ask -> F done)"
    asking = "env done: bool\nsys ask: bool\nassume G (ask -> F done)\npromise recurs !ask"
    composition = compose(server=answering, client=asking)
    assert list_open_assumptions(composition) == []


def test_contradicting_parts_are_reported_with_the_conflicting_conjuncts():
    never = FEEDER.replace("promise recurs ready", "promise always !ready'")
    composition = compose(feeder=never, picker=PICKER)
    assert [conjunct.text for conjunct in composition.conflict] == [
        "!ready'",
        "taken' -> ready",
        "taken",
    ]
    assert (composition.open, composition.failures) == ((), ())
    assert compose(**OTHERS).conflict == ()


def test_a_variable_is_decided_by_one_part():
    with pytest.raises(DriverError, match="'a' is decided by one and other"):
        compose(one="sys a: bool\npromise always a", other="sys a: bool\npromise recurs a")


def test_guarantees_about_inputs_do_not_discharge_assumptions_about_them():
    first_part = "sys x: bool\nenv y: bool\nassume at first y"
    second_part = (
        "sys y: bool\nenv x: bool\nassume at first x\npromise at first !y\npromise always x | y"
    )
    assert "other: x" in list_open_assumptions(compose(one=first_part, other=second_part))


def test_outputs_that_precede_the_inputs_of_a_step_are_guaranteed():
    """The server drops its work when it answers; the client holds its request until then."""
    server = (
        "sys told: bool\nsys busy: bool\nenv asked: bool\nassume always busy -> !asked' | told'"
    )
    server += "\npromise at first !busy\npromise at first !told\npromise always told' <-> busy"
    server += "\npromise always busy' <-> asked & !busy"
    client = "sys asked: bool\nenv told: bool\npromise at first !asked"
    client += "\npromise always told' -> !asked'"
    assert list_open_assumptions(compose(server=server, client=client)) == []


# -- numbers with different thresholds -------------------------------------------------------------

FAN = """
    env t: number 22
    sys fan: bool
    assume always t=from_22 -> t'=from_22
    promise always t=from_22 -> fan'
"""


def join_temperature(source, fan):
    """Return the wire of the two parts, and the composite."""
    contracts = parse_contract(source, "Source"), parse_contract(fan, "Fan")
    source, fan = (
        Member(path, path, "", contract, {name: name})
        for path, name, contract in zip(("source", "fan"), ("temp", "t"), contracts, strict=True)
    )
    ends = (source, contracts[0].variables[0]), (fan, contracts[1].variables[0])
    wire = Wire("temp", ends)
    features = DisjointSets()
    features.union(("source", "temp"), ("fan", "t"))
    parts = (
        Part(item.name, rename_contract(item, [wire], features), item.name)
        for item in (source, fan)
    )
    return wire, Composite("Room", "", tuple(parts))


@pytest.mark.parametrize(
    ("promise", "is_met"),
    [
        ("temp=from_18", False),
        ("temp=below_18", True),
        ("temp=from_18 -> temp'=from_18", False),
    ],
)
def test_parts_with_different_thresholds_share_a_number(promise, is_met):
    """The fan assumes that a room of 22 degrees stays so; 18 degrees do not say that."""
    _, composite = join_temperature(f"sys temp: number 18\npromise always {promise}", FAN)
    assert [part.contract.variables[0].name for part in composite.parts] == ["temp", "temp"]
    terms = {part.contract.variables[0].term for part in composite.parts}
    assert [key for ((key, _),) in terms] == ["source.temp"]
    composition = compose_parts(composite, Manager())
    assert list_open_assumptions(composition) == (
        [] if is_met else ["fan: t=from_22 -> t'=from_22"]
    )


def test_parts_that_measure_in_different_units_do_not_fit():
    celsius = FAN.replace("number 22", "number 22 K").replace("from_22", "from_22_K")
    wire, _ = join_temperature("sys temp: number 18", FAN)
    assert has_single_type(wire)
    contract = parse_contract(celsius, "Fan")
    other = replace(wire, ends=(wire.ends[0], (wire.ends[1][0], contract.variables[0])))
    assert not has_single_type(other)
