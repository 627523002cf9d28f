"""What is called or performed is given no more than it takes."""

import pytest
from resolving import documents, library

from sysmlc.diagnostics import Sink
from sysmlc.language.checks import behaviors, check
from sysmlc.language.names import resolve


def found(text):
    sink = Sink({"SM207": None})
    check(resolve(documents(text), library(), sink), sink)
    return [f"{one.rule.code} {one.message}" for one in sink]


@pytest.mark.parametrize(
    ("rule", "code"), [(behaviors.TOO_MANY, "SM248"), (behaviors.NO_PARAMETER, "SM249")]
)
def test_the_wrong_model_has_the_finding_and_the_right_one_nearly(rule, code):
    assert [one[:5] for one in found(rule.read_page().wrong)] == [code]
    assert found(rule.read_page().right) == []


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
def test_a_step_repeats_what_it_likes_of_its_definition(usage):
    assert found(FEED % usage) == []


@pytest.mark.parametrize(
    ("usage", "name"),
    [
        ("Feed { in item piece; in speed; out ready; in place; }", "place"),
        ("Slow { in item piece; in speed; in place = 1; }", "place"),
        ("Feed { out piece; }", "piece"),
        ("Feed { in item piece; out late; }", "late"),
    ],
)
def test_a_parameter_that_the_definition_has_not_is_told(usage, name):
    called = usage.split()[0]
    assert found(FEED % usage) == [f"SM249 '{name}' of 'feed' is not a parameter of '{called}'"]


def test_an_inout_may_be_given_in_or_out():
    text = "action def W { inout a; inout b; }\naction w : W { in a = 1; out b; }\n"
    assert found(text) == []


def test_a_performed_action_is_judged_as_any_other():
    text = "action def W { in a; }\npart b { perform action w : W { in a = 1; in z = 2; } }\n"
    assert found(text) == ["SM249 'z' of 'w' is not a parameter of 'W'"]


def test_arguments_are_counted_with_what_is_inherited_and_with_the_subject():
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
    assert found(text) == [
        "SM248 'Mean' takes 2 values, but 3 values are given",
        "SM248 'Light' takes 2 values, but 3 values are given",
    ]
