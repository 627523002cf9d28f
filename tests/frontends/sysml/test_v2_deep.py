"""Values that nest as deep as they are long."""

import pytest
from reading_v2 import read

from sysmlc.ir import Kind


def test_a_sequence_of_thousands_is_read_in_order():
    reading = read(f"package P {{ part def A {{ attribute x = ({'1, 2, ' * 2_000}3); }} }}")
    assert reading.list_codes() == []
    (element,) = (element for element in reading.graph if element.name == "x")
    values = [value for value in element.attrs.values() if isinstance(value, tuple)]
    assert values == [(1, 2) * 2_000 + (3,)]


@pytest.mark.parametrize(
    ("opening", "inner", "levels"),
    [
        ("part arm { ", "part tool;", 195),
        ("action move { if true { ", "action pick;", 95),
        ("attribute size = 3 { doc /* x */ ", "attribute width;", 195),
    ],
)
def test_bodies_in_bodies_are_read_as_deep_as_the_notation_allows(opening, inner, levels):
    closing = "}" * opening.count("{")
    reading = read(f"package P {{ {opening * levels}{inner}{closing * levels} }}")
    assert reading.list_codes() == []
    name = inner.split()[-1].rstrip(";")
    assert [element.name for element in reading.graph if element.name == name] == [name]


def test_what_waits_until_all_is_there_may_be_as_deep():
    ends = f"end port a : Q {{ {'port p : Q { ' * 190}port last : Q;{'}' * 190} }} end port b : Q;"
    reading = read(f"package P {{ port def Q; interface def W {{ {ends} }} }}")
    assert reading.list_codes() == []
    assert [element.name for element in reading.graph if element.name == "last"] == ["last"]


def test_a_condition_may_have_a_thousand_others_after_it():
    choice = "if true { action pick; } else " * 1_000
    reading = read(f"package P {{ action move {{ {choice} {{ action place; }} }} }}")
    assert reading.list_codes() == []
    names = [element.name for element in reading.graph if element.kind is Kind.ACTION]
    assert len(names) == 1_001
    assert names[-1] == "place"


def test_a_chain_of_thousands_of_features_is_kept_as_it_is_written():
    chain = f"arm{'.arm' * 3_000}"
    reading = read(f"package P {{ part def A {{ part arm : A; attribute x = {chain}; }} }}")
    (element,) = (element for element in reading.graph if element.name == "x")
    assert chain in element.attrs.values()
