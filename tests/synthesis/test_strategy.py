"""Controllers of contracts, and their verification."""

from itertools import pairwise

import controller_plays as machines
import pytest
import small_games
from contracts_in_lines import parse_contract
from msgspec.structs import replace

from sysmlc.controllers.machine import Move
from sysmlc.logic.contract import Class
from sysmlc.logic.formula import TRUE, Const, Var
from sysmlc.logic.printing import print_formula
from sysmlc.synthesis import LimitError, Manager, make_game, solve
from sysmlc.synthesis import controller_synthesis as synthesise
from sysmlc.synthesis.bdd.limits import TooLargeError
from sysmlc.synthesis.controller_synthesis import Form
from sysmlc.synthesis.games.arena import nodes_of
from sysmlc.synthesis.strategies.conditions import build_machine
from sysmlc.synthesis.strategies.explicit_states import enumerate_states
from sysmlc.synthesis.strategies.minimisation import minimise
from sysmlc.synthesis.strategies.strategy import extract_strategy
from sysmlc.synthesis.strategies.strategy_memory import choose_registers, explore_strategy
from sysmlc.synthesis.strategies.tables import rebuild_in_variable_order

SUITE = 200
KINDS = [small_games.random_contract, small_games.random_plant]
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


def list_realizable(kind, seeds, form=Form.ANY, is_encoded=True):
    contracts = [kind(seed) for seed in seeds]
    pairs = (
        (contract, machines.build_controller(contract, form, "", is_encoded))
        for contract in contracts
    )
    return [(contract, controller) for contract, controller in pairs if controller]


def draft_machine(contract, **limits):
    """Build the machine of a contract without minimising it."""
    game, plan = machines.plan_strategy(contract)
    strategy = explore_strategy(plan, nodes_of(game.init_assumptions), nodes_of(game.assumptions))
    return enumerate_states(strategy, choose_registers(strategy), **limits)


def test_a_controller_answers_step_by_step():
    answer = machines.follow(machines.build_controller(parse_contract(LAMP)))
    inputs = [True, True, False]
    assert [answer({"press": press})["lamp"] for press in inputs] == ["off", "on", "on"]


@pytest.mark.parametrize("form", FORMS)
def test_goals_take_turns_and_the_controller_waits_for_fairness(form):
    answer = machines.follow(machines.build_controller(parse_contract(DOOR), form))
    positions = [answer({"arrived": False, "blocked": False})["door"]]
    for step in range(24):
        positions.append(answer({"arrived": True, "blocked": step % 3 == 0})["door"])
    assert all(abs(before - after) <= 1 for before, after in pairwise(positions))
    assert positions.count(0) >= 3
    assert positions.count(2) >= 3


def test_a_lost_game_has_no_strategy():
    lost = make_game(parse_contract("env a: bool\nsys x: bool\npromise always x <-> a'"), Manager())
    with pytest.raises(ValueError, match="was won"):
        extract_strategy(lost, solve(lost))


@pytest.mark.parametrize("start", range(0, SUITE, 50))
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("form", FORMS)
def test_controllers_of_random_contracts_pass_verification(kind, form, start):
    for contract, controller in list_realizable(kind, range(start, start + 50), form):
        assert machines.list_faults(controller, contract) == []


