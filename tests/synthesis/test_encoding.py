"""Encodings of a game: eliminated variables and commands, with an unchanged verdict."""

import pytest
import small_games
from contracts_in_lines import parse_contract

from long_runs import quick_first
from sysmlc.logic.contract import Owner
from sysmlc.synthesis import Manager, make_game
from sysmlc.synthesis.games.command_elimination import eliminate_commands
from sysmlc.synthesis.games.variable_elimination import eliminate_determined_variables

SUITE = 500
ROBOT = """
    env pos: 0..2
    env target: 0..2
    env left: bool
    env right: bool
    sys command: stay back ahead
    assume at first left <-> pos!=0
    assume at first right <-> pos!=2
    assume always left' <-> pos'!=0
    assume always pos'=0 -> right'
    assume always pos'=1 -> right'
    assume always pos'=2 -> !right'
    assume always command=back -> pos' = pos - 1
    assume always command=ahead -> pos' = pos + 1
    assume always command=stay -> pos'=pos
    assume always pos!=target -> target'=target
    promise always command'=back -> left'
    promise always command'=ahead -> right'
    promise recurs pos=target
"""


@pytest.mark.parametrize("start", quick_first(range(0, SUITE, 100)))
@pytest.mark.parametrize("kind", [small_games.random_contract, small_games.random_plant])
def test_the_verdict_is_that_of_listed_states(kind, start):
    disagreements = [
        small_games.describe_encoded_disagreement(kind(seed)) for seed in range(start, start + 100)
    ]
    assert [text for text in disagreements if text] == []


def test_without_cudd_the_verdict_is_the_same():
    plants = [small_games.random_plant(seed) for seed in range(20)]
    disagreements = [
        small_games.describe_encoded_disagreement(plant, "autoref") for plant in plants
    ]
    assert [text for text in disagreements if text] == []


def test_random_plants_are_encoded():
    arenas = [small_games.encode_game(small_games.random_plant(seed)) for seed in range(40)]
    assert sum(is_assigned_by_system(arena, "p") for arena in arenas) > 20
    assert sum(not is_assigned(arena, "d") for arena in arenas) > 10


def is_assigned(arena, name: str) -> bool:
    """Whether some turn assigns the next value of the variable."""
    return any(f"{name}.0'" in turn.bits for turn in arena.turns)


def is_assigned_by_system(arena, name: str) -> bool:
    """Whether a turn of the system assigns the next value of the variable."""
    return any(f"{name}.0'" in turn.bits for turn in arena.turns if turn.owner is Owner.SYSTEM)


def test_determined_inputs_are_eliminated():
    game = eliminate_determined_variables(make_game(parse_contract(ROBOT), Manager()))
    assert game.names(Owner.ENVIRONMENT) == ("pos", "target")
    definition = game.definitions["left"]["left.0"]
    assert all((game.symbols.encode({"pos": pos}) <= definition) == (pos != 0) for pos in range(3))


def test_a_command_is_replaced_by_a_turn_of_the_system():
    arena = eliminate_commands(
        eliminate_determined_variables(make_game(parse_contract(ROBOT), Manager()))
    )
    assert [(turn.owner.value, turn.bits) for turn in arena.turns] == [
        ("sys", ("pos.0'", "pos.1'")),
        ("env", ("target.0'", "target.1'")),
        ("sys", ()),
    ]


@pytest.mark.parametrize(
    ("line", "why"),
    [
        ("promise always command!=stay -> command'=stay", "it is remembered"),
        ("promise always pos=target -> command'=stay", "the state before binds it"),
        ("promise recurs command=stay", "it has to recur"),
        ("assume recurs command!=stay", "the environment answers to it for ever"),
    ],
)
def test_a_command_stays_in_the_state_when(line, why):
    arena = eliminate_commands(make_game(parse_contract(f"{ROBOT}\n{line}"), Manager()))
    assert len(arena.turns) == 2, why


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("left' <-> pos'!=0", "left' -> pos'!=0"),
        ("at first left <-> pos!=0", "at first left -> pos!=0"),
        ("always left' <-> pos'!=0", "always left' <-> pos!=0"),
    ],
)
def test_an_input_with_a_choice_stays(old, new):
    text = ROBOT.replace(f"assume {old}", f"assume {new}").replace(old, new)
    assert "left" in eliminate_determined_variables(
        make_game(parse_contract(text), Manager())
    ).names(Owner.ENVIRONMENT)


def test_a_plant_with_a_choice_stays_with_the_environment():
    text = ROBOT.replace("command=stay -> pos'=pos", "command=stay -> pos'<=pos")
    arena = eliminate_commands(
        eliminate_determined_variables(make_game(parse_contract(text), Manager()))
    )
    assert not is_assigned_by_system(arena, "pos")
