"""Imports with conditions: what they keep out is unknown, what they let in is known."""

import pytest
from resolving import told

MODEL = """
package Marks {{
    metadata def Safe {{ attribute level : ScalarValues::Integer; }}
    part def Two {{ @Safe {{ level = 2; }} part inner {{ @Safe {{ level = 5; }} }} }}
    part def Plain;
}}
package User {{ {0} }}
"""


@pytest.mark.parametrize(
    ("imported", "unknown"),
    [
        ("private import Marks::*;", []),
        ("private import Marks::*[@Marks::Safe];", ["Plain"]),
        ("private import Marks::*[@Marks::Safe and Marks::Safe::level > 3];", ["Two", "Plain"]),
        ("private import Marks::**[@Marks::Safe and Marks::Safe::level > 3];", ["Two", "Plain"]),
        ("private import Marks::*; filter @Marks::Safe;", ["Plain"]),
    ],
)
def test_a_filter_keeps_out_what_does_not_have_what_it_asks_for(imported, unknown):
    found = told(MODEL.format(f"{imported} part two : Two; part plain : Plain;"))
    assert [line.split("'")[1] for line in found] == unknown


@pytest.mark.parametrize(("level", "unknown"), [(3, []), (6, ["inner"])])
def test_a_recursive_import_with_a_filter_looks_at_what_is_inside(level, unknown):
    imported = f"private import Marks::**[@Marks::Safe and Marks::Safe::level > {level}];"
    found = told(MODEL.format(f"{imported} part mine :> inner;"))
    assert [line.split("'")[1] for line in found] == unknown
