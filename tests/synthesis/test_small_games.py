"""Random small contracts: the engine and the explicit solver agree on all of them.

Together with ``test_encoding`` 2,000 contracts are compared; 6,000 by
``python tests/synthesis/small_games.py 2000``.
"""

import pytest
import small_games
from explicit import ExplicitGame

from long_runs import quick_first

SUITE = 1000


@pytest.mark.parametrize("start", quick_first(range(0, SUITE, 100), 3))
def test_verdict_and_winning_states_agree_with_listed_states(start):
    disagreements = [small_games.describe_disagreement(seed) for seed in range(start, start + 100)]
    assert [text for text in disagreements if text] == []


def test_verdicts_without_cudd_agree_with_listed_states():
    disagreements = [small_games.describe_disagreement(seed, "autoref") for seed in range(40)]
    assert [text for text in disagreements if text] == []


def test_random_contracts_are_of_all_kinds():
    games = [ExplicitGame(small_games.random_contract(seed)) for seed in range(100)]
    verdicts = [game.is_realizable() for game in games]
    sizes = [(len(game.find_winning_states()), len(game.states)) for game in games]
    assert 20 < sum(verdicts) < 80
    assert sum(0 < won < states for won, states in sizes) > 10


def test_the_comparison_detects_a_wrong_solver(monkeypatch):
    monkeypatch.setattr(ExplicitGame, "find_winning_states", lambda self: set())
    assert any(small_games.describe_disagreement(seed) for seed in range(20))
