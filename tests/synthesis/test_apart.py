"""Games that consist of several: their strategies side by side, and the check group by group."""

from contracts_in_lines import contract
from made_machines import said
from msgspec.structs import replace

from sysmlc.logic.printing import print_formula
from sysmlc.support.disjoint_sets import group_related
from sysmlc.synthesis import Manager, make_game
from sysmlc.synthesis.controller_synthesis import combine_independent_strategies, split_game
from sysmlc.synthesis.controllers.forms import build_table

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


def made(text):
    """The table of the games of a contract."""
    plan = combine_independent_strategies(make_game(contract(text), Manager()))
    return plan and build_table(plan)


def broken(table, text):
    """The guarantees that a table does not keep."""
    return [
        print_formula(fault.conjunct.formula) if fault.conjunct else "no answer"
        for fault in said(table, contract(text))
    ]


def test_names_are_tied_by_what_speaks_of_two():
    groups = group_related("abcde", [("a", "c"), ("c", "e"), ("d",), ("b", "other")])
    assert groups == [frozenset("ace"), frozenset("b"), frozenset("d")]


def test_a_game_is_several_where_nothing_is_said_of_both():
    games = split_game(make_game(contract(BOTH), Manager()))
    assert [sorted(one.symbols.variables) for one in games] == [["ask", "lamp"], ["door", "knock"]]
    assert [len(one.goals) for one in games] == [2, 1]
    assert len(split_game(make_game(contract(f"{BOTH}promise always ask -> door"), Manager()))) == 1


def test_strategies_side_by_side_keep_the_contract_of_all():
    assert broken(made(BOTH), BOTH) == []
    assert len(made(BOTH).modes) == 2


def test_one_game_or_a_lost_one_has_no_strategies_side_by_side():
    assert made(LAMP) is None
    assert made(f"{BOTH}env never: bool\npromise recurs never") is None


def test_each_group_is_checked():
    table = made(BOTH)
    door = len(table.modes[0].outputs) - 1
    for at, entry in enumerate(table.modes):
        outputs = tuple(0 if bit == door else place for bit, place in enumerate(entry.outputs))
        modes = list(table.modes)
        modes[at] = replace(entry, outputs=outputs)
        found = broken(replace(table, modes=tuple(modes)), BOTH)
        assert any("door" in formula for formula in found)


def test_what_is_said_of_no_variable_is_checked_too():
    assert broken(made(BOTH), f"{BOTH}promise always false") == ["false"]
