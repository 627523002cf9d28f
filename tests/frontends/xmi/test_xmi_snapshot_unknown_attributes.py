"""Attributes of library elements that UML does not have are told, once for each snapshot."""

import pytest
from reading_xmi import read
from test_xmi_snapshots import COMPANY, MODEL, SYSML, archive, model, snapshot

from sysmlc.driver import Request, compile_model

ROBOT = '<packagedElement xsi:type="uml:Class" xmi:id="robot" ID="robot" name="Robot"'


def told(*changes):
    library = COMPANY
    for old, new in changes:
        assert old in library
        library = library.replace(old, new)
    return read(model(), snapshot(library), snapshot(SYSML, "b"))


def messages(reading):
    return [one.message for one in reading.sink if one.rule.code == "SM155"]


def test_an_attribute_of_an_element_that_the_model_takes_is_told_where_it_is():
    reading = told((ROBOT, f'{ROBOT} isAbstrct="true"'))
    assert messages(reading) == [
        "attribute 'isAbstrct' of 'Library::Robot', taken from 'Company%20Library.mdzip', is known "
        "neither to UML nor to MagicDraw"
    ]
    (finding,) = reading.sink
    assert finding.help == "did you mean 'isAbstract'?"
    assert finding.subject.name == "Library::Robot"
    assert finding.subject.place.ordinal == 7


def test_the_same_attribute_is_told_once_with_the_number_of_elements():
    reading = told((' ID="machine"', ' ID="machine" x="1"'), (' ID="tool"', ' ID="tool" x="2"'))
    (message,) = messages(reading)
    assert message.startswith("attribute 'x' of 'Library::Machine' and 1 more, taken from")


def test_what_refers_is_looked_at_too():
    reading = told(('href="#machine"', 'href="#machine" hrfe="#tool"'))
    (message,) = messages(reading)
    assert message.startswith("attribute 'hrfe' of 'Library::Robot::Generalization', taken from")


@pytest.mark.parametrize(
    "attribute", ['isDerived="true"', 'xmi:uuid="1"', '_extensionEndOfType=""']
)
def test_attributes_that_uml_xmi_or_the_tool_has_are_not_told(attribute):
    assert messages(told((ROBOT, f"{ROBOT} {attribute}"))) == []


def test_what_no_model_takes_is_not_told():
    assert messages(told((' ID="other"', ' ID="other" x="1"'))) == []


def test_such_elements_are_approximated():
    clean, odd = (told(*changes).totals for changes in ((), [(ROBOT, f'{ROBOT} x="1"')]))
    assert clean.get("approximated", 0) == 0
    assert odd["approximated"] == 1
    assert odd["mapped"] == clean["mapped"] - 1
    assert odd["elements"] == clean["elements"]


def test_the_place_is_found_in_the_entry_of_the_archive(tmp_path):
    library = snapshot(COMPANY.replace(ROBOT, f'{ROBOT} x="1"'))
    made = compile_model(Request((archive(tmp_path, model(MODEL), library),)))
    (finding,) = [one for one in made.diagnostics if one.rule.code == "SM155"]
    assert finding.subject.place.file.endswith("snapshot")
