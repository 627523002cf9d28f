"""Controllers of contracts, and the check that nothing of theirs can pass by."""

from itertools import pairwise

import made_machines as machines
import pytest
import small_games
from contracts_in_lines import contract
from msgspec.structs import replace

from sysmlc.logic.contract import Class
from sysmlc.logic.formula import TRUE, Const, Var
from sysmlc.logic.printing import print_formula
from sysmlc.synthesis import LimitError, Manager, make_game, solve
from sysmlc.synthesis import controller_synthesis as synthesise
from sysmlc.synthesis.bdd.limits import TooLargeError
from sysmlc.synthesis.controller_synthesis import Form
from sysmlc.synthesis.controllers.conditions import build_machine as written
from sysmlc.synthesis.controllers.explicit_states import enumerate_states
from sysmlc.synthesis.controllers.forms import Move, rebuild_in_variable_order
from sysmlc.synthesis.controllers.minimisation import minimise
from sysmlc.synthesis.controllers.strategy import extract_strategy
from sysmlc.synthesis.controllers.strategy_memory import choose_registers, explore_strategy
from sysmlc.synthesis.games.arena import nodes_of

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


COUNTING = """
    env go: bool
    sys n: 0..20
    sys done: bool
    promise at first n=0 & !done
    promise always go' & n<20 -> n'=n+1
    promise always go' & n=20 -> n'=0
    promise always !go' -> n'=n
    promise always done' <-> n'=20
"""
FOLLOWING = """
    env wanted: 0..9
    sys at: 0..9
    assume always at!=wanted -> wanted'=wanted
    promise at first at=0
    promise always at<wanted -> at'=at+1
    promise always at>wanted -> at'=at-1
    promise always at=wanted -> at'=at
    promise recurs at=wanted
"""
FORMS = list(Form)


def realizable(kind, seeds, form=Form.ANY, is_encoded=True):
    made = [kind(seed) for seed in seeds]
    found = ((one, machines.controller(one, form, "", is_encoded)) for one in made)
    return [(one, controller) for one, controller in found if controller]


def drafted(made, **limits):
    """The draft of a contract's machine, not minimised."""
    game, plan = machines.planned(made)
    found = explore_strategy(plan, nodes_of(game.init_assumptions), nodes_of(game.assumptions))
    return enumerate_states(found, choose_registers(found), **limits)


def test_a_controller_answers_step_by_step():
    answer = machines.followed(machines.controller(contract(LAMP)))
    given = [True, True, False]
    assert [answer({"press": one})["lamp"] for one in given] == ["off", "on", "on"]


@pytest.mark.parametrize("form", FORMS)
def test_goals_take_turns_and_waiting_is_for_what_recurs(form):
    answer = machines.followed(machines.controller(contract(DOOR), form))
    seen = [answer({"arrived": False, "blocked": False})["door"]]
    for step in range(24):
        seen.append(answer({"arrived": True, "blocked": step % 3 == 0})["door"])
    assert all(abs(one - other) <= 1 for one, other in pairwise(seen))
    assert seen.count(0) >= 3
    assert seen.count(2) >= 3


def test_a_lost_game_has_no_strategy():
    lost = make_game(contract("env a: bool\nsys x: bool\npromise always x <-> a'"), Manager())
    with pytest.raises(ValueError, match="was won"):
        extract_strategy(lost, solve(lost))


@pytest.mark.parametrize("start", range(0, SUITE, 50))
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("form", FORMS)
def test_controllers_of_random_contracts_pass_the_check(kind, form, start):
    for made, controller in realizable(kind, range(start, start + 50), form):
        assert machines.said(controller, made) == []


