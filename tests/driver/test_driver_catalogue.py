"""Every rule can be explained: a reason, a wrong model and a right one."""

import re

import pytest

from sysmlc.driver import full_catalogue

RULES = [rule for rule in full_catalogue().values() if not rule.name.startswith("test-")]


@pytest.mark.parametrize("rule", RULES, ids=lambda rule: f"{rule.code}-{rule.name}")
def test_a_rule_is_explained(rule):
    assert re.fullmatch(r"SM[1-79]\d\d", rule.code)
    assert re.fullmatch(r"[a-z0-9]+(-[a-z0-9]+)*", rule.name)
    assert not rule.phrase.endswith(".")
    assert rule.why.endswith((".", ".)"))
    assert not rule.help[:1].isupper()
    assert not rule.help.endswith(".")
    is_ours = rule.code in {"SM900", "SM901"}
    assert is_ours or (rule.wrong and rule.right)
    assert rule.wrong != rule.right or is_ours
