"""File names of outputs are safe everywhere and never collide."""

import re
import unicodedata
from urllib.parse import unquote

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sysmlc.support.output import assign_file_names, fold_path

NASTY = st.characters() | st.sampled_from(" ._:%~\u0301\u0345\u1e9eßſKİıåΣς\ud800\u200d")


def name_of(qualified_name: str) -> str:
    return assign_file_names([qualified_name])[qualified_name]


def test_plain_names_stay_readable():
    assert name_of("Plant::Gate::open_bay") == "Plant.Gate.open_bay"


@pytest.mark.parametrize(
    ("name", "file_name"),
    [
        ("装置::Förder band", "装置.Förder_band"),
        ("Двигатель №2", "Двигатель_%E2%84%962"),
        ("แขนกล", "แขนกล"),
        ("全角\u3000空白", "全角_空白"),
        ("Fo\u0308rder band", "Förder_band"),
    ],
)
def test_letters_of_all_scripts_stay_and_blanks_become_underscores(name, file_name):
    assert name_of(name) == file_name


@pytest.mark.parametrize(
    ("name", "file_name"),
    [
        ("Band/1 (left)", "Band%2F1_%28left%29"),
        ('<>:"|?*', "%3C%3E%3A%22%7C%3F%2A"),
        ("50 %", "50_%25"),
        ("a\nb\x7f", "a%0Ab%7F"),
        ("in\u202etuo", "in%E2%80%AEtuo"),
        ("zero\u200bwidth", "zero%E2%80%8Bwidth"),
        ("葛\U000e0100", "葛%F3%A0%84%80"),
        ("blank\u3164", "blank%E3%85%A4"),
        ("Gate ", "Gate%20"),
        ("-rf x-y", "%2Drf_x-y"),
        ("Gate.", "Gate"),
        ("\udcff", "%ED%B3%BF"),
        ("", "_"),
    ],
)
def test_other_characters_are_percent_encoded(name, file_name):
    assert name_of(name) == file_name


def test_names_that_windows_reserves_are_changed():
    assert name_of("con::x") == "_con.x"
    assert name_of("console") == "console"
    assert name_of("COM¹") == "_COM¹"


def test_names_that_collide_without_case_all_get_a_suffix():
    names = assign_file_names(["Gate", "gate", "Bay"])
    assert names["Bay"] == "Bay"
    assert re.fullmatch(r"Gate~[0-9a-f]{6}", names["Gate"])
    assert re.fullmatch(r"gate~[0-9a-f]{6}", names["gate"])


@pytest.mark.parametrize(
    "names",
    [
        ("Groß", "GROSS"),
        ("ΣΊΣΥΦΟΣ", "σίσυφος"),
        ("Maß 1", "Maß_1"),
        ("Å", "A\u030a"),
        ("\u0345\u0301", "\u0301\u0399"),
    ],
)
def test_names_that_a_file_system_confuses_all_get_a_suffix(names):
    file_names = assign_file_names(names).values()
    assert len(set(map(fold_path, file_names))) == 2
    assert all("~" in name for name in file_names)


@pytest.mark.parametrize("name", ["装" * 41, "x" + "é" * 60, "a" + " (" * 60, "𝔸" * 31])
def test_long_names_are_cut_after_a_whole_character(name):
    file_name = name_of(name)
    assert 110 < len(file_name.encode()) <= 120
    start = file_name.partition("~")[0]
    assert unquote(start, errors="strict") == name.replace(" ", "_")[: len(unquote(start))]


def test_long_names_are_cut_and_stay_distinct():
    names = assign_file_names(["x" * 300 + "a", "x" * 300 + "b"])
    assert len(set(names.values())) == 2
    assert all(len(name.encode()) <= 120 for name in names.values())


@given(st.lists(st.text(NASTY, min_size=1), unique=True, max_size=8))
def test_any_names_become_distinct_safe_file_names(names):
    file_names = list(assign_file_names(names).values())
    assert len(set(map(fold_path, file_names))) == len(names)
    for name in file_names:
        assert len(name.encode()) <= 120
        assert name not in {"", ".", ".."}
        assert name == unicodedata.normalize("NFC", name)
        assert not set(name) & set('/\\:*?"<>| ')
        assert name.isprintable()
