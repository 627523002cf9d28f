"""Parts that run together: what they rely on is discharged by the others, or a run tells why."""

import pytest
from contracts_in_lines import contract

from sysmlc.logic.contract import Composite, Part
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


def composed(whole="", **parts):
    made = tuple(Part(name, contract(text, name), name) for name, text in parts.items())
    stated = contract(whole) if whole else None
    return compose_parts(Composite("Cell", "", made, (), stated), Manager())


def open_ones(found):
    return [f"{one.part.name}: {one.conjunct.text}" for one in found.open]


def broken(found):
    return [one.conjunct.text for one in found.failures]


def test_what_one_part_promises_another_may_assume():
    found = composed("sys taken: bool\npromise recurs taken", **OTHERS)
    assert open_ones(found) == []
    assert broken(found) == []


def test_what_no_part_promises_stays_open_and_a_run_shows_it():
    lazy = FEEDER.replace("promise recurs ready", "")
    found = composed("sys taken: bool\npromise recurs taken", feeder=lazy, picker=PICKER)
    assert open_ones(found) == ["picker: ready"]
    ((only),) = found.open
    assert all(not one["ready"] for one in only.trace.steps[only.trace.loop :])
    assert broken(found) == ["taken"]


def test_a_part_that_waits_for_something_to_recur_keeps_its_steps_meanwhile():
    lazy = FEEDER.replace("promise recurs ready", "")
    found = composed("sys taken: bool\npromise at first !taken", feeder=lazy, picker=PICKER)
    assert broken(found) == []


def test_a_part_that_is_not_established_is_not_relied_upon():
    fragile = PICKER + "assume always ready'"
    found = composed("sys taken: bool\npromise at first !taken", feeder=FEEDER, picker=fragile)
    assert open_ones(found) == ["picker: ready'"]
    assert broken(found) == ["!taken"]


def test_liveness_is_never_taken_in_a_circle():
    one = "env b: bool\nsys a: bool\nassume recurs b\npromise recurs a"
    other = "env a: bool\nsys b: bool\nassume recurs a\npromise recurs b"
    found = composed(one=one, other=other)
    assert open_ones(found) == ["one: b", "other: a"]
    first, _ = found.open
    assert first.is_circular
    assert all(not (step["a"] or step["b"]) for step in first.trace.steps)


def test_what_recurs_may_be_waited_for_by_both_when_one_of_them_has_to_begin():
    """Whoever has the token gives it; one of them always has it, and waits only for the other."""
    one = """
        env taken: bool
        sys given: bool
        assume recurs !given | taken
        promise recurs given
    """
    other = """
        env given: bool
        sys taken: bool
        assume recurs given
        promise recurs !given | taken
    """
    assert open_ones(composed(one=one, other=other)) == []


def test_what_follows_once_the_one_thing_that_is_open_is_promised_is_not_told():
    one = """
        env power: bool
        sys a: bool
        assume always power'
        promise recurs a
    """
    other = "env a: bool\nsys b: bool\nassume recurs a\npromise recurs b"
    last = "env b: bool\nsys c: bool\nassume recurs b\npromise recurs c"
    whole = "env power: bool\nsys c: bool\npromise recurs c"
    found = composed(whole, one=one, other=other, last=last)
    assert open_ones(found) == ["one: power'"]
    assert broken(found) == ["c"]


SAFE = """
    env {it}: bool
    sys {me}: bool
    assume at first !{it}
    assume always !{it}'
    promise at first !{me}
    promise always !{me}'
"""


def test_safety_is_taken_in_a_circle_step_by_step():
    found = composed(one=SAFE.format(me="a", it="b"), other=SAFE.format(me="b", it="a"))
    assert open_ones(found) == []


def test_not_when_both_read_in_the_step_what_the_other_writes():
    copy = SAFE + "\n promise always {me}' <-> {it}'\n promise at first {me} <-> {it}"
    parts = {"1": copy.format(me="a", it="b"), "2": copy.format(me="b", it="a")}
    assert open_ones(composed(**parts)) == ["1: !b", "1: !b'", "2: !a", "2: !a'"]


def read_at_once(text):
    """The inputs that have a say in the outputs of each step after the first one."""
    made = contract(text)
    found = find_dependencies(made, Universe((made,), Manager()))
    return [(sorted(one.outputs), sorted(one.inputs)) for one in found if not one.is_first]


