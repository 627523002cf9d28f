"""Links, pipes, devices and references: sysmlc reads no file outside the unit and never waits."""

import os

import pytest

from fuzz.checker import CLASS, make_model

SECRET = make_model('<packagedElement xmi:type="uml:Class" xmi:id="s" name="TOPSECRET"/>')


def make_reference(href):
    general = f'<generalization xmi:id="g"><general href="{href}"/></generalization>'
    return make_model(CLASS.replace("/>", f">{general}</packagedElement>"))


@pytest.fixture
def unit(checker):
    """Return a checker in a folder with an empty unit and a file outside the unit."""
    checker.write(SECRET, "secret.uml")
    (checker.folder / "unit").mkdir()
    return checker


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
    unit.write(make_reference(href.format(folder=unit.folder)), "unit/m.uml")
    command = unit.run("check", "unit/m.uml", "--print-after", "resolve")
    assert "Class c" in command.out
    assert "TOPSECRET" not in command.out + command.err


def test_a_link_in_a_folder_does_not_leave_the_folder(unit):
    unit.write(make_model(), "unit/m.uml")
    (unit.folder / "unit" / "link.uml").symlink_to(unit.folder / "secret.uml")
    (unit.folder / "unit" / "mine.uml").symlink_to(unit.folder / "unit" / "m.uml")
    result = unit.check("unit")
    assert (result.exit_code, result.diagnostic.code, result.diagnostic.file) == (
        0,
        "SM180",
        "unit/link.uml",
    )


def test_a_link_named_on_the_command_line_is_read(unit):
    (unit.folder / "unit" / "link.uml").symlink_to(unit.folder / "secret.uml")
    assert unit.check("unit/link.uml").codes == []


def test_cycles_of_links_terminate(unit):
    (unit.folder / "unit" / "a.uml").symlink_to("b.uml")
    (unit.folder / "unit" / "b.uml").symlink_to("a.uml")
    (unit.folder / "unit" / "loop").symlink_to(unit.folder / "unit")
    unit.write(make_model(), "unit/m.uml")
    result = unit.check("unit")
    assert result.exit_code == 2
    assert {(diagnostic.code, diagnostic.file) for diagnostic in result.diagnostics} == {
        ("SM179", "unit/a.uml"),
        ("SM179", "unit/b.uml"),
    }


def test_pipes_and_devices_are_refused_without_waiting(unit):
    os.mkfifo(unit.folder / "unit" / "pipe.uml")
    for name in ("unit/pipe.uml", "/dev/zero", "/dev/stdin"):
        result = unit.check(name)
        assert (result.exit_code, result.diagnostic.code) == (2, "SM179")
        assert "is not a regular file" in result.diagnostic.message


def test_a_folder_with_the_name_of_a_model_is_a_folder(unit):
    unit.write(make_model(), "unit/plant.uml/m.uml")
    assert unit.check("unit").exit_code == 0
    assert unit.check("unit/plant.uml").exit_code == 0


def test_a_file_that_many_references_name_in_vain_is_searched_once(unit):
    general = "".join(
        f'<generalization xmi:id="g{n}"><general href="no{n}.uml#s"/></generalization>'
        for n in range(2000)
    )
    unit.write(make_model(CLASS.replace("/>", f">{general}</packagedElement>")), "unit/m.uml")
    assert set(unit.check("unit/m.uml").codes) == {"SM152"}
