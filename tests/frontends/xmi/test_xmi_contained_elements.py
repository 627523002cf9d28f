"""Parts of a model in files of their own, as Papyrus and EMF keep them (control, submodels)."""

import pytest
from reading_xmi import PAPYRUS, magicdraw, papyrus, read, source

PUMP = '<packagedElement xmi:type="uml:Class" xmi:id="pump" name="Pump"/>'
ROBOTS = (
    '<uml:Package xmi:id="robots" name="Robots">'
    '<packagedElement xmi:type="uml:Class" xmi:id="arm" name="Arm"/>%s'
    '</uml:Package><Blocks:Block xmi:id="b" base_Class="arm"/>'
)


def holds(href):
    return f'<packagedElement xmi:type="uml:Package" href="{href}"/>'


def part(content="", name="parts/robots.uml"):
    return source(PAPYRUS % ROBOTS % content, name)


def name_of(reading, id):
    return reading.graph.qualified_name(reading.graph[id])


@pytest.mark.parametrize("fragment", ["robots", "/0", "/"])
@pytest.mark.parametrize("is_reversed", [False, True])
def test_a_contained_element_belongs_to_the_element_that_refers_to_it(fragment, is_reversed):
    files = [papyrus(holds(f"parts/robots.uml#{fragment}") + PUMP), part()]
    done = read(*reversed(files)) if is_reversed else read(*files)
    assert done.findings == []
    assert name_of(done, "arm") == "M::Robots::Arm"
    assert done.graph["arm"].source == "parts/robots.uml"
    assert [root.id for root in done.graph.roots()] == ["m"]
    assert "external" not in done.totals


def test_a_contained_element_may_contain_another():
    arm = '<uml:Class xmi:id="hand" name="Hand"/>'
    done = read(
        papyrus(holds("parts/robots.uml#robots")),
        part('<packagedElement xmi:type="uml:Class" href="hand.uml#hand"/>'),
        source(PAPYRUS % arm, "parts/hand.uml"),
    )
    assert name_of(done, "hand") == "M::Robots::Hand"


def test_a_missing_contained_element_is_reported():
    done = read(papyrus(holds("gone.uml#robots") + PUMP))
    assert done.findings == [
        "missing-part: 'M' contains 'gone.uml#robots', which no file of the compile unit has"
    ]
    assert done.totals["external"] == 1


@pytest.mark.parametrize(
    ("href", "back", "problem"),
    [
        ("parts/robots.uml#arm", "", "which belongs to another element"),
        ("parts/robots.uml#robots", holds("../m.uml#m"), "which it is in itself"),
    ],
)
def test_an_element_has_one_owner_and_does_not_contain_itself(href, back, problem):
    (finding,) = read(papyrus(holds(href)), part(back)).findings
    assert finding.startswith("missing-part: ")
    assert finding.endswith(problem)


def test_a_contained_element_that_is_not_read_is_reported():
    region = source(PAPYRUS % '<uml:Region xmi:id="region"/>', "region.uml")
    done = read(papyrus(holds("region.uml#region")), region)
    assert "region" not in done.graph
    assert any(finding.startswith("missing-part: ") for finding in done.findings)


def test_packages_of_projects_that_magicdraw_uses_are_not_the_models_own():
    shown = (
        "<packagedElement href='local:/PROJECT-1?resource=shared#lib'><xmi:Extension>"
        "<referenceExtension referentPath='Library' referentType='Package'/>"
        "</xmi:Extension></packagedElement>"
    )
    done = read(magicdraw(shown))
    assert (done.findings, done.totals["external"]) == ([], 1)
