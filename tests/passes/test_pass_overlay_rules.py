"""Each rule about overlays: an overlay that has the fault, and one that nearly has it."""

import pytest
from overlay_samples import apply_overlays
from pass_runs import list_codes

from sysmlc.driver import load_full_catalogue

CODES = {*range(320, 341), 637}
RULES = [rule for rule in load_full_catalogue().values() if int(rule.code[2:]) in CODES]


@pytest.mark.parametrize("rule", RULES, ids=lambda rule: rule.name)
def test_rule_reports_its_wrong_overlay_and_not_its_right_one(rule):
    assert rule.code in list_codes(apply_overlays(rule.read_page().wrong)[1])
    assert rule.code not in list_codes(apply_overlays(rule.read_page().right)[1])


@pytest.mark.parametrize("rule", RULES, ids=lambda rule: rule.name)
def test_right_overlay_is_right_in_every_way(rule):
    found = [one for one in apply_overlays(rule.read_page().right)[1] if one.severity != "info"]
    assert found == []


@pytest.mark.parametrize("rule", RULES, ids=lambda rule: rule.name)
def test_finding_has_file_line_and_column(rule):
    found = next(
        diagnostic
        for diagnostic in apply_overlays(rule.read_page().wrong)[1]
        if diagnostic.rule is rule
    )
    place = found.subject.place
    is_of_model = rule.name.startswith("call-")
    assert place.file == ("gate.uml" if is_of_model else "0.overlay.yaml")
    assert is_of_model or (place.line > 0 and place.column > 0)


def test_there_are_as_many_rules_as_codes():
    assert len(RULES) == len(CODES)
