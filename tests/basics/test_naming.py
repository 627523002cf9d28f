"""File names of outputs are safe everywhere and never collide."""

import re

from hypothesis import given
from hypothesis import strategies as st

from sysmlc.support.output import assign_file_names


def name_of(qualified_name: str) -> str:
    return assign_file_names([qualified_name])[qualified_name]


def test_plain_names_stay_readable():
    assert name_of("Plant::Gate::open_bay") == "Plant.Gate.open_bay"


def test_other_characters_are_percent_encoded():
    assert name_of("Förder band/1") == "F%C3%B6rder%20band%2F1"


def test_names_that_windows_reserves_are_changed():
    assert name_of("con::x") == "_con.x"
    assert name_of("console") == "console"


def test_names_that_collide_without_case_all_get_a_suffix():
    names = assign_file_names(["Gate", "gate", "Bay"])
    assert names["Bay"] == "Bay"
    assert re.fullmatch(r"Gate~[0-9a-f]{6}", names["Gate"])
    assert re.fullmatch(r"gate~[0-9a-f]{6}", names["gate"])


def test_long_names_are_cut_and_stay_distinct():
    names = assign_file_names(["x" * 300 + "a", "x" * 300 + "b"])
    assert len(set(names.values())) == 2
    assert all(len(name.encode()) <= 120 for name in names.values())


@given(st.lists(st.text(min_size=1), unique=True, max_size=8))
def test_any_names_become_distinct_safe_file_names(names):
    file_names = list(assign_file_names(names).values())
    assert len({name.lower() for name in file_names}) == len(names)
    for name in file_names:
        assert len(name.encode()) <= 120
        assert name not in {"", ".", ".."}
        assert not set(name) & set('/\\:*?"<>| ')
