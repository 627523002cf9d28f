"""Losses: what CAEX cannot express, or expresses in another form than the graph."""

import re

import pytest
from aml_files import refine, save

from rule_examples import read_graphs
from sysmlc.backends.aml import rules

RULES = (
    rules.UNSUPPORTED_KIND,
    rules.UNSUPPORTED_EDGE,
    rules.UNSUPPORTED_ATTRIBUTE,
    rules.MOVED,
    rules.APPROXIMATED,
    rules.ILLEGAL_CHARACTERS,
    rules.ADDED,
    rules.EMPTY,
)


@pytest.mark.parametrize("rule", RULES, ids=lambda rule: rule.name)
def test_the_wrong_example_breaks_the_rule_and_the_right_one_does_not(rule):
    assert rule.code in [message[:5] for message in save(refine(read_graphs(rule).wrong))[1]]
    assert save(refine(read_graphs(rule).right))[1] == []


def test_a_loss_is_counted_and_reported_once():
    machines = "".join(f'    StateMachine m{n} "M{n}"\n' for n in range(3))
    gate = 'Package p "Plant"\n  Class gate "Gate" role="block"\n'
    assert save(refine(gate + machines))[1] == [
        "SM740 AutomationML cannot express state machine (3 omitted from the saved plant)"
    ]


def test_an_interface_that_contains_itself_is_written_once():
    texts, _ = save(
        refine(
            'Package p "Plant"\n  Class gate "Gate" role="block"\n    -> feature a\n'
            '    Port a "a"\n      -> typed-by t\n'
            '    Class t "a" subkind="external-interface"\n      -> feature b\n'
            '      Port b "b"\n        -> typed-by t\n'
        )
    )
    (text,) = texts.values()
    assert [text.count(f'<ExternalInterface Name="{name}"') for name in "ab"] == [1, 1]


UNITS = """\
Package p "Plant"
  Class tank "Tank" role="block"
    Property mass "mass" role="value" default=500 default_unit="SI::kg"
    Property level "level" role="value" unit="mm" default=3 default_unit="SI::m"
    Property flow "flow" role="value" unit="l" default=2 default_unit="SI::kg"
    Constraint k "k" body="flow <= 5" language="sysmlc"
      -> references flow
  Package h "Site" subkind="instance-hierarchy"
    Instance t1 "T1"
      -> instance-of tank
      Slot s1 value=20{unit}
        -> instance-of mass
"""


def list_units(unit):
    texts, losses = save(refine(UNITS.format(unit=unit)))
    text = "".join(texts.values())
    names_and_units = re.findall(r'<Attribute Name="(\w+)"(?: Unit="(\w+)")?', text)
    return names_and_units, [loss for loss in losses if " unit'" in loss]


def test_the_unit_of_a_value_is_written_unless_bounds_have_another_one():
    units, losses = list_units(' value_unit="SI::g"')
    assert units[-3:] == [("mass", "kg"), ("level", "m"), ("flow", "l")]
    assert ("mass", "g") in units
    assert losses == [
        "SM742 AutomationML cannot express 'default unit' of property (value) "
        "(1 omitted from the saved plant)"
    ]


def test_a_value_without_a_unit_has_not_the_unit_of_the_default_value():
    units, _ = list_units("")
    assert ("mass", "") in units


def test_the_value_of_an_attribute_is_the_name_of_an_enumeration_literal():
    texts, losses = save(
        refine(
            'Package p "Plant"\n'
            '  Enumeration c "Colour"\n    EnumerationLiteral r "red"\n'
            '  Class tank "Tank" role="block"\n'
            '    Property paint "paint" role="value"\n      -> typed-by c\n'
            '  Package h "Site" subkind="instance-hierarchy"\n'
            '    Instance t1 "T1"\n      -> instance-of tank\n'
            "      Slot s1\n        -> instance-of paint\n        -> references r\n"
        )
    )
    assert "<Value>red</Value>" in "".join(texts.values())
    assert [loss for loss in losses if "references" in loss] == []
