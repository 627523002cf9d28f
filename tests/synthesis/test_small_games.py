"""Random small contracts: the engine and a solver that lists every state agree on all of them.

With those of ``test_encoding`` these are 2,000; ``python tests/synthesis/small_games.py 2000``
compares 6,000.
"""

import pytest
import small_games
from explicit import Explicit

SUITE = 1000


@pytest.mark.parametrize("start", range(0, SUITE, 100))
def test_verdict_and_winning_states_agree_with_listed_states(start):
    found = [small_games.disagreement(seed) for seed in range(start, start + 100)]
    assert [text for text in found if text] == []


def test_without_cudd_the_same_code_says_the_same():
    found = [small_games.disagreement(seed, "autoref") for seed in range(40)]
    assert [text for text in found if text] == []


def test_random_contracts_are_of_all_kinds():
    listed = [Explicit(small_games.contract(seed)) for seed in range(100)]
    verdicts = [one.is_realizable() for one in listed]
    sizes = [(len(one.winning()), len(one.states)) for one in listed]
    assert 20 < sum(verdicts) < 80
    assert sum(0 < won < states for won, states in sizes) > 10


def test_the_comparison_would_notice(monkeypatch):
    monkeypatch.setattr(Explicit, "winning", lambda self: set())
    assert any(small_games.disagreement(seed) for seed in range(20))
