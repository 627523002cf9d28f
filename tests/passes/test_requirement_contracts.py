"""Contracts of the subjects of requirements: their assumptions and guarantees."""

import pytest
from pass_runs import derive_contracts, list_codes, list_messages, print_conjuncts

from rule_examples import read_graphs
from sysmlc.analyses import analysis
from sysmlc.diagnostics import catalogue
from sysmlc.logic.contract import IntegerDomain

analysis.load("contracts")
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
{members}  Class q "Safe" role="requirement" req_id="R1"
    -> subject c
    -> assumes a
    Constraint a {assumption}
    Constraint f "never full" {body}
{elements}  DataType bool "Boolean"
  DataType int "Integer"
"""
CALM = 'language="LTL" body="G (filling -> X !filling)"'


def build_tank(body, assumption=CALM, members="", elements="", tank=""):
    """Return a tank with a requirement: *body* is its guarantee and *assumption* its assumption.

    *members* are added to the tank, *elements* to the package.
    """
    return TANK.format(
        body=body, assumption=assumption, members=members, elements=elements, tank=tank
    )


def derive(text):
    _, contracts, sink = derive_contracts(text)
    return contracts, sink


def test_rule_reports_its_wrong_example_and_not_its_right_one():
    page = read_graphs(catalogue()["SM522"])
    assert "SM522" in list_codes(derive(page.wrong)[1])
    assert "SM522" not in list_codes(derive(page.right)[1])


def test_assumptions_and_guarantees_of_a_requirement_are_a_contract():
    (contract,), sink = derive(
        build_tank('language="LTL" body="G (filling -> level' + "'>level)\"")
    )
    assert contract.component == "Plant::Tank"
    assert [(variable.name, variable.owner.value) for variable in contract.variables] == [
        ("filling", "env"),
        ("level", "sys"),
    ]
    assert print_conjuncts(contract.assumptions) == ["safety: filling -> !filling'"]
    assert print_conjuncts(contract.guarantees) == [
        "init: level=0",
        "safety: filling -> level'>level",
    ]
    assert [conjunct.text for conjunct in contract.guarantees] == [
        "'level' starts with 0.",
        "'never full' of 'Safe' demands it.",
    ]
    assert list_codes(sink) == []


def test_conditions_without_temporal_operators_hold_at_all_times():
    (contract,), _ = derive(build_tank('body="level < size"', assumption='body="not filling"'))
    assert print_conjuncts(contract.assumptions) == ["init: !filling", "safety: !filling'"]
    assert print_conjuncts(contract.guarantees)[-1] == "safety: level<9"


def test_a_constant_of_the_model_bounds_a_range():
    (contract,), _ = derive(build_tank('body="level < size"'))
    assert contract.variables[-1].domain == IntegerDomain(0, 9)


def test_a_constant_has_the_same_value_in_the_next_step():
    (contract,), _ = derive(build_tank('language="LTL" body="G (filling -> X (level < size))"'))
    assert print_conjuncts(contract.guarantees)[-1] == "safety: filling -> level'<9"


def test_a_specialisation_of_the_subject_has_the_contract_with_redefined_constants():
    small = (
        '  Class s "Small" role="block"\n    -> specializes c\n    -> feature own\n'
        '    Property own "size" default=4 readonly=true\n'
        "      -> typed-by int\n      -> redefines size\n"
    )
    text = build_tank('body="level < size"', elements=small, tank=" abstract=true")
    (contract,), _ = derive(text)
    assert contract.component == "Plant::Small"
    assert contract.variables[-1].domain == IntegerDomain(0, 4)
    assert print_conjuncts(contract.guarantees)[-1] == "safety: level<4"


def test_requirements_about_one_subject_are_one_contract():
    second = (
        '  Class r "Used" role="requirement"\n    -> subject c\n'
        '    Constraint g language="LTL" body="G F level=9"\n'
    )
    (contract,), _ = derive(build_tank('body="level < 9"', elements=second))
    assert print_conjuncts(contract.guarantees)[1:] == ["safety: level<9", "liveness: level=9"]


def test_a_requirement_with_assumptions_only_gives_no_contract():
    text = build_tank("").replace('    Constraint f "never full" \n', "")
    assert derive(text)[0] == []


def test_a_constraint_in_another_language_is_reported():
    sink = derive(build_tank('language="Modelica" body="der(level) > 0"'))[1]
    assert list_messages(sink, "SM523") == [
        "constraint 'never full' of requirement 'Safe' is in no contract: it is written in Modelica"
    ]


@pytest.mark.parametrize("language", ["C", "Java", "Python", "Modelica", "English"])
def test_a_plain_condition_is_read_in_any_language(language):
    body = f'language="{language}" body="!(level == size && filling)"'
    (contract,), sink = derive(build_tank(body))
    assert list_messages(sink, "SM523") == []
    assert "!(level=9 & filling)" in print_conjuncts(contract.guarantees)[-1]


def test_not_before_a_comparison_needs_parentheses():
    (message,) = list_messages(derive(build_tank('body="!level == 3"'))[1], "SM523")
    assert message.endswith("; write 'not (level == 3)' if 'not' is about the comparison")


def test_a_condition_about_a_feature_with_several_values_is_reported():
    model = build_tank('body="level < 9"').replace(
        'Property level "level"', 'Property level "level" multiplicity="3"'
    )
    contracts, sink = derive(model)
    assert contracts == []
    assert list_messages(sink, "SM523") == [
        "constraint 'never full' of requirement 'Safe' is in no contract: "
        "'level' has several values"
    ]


def test_a_requirement_about_several_subjects_is_reported_once():
    special = '  Class d "Silo" role="block"\n    -> specializes c\n'
    sink = derive(build_tank('body="lid"', elements=special))[1]
    assert list_messages(sink, "SM523") == [
        "constraint 'never full' of requirement 'Safe' is in no contract: 'lid' is not a feature "
        "of 'Tank' itself, or has no finite type; the same holds for 1 more subject"
    ]


def test_in_sysml_v1_a_formula_over_inputs_only_is_an_assumption():
    text = build_tank('language="LTL" body="G F !filling"', assumption='body="level < 9"')
    text = text.replace("    -> subject c\n    -> assumes a\n", "")
    text = text.replace('role="block"', 'role="block"\n    -> satisfies q', 1)
    (contract,), _ = derive(text)
    assert print_conjuncts(contract.assumptions) == ["liveness: !filling"]
    assert print_conjuncts(contract.guarantees) == ["init: level=0", "safety: level<9"]


def test_subjects_of_the_same_name_get_different_components():
    twin = '  Class d "Tank" role="block"\n    -> specializes c\n'
    contracts, sink = derive(build_tank('body="level < 9"', elements=twin))
    assert [contract.component for contract in contracts] == ["Plant::Tank", "Plant::Tank#2"]
    assert "SM500" in list_codes(sink)


def test_an_operation_has_the_contract_of_its_method():
    operation = '    Operation o "fill"\n      -> method m\n'
    elements = (
        '  Activity m "Fill" external=true\n'
        '    Parameter full "full" direction="out" default=false\n      -> typed-by bool\n'
        '  Class w "Done" role="requirement" req_id="R2"\n    -> subject m\n'
        '    Constraint g language="LTL" body="G F full"\n'
    )
    contracts, _ = derive(build_tank('body="level < 9"', members=operation, elements=elements))
    (fill,) = [contract for contract in contracts if contract.component == "Plant::Tank.fill"]
    assert print_conjuncts(fill.guarantees) == ["init: !full", "liveness: full"]


@pytest.mark.parametrize(
    ("text", "expected"), [("F G (level = 0)", ["SM503"]), ("G (filling -> F (level = 0))", [])]
)
def test_a_guarantee_outside_gr1_is_reported(text, expected):
    _, sink = derive(build_tank(f'language="LTL" body="{text}"'))
    assert list_codes(sink) == expected


def list_codes_of_chain(name):
    """Return the codes for a requirement with the subject 'reserve' that names a feature so."""
    text = build_tank(f'language="LTL" body="G ({name}<=3)"')
    return list_codes(derive(text.replace('"R1"', '"R1" subject_name="reserve"'))[1])


@pytest.mark.parametrize("name", ["level", "reserve.level", "Tank.level", "self.level"])
def test_the_name_of_the_subject_may_precede_a_name(name):
    assert "SM522" not in list_codes_of_chain(name)


@pytest.mark.parametrize("name", ["reserv.level", "Safe.level", "reserve.x.level"])
def test_another_name_before_a_name_is_an_error(name):
    assert "SM522" in list_codes_of_chain(name)
