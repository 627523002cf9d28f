"""From a contract to a game: its parts, their conjuncts, and conjuncts outside GR(1)."""

import pytest
from contracts_in_lines import parse_contract

from sysmlc.synthesis import LimitError, Limits, Manager, OutsideGr1Error, make_game, solve

TURN = """
    env angle: 0..4
    env wanted: 0..4
    sys turning: bool
    assume at first angle=0
    assume always turning -> angle'=wanted
    assume always wanted'=wanted
    promise at first !turning
    promise always turning' <-> angle'!=wanted'
    promise recurs angle=wanted
"""


def list_texts(parts):
    return [part.conjunct.text if part.conjunct else "range" for part in parts]


def test_each_part_keeps_its_conjunct():
    game = make_game(parse_contract(TURN), Manager())
    assert list_texts(game.init_assumptions) == ["angle=0", "range", "range"]
    assert list_texts(game.init_guarantees) == ["!turning"]
    assert list_texts(game.assumptions) == [
        "turning -> angle'=wanted",
        "wanted'=wanted",
        "range",
        "range",
    ]
    assert list_texts(game.guarantees) == ["turning' <-> angle'!=wanted'"]
    assert [list_texts(game.fairness), list_texts(game.goals)] == [[], ["angle=wanted"]]


def test_a_winning_game_has_layers_towards_each_goal():
    solution = solve(make_game(parse_contract(TURN), Manager()))
    assert solution.is_realizable
    assert [len(layers) for layers in solution.layers] == [3]
    assert solution.layers[0][-1].states == solution.winning


@pytest.mark.parametrize(
    ("line", "why"),
    [
        ("promise at first turning'", "an initial condition cannot refer to the next step"),
        ("promise recurs angle=wanted'", "what must recur cannot refer to the next step (wanted')"),
        ("assume at first turning", "an initial assumption cannot refer to an output (turning)"),
        ("assume always turning'", "cannot refer to the next value of an output (turning')"),
        ("promise F turning", "neither initial, nor for every step (G), nor recurring (GF)"),
    ],
)
def test_a_conjunct_outside_gr1_is_named(line, why):
    with pytest.raises(OutsideGr1Error) as raised:
        make_game(parse_contract(f"{TURN}\n{line}"), Manager())
    assert why in raised.value.reason
    assert line.endswith(raised.value.conjunct.text)


def test_a_safety_guarantee_may_prime_everything():
    text = TURN + "promise always wanted' != 3 | turning | !turning'"
    assert len(make_game(parse_contract(text), Manager()).guarantees) == 2


def is_realizable(text: str) -> bool:
    return solve(make_game(parse_contract(text), Manager())).is_realizable


def test_the_system_sees_the_next_input_before_it_answers():
    assert is_realizable("env a: bool\nsys x: bool\npromise always x' <-> a'")
    assert not is_realizable("env a: bool\nsys x: bool\npromise always x <-> a'")


def test_the_first_output_follows_the_first_input():
    assert is_realizable("env a: bool\nsys x: bool\npromise at first x <-> a")
    assert not is_realizable("env a: bool\nsys x: bool\npromise at first a")
    assert is_realizable("env a: bool\nsys x: bool\nassume at first a\npromise at first a")


def test_the_system_may_not_break_its_promise_before_the_environment():
    text = """
        env a: bool
        sys x: bool
        promise always x' -> a'
        promise always !a' -> x'
    """
    assert not is_realizable(text)
    assert is_realizable(text + "assume always a'")
    # x is promised in the step in which the environment has no next input: it has lost before.
    assert is_realizable(text + "assume always a & !a")


def test_an_environment_without_next_input_has_lost():
    assert is_realizable("env a: bool\nsys x: bool\nassume always !x\npromise recurs a")
    assert not is_realizable("env a: bool\nsys x: bool\nassume always !a | a'\npromise recurs a")


def test_an_assumption_that_does_not_recur_frees_the_system():
    text = "env a: bool\nsys x: bool\npromise recurs a"
    assert not is_realizable(text)
    assert is_realizable(text + "\nassume recurs a")
    assert is_realizable(text + "\nassume recurs x")


def test_ranges_restrict_the_moves():
    assert not is_realizable("env a: bool\nsys n: 0..2\npromise always n' = n + 1")
    assert is_realizable(
        "env n: 0..2\nsys x: bool\nassume always n' = n + 1\npromise recurs n=7 & n=6"
    )


def test_an_unfinished_solution_has_the_verdict():
    game = make_game(parse_contract("env a: bool\nsys x: bool\npromise always x & a"), Manager())
    solution = solve(game, is_complete=False)
    assert [solution.is_realizable, solution.is_complete] == [False, False]
    assert solve(game).winning == game.manager.false


def copy_inputs(number: int) -> str:
    """Return outputs that copy inputs far away in the order of bits: 2^number nodes."""
    lines = [
        *(f"env a{n}: bool" for n in range(number)),
        *(f"sys x{n}: bool" for n in range(number)),
    ]
    equalities = " & ".join(f"(x{n}' <-> a{n}')" for n in range(number))
    return "\n".join([*lines, f"promise always {equalities}", "promise recurs a0"])


@pytest.mark.parametrize(
    ("limits", "number", "words"),
    [
        (Limits(nodes=500), 16, "the limit of 500 nodes was reached"),
        (Limits(seconds=1e-9), 1, "the limit of 1e-09 s of CPU time was reached"),
        (Limits(memory=1 << 26), 22, "the limit of 0.0625 GiB of memory was reached"),
    ],
)
def test_a_reached_limit_is_named(limits, number, words):
    with pytest.raises(LimitError, match=words):
        solve(make_game(parse_contract(copy_inputs(number)), Manager(limits=limits)))


def test_progress_is_reported():
    messages = []
    solve(make_game(parse_contract(TURN), Manager(progress=messages.append)))
    assert messages[-1].startswith("round ")
