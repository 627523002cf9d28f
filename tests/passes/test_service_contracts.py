"""Contracts of services: preconditions and postconditions of operations and actions."""

import pytest
from pass_runs import derive_contracts, list_codes, list_messages, print_conjuncts

from sysmlc.analyses import analysis
from sysmlc.diagnostics import Sink
from sysmlc.ir.text import parse_text
from sysmlc.logic.contract import IntegerDomain
from sysmlc.logic.services.derivation import iter_services
from sysmlc.synthesis.bdd.manager import Manager
from sysmlc.synthesis.games.game import make_game
from sysmlc.synthesis.games.solver import solve

analysis.load("contracts")
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


def build_tank(*conditions):
    """Return a tank whose operation has these conditions, each a kind, a name and a body."""
    constraints = "".join(
        f'      Constraint k{number} "{name}" subkind="{kind}" body="{body}"\n'
        for number, (kind, name, body) in enumerate(conditions)
    )
    return TANK.format(conditions=constraints.replace(' subkind=""', ""))


def derive(text):
    """Return the contracts by component."""
    return {contract.component: contract for contract in derive_contracts(text)[1]}


def derive_fill_contract(*conditions):
    return derive(build_tank(*conditions))["Plant::Tank.fill"]


def is_realizable(contract):
    return solve(make_game(contract, Manager())).is_realizable


FILL = build_tank(
    ("precondition", "shut", "not open"),
    ("precondition", "", "amount > 0"),
    ("postcondition", "", "level >= amount"),
)


