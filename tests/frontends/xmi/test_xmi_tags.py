"""Tagged values: ids of elements where they are some, text where they are text."""

import pytest
from reading_xmi import papyrus, read, source

CELL = '<packagedElement xmi:type="uml:Class" xmi:id="c" name="Cell"/>'
ROBOT = '<packagedElement xmi:type="uml:Class" xmi:id="_b1cQPoREe2dJ8u5Yq1m4wX" name="Robot"/>'
HERE = "_b1cQPoREe2dJ8u5Yq1m4wX"
GONE = "_Zk3cQPoREe2dJ8u5Yq1m4w"
LOST = (
    "tag-names-missing-element: tag 'robot' of stereotype 'Cell' names '{}', which does not exist"
)


def applied(attributes="", children="", model=CELL + ROBOT):
    tags = f'<Plant:Cell xmi:id="p" base_Class="c" {attributes}>{children}</Plant:Cell>'
    reading = read(papyrus(model, tags))
    return reading.graph["p"].attrs.get("tag.robot"), reading.findings


def test_an_id_is_that_of_an_element():
    assert applied(f'robot="{HERE}"') == (HERE, [])
    assert applied(f'robot="{HERE} c"') == ((HERE, "c"), [])


def test_an_id_without_target_is_reported():
    assert applied(f'robot="{GONE}"') == (GONE, [LOST.format(GONE)])


def test_the_existing_ids_of_several_are_stored():
    assert applied(f'robot="{HERE} {GONE}"') == ((HERE,), [LOST.format(GONE)])


def test_many_ids_without_target_are_one_diagnostic():
    gone = " ".join(f"_Zk3cQPoREe2dJ8u5Yq1{i:03}" for i in range(500))
    tag, (finding,) = applied(f'robot="{gone}"')
    assert tag == gone
    assert finding == LOST.format("_Zk3cQPoREe2dJ8u5Yq1000")


def test_a_child_without_target_is_reported():
    assert applied(children='<robot xmi:idref="gone"/>') == ("gone", [LOST.format("gone")])
    assert applied(children=f'<robot xmi:idref="{HERE}"/>') == (HERE, [])


@pytest.mark.parametrize(
    "gone", ["_19_0_4_25dc056a_1603446189175_568939_54374", "EAID_939C72FB_4C44_ae7b_EC5C"]
)
def test_ids_of_other_tools_are_known_too(gone):
    assert applied(f'robot="{gone}"')[1] == [LOST.format(gone)]


@pytest.mark.parametrize(
    "text", ["", "6", "fast c", "_private", "c-3po", f"see {GONE}", "Zk3cQPoREe2dJ8u5Yq1m4w"]
)
def test_text_is_text(text):
    assert applied(f'robot="{text}"') == (text, [])


def test_an_element_of_another_file_of_the_unit_exists():
    one = papyrus(CELL, f'<Plant:Cell xmi:id="p" base_Class="c" robot="{HERE}"/>')
    other = source(papyrus(ROBOT.replace('"m"', '"n"')).data, "other.uml")
    reading = read(one, other)
    assert [finding for finding in reading.findings if "tag" in finding] == []
    assert reading.graph["p"].attrs["tag.robot"] == HERE
