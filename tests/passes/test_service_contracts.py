"""Contracts of services: pre- and postconditions of operations and actions."""

import pytest

from sysmlc.diagnostics import Sink
from sysmlc.ir.text import parse_text
from sysmlc.logic.contract import Contract, IntegerDomain
from sysmlc.logic.printing import print_formula
from sysmlc.passes import pipeline
from sysmlc.synthesis.bdd.manager import Manager
from sysmlc.synthesis.games.game import make_game
from sysmlc.synthesis.games.solver import solve

pipeline.load("contracts")
TANK = """\
Package p "Plant"
  Class c "Tank" role="block"
    Property level "level"
      -> typed-by int
    Property open "open"
      -> typed-by bool
    Constraint r body="0 <= level <= 9"
    Operation o "fill"
      Parameter a "amount" direction="in"
        -> typed-by int
      Constraint ra body="0 <= amount <= 4"
{conditions}  DataType int "Integer"
  DataType bool "Boolean"
"""


def model(*conditions):
    lines = [
        f'      Constraint k{at} "{name}" subkind="{kind}" body="{body}"\n'
        for at, (kind, name, body) in enumerate(conditions)
    ]
    return TANK.format(conditions="".join(lines).replace(' subkind=""', ""))


def derived(text):
    graph, sink = parse_text(text), Sink()
    pipeline.run(graph, sink, verify_each=True)
    return list(graph.derived(Contract)), sink, graph


def lines(conjuncts):
    return [f"{one.class_}: {print_formula(one.formula)}" for one in conjuncts]


FILL = model(
    ("precondition", "shut", "not open"),
    ("precondition", "", "amount > 0"),
    ("postcondition", "", "level >= amount"),
)


def test_who_asks_keeps_the_preconditions_and_what_is_done_the_postconditions():
    (contract,), sink, graph = derived(FILL)
    assert [diagnostic.rule.code for diagnostic in sink] == []
    assert contract.component == "Plant::Tank.fill"
    assert [f"{one.owner.value} {one.name}" for one in contract.variables] == [
        *("env call", "sys busy", "sys done", "env amount", "sys level", "sys open"),
    ]
    assert lines(contract.assumptions) == [
        "safety: call' -> !open",
        "init: call -> amount>0",
        "safety: call' -> amount'>0",
        "safety: (call | busy) & !done -> !call'",
        "safety: (call | busy) & !done -> amount'=amount",
    ]
    assert lines(contract.guarantees) == [
        "init: !busy & !done",
        "safety: busy' <-> (call | busy) & !done & !done'",
        "safety: done' -> (call | busy) & !done",
        "safety: done' -> level'>=amount'",
        "safety: !done' -> level'=level",
        "safety: !done' -> (open' <-> open)",
        "liveness: done | !(call | busy)",
    ]
    for conjunct in (*contract.assumptions, *contract.guarantees):
        assert conjunct.origin in graph
        assert conjunct.text.endswith(".")


def test_a_service_with_conditions_that_can_be_met_can_be_synthesised():
    (contract,), _, _ = derived(FILL)
    assert solve(make_game(contract, Manager())).is_realizable


def test_a_postcondition_that_a_precondition_does_not_allow_for_cannot_be_kept():
    (contract,), _, _ = derived(model(("postcondition", "", "level > amount and level < 3")))
    assert not solve(make_game(contract, Manager())).is_realizable
    allowed = ("precondition", "", "amount < 2")
    (contract,), _, _ = derived(
        model(allowed, ("postcondition", "", "level > amount and level < 3"))
    )
    assert solve(make_game(contract, Manager())).is_realizable


def test_of_a_condition_of_neither_kind_what_it_speaks_of_counts():
    (contract,), _, _ = derived(model(("", "", "amount != 1"), ("", "", "level == amount")))
    assert "safety: call' -> amount'!=1" in lines(contract.assumptions)
    assert "safety: done' -> level'=amount'" in lines(contract.guarantees)


def test_ranges_alone_are_no_conditions():
    assert derived(model())[0] == []


def test_a_bound_that_the_values_have_already_is_a_condition_all_the_same():
    (contract,), _, _ = derived(model(("", "", "amount > 0"), ("", "", "level == amount")))
    amount = next(one for one in contract.variables if one.name == "amount")
    assert amount.domain == IntegerDomain(1, 4)
    bounds = [one for one in contract.assumptions if one.origin == "k0"]
    assert lines(bounds) == ["init: call -> amount>0", "safety: call' -> amount'>0"]
    assert bounds[0].text == "The caller of 'fill' ensures that 'amount > 0' holds."


def test_of_an_output_a_bound_is_what_is_promised():
    text = ACTION.format(method="g").replace("f.k ", 'f.b body="0 < level"\n    Constraint f.k ')
    (contract,) = [one for one in derived(text)[0] if one.component == "Plant::Filling"]
    assert "safety: done' -> 0<level'" in lines(contract.guarantees)


ACTION = """\
Package p "Plant"
  Activity f "Filling"
    Parameter f.a "amount" direction="in"
      -> typed-by int
    Parameter f.l "level" direction="out"
      -> typed-by int
    Constraint f.r body="0 <= amount <= 4"
    Constraint f.s body="0 <= level <= 4"
    Constraint f.k body="level == amount"
  Class c "Tank" role="block"
    Operation o "fill"
      -> method {method}
      Parameter o.a "amount" direction="in"
        -> typed-by int
      Parameter o.l "level" direction="out"
        -> typed-by int
    Activity g "Slow"
      -> specializes f
  DataType int "Integer"
"""


def test_an_operation_keeps_the_conditions_of_its_method():
    found = {one.component: one for one in derived(ACTION.format(method="f"))[0]}
    assert sorted(found) == ["Plant::Tank.Slow", "Plant::Tank.fill"]
    level = next(one for one in found["Plant::Tank.fill"].variables if one.name == "level")
    assert level.domain == IntegerDomain(0, 4)


def test_an_action_that_no_operation_performs_is_a_service_itself():
    found = {one.component: one for one in derived(ACTION.format(method="g"))[0]}
    assert sorted(found) == ["Plant::Filling", "Plant::Tank.fill"]


@pytest.mark.parametrize("kind", ["time", "invariant"])
def test_other_constraints_are_no_conditions(kind):
    assert derived(model((kind, "", "amount > 1")))[0] == []
