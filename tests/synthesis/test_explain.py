"""Minimal conflicts among many items."""

from itertools import combinations

from hypothesis import given
from hypothesis import strategies as st

from sysmlc.synthesis.unrealizable import find_minimal_conflict

CONFLICTS = st.lists(st.frozensets(st.integers(0, 9), min_size=1, max_size=4), min_size=1)


@given(CONFLICTS)
def test_a_minimal_conflict_conflicts_and_none_of_its_subsets_does(conflicts):
    def is_conflict(items):
        return any(conflict <= set(items) for conflict in conflicts)

    smallest = find_minimal_conflict(range(10), is_conflict)
    assert is_conflict(smallest)
    assert not any(is_conflict(fewer) for fewer in combinations(smallest, len(smallest) - 1))
    assert list(smallest) == sorted(smallest)


@given(CONFLICTS, st.integers(0, 5))
def test_a_limited_search_still_returns_a_conflict(conflicts, max_checks):
    def is_conflict(items):
        return any(conflict <= set(items) for conflict in conflicts)

    assert is_conflict(find_minimal_conflict(range(10), is_conflict, max_checks))
