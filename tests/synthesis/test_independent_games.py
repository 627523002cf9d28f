"""Games of independent parts: their combined strategies, and verification by groups."""

from contracts_in_lines import parse_contract
from controller_plays import list_faults
from msgspec.structs import replace

from sysmlc.logic.printing import print_formula
from sysmlc.support.disjoint_sets import group_related
from sysmlc.synthesis import Manager, make_game
from sysmlc.synthesis.controller_synthesis import combine_independent_strategies, split_game
from sysmlc.synthesis.strategies.tables import build_table

LAMP = """
env ask: bool
sys lamp: 0..3
assume recurs ask
promise at first lamp = 0
promise always ask' -> lamp' = lamp + 1 | lamp' = 0
promise recurs lamp = 3
promise recurs lamp = 0
"""
DOOR = """
env knock: bool
sys door: bool
promise always knock' -> door'
promise recurs !door | knock
"""
BOTH = LAMP + DOOR


def build_combined_table(text):
    """Build the table that combines the strategies of independent games, or return None."""
    plan = combine_independent_strategies(make_game(parse_contract(text), Manager()))
    return plan and build_table(plan)


def list_broken_guarantees(table, text):
    """List the guarantees that *table* violates."""
    return [
        print_formula(fault.conjunct.formula) if fault.conjunct else "no answer"
        for fault in list_faults(table, parse_contract(text))
    ]


def test_relations_group_the_names_that_they_share():
    groups = group_related("abcde", [("a", "c"), ("c", "e"), ("d",), ("b", "other")])
    assert groups == [frozenset("ace"), frozenset("b"), frozenset("d")]


def test_a_game_is_split_where_no_conjunct_relates_two_parts():
    games = split_game(make_game(parse_contract(BOTH), Manager()))
    assert [sorted(game.symbols.variables) for game in games] == [
        ["ask", "lamp"],
        ["door", "knock"],
    ]
    assert [len(game.goals) for game in games] == [2, 1]
    assert (
        len(split_game(make_game(parse_contract(f"{BOTH}promise always ask -> door"), Manager())))
        == 1
    )


def test_combined_strategies_satisfy_the_whole_contract():
    assert list_broken_guarantees(build_combined_table(BOTH), BOTH) == []
    assert len(build_combined_table(BOTH).modes) == 2


def test_a_single_or_lost_game_has_no_combined_strategy():
    assert build_combined_table(LAMP) is None
    assert build_combined_table(f"{BOTH}env never: bool\npromise recurs never") is None


def test_each_group_is_checked():
    table = build_combined_table(BOTH)
    door = len(table.modes[0].outputs) - 1
    for index, entry in enumerate(table.modes):
        outputs = tuple(0 if bit == door else place for bit, place in enumerate(entry.outputs))
        modes = list(table.modes)
        modes[index] = replace(entry, outputs=outputs)
        violations = list_broken_guarantees(replace(table, modes=tuple(modes)), BOTH)
        assert any("door" in formula for formula in violations)


def test_a_guarantee_without_variables_is_checked():
    assert list_broken_guarantees(build_combined_table(BOTH), f"{BOTH}promise always false") == [
        "false"
    ]
