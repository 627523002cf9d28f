"""Losses: what CAEX cannot express, or expresses in another form than the graph."""

import pytest
from aml_files import refine, save

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
    assert rule.code in [message[:5] for message in save(refine(rule.read_page().wrong))[1]]
    assert save(refine(rule.read_page().right))[1] == []


def test_a_loss_is_counted_and_reported_once():
    machines = "".join(f'    StateMachine m{n} "M{n}"\n' for n in range(3))
    gate = 'Package p "Plant"\n  Class gate "Gate" role="block"\n'
    assert save(refine(gate + machines))[1] == [
        "SM740 AutomationML cannot express StateMachine (3 omitted from the saved plant)"
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
