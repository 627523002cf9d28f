"""The order of bits follows the structure of the contract: equal ranges are interleaved."""

import random
from itertools import pairwise

import pytest
from contracts_in_lines import describe_elevator, parse_contract
from msgspec.structs import replace

from sysmlc.diagnostics import Sink, Subject
from sysmlc.synthesis import Limits, Manager, Symbols, make_game, solve
from sysmlc.synthesis.bdd.variable_order import VariableOrder, order_by_force
from sysmlc.synthesis.decision import Options, decide


def list_bits(text: str) -> list[str]:
    bits = Symbols(Manager(), parse_contract(text).variables).manager.bits
    return [bit for bit in bits if not bit.endswith("'")]


def test_many_numbers_of_one_range_are_interleaved():
    alike = "\n".join(f"sys n{number}: 0..3" for number in range(5))
    assert list_bits(f"{alike}\nenv go: bool") == [
        *(f"n{number}.0" for number in range(5)),
        *(f"n{number}.1" for number in range(5)),
        "go.0",
    ]


def test_few_numbers_and_other_variables_stay_as_declared():
    text = "env a: 0..3\nenv go: bool\nsys b: 0..3\nsys c: 0..4"
    assert list_bits(text) == ["a.0", "a.1", "b.0", "b.1", "go.0", "c.0", "c.1", "c.2"]


def test_related_names_are_adjacent_among_many():
    names = [f"{kind}{number}" for kind in ("run", "done") for number in range(30)]
    pairs = [(f"run{number}", f"done{number}") for number in range(30)]
    ordered = order_by_force(names, pairs)
    assert all(abs(ordered.index(first) - ordered.index(second)) == 1 for first, second in pairs)


def test_unrelated_names_stay_in_place():
    assert order_by_force(["a", "b", "c"], []) == ("a", "b", "c")


def test_the_order_of_many_variables_follows_the_conjuncts():
    text = "\n".join(f"env {kind}{number}: bool" for kind in "ab" for number in range(25))
    rules = "\n".join(f"assume always a{number} -> b{number}'" for number in range(25))
    bits = make_game(parse_contract(f"{text}\n{rules}"), Manager()).manager.bits
    places = {bit: place for place, bit in enumerate(bits)}
    assert all(abs(places[f"a{n}.0"] - places[f"b{n}.0"]) == 2 for n in range(25))


def test_wide_numbers_are_interleaved_whatever_their_ranges():
    assert list_bits("env y: 0..127\nsys on: bool\nsys x: 0..200")[-3:] == ["y.6", "x.7", "on.0"]


def test_wide_numbers_are_decided_as_fast_as_narrow_ones():
    manager = Manager()
    wide = "env y: 0..1000000000\nsys x: 0..1000000001\npromise always x'=y'+1"
    assert solve(make_game(parse_contract(wide), manager)).is_realizable
    assert manager.usage().peak < 5_000


# -- variables that most conjuncts share -----------------------------------------------------------


def list_variables(text: str, order: VariableOrder) -> list[str]:
    """Return the variables in the order of their first bits."""
    bits = make_game(parse_contract(text), Manager(), order).manager.bits
    return list(dict.fromkeys(bit.partition(".")[0] for bit in bits))


def test_the_floor_comes_before_the_calls_that_it_selects():
    elevator = describe_elevator(8)
    declared = list_variables(elevator, VariableOrder.DECLARED)
    assert declared[-2:] == ["floor", "open"]
    assert list_variables(elevator, VariableOrder.CONJUNCTS)[:2] == ["floor", "open"]


def test_without_shared_variables_neighbours_are_close_together():
    declared = [0, 4, 2, 6, 1, 5, 3, 7]
    text = "\n".join(f"sys m{n}: bool" for n in declared)
    rules = "\n".join(f"promise always m{n} -> m{n + 1}'" for n in range(7))
    order = list_variables(f"{text}\n{rules}", VariableOrder.CONJUNCTS)
    numbers = [int(name[1:]) for name in order]
    assert sum(abs(a - b) for a, b in pairwise(numbers)) < 20


@pytest.mark.parametrize("order", ["declared", "reversed", "shuffled"])
def test_an_elevator_is_decided_whatever_the_order_of_declarations(order: str):
    contract = parse_contract(describe_elevator(20))
    variables = list(contract.variables)
    if order == "reversed":
        variables.reverse()
    elif order == "shuffled":
        random.Random(21).shuffle(variables)
    options = Options(limits=Limits(seconds=10.0))
    contract = replace(contract, variables=tuple(variables))
    verdict = decide(contract, lambda origin: Subject(), Sink(), options)
    assert verdict.is_realizable
    assert verdict.figures is not None
    assert verdict.figures.nodes < 10_000