@pytest.mark.parametrize("kind", KINDS)
def test_controllers_of_games_as_they_are_written_pass_the_check(kind):
    for made, controller in realizable(kind, range(SUITE // 4), is_encoded=False):
        assert machines.said(controller, made) == []


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("form", FORMS)
def test_random_plays_keep_the_contract(kind, form):
    for at, (made, controller) in enumerate(realizable(kind, range(SUITE // 2), form)):
        steps = machines.play(made, machines.followed(controller), 40, at)
        assert not steps or machines.broken(made, steps) == []


@pytest.mark.parametrize("form", FORMS)
def test_the_controller_answers_the_same_without_cudd(form):
    for seed in range(40):
        made = small_games.contract(seed)
        one, other = (machines.controller(made, form, engine) for engine in ("", "autoref"))
        if form is Form.TABLE and one:
            one, other = (
                rebuild_in_variable_order(one, Manager()),
                rebuild_in_variable_order(other, Manager()),
            )
        assert one == other
        plays = [
            machines.play(made, machines.followed(each), 20, seed) for each in (one, other) if each
        ]
        assert not plays or plays[0] == plays[1]


@pytest.mark.parametrize("form", FORMS)
def test_the_controller_is_the_same_in_any_order_of_bits(form):
    for made in map(small_games.plant, range(30)):
        found = machines.planned(made)
        if found is None:
            continue
        game, plan = found
        before = written_in(made, game, plan, form)
        game.manager.sift()
        assert written_in(made, game, plan, form) == before


def written_in(made, game, plan, form):
    controller = synthesise.build_controller_form(made, game, plan, form)
    return rebuild_in_variable_order(controller, Manager()) if form is Form.TABLE else controller


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("form", FORMS)
def test_the_check_finds_in_spoilt_controllers_what_listing_all_states_finds(kind, form):
    caught = []
    for made, controller in realizable(kind, range(SUITE // 2), form):
        for seed in range(4):
            spoilt = machines.spoilt(controller, f"{made.component} {seed}")
            if spoilt is None:
                continue
            found = machines.said(spoilt, made)
            judge = machines.Closed(spoilt, made)
            assert [one.conjunct for one in found if one.conjunct] == judge.broken()
            assert any(one.conjunct is None for one in found) == judge.stuck
            caught += [one.conjunct.class_ if one.conjunct else None for one in found]
    assert {*caught} >= {Class.SAFETY, *([] if form is Form.TABLE else [None])}
    assert kind is small_games.plant or Class.LIVENESS in caught


def test_a_fault_shows_the_steps_that_lead_to_it():
    made = contract(LAMP)
    machine = machines.controller(made)
    always = Move(TRUE, (Const("on"),), 0)
    first, *_ = machines.said(replace(machine, states=((always,),)), made)
    assert first.conjunct is made.guarantees[0]
    assert first.steps == ({"press": first.steps[0]["press"], "lamp": "on"},)


def test_a_machine_that_never_comes_to_a_goal_shows_the_loop():
    made = contract("env a: bool\nsys x: bool\npromise recurs x")
    idle = (Move(TRUE, (Const(False),), 0),)
    (fault,) = machines.said(replace(machines.controller(made), states=(idle,)), made)
    assert fault.conjunct is made.guarantees[0]
    assert fault.loop is not None
    assert not any(step["x"] for step in fault.steps[fault.loop :])


def test_too_many_states_moves_or_conditions_are_said():
    door = contract(DOOR)
    with pytest.raises(TooLargeError, match="the limit of 1 states of the machine"):
        drafted(door, max_states=1)
    with pytest.raises(TooLargeError, match="the limit of 5 moves of the machine"):
        drafted(door, max_moves=5)
    with pytest.raises(TooLargeError, match="the limit of 4 cases in the conditions"):
        written(minimise(drafted(door)), door, max_cases=4)


def test_states_that_no_allowed_input_tells_apart_are_one():
    assert machines.controller(contract(LAMP)).size == 3
    assert machines.controller(contract(TURNS)).size == 1


def test_what_time_does_not_suffice_to_join_stays_apart():
    made = contract(TURNS)
    hasty = written(minimise(drafted(made), max_comparisons=0), made)
    assert hasty.size > machines.controller(made).size
    assert machines.said(hasty, made) == []


def test_a_counter_is_a_register():
    made = contract(COUNTING)
    machine = machines.controller(made)
    assert [one.name for one in machine.registers] == ["n"]
    assert machine.size <= 3
    assert machines.controller(made, Form.LISTED).size >= 20
    values = {print_formula(move.output[0]) for moves in machine.states[1:] for move in moves}
    assert values == {"n", "n + 1", "0"}


def test_a_register_that_counts_wrong_is_caught():
    made = contract(COUNTING)
    machine = machines.controller(made)
    others = {"n + 1": Var("n"), "n": Const(0), "0": Var("n")}
    for place, moves in enumerate(machine.states):
        for at, move in enumerate(moves):
            number = others[print_formula(move.output[0])] if place else Const(3)
            spoilt = replace(move, output=(number, *move.output[1:]))
            states = [*machine.states]
            states[place] = (*moves[:at], spoilt, *moves[at + 1 :])
            assert machines.said(replace(machine, states=tuple(states)), made)


def test_what_a_counter_is_compared_with_is_kept_beside_it():
    made = contract(FOLLOWING)
    machine = machines.controller(made)
    assert [one.name for one in machine.registers] == ["wanted", "at"]
    assert machine.size == 2
    told = {print_formula(one.output[0]): print_formula(one.when) for one in machine.states[1]}
    assert told == {
        "at": "at=wanted' | wanted!=wanted'",
        "at + 1": "wanted=wanted' & at<wanted'",
        "at - 1": "wanted=wanted' & at>wanted'",
    }


def test_registers_go_on_from_what_was_the_step_before():
    answer = machines.followed(machines.controller(contract(FOLLOWING)))
    wanted = [2, 2, 2, 1, 1]
    assert [answer({"wanted": one})["at"] for one in wanted] == [0, 1, 2, 2, 1]


def test_a_table_is_one_where_no_machine_can_be_listed():
    cells = "\n".join(f"env a{at}: 0..30\nsys x{at}: 0..30" for at in range(3))
    said = "\n".join(f"promise always x{at}' * 7 mod 31 = a{at}'" for at in range(3))
    made = contract(f"{cells}\n{said}")
    table = machines.controller(made)
    assert len(table.nodes) > 30
    assert machines.said(table, made) == []
    with pytest.raises(LimitError):
        machines.controller(made, Form.LISTED)


def test_many_bits_are_no_deep_recursion():
    names = [f"x{at}" for at in range(400)]
    wide = contract("\n".join(["env a: bool", *(f"sys {one}: bool" for one in names)]))
    for form in (Form.ANY, Form.TABLE):
        answer = machines.followed(machines.controller(wide, form))
        assert len(answer({"a": True})) == 400