@pytest.mark.parametrize("kind", KINDS)
def test_controllers_of_plain_games_pass_verification(kind):
    for contract, controller in list_realizable(kind, range(SUITE // 4), is_encoded=False):
        assert machines.list_faults(controller, contract) == []


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("form", FORMS)
def test_random_plays_satisfy_the_contract(kind, form):
    for seed, (contract, controller) in enumerate(list_realizable(kind, range(SUITE // 2), form)):
        steps = machines.play_randomly(contract, machines.follow(controller), 40, seed)
        assert not steps or machines.list_broken_guarantees(contract, steps) == []


@pytest.mark.parametrize("form", FORMS)
def test_the_controller_answers_the_same_without_cudd(form):
    for seed in range(40):
        contract = small_games.random_contract(seed)
        controller, pure_controller = (
            machines.build_controller(contract, form, engine) for engine in ("", "autoref")
        )
        if form is Form.TABLE and controller:
            controller, pure_controller = (
                rebuild_in_variable_order(controller, Manager()),
                rebuild_in_variable_order(pure_controller, Manager()),
            )
        assert controller == pure_controller
        plays = [
            machines.play_randomly(contract, machines.follow(player), 20, seed)
            for player in (controller, pure_controller)
            if player
        ]
        assert not plays or plays[0] == plays[1]


@pytest.mark.parametrize("form", FORMS)
def test_the_controller_is_the_same_in_any_order_of_bits(form):
    for contract in map(small_games.random_plant, range(30)):
        solved = machines.plan_strategy(contract)
        if solved is None:
            continue
        game, plan = solved
        before = build_in_variable_order(contract, game, plan, form)
        game.manager.sift()
        assert build_in_variable_order(contract, game, plan, form) == before


def build_in_variable_order(contract, game, plan, form):
    controller = synthesise.build_controller_form(contract, game, plan, form)
    return rebuild_in_variable_order(controller, Manager()) if form is Form.TABLE else controller


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("form", FORMS)
def test_verification_of_mutated_controllers_agrees_with_enumeration(kind, form):
    violated_classes = []
    for contract, controller in list_realizable(kind, range(SUITE // 2), form):
        for seed in range(4):
            mutant = machines.mutate(controller, f"{contract.component} {seed}")
            if mutant is None:
                continue
            faults = machines.list_faults(mutant, contract)
            closed_loop = machines.ClosedLoop(mutant, contract)
            assert [
                fault.conjunct for fault in faults if fault.conjunct
            ] == closed_loop.list_broken_guarantees()
            assert any(fault.conjunct is None for fault in faults) == closed_loop.is_stuck
            violated_classes += [
                fault.conjunct.class_ if fault.conjunct else None for fault in faults
            ]
    assert {*violated_classes} >= {Class.SAFETY, *([] if form is Form.TABLE else [None])}
    assert kind is small_games.random_plant or Class.LIVENESS in violated_classes


def test_a_fault_shows_the_steps_that_lead_to_it():
    contract = parse_contract(LAMP)
    machine = machines.build_controller(contract)
    always = Move(TRUE, (Const("on"),), 0)
    first, *_ = machines.list_faults(replace(machine, states=((always,),)), contract)
    assert first.conjunct is contract.guarantees[0]
    assert first.steps == ({"press": first.steps[0]["press"], "lamp": "on"},)


def test_a_fault_of_a_goal_shows_the_loop():
    contract = parse_contract("env a: bool\nsys x: bool\npromise recurs x")
    idle = (Move(TRUE, (Const(False),), 0),)
    (fault,) = machines.list_faults(
        replace(machines.build_controller(contract), states=(idle,)), contract
    )
    assert fault.conjunct is contract.guarantees[0]
    assert fault.loop is not None
    assert not any(step["x"] for step in fault.steps[fault.loop :])


def test_too_many_states_moves_or_conditions_raise():
    door = parse_contract(DOOR)
    with pytest.raises(TooLargeError, match="the limit of 1 state of the machine"):
        draft_machine(door, max_states=1)
    with pytest.raises(TooLargeError, match="the limit of 5 moves of the machine"):
        draft_machine(door, max_moves=5)
    with pytest.raises(TooLargeError, match="the limit of 4 cases in the conditions"):
        build_machine(minimise(draft_machine(door)), door, max_cases=4)


def test_states_that_no_allowed_input_distinguishes_are_merged():
    assert machines.build_controller(parse_contract(LAMP)).size == 3
    assert machines.build_controller(parse_contract(TURNS)).size == 1


def test_states_beyond_the_limit_of_comparisons_are_not_merged():
    contract = parse_contract(TURNS)
    hasty = build_machine(minimise(draft_machine(contract), max_comparisons=0), contract)
    assert hasty.size > machines.build_controller(contract).size
    assert machines.list_faults(hasty, contract) == []


def test_a_counter_is_a_register():
    contract = parse_contract(COUNTING)
    machine = machines.build_controller(contract)
    assert [register.name for register in machine.registers] == ["n"]
    assert machine.size <= 3
    assert machines.build_controller(contract, Form.LISTED).size >= 20
    values = {print_formula(move.output[0]) for moves in machine.states[1:] for move in moves}
    assert values == {"n", "n + 1", "0"}


def test_a_register_that_counts_wrong_is_caught():
    contract = parse_contract(COUNTING)
    machine = machines.build_controller(contract)
    replacements = {"n + 1": Var("n"), "n": Const(0), "0": Var("n")}
    for state, moves in enumerate(machine.states):
        for index, move in enumerate(moves):
            number = replacements[print_formula(move.output[0])] if state else Const(3)
            mutant = replace(move, output=(number, *move.output[1:]))
            states = [*machine.states]
            states[state] = (*moves[:index], mutant, *moves[index + 1 :])
            assert machines.list_faults(replace(machine, states=tuple(states)), contract)


def test_the_operand_of_a_counter_is_a_register_too():
    contract = parse_contract(FOLLOWING)
    machine = machines.build_controller(contract)
    assert [register.name for register in machine.registers] == ["wanted", "at"]
    assert machine.size == 2
    conditions = {
        print_formula(move.output[0]): print_formula(move.when) for move in machine.states[1]
    }
    assert conditions == {
        "at": "at=wanted' | wanted!=wanted'",
        "at + 1": "wanted=wanted' & at<wanted'",
        "at - 1": "wanted=wanted' & at>wanted'",
    }


def test_registers_hold_the_values_of_the_previous_step():
    answer = machines.follow(machines.build_controller(parse_contract(FOLLOWING)))
    wanted = [2, 2, 2, 1, 1]
    assert [answer({"wanted": target})["at"] for target in wanted] == [0, 1, 2, 2, 1]


def test_a_table_replaces_a_machine_that_cannot_be_enumerated():
    cells = "\n".join(f"env a{index}: 0..30\nsys x{index}: 0..30" for index in range(3))
    guarantees = "\n".join(f"promise always x{index}' * 7 mod 31 = a{index}'" for index in range(3))
    contract = parse_contract(f"{cells}\n{guarantees}")
    table = machines.build_controller(contract)
    assert len(table.nodes) > 30
    assert machines.list_faults(table, contract) == []
    with pytest.raises(LimitError):
        machines.build_controller(contract, Form.LISTED)


def test_many_bits_need_no_deep_recursion():
    names = [f"x{index}" for index in range(400)]
    wide = parse_contract("\n".join(["env a: bool", *(f"sys {name}: bool" for name in names)]))
    for form in (Form.ANY, Form.TABLE):
        answer = machines.follow(machines.build_controller(wide, form))
        assert len(answer({"a": True})) == 400
