"""Controllers and machines of contracts, and the check that nothing of theirs can pass by."""

from itertools import pairwise

import made_machines as machines
import pytest
import small_games
from contracts_in_lines import contract

from sysmlc.logic.contract import Class
from sysmlc.synthesis import LimitError, Manager, make_game, solve
from sysmlc.synthesis.mealy import Move, explored
from sysmlc.synthesis.minimise import minimised
from sysmlc.synthesis.strategy import AssumptionBrokenError, Controller
from sysmlc.values import replace

SUITE = 200
KINDS = [small_games.contract, small_games.plant]
LAMP = """
    env press: bool
    sys lamp: off on
    promise at first lamp=off
    promise always press' -> lamp'!=lamp
    promise always !press' -> lamp'=lamp
"""
TURNS = """
    env a: bool
    sys x: bool
    assume at first a
    assume always a <-> !a'
    promise at first x
    promise always x' <-> a'
"""
DOOR = """
    env arrived: bool
    env blocked: bool
    sys door: 0..2
    assume always door=2 -> arrived'
    assume recurs !blocked
    promise at first door=0
    promise always blocked' -> door'=door
    promise always door' <= door + 1
    promise always door' >= door - 1
    promise recurs door=2
    promise recurs door=0
"""


def realizable(kind, seeds):
    made = [kind(seed) for seed in seeds]
    found = ((one, machines.machine(one)) for one in made)
    return [(one, machine) for one, machine in found if machine]


def test_a_controller_answers_step_by_step():
    lamp = machines.controller(contract(LAMP))
    state = lamp.start({"press": True})
    assert lamp.values(state) == {"press": True, "lamp": "off"}
    state = lamp.step(state, {"press": True})
    assert lamp.values(state) == {"press": True, "lamp": "on"}
    assert lamp.values(lamp.step(state, {"press": False}))["lamp"] == "on"


def test_goals_take_turns_and_waiting_is_for_what_recurs():
    door = machines.controller(contract(DOOR))
    state = door.start({"arrived": False, "blocked": False})
    seen = []
    for step in range(24):
        given = {"arrived": True, "blocked": step % 3 == 0}
        state = door.step(state, given)
        seen.append(door.values(state)["door"])
    assert all(abs(one - other) <= 1 for one, other in pairwise(seen))
    assert seen.count(0) >= 3
    assert seen.count(2) >= 3


def test_inputs_that_break_an_assumption_are_refused():
    told = contract("env a: bool\nsys x: bool\nassume at first a\nassume always a -> !a'")
    one = machines.controller(told)
    with pytest.raises(AssumptionBrokenError):
        one.start({"a": False})
    with pytest.raises(AssumptionBrokenError):
        one.step(one.start({"a": True}), {"a": True})


def test_a_lost_game_has_no_controller():
    lost = contract("env a: bool\nsys x: bool\npromise always x <-> a'")
    with pytest.raises(ValueError, match="was won"):
        Controller(solve(make_game(lost, Manager())))


@pytest.mark.parametrize("start", range(0, SUITE, 50))
@pytest.mark.parametrize("kind", KINDS)
def test_machines_of_random_contracts_pass_the_check(kind, start):
    for made, machine in realizable(kind, range(start, start + 50)):
        assert machines.said(machine, made) == []
        small = minimised(machine)
        assert small.size <= machine.size
        assert machines.said(small, made) == []


@pytest.mark.parametrize("kind", KINDS)
def test_random_plays_keep_the_contract(kind):
    for at, (made, machine) in enumerate(realizable(kind, range(SUITE // 2))):
        steps = machines.play(made, machines.followed(minimised(machine)), 40, at)
        assert not steps or machines.broken(made, steps) == []


def test_the_machine_is_the_same_without_cudd():
    for seed in range(40):
        made = small_games.contract(seed)
        assert machines.machine(made) == machines.machine(made, "autoref")


@pytest.mark.parametrize("kind", KINDS)
def test_the_check_finds_in_spoilt_machines_what_listing_all_states_finds(kind):
    caught = []
    for made, machine in realizable(kind, range(SUITE // 2)):
        if not any(machine.moves):
            continue
        for seed in range(4):
            spoilt = machines.spoilt(machine, made, f"{made.component} {seed}")
            found = machines.said(spoilt, made)
            judge = machines.Closed(spoilt, made)
            assert [one.conjunct for one in found if one.conjunct] == judge.broken()
            assert any(one.conjunct is None for one in found) == judge.stuck
            caught += [one.conjunct.class_ if one.conjunct else None for one in found]
    assert {Class.SAFETY, None} <= {*caught}
    assert kind is small_games.plant or Class.LIVENESS in caught


def test_a_fault_shows_the_steps_that_lead_to_it():
    made = contract(LAMP)
    machine = minimised(machines.machine(made))
    always = Move(("on",), 0)
    first, *_ = machines.said(replace(machine, moves=({(False,): always, (True,): always},)), made)
    assert first.conjunct is made.guarantees[0]
    assert first.steps == ({"press": False, "lamp": "on"},)


def test_a_machine_that_never_comes_to_a_goal_shows_the_loop():
    made = contract("env a: bool\nsys x: bool\npromise recurs x")
    idle = {(value,): Move((False,), 0) for value in (False, True)}
    lazy = replace(machines.machine(made), moves=(idle,))
    (fault,) = machines.said(lazy, made)
    assert fault.conjunct is made.guarantees[0]
    assert fault.loop is not None
    assert not any(step["x"] for step in fault.steps[fault.loop :])


def test_too_many_states_or_moves_are_said():
    door = machines.controller(contract(DOOR))
    with pytest.raises(LimitError, match="the limit of 3 states of the machine"):
        explored(door, most_states=3)
    with pytest.raises(LimitError, match="the limit of 5 moves of the machine"):
        explored(door, most_moves=5)


def test_states_that_no_allowed_input_tells_apart_are_one():
    toggle = minimised(machines.machine(contract(LAMP)))
    assert toggle.size == 3
    assert minimised(machines.machine(contract(TURNS))).size == 1


def test_what_time_does_not_suffice_to_join_stays_apart():
    made = contract(TURNS)
    machine = machines.machine(made)
    hasty = minimised(machine, most=0)
    assert hasty.size > minimised(machine).size
    assert machines.said(hasty, made) == []


def test_many_bits_are_no_deep_recursion():
    names = [f"x{at}" for at in range(600)]
    wide = contract("\n".join(["env a: bool", *(f"sys {one}: bool" for one in names)]))
    state = machines.controller(wide).start({"a": True})
    assert len(state.code) == 601
