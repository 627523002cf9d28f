"""Small valid models about which sysmlc once reported something untrue, and what it must report."""

import pytest
from reading_v2 import read

from sysmlc import compile_model


@pytest.fixture
def list_findings(tmp_path):
    """Return a function that compiles a text and lists its errors and warnings with messages."""

    def list_of(text):
        path = tmp_path / "model.sysml"
        path.write_text(text, encoding="utf-8")
        return [
            f"{diagnostic.rule.code} {diagnostic.message}"
            for diagnostic in compile_model(path, emit=["contracts"]).diagnostics
            if diagnostic.severity.name != "INFO"
        ]

    return list_of


# -- messages ------------------------------------------------------------------------------------

REQUEST = """
occurrence def Exchange {
    ref part client { event occurrence asks; then event occurrence gets; }
    ref part server { event occurrence hears; then event occurrence answers; }
    message request from client.asks to server.hears;
    message answer from %s to %s;
}
"""


def test_events_are_ordered_by_messages_and_not_by_the_place_of_their_lifeline(list_findings):
    """The events of the client stand before those of the server in the text, not in time."""
    text = REQUEST % ("server.answers", "client.gets")
    assert list_findings(text) == []
    occurrences = [line for line in read(text).list_owned("Exchange") if "Occurrence" in line]
    assert occurrences == [
        "Occurrence asks",
        "Occurrence hears",
        "Occurrence answers",
        "Occurrence gets",
    ]


def test_messages_that_contradict_each_other_are_reported(list_findings):
    text = """
    occurrence def Exchange {
        ref part client { event occurrence a; }
        ref part server { event occurrence b; }
        message request from client.a to server.b;
        message answer from server.b to client.a;
    }
    """
    assert list_findings(text) == [
        "SM444 message 'answer' of 'Exchange' is received before it is sent"
    ]


# -- sending and accepting -----------------------------------------------------------------------


@pytest.mark.parametrize(
    "payload", ["send held via p;", "send 3 via p;", "send via p { in :>> payload = held; }"]
)
def test_a_send_action_may_send_any_value(list_findings, payload):
    text = f"""
    item def Order;
    part def Device {{ port p; item held : Order; action run {{ {payload} }} }}
    """
    assert list_findings(text) == []


@pytest.mark.parametrize(
    "steps",
    [
        "accept Order; then action act;",
        "first start; then action group { accept Order; then action act; } then done;",
        "first start; then for i in 1..4 { accept Order; then action act; } then done;",
    ],
)
def test_an_accept_action_occurs_once(list_findings, steps):
    """An accept action of UML without incoming flow listens again, so that events would pile up."""
    assert list_findings(f"item def Order; action def Serve {{ {steps} }}") == []


# -- loops ---------------------------------------------------------------------------------------


def test_a_loop_that_starts_a_branch_starts_after_the_condition(list_findings):
    text = """
    action def Work {
        in ready : ScalarValues::Boolean;
        first start;
        then action choice if ready { loop { action step; } until ready; }
        then done;
    }
    """
    assert list_findings(text) == []
    assert len([flow for flow in read(text).list_flows("Work") if flow.startswith("start")]) == 1


def test_the_end_of_an_endless_loop_is_reported_if_something_waits_for_it(list_findings):
    body = "first start; then loop { action step; }"
    assert list_findings(f"action def Work {{ {body} }}") == []
    (finding,) = list_findings(f"action def Work {{ {body} then action later; then done; }}")
    assert finding.startswith("SM452 no token ever reaches")


# -- names and expressions -----------------------------------------------------------------------

MACHINE = """
private import ScalarValues::*;
part def Machine {{
    attribute 'is ready' : Boolean;
    attribute count : Integer := 0;
    attribute 'last number' : Integer := 0;
    attribute note : String := "a\\n\\"b\\"";
    exhibit state life {{
        entry; then off;
        state off;
        state on;
        transition first off {rest} then on;
    }}
}}
"""


@pytest.mark.parametrize(
    "rest",
    [
        "accept when 'is ready'",
        "if 'is ready'",
        "if not 'is ready'",
        "if 'last number' > 40",
        'if note == "a\\n\\"b\\""',
        'do assign note := "c\\n\\td"',
    ],
)
def test_quoted_names_and_escapes_are_understood(list_findings, rest):
    assert list_findings(MACHINE.format(rest=rest)) == []


def test_an_unsupported_condition_is_quoted_with_its_parentheses(list_findings):
    rest = "if ((1, 2)#(1) + count) * (count + 2) > (3 - (4, 5)#(2))"
    (finding,) = list_findings(MACHINE.format(rest=rest))
    assert f"guard '{rest.removeprefix('if ')}'" in finding


@pytest.mark.parametrize("guard", ["-5 < -14", "3 > 2", "-count < count"])
def test_numbers_that_are_compared_have_no_range(list_findings, guard):
    assert list_findings(MACHINE.format(rest=f"if {guard}")) == []


def test_a_number_outside_the_range_of_a_feature_is_reported(list_findings):
    bounds = "attribute count : Integer := 0; assert constraint { count >= 0 and count <= 9 }"
    text = MACHINE.replace(
        "attribute count : Integer := 0;", bounds.replace("{", "{{").replace("}", "}}")
    )
    findings = list_findings(text.format(rest="if count > 40"))
    assert findings == ["SM414 guard 'count > 40': 40 is outside 0..9"]


def test_a_default_value_that_must_be_computed_is_not_compared_with_a_range(list_findings):
    text = MACHINE.replace(":= 0", ":= (3, 40)#(2)").format(rest="if count < 3")
    assert list_findings(text) == []
