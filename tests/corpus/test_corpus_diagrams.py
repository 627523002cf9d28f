"""Diagrams of authors in real MagicDraw models, counted once more by lxml."""

import re
import zipfile
from collections import Counter

import pytest
from lxml import etree

from sysmlc.backends.plantuml import BACKEND
from sysmlc.driver import Request, compile_model
from sysmlc.ir import Edge, Kind

pytestmark = pytest.mark.corpus

MODELS = (
    "App_test_JD_v2.mdzip",
    "BallotDefinition.xml",
    "SUV_Example.mdzip",
    "Smart_street_light_2.mdzip",
    "TMT-Models-and-Analysis-Profile.mdzip",
    "Tank_control_2.mdzip",
    "Tank_control_2.xml",
    "Water_Supply_Example.mdzip",
    "Wired_Camera_Example.mdzip",
    "fUML-Tests.mdxml",
)
_ENTRY = re.compile(r"com\.nomagic\.magicdraw\.uml_model(?!____).*model$")


def documents(path):
    """Trees of the model files, without a word of ours."""
    parser = etree.XMLParser(huge_tree=True, resolve_entities=False)
    if path.suffix != ".mdzip":
        return [etree.parse(path, parser).getroot()]
    with zipfile.ZipFile(path) as packed:
        names = [name for name in packed.namelist() if _ENTRY.match(name)]
        return [etree.fromstring(packed.read(name), parser) for name in names]


def counted(path):
    """Name and type of every diagram, and what each shows."""
    found = {}
    for tree in documents(path):
        for diagram in tree.iter("ownedDiagram"):
            (made,) = diagram.iter("{*}DiagramRepresentationObject")
            id = next(value for key, value in diagram.attrib.items() if key.endswith("}id"))
            used = {e.text for e in diagram.iter("usedElements")} - {id}
            found[id] = (diagram.get("name", ""), made.get("type"), used)
    return found


@pytest.fixture(scope="module")
def compiled(corpus):
    made = {}

    def compile_once(name, diagrams="author"):
        if (name, diagrams) not in made:
            path = corpus / "xmi" / "magicdraw" / name
            request = Request(inputs=(path,), diagrams=diagrams, backends=(BACKEND,))
            made[name, diagrams] = compile_model(request)
        return made[name, diagrams]

    return compile_once


def views(made):
    return [one for one in made.graph.of_kind(Kind.VIEW) if one.subkind == "diagram"]


@pytest.mark.parametrize("name", MODELS)
def test_every_diagram_has_its_name_and_type(name, corpus, compiled):
    expected = counted(corpus / "xmi" / "magicdraw" / name)
    found = {one.id: (one.name, one.attrs["diagram_type"]) for one in views(compiled(name))}
    assert found == {id: (title, type_) for id, (title, type_, _) in expected.items()}


def test_tank_control_has_its_fifteen_drawings(compiled):
    words = Counter(one.attrs["diagram"] for one in views(compiled("Tank_control_2.mdzip")))
    assert words == {
        "bdd": 6, "ibd": 3, "sd": 2, "uc": 1, "par": 1, "req": 1, "table": 5, "matrix": 2
    }  # fmt: skip
    with_shapes = [one for one in views(compiled("Tank_control_2.mdzip")) if drawn(one)]
    assert len(with_shapes) == 14


def drawn(view):
    return view.attrs["diagram"] not in ("table", "matrix")


def test_archive_and_one_file_agree(corpus, compiled):
    """The archive is a later revision: diagrams that are the same in both show the same."""
    names = ("Tank_control_2.mdzip", "Tank_control_2.xml")
    files = [counted(corpus / "xmi" / "magicdraw" / name) for name in names]
    same = [id for id in files[1] if files[0].get(id) == files[1][id]]
    assert (len(files[0]), len(files[1]), len(same)) == (21, 20, 19)
    one, other = map(compiled, names)
    for id in same:
        assert one.graph[id].attrs["diagram"] == other.graph[id].attrs["diagram"]
        assert one.graph[id].attrs["relations"] == other.graph[id].attrs["relations"]
        shown = {e.id for e in other.graph.targets(other.graph[id], Edge.REFERENCES) if e.source}
        assert shown <= {e.id for e in one.graph.targets(one.graph[id], Edge.REFERENCES)}


@pytest.mark.parametrize("name", MODELS)
def test_everything_that_is_shown_is_in_the_graph_or_reported(name, corpus, compiled):
    made = compiled(name)
    expected = counted(corpus / "xmi" / "magicdraw" / name)
    lines = {id for tree in documents(corpus / "xmi" / "magicdraw" / name) for id in folded(tree)}
    told = Counter()
    for found in made.diagnostics:
        if found.rule.code == "SM162":
            told[found.subject.id] += int(found.message.split()[0])
    for id, (title, _, used) in expected.items():
        shown = {e.id.rpartition("#")[2] for e in made.graph.targets(made.graph[id], "references")}
        shown |= {
            str(e.attrs.get("href", "")).rpartition("#")[2]
            for e in made.graph.targets(made.graph[id], "references")
        }
        assert len(used - shown - lines) <= told[id], title


def folded(tree):
    for feature in ("generalization", "packageImport", "include", "elementImport"):
        for element in tree.iter(feature):
            yield from (value for key, value in element.attrib.items() if key.endswith("}id"))


@pytest.mark.parametrize("name", MODELS)
def test_what_was_chosen_is_drawn(name, compiled):
    """A dependency without an end that is drawn is the only thing left out."""
    left = [d.message for d in compiled(name).diagnostics if d.rule.code == "SM703"]
    expected = {
        "TMT-Models-and-Analysis-Profile.mdzip": [
            "1 of the 4 elements that diagram 'Model Profile' shows are not drawn: Dependency"
        ]
    }
    assert left == expected.get(name, [])


@pytest.mark.parametrize("name", MODELS)
def test_what_was_not_chosen_is_not_drawn(name, compiled):
    made = compiled(name)
    graph = made.graph
    for artefact in made.artefacts:
        view, *shown = artefact.trace
        if graph[view].attrs["diagram"] == "sd":
            continue
        chosen = {e.id for e in graph.targets(graph[view], Edge.REFERENCES)}
        around = {e.id for id in chosen for e in graph.subtree(graph[id])}
        around |= {e.id for id in chosen for e in graph.targets(graph[id], Edge.END)}
        around |= {e.id for id in chosen for e in graph.sources(graph[id], Edge.REALIZING)}
        extra = [graph[id] for id in shown if id not in around]
        assert [e for e in extra if e.kind is not Kind.PARTITION] == [], artefact.path


@pytest.mark.plantuml
@pytest.mark.parametrize("name", ["Tank_control_2.mdzip", "Wired_Camera_Example.mdzip"])
def test_real_plantuml_renders_them(name, compiled, plantuml):
    made = {artefact.path: artefact.text for artefact in compiled(name).artefacts}
    assert made
    assert set(plantuml.render(made)) == set(made)


def test_two_runs_write_the_same_bytes(corpus, compiled):
    name = "Wired_Camera_Example.mdzip"
    first = {a.path: a.text for a in compiled(name).artefacts}
    path = corpus / "xmi" / "magicdraw" / name
    again = compile_model(Request(inputs=(path,), diagrams="author", backends=(BACKEND,)))
    assert {a.path: a.text for a in again.artefacts} == first
