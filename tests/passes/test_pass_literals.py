"""Directions and aggregations that UML does not have: reported, and not in the graph any more."""

import pytest
from passing import refined


@pytest.mark.parametrize(
    ("element", "attribute"),
    [
        ('Parameter x "x" direction="Sideways"', "direction"),
        ('Port x "x" direction="sideways"', "direction"),
        ('Property x "x" aggregation="weird"', "aggregation"),
    ],
)
def test_what_is_no_literal_counts_as_none(element, attribute):
    graph, (found,) = refined(f"{element}\n", "classify")
    assert (found.rule.code, found.severity) == ("SM220", "warning")
    assert found.message.startswith(f"the {attribute} of 'x' is ")
    assert attribute not in graph["x"].attrs


@pytest.mark.parametrize("value", ["in", "inout", "out", "return"])
def test_literals_stay(value):
    graph, sink = refined(f'Parameter x "x" direction="{value}"\n', "classify")
    assert (list(sink), graph["x"].attrs["direction"]) == ([], value)
