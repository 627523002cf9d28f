"""Smallest conflicts among many things."""

from itertools import combinations

from hypothesis import given
from hypothesis import strategies as st

from sysmlc.synthesis.unrealizable import minimal_conflict

CONFLICTS = st.lists(st.frozensets(st.integers(0, 9), min_size=1, max_size=4), min_size=1)


@given(CONFLICTS)
def test_what_is_found_conflicts_and_nothing_of_it_can_be_left_out(known):
    def is_conflict(some):
        return any(one <= set(some) for one in known)

    found = minimal_conflict(range(10), is_conflict)
    assert is_conflict(found)
    assert not any(is_conflict(fewer) for fewer in combinations(found, len(found) - 1))
    assert list(found) == sorted(found)


@given(CONFLICTS, st.integers(0, 5))
def test_with_few_questions_what_is_found_still_conflicts(known, most):
    def is_conflict(some):
        return any(one <= set(some) for one in known)

    assert is_conflict(minimal_conflict(range(10), is_conflict, most))
