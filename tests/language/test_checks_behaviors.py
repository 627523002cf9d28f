"""Constraints on arguments and parameters of performed actions and called functions."""

import pytest
from small_models import check_text

from sysmlc.language.checks import behaviors


def list_violations(text):
    return [f"{diagnostic.rule.code} {diagnostic.message}" for diagnostic in check_text(text)]


@pytest.mark.parametrize(
    ("rule", "code"), [(behaviors.TOO_MANY, "SM248"), (behaviors.NO_PARAMETER, "SM249")]
)
def test_the_wrong_example_breaks_the_rule_and_the_right_one_does_not(rule, code):
    assert [violation[:5] for violation in list_violations(rule.read_page().wrong)] == [code]
    assert list_violations(rule.read_page().right) == []


FEED = """
action def Feed { in item piece; in speed; out ready; }
action def Slow :> Feed;
action def Empty;
part belt { action feed : %s }
"""


@pytest.mark.parametrize(
    "usage",
    [
        "Feed;",
        "Feed { in speed = 3; out ready; }",
        "Feed { in item a; in b; out c; }",
        "Slow { in item piece; in speed = 3; out ready; }",
        "Feed { in :>> speed = 3; }",
        "Empty { in speed = 3; }",
        "Feed, Empty { in extra; in more; in most; }",
    ],
)
def test_a_usage_may_repeat_any_parameters_of_its_definition(usage):
    assert list_violations(FEED % usage) == []


@pytest.mark.parametrize(
    ("usage", "name"),
    [
        ("Feed { in item piece; in speed; out ready; in place; }", "place"),
        ("Slow { in item piece; in speed; in place = 1; }", "place"),
        ("Feed { out piece; }", "piece"),
        ("Feed { in item piece; out late; }", "late"),
    ],
)
def test_a_parameter_that_the_definition_lacks_is_reported(usage, name):
    definition = usage.split()[0]
    assert list_violations(FEED % usage) == [
        f"SM249 '{name}' of 'feed' is not a parameter of '{definition}'"
    ]


def test_an_inout_parameter_may_be_redeclared_as_in_or_out():
    text = "action def W { inout a; inout b; }\naction w : W { in a = 1; out b; }\n"
    assert list_violations(text) == []


def test_parameters_of_a_performed_action_are_checked_too():
    text = "action def W { in a; }\npart b { perform action w : W { in a = 1; in z = 2; } }\n"
    assert list_violations(text) == ["SM249 'z' of 'w' is not a parameter of 'W'"]


def test_inherited_parameters_and_the_subject_count_as_parameters():
    text = """
        calc def Sum { in a; in b; return c; }
        calc def Mean :> Sum { in e; }
        requirement def Light { subject thing; in limit; }
        part gate {
            attribute x = Mean(1, 2);
            attribute y = Mean(1, 2, 3);
            attribute z = Light(gate, 4);
            attribute u = Light(gate, 4, 5);
        }
    """
    assert list_violations(text) == [
        "SM248 'Mean' takes 2 values, not 3 values",
        "SM248 'Light' takes 2 values, not 3 values",
    ]
