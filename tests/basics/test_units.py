"""Units of measurement: which unit a text means, and conversion of numbers."""

from fractions import Fraction

import pytest

from sysmlc.support.units import UNITS, convert, find_unit, split_quantity


def test_symbols_and_names_are_unique():
    for texts in ([unit.symbol for unit in UNITS], [unit.name for unit in UNITS]):
        assert len(set(texts)) == len(texts)


@pytest.mark.parametrize(
    ("text", "symbol"),
    [("s", "s"), ("SEC", "s"), ("seconds", "s"), ("kW⋅h", "kWh"), ("m / s", "m/s"), ("m", "m")],
)
def test_a_unit_has_several_spellings(text, symbol):
    unit = find_unit(text)
    assert unit is not None
    assert unit.symbol == symbol


def test_other_texts_are_no_units():
    assert [find_unit(text) for text in ("", "cycles", "S", "5")] == [None] * 4


@pytest.mark.parametrize(
    ("number", "unit", "target", "result"),
    [
        ("9", "s", "ms", "9000"),
        ("1.5", "h", "min", "90"),
        ("1", "kWh", "J", "3600000"),
        ("36", "km/h", "m/s", "10"),
        ("7", "pcs", "pcs", "7"),
        ("9", "kg", "s", None),
        ("3", "H", "ms", None),
        ("3", "S", "ms", None),
        ("3", "MIN", "s", "180"),
        ("20", "°C", "K", None),
        ("9", "cycles", "s", None),
    ],
)
def test_numbers_are_converted_exactly(number, unit, target, result):
    converted = convert(Fraction(number), unit, target)
    assert converted == (None if result is None else Fraction(result))


@pytest.mark.parametrize(
    ("text", "quantity"),
    [
        ("9 s", (9, "s")),
        ("9s", (9, "s")),
        (" -1.5e3 [ms] ", (-1500, "ms")),
        ("9", None),
        ("s", None),
        ("1,5 s", None),
    ],
)
def test_a_quantity_is_a_number_and_a_unit(text, quantity):
    assert split_quantity(text) == quantity
