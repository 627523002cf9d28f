"""Attributes of library elements that UML does not have are reported, once for each snapshot."""

import pytest
from reading_xmi import read
from test_xmi_snapshots import COMPANY, MODEL, SYSML, archive, model, snapshot

from sysmlc.driver import Request, compile_model

ROBOT = '<packagedElement xsi:type="uml:Class" xmi:id="robot" ID="robot" name="Robot"'


def list_messages(*changes):
    library = COMPANY
    for old, new in changes:
        assert old in library
        library = library.replace(old, new)
    return read(model(), snapshot(library), snapshot(SYSML, "b"))


def messages(reading):
    return [item.message for item in reading.sink if item.rule.code == "SM155"]


def test_an_unknown_attribute_of_a_used_element_is_reported_at_its_location():
    reading = list_messages((ROBOT, f'{ROBOT} isAbstrct="true"'))
    assert messages(reading) == [
        "attribute 'isAbstrct' of 'Library::Robot', taken from 'Company%20Library.mdzip', is "
        "defined neither by UML nor by MagicDraw"
    ]
    (finding,) = reading.sink
    assert finding.help == "did you mean 'isAbstract'?"
    assert finding.subject.name == "Library::Robot"
    assert finding.subject.place.ordinal == 7


def test_an_unknown_attribute_is_reported_once_with_the_number_of_elements():
    reading = list_messages(
        (' ID="machine"', ' ID="machine" x="1"'), (' ID="tool"', ' ID="tool" x="2"')
    )
    (message,) = messages(reading)
    assert message.startswith("attribute 'x' of 'Library::Machine' and 1 more, taken from")


def test_elements_that_only_refer_are_checked_too():
    reading = list_messages(('href="#machine"', 'href="#machine" hrfe="#tool"'))
    (message,) = messages(reading)
    assert message.startswith("attribute 'hrfe' of 'Library::Robot::Generalization', taken from")


@pytest.mark.parametrize(
    "attribute", ['isDerived="true"', 'xmi:uuid="1"', '_extensionEndOfType=""']
)
def test_attributes_of_uml_xmi_and_the_tool_are_not_reported(attribute):
    assert messages(list_messages((ROBOT, f"{ROBOT} {attribute}"))) == []


def test_elements_that_no_model_uses_are_not_reported():
    assert messages(list_messages((' ID="other"', ' ID="other" x="1"'))) == []


def test_elements_with_unknown_attributes_are_approximated():
    clean, odd = (list_messages(*changes).totals for changes in ((), [(ROBOT, f'{ROBOT} x="1"')]))
    assert clean.get("approximated", 0) == 0
    assert odd["approximated"] == 1
    assert odd["mapped"] == clean["mapped"] - 1
    assert odd["elements"] == clean["elements"]


def test_the_location_is_in_the_entry_of_the_archive(tmp_path):
    library = snapshot(COMPANY.replace(ROBOT, f'{ROBOT} x="1"'))
    compilation = compile_model(Request((archive(tmp_path, model(MODEL), library),)))
    (finding,) = [item for item in compilation.diagnostics if item.rule.code == "SM155"]
    assert finding.subject.place.file.endswith("snapshot")
