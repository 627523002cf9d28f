"""Units and kinds of values in SysML v2: what they mean in the graph, in a comparison, in text."""

import pytest

from frontends.sysml.reading_v2 import read
from sysmlc.ir.compare import compare

VALUE = """
package Plant {{
    private import SI::*;
    attribute def Unitless;
    attribute <box> boxful : MeasurementReferences::SimpleUnit;
    part def Tank {{ attribute mass {value}; }}
}}
"""


def read_value(value):
    """Return the attributes of a feature with a value."""
    return read(VALUE.format(value=value)).find_element("Plant::Tank::mass").attrs


def list_changes(before, after):
    """Return the differences between two values as ``aspect: before => after``."""
    graphs = [read(VALUE.format(value=value)).graph for value in (before, after)]
    return [f"{change.aspect}: {change.before} => {change.after}" for change in compare(*graphs)]


@pytest.mark.parametrize(
    ("sign", "kind"),
    [
        ("=", "bound"),
        (":=", "initial"),
        ("default", None),
        ("default =", None),
        ("default :=", "default initial"),
    ],
)
def test_the_words_before_a_value_state_its_kind(sign, kind):
    attributes = read_value(f"{sign} 500")
    assert (attributes["default"], attributes.get("default_kind")) == (500, kind)


@pytest.mark.parametrize(
    ("value", "number", "unit"),
    [
        ("500 [kg]", 500, "SI::kg"),
        ("500 [kilogram]", 500, "SI::kg"),
        ("-5 [SI::'°C']", -5, "SI::'°C'"),
        ("5 [km/h]", 5, "SI::km / SI::h"),
        ("(1, 2) [m]", (1, 2), "SI::m"),
        ("(1 [m], 2 [cm])", (1, 2), ("SI::m", "SI::cm")),
        ("(1 [m], 2)", (1, 2), ("SI::m", "")),
        ("500", 500, None),
    ],
)
def test_a_quantity_has_a_number_and_a_unit(value, number, unit):
    attributes = read_value(f"= {value}")
    assert (attributes["default"], attributes.get("default_unit")) == (number, unit)


def test_a_unit_of_the_model_is_an_element():
    reading = read(VALUE.format(value="= 3 [box]"))
    tank_mass = reading.find_element("Plant::Tank::mass")
    assert reading.graph[tank_mass.attrs["default_unit"]].name == "boxful"


@pytest.mark.parametrize(
    ("before", "after", "change"),
    [
        ("= 500 [kg]", "= 500 [g]", "default unit: SI::kg => SI::g"),
        ("= 500 [kg]", "= 500", "default unit: SI::kg => "),
        ("= 5 [m/s]", "= 5 [m/h]", "default unit: SI::m / SI::s => SI::m / SI::h"),
        ("= 5", ":= 5", "default kind: bound => initial"),
        ("= 5", "default = 5", "default kind: bound => "),
        ("default = 5", "default := 5", "default kind:  => default initial"),
    ],
)
def test_values_that_differ_in_one_token_have_one_difference(before, after, change):
    assert list_changes(before, after) == [change]


def test_two_notations_of_one_value_have_no_difference():
    assert list_changes("default 500 [kg]", "default = 500 [SI::kilogram]") == []


def test_a_slot_keeps_unit_and_kind():
    text = "package P {{ part def A {{ attribute m; }} part a : A {{ :>> m {}; }} }}"
    graphs = [read(text.format(value)).graph for value in ("= 1 [SI::g]", ":= 1 [SI::kg]")]
    assert [change.aspect for change in compare(*graphs)] == [
        "value of m kind",
        "value of m unit",
    ]
