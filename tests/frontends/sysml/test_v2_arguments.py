"""Arguments of calls, new instances and send actions: named ones are sorted, none is lost."""

import pytest
from reading_v2 import read

from sysmlc.ir import Kind

AROUND = """
package P {
    private import ScalarValues::*;
    calc def F { in a : Integer; in b : Integer; return : Integer = a - b; }
    item def Sig { attribute n : Integer; attribute m : Integer; }
    part def D { attribute u : Integer; %s }
}"""


@pytest.mark.parametrize(
    ("written", "expected"),
    [
        ("F(u, 1)", "F(u, 1)"),
        ("F(b = 1, a = u)", "F(u, 1)"),
        ("F(b = u)", "F(b = u)"),
        ("new Sig(u, 2)", "Sig(u, 2)"),
        ("new Sig(m = 2, n = u)", "Sig(u, 2)"),
        ("new Sig()", "Sig()"),
    ],
)
def test_arguments_stand_in_the_order_of_what_they_are_given_to(written, expected):
    reading = read(AROUND % f"attribute v = {written};")
    assert reading.list_codes() == []
    assert reading.find_element("P::D::v").attrs["default"] == expected


@pytest.mark.parametrize("written", ["new Sig(u, 2)", "new Sig(m = 2, n = u)"])
def test_what_is_sent_has_a_pin_for_each_argument(written):
    reading = read(AROUND % f"action a {{ first start; then action s send {written} to self; }}")
    assert reading.list_codes() == []
    assert [pin.attrs["value"] for pin in reading.graph.of_kind(Kind.PIN)] == ["u", 2]


def test_an_effect_that_sends_keeps_what_it_sends():
    member = "state s { entry; then a; state a;"
    member += " transition first a do send new Sig(u, 2) to self then a; }"
    reading = read(AROUND % member)
    bodies = [activity.attrs.get("body") for activity in reading.graph.of_kind(Kind.ACTIVITY)]
    assert "send Sig(u, 2) to self" in bodies


def test_a_point_in_time_keeps_what_it_is_made_of():
    member = "attribute t : Time::Iso8601DateTime; action a { accept at new"
    reading = read(AROUND % f"{member} Time::Iso8601DateTime(t); }}")
    (trigger,) = reading.graph.of_kind(Kind.TRIGGER)
    assert trigger.attrs["when"] == "Time::Iso8601DateTime(t)"
    assert "relative" not in trigger.attrs
