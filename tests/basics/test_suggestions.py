"""Which of the known names is suggested for an unknown one."""

import pytest

from sysmlc.support.suggestions import did_you_mean, find_similar


@pytest.mark.parametrize(
    ("word", "name"),
    [
        ("Tankk", "Tank"),
        ("kgg", "kg"),
        ("Gat", "Gate"),
        ("prat", "part"),
        ("recieve", "receive"),
        ("activity", "activities"),
        ("TANK", "Tank"),
        ("levelFill", "fillLevel"),
        ("fill_level", "fillLevel"),
        ("käse", "Käse"),
    ],
)
def test_a_slip_and_the_same_words_in_another_order_are_similar(word, name):
    assert find_similar(word, [name, "Conveyor"]) == name


@pytest.mark.parametrize(
    ("word", "name"),
    [
        ("OpcUaConnection", "OpcUaMethod"),
        ("RoboticCellCmdPort", "RoboticCellEquipment"),
        ("ConveyorSpeedSensor", "ConveyorLoadSensor"),
        ("sensor4", "sensor3"),
        ("b", "a"),
        ("++", "--"),
        ("x" * 100, "x" * 99),
    ],
)
def test_names_of_other_things_are_not_similar(word, name):
    assert find_similar(word, [name]) == ""


def test_the_name_with_the_fewest_slips_is_suggested():
    assert (
        did_you_mean("convayer", ["conveyed", "conveyor", "convoy"]) == "did you mean 'conveyor'?"
    )


def test_without_a_similar_name_the_known_names_are_listed():
    assert did_you_mean("xml", ["json", "text"]) == "known: json, text"
    assert did_you_mean("xml", []) == "there is none"
