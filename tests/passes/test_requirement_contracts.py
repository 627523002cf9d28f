"""Contracts of the subjects of requirements: assumptions and demands."""

import pytest

from sysmlc.diagnostics import Sink, catalogue
from sysmlc.ir.text import parse_text
from sysmlc.logic.contract import Contract, IntegerDomain
from sysmlc.logic.printing import print_formula
from sysmlc.passes import pipeline

pipeline.load("contracts")
TANK = """\
Package p "Plant"
  Class c "Tank" role="block"{tank}
    -> feature size
    Property level "level" direction="out" default=0
      -> typed-by int
    Property filling "filling" direction="in"
      -> typed-by bool
    Property size "size" default=9 readonly=true
      -> typed-by int
    Constraint k body="0 <= level <= size"
{inside}  Class q "Safe" role="requirement" req_id="R1"
    -> subject c
    -> assumes a
    Constraint a {assumed}
    Constraint f "never full" {body}
{more}  DataType bool "Boolean"
  DataType int "Integer"
"""
CALM = 'language="LTL" body="G (filling -> X !filling)"'


def model(body, assumed=CALM, inside="", more="", tank=""):
    return TANK.format(body=body, assumed=assumed, inside=inside, more=more, tank=tank)


def derive(text):
    graph, sink = parse_text(text), Sink()
    pipeline.run(graph, sink, verify_each=True)
    return list(graph.derived(Contract)), sink


def lines(conjuncts):
    return [f"{conjunct.class_}: {print_formula(conjunct.formula)}" for conjunct in conjuncts]


def codes(sink):
    return [diagnostic.rule.code for diagnostic in sink]


def test_rule_reports_its_wrong_model_and_not_its_right_one():
    page = catalogue()["SM522"].read_page()
    assert "SM522" in codes(derive(page.wrong)[1])
    assert "SM522" not in codes(derive(page.right)[1])


def test_assumptions_and_demands_of_a_requirement_are_a_contract():
    (contract,), sink = derive(model('language="LTL" body="G (filling -> level' + "'>level)\""))
    assert contract.component == "Plant::Tank"
    assert [(variable.name, variable.owner.value) for variable in contract.variables] == [
        ("filling", "env"),
        ("level", "sys"),
    ]
    assert lines(contract.assumptions) == ["safety: filling -> !filling'"]
    assert lines(contract.guarantees) == ["init: level=0", "safety: filling -> level'>level"]
    assert [conjunct.text for conjunct in contract.guarantees] == [
        "'level' starts with 0.",
        "'never full' of 'Safe' demands it.",
    ]
    assert codes(sink) == []


def test_conditions_without_temporal_operators_hold_at_all_times():
    (contract,), _ = derive(model('body="level < size"', assumed='body="not filling"'))
    assert lines(contract.assumptions) == ["init: !filling", "safety: !filling'"]
    assert lines(contract.guarantees)[-1] == "safety: level<9"


def test_a_constant_of_the_model_bounds_a_range():
    (contract,), _ = derive(model('body="level < size"'))
    assert contract.variables[-1].domain == IntegerDomain(0, 9)


def test_a_constant_is_the_same_in_the_next_step():
    (contract,), _ = derive(model('language="LTL" body="G (filling -> X (level < size))"'))
    assert lines(contract.guarantees)[-1] == "safety: filling -> level'<9"


def test_a_specialisation_of_the_subject_has_the_contract_with_its_own_constants():
    small = (
        '  Class s "Small" role="block"\n    -> specializes c\n    -> feature own\n'
        '    Property own "size" default=4 readonly=true\n'
        "      -> typed-by int\n      -> redefines size\n"
    )
    text = model('body="level < size"', more=small, tank=" abstract=true")
    (contract,), _ = derive(text)
    assert contract.component == "Plant::Small"
    assert contract.variables[-1].domain == IntegerDomain(0, 4)
    assert lines(contract.guarantees)[-1] == "safety: level<4"


def test_requirements_about_one_subject_are_one_contract():
    second = (
        '  Class r "Used" role="requirement"\n    -> subject c\n'
        '    Constraint g language="LTL" body="G F level=9"\n'
    )
    (contract,), _ = derive(model('body="level < 9"', more=second))
    assert lines(contract.guarantees)[1:] == ["safety: level<9", "liveness: level=9"]


def test_a_requirement_that_only_assumes_is_no_contract():
    text = model("").replace('    Constraint f "never full" \n', "")
    assert derive(text)[0] == []


def test_a_constraint_in_another_language_is_reported():
    sink = derive(model('language="Modelica" body="der(level) > 0"'))[1]
    (diagnostic,) = [diagnostic for diagnostic in sink if diagnostic.rule.code == "SM523"]
    assert diagnostic.message == (
        "'never full' of requirement 'Safe' is in no contract: it is written in Modelica"
    )


def test_in_v1_a_formula_over_inputs_alone_is_assumed():
    text = model('language="LTL" body="G F !filling"', assumed='body="level < 9"')
    text = text.replace("    -> subject c\n    -> assumes a\n", "")
    text = text.replace('role="block"', 'role="block"\n    -> satisfies q', 1)
    (contract,), _ = derive(text)
    assert lines(contract.assumptions) == ["liveness: !filling"]
    assert lines(contract.guarantees) == ["init: level=0", "safety: level<9"]


def test_subjects_of_the_same_name_get_different_components():
    twin = '  Class d "Tank" role="block"\n    -> specializes c\n'
    contracts, sink = derive(model('body="level < 9"', more=twin))
    assert [contract.component for contract in contracts] == ["Plant::Tank", "Plant::Tank#2"]
    assert "SM500" in codes(sink)


def test_an_operation_has_the_contract_of_its_method():
    inside = '    Operation o "fill"\n      -> method m\n'
    more = (
        '  Activity m "Fill" external=true\n'
        '    Parameter full "full" direction="out" default=false\n      -> typed-by bool\n'
        '  Class w "Done" role="requirement" req_id="R2"\n    -> subject m\n'
        '    Constraint g language="LTL" body="G F full"\n'
    )
    contracts, _ = derive(model('body="level < 9"', inside=inside, more=more))
    (fill,) = [contract for contract in contracts if contract.component == "Plant::Tank.fill"]
    assert lines(fill.guarantees) == ["init: !full", "liveness: full"]


@pytest.mark.parametrize(
    ("text", "expected"), [("F G (level = 0)", ["SM503"]), ("G (filling -> F (level = 0))", [])]
)
def test_a_demand_outside_gr1_is_reported(text, expected):
    _, sink = derive(model(f'language="LTL" body="{text}"'))
    assert codes(sink) == expected