def test_what_ties_an_output_to_an_input_of_the_same_step_is_reading_at_once():
    """That ``me`` follows ``it`` in the same step is said without a prime, or by two promises."""
    twice = "promise always it=1 & me -> me'\npromise always it=1 & me -> !me'"
    for tie in ("promise always me <-> it=1", twice):
        assert read_at_once(f"env it: 0..2\nsys me: bool\n{tie}") == [(["me"], ["it"])]


def test_what_is_answered_in_the_next_step_is_not_read_at_once():
    text = "env it: 0..2\nsys me: 0..4\npromise always me=1 & it=2 -> me'=3"
    assert read_at_once(text) == [(["me"], [])]


def test_outputs_that_no_promise_joins_read_apart():
    text = (
        "env a: bool\nsys x: bool\nsys y: bool\npromise always x' <-> a'\npromise always y' <-> x"
    )
    assert read_at_once(text) == [(["x"], ["a"]), (["y"], [])]


def test_parts_that_read_one_another_in_different_outputs_wait_for_nobody():
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
    found = composed(pick=hand.format(me="p", other="q"), place=hand.format(me="q", other="p"))
    assert open_ones(found) == []


def test_a_chain_within_a_step_is_no_circle():
    copy = SAFE + "\n promise always {me}' <-> {it}'"
    found = composed(one=SAFE.format(me="a", it="b"), other=copy.format(me="b", it="a"))
    assert open_ones(found) == []


def test_what_a_part_assumes_of_the_outside_the_composition_assumes():
    needing = PICKER.replace("env ready: bool", "env ready: bool\nenv power: bool")
    needing += "assume always power"
    found = composed(feeder=FEEDER, picker=needing)
    assert open_ones(found) == []
    assert [one.text for one in found.contract.assumptions] == ["power"]
    whole = "env power: bool\nsys taken: bool\npromise recurs taken"
    assert open_ones(composed(whole, feeder=FEEDER, picker=needing)) == ["picker: power"]


def test_what_the_outside_does_when_a_part_asks_the_composition_assumes():
    asking = PICKER.replace("env ready: bool", "env ready: bool\nenv done: bool")
    asking += "assume recurs !taken | done"
    found = composed(feeder=FEEDER, picker=asking)
    assert [one.text for one in found.contract.assumptions] == ["!taken | done"]
    waiting = asking.replace("!taken | done", "!ready | done")
    assert open_ones(composed(feeder=FEEDER, picker=waiting)) == ["picker: !ready | done"]


def test_what_is_outside_gr1_is_observed_on_both_sides():
    answering = "env ask: bool\nsys done: bool\npromise G (ask -> F done)"
    asking = "env done: bool\nsys ask: bool\nassume G (ask -> F done)\npromise recurs !ask"
    found = composed(server=answering, client=asking)
    assert open_ones(found) == []


def test_parts_that_contradict_one_another_are_told_by_what_contradicts():
    never = FEEDER.replace("promise recurs ready", "promise always !ready'")
    found = composed(feeder=never, picker=PICKER)
    assert [one.text for one in found.conflict] == ["!ready'", "taken' -> ready", "taken"]
    assert (found.open, found.failures) == ((), ())
    assert composed(**OTHERS).conflict == ()


def test_a_variable_is_decided_by_one_part():
    with pytest.raises(DriverError, match="'a' is decided by one and other"):
        composed(one="sys a: bool\npromise always a", other="sys a: bool\npromise recurs a")


def test_variables_of_the_composition_are_the_parts():
    found = composed(**OTHERS)
    assert {one.name: str(one.owner) for one in found.contract.variables} == {
        "taken": "sys",
        "ready": "sys",
    }


def test_what_a_part_promises_of_its_inputs_does_not_prove_what_it_assumes_of_them():
    one = "sys x: bool\nenv y: bool\nassume at first y"
    other = "sys y: bool\nenv x: bool\nassume at first x\npromise at first !y\npromise always x | y"
    assert "other: x" in open_ones(composed(one=one, other=other))


def test_what_a_part_says_before_it_sees_its_inputs_it_says_as_promised():
    """The server drops its work when the client is told; the client holds on until it is."""
    server = (
        "sys told: bool\nsys busy: bool\nenv asked: bool\nassume always busy -> !asked' | told'"
    )
    server += "\npromise at first !busy\npromise at first !told\npromise always told' <-> busy"
    server += "\npromise always busy' <-> asked & !busy"
    client = "sys asked: bool\nenv told: bool\npromise at first !asked"
    client += "\npromise always told' -> !asked'"
    assert open_ones(composed(server=server, client=client)) == []