def test_preconditions_are_assumed_of_the_caller_and_postconditions_are_guaranteed():
    graph, (contract,), sink = derive_contracts(FILL)
    assert list_codes(sink) == []
    assert contract.component == "Plant::Tank.fill"
    assert [f"{v.owner.value} {v.name}" for v in contract.variables] == [
        *("env call", "sys busy", "sys done", "env amount", "sys level", "sys open"),
    ]
    assert print_conjuncts(contract.assumptions) == [
        "safety: call' -> !open",
        "init: call -> amount>0",
        "safety: call' -> amount'>0",
        "safety: (call | busy) & !done -> !call'",
        "safety: (call | busy) & !done -> amount'=amount",
    ]
    assert print_conjuncts(contract.guarantees) == [
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


def test_a_service_whose_conditions_can_be_met_is_realizable():
    (contract,) = derive(FILL).values()
    assert is_realizable(contract)


def test_a_service_whose_postcondition_needs_a_missing_precondition_is_unrealizable():
    postcondition = ("postcondition", "", "level > amount and level < 3")
    assert not is_realizable(derive_fill_contract(postcondition))
    assert is_realizable(derive_fill_contract(("precondition", "", "amount < 2"), postcondition))


def test_a_condition_without_a_kind_is_classified_by_its_variables():
    contract = derive_fill_contract(("", "", "amount != 1"), ("", "", "level == amount"))
    assert "safety: call' -> amount'!=1" in print_conjuncts(contract.assumptions)
    assert "safety: done' -> level'=amount'" in print_conjuncts(contract.guarantees)


def test_ranges_alone_give_no_contract():
    assert derive(build_tank()) == {}


def test_a_bound_that_narrows_a_range_is_also_a_condition():
    contract = derive_fill_contract(("", "", "amount > 0"), ("", "", "level == amount"))
    amount = next(variable for variable in contract.variables if variable.name == "amount")
    assert amount.domain == IntegerDomain(1, 4)
    bounds = [conjunct for conjunct in contract.assumptions if conjunct.origin == "k0"]
    assert print_conjuncts(bounds) == ["init: call -> amount>0", "safety: call' -> amount'>0"]
    assert bounds[0].text == "The caller of 'fill' ensures that 'amount > 0' holds."


def test_a_bound_of_an_output_is_guaranteed():
    text = ACTION.format(method="g").replace("f.k ", 'f.b body="0 < level"\n    Constraint f.k ')
    contract = derive(text)["Plant::Filling"]
    assert "safety: done' -> 0<level'" in print_conjuncts(contract.guarantees)


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


def test_an_operation_has_the_conditions_of_its_method():
    contracts = derive(ACTION.format(method="f"))
    assert sorted(contracts) == ["Plant::Tank.Slow", "Plant::Tank.fill"]
    variables = contracts["Plant::Tank.fill"].variables
    level = next(variable for variable in variables if variable.name == "level")
    assert level.domain == IntegerDomain(0, 4)


def test_an_action_that_is_not_the_method_of_an_operation_is_a_service_itself():
    assert sorted(derive(ACTION.format(method="g"))) == ["Plant::Filling", "Plant::Tank.fill"]


@pytest.mark.parametrize("kind", ["time", "invariant"])
def test_constraints_of_other_kinds_are_no_conditions(kind):
    assert derive(build_tank((kind, "", "amount > 1"))) == {}


SPECIALIZED_ACTION = """\
Package p "P"
  Activity a "A"
    Parameter a.x "x" direction="in"
      -> typed-by b
    Constraint a.c "c" subkind="precondition" body="x" language=""
  {kind} s "S"
    -> specializes a
  DataType b "Boolean"
"""


@pytest.mark.parametrize(("kind", "services"), [("Class", 1), ("Activity", 2)])
def test_a_structure_that_specialises_a_behaviour_is_no_service(kind, services):
    """In KerML, a structure may specialise a behaviour with conditions."""
    graph = parse_text(SPECIALIZED_ACTION.format(kind=kind))
    assert len(list(iter_services(graph, (0, 15), Sink()))) == services


# -- conditions without formula ----------------------------------------------------------------


def list_informal(text):
    return list_messages(derive_contracts(text)[2], "SM505")


def test_conditions_in_another_language_are_one_finding_for_each_language():
    conditions = [("", "", text) for text in ("the lid is shut", "the tank is cold", "hot")]
    text = build_tank(*conditions).replace('body="the', 'language="English" body="the')
    assert list_informal(text) == [
        "the constraint 'the lid is shut' of 'fill' is in no contract: it is written in English; "
        "the same holds for 1 more condition",
        "the constraint 'hot' of 'fill' is in no contract: 'hot' is not a parameter or feature "
        "with finitely many values",
    ]


@pytest.mark.parametrize("language", ["", "C++", "Java", "Python", "OCL 2.0", "English"])
@pytest.mark.parametrize(
    ("body", "formula"),
    [
        ("amount > 0 && !open", "amount'>0 & !open"),
        ("not (open and amount <> 0)", "!(open & amount'!=0)"),
    ],
)
def test_a_plain_condition_is_read_in_any_language(language, body, formula):
    text = build_tank(("precondition", "", body))
    text = text.replace(f'body="{body}"', f'body="{body}" language="{language}"')
    assert list_informal(text) == []
    assumptions = print_conjuncts(derive(text)["Plant::Tank.fill"].assumptions)
    assert f"safety: call' -> {formula}" in assumptions


def test_not_before_a_comparison_needs_parentheses():
    assert list_informal(build_tank(("precondition", "", "not amount < 3"))) == [
        "the precondition 'not amount < 3' of 'fill' is in no contract: 'amount' is a number, not "
        "a condition; write 'not (amount < 3)' if 'not' is about the comparison"
    ]


def test_a_condition_that_several_services_inherit_is_one_finding():
    text = SPECIALIZED_ACTION.format(kind="Activity").replace('body="x"', 'body="y"')
    assert list_informal(text) == [
        "the precondition 'y' of 'A' is in no contract: 'y' is not a parameter or feature with "
        "finitely many values; the same holds for 1 more service"
    ]


def test_operations_of_a_stereotype_are_no_services():
    text = 'KIND s "S"\n  Operation o "o"\n    Constraint c subkind="body" body="x"\n'
    assert list_informal(text.replace("KIND", "Stereotype")) == []
    assert list_informal(text.replace("KIND", "Class")) == [
        "the body condition 'x' of 'o' is in no contract: 'x' is not a parameter or feature with "
        "finitely many values"
    ]


@pytest.mark.parametrize(
    ("body", "reason"),
    [
        ("level->size() > 0", "operations on collections ('->') are not supported"),
        ("let low : Integer = 2 in level > low", "unexpected 'low'"),
        ("level >", "the text ends too early"),
        ("grade(level) > 2", "calls such as 'grade(level)' are not evaluated"),
        ("level + 2.5 > level * level", "2.5 is not an Integer"),
    ],
)
def test_the_reason_names_the_token_that_is_not_read(body, reason):
    assert list_informal(build_tank(("", "", body))) == [
        f"the constraint '{body}' of 'fill' is in no contract: {reason}"
    ]
