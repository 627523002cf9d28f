"""Values that nest as deep as they are long."""

from reading_v2 import read


def test_a_sequence_of_thousands_is_read_in_order():
    reading = read(f"package P {{ part def A {{ attribute x = ({'1, 2, ' * 2_000}3); }} }}")
    assert reading.codes() == []
    (element,) = (one for one in reading.graph if one.name == "x")
    values = [value for value in element.attrs.values() if isinstance(value, tuple)]
    assert values == [(1, 2) * 2_000 + (3,)]
