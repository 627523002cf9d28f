"""Links, pipes, devices and references: nothing outside the unit is read, nothing is waited for."""

import os

import pytest

from fuzz.answers import CLASS, model

SECRET = model('<packagedElement xmi:type="uml:Class" xmi:id="s" name="TOPSECRET"/>')


def refers(href):
    general = f'<generalization xmi:id="g"><general href="{href}"/></generalization>'
    return model(CLASS.replace("/>", f">{general}</packagedElement>"))


@pytest.fixture
def unit(asked):
    """A unit in a folder beside a file that is not its own."""
    asked.write(SECRET, "secret.uml")
    (asked.folder / "unit").mkdir()
    return asked


@pytest.mark.parametrize(
    "href",
    [
        "../secret.uml#s",
        "../unit/../secret.uml#s",
        "%2e%2e/secret.uml#s",
        "{folder}/secret.uml#s",
        "file://{folder}/secret.uml#s",
        "link.uml#s",
        "http://127.0.0.1:1/secret.uml#s",
        "\\\\host\\share\\secret.uml#s",
        "//host/share/secret.uml#s",
    ],
)
def test_a_reference_does_not_leave_the_unit(unit, href):
    (unit.folder / "unit" / "link.uml").symlink_to(unit.folder / "secret.uml")
    unit.write(refers(href.format(folder=unit.folder)), "unit/m.uml")
    ended = unit.run("check", "unit/m.uml", "--print-after", "resolve")
    assert "Class c" in ended.out
    assert "TOPSECRET" not in ended.out + ended.err


def test_a_link_in_a_folder_does_not_leave_the_folder(unit):
    unit.write(model(), "unit/m.uml")
    (unit.folder / "unit" / "link.uml").symlink_to(unit.folder / "secret.uml")
    (unit.folder / "unit" / "mine.uml").symlink_to(unit.folder / "unit" / "m.uml")
    answer = unit.check("unit")
    assert (answer.ended.code, answer.only.code, answer.only.file) == (
        0,
        "SM180",
        "unit/link.uml",
    )


def test_a_link_that_is_named_is_read(unit):
    (unit.folder / "unit" / "link.uml").symlink_to(unit.folder / "secret.uml")
    assert unit.check("unit/link.uml").codes == []


def test_links_in_circles_end(unit):
    (unit.folder / "unit" / "a.uml").symlink_to("b.uml")
    (unit.folder / "unit" / "b.uml").symlink_to("a.uml")
    (unit.folder / "unit" / "loop").symlink_to(unit.folder / "unit")
    unit.write(model(), "unit/m.uml")
    answer = unit.check("unit")
    assert answer.ended.code == 2
    assert {(found.code, found.file) for found in answer.findings} == {
        ("SM179", "unit/a.uml"),
        ("SM179", "unit/b.uml"),
    }


def test_pipes_and_devices_are_not_waited_for(unit):
    os.mkfifo(unit.folder / "unit" / "pipe.uml")
    for name in ("unit/pipe.uml", "unit", "/dev/zero", "/dev/stdin"):
        answer = unit.check(name)
        assert (answer.ended.code, answer.only.code) == (2, "SM179")
        assert "is not a regular file" in answer.only.message


def test_a_folder_that_is_named_like_a_model_is_a_folder(unit):
    unit.write(model(), "unit/plant.uml/m.uml")
    assert unit.check("unit").ended.code == 0
    assert unit.check("unit/plant.uml").ended.code == 0


def test_many_references_to_files_that_are_not_there_are_looked_for_once(unit):
    general = "".join(
        f'<generalization xmi:id="g{n}"><general href="no{n}.uml#s"/></generalization>'
        for n in range(2000)
    )
    unit.write(model(CLASS.replace("/>", f">{general}</packagedElement>")), "unit/m.uml")
    assert set(unit.check("unit/m.uml").codes) == {"SM152"}
