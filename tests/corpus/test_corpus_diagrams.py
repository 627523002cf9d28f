"""Diagrams of authors in real MagicDraw models are drawn as lxml counts them."""

from collections import Counter

import pytest
from reading_corpus import parse_models

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


def read_diagrams(path):
    """Return the name and type of every diagram, and the ids of the elements that it shows."""
    diagrams = {}
    for tree in parse_models(path):
        for diagram in tree.iter("ownedDiagram"):
            (drawing,) = diagram.iter("{*}DiagramRepresentationObject")
            id = next(value for key, value in diagram.attrib.items() if key.endswith("}id"))
            used = {e.text for e in diagram.iter("usedElements")} - {id}
            diagrams[id] = (diagram.get("name", ""), drawing.get("type"), used)
    return diagrams


@pytest.fixture(scope="module")
def compile_once(corpus):
    compilations = {}

    def compile_cached(name, diagrams="author"):
        if (name, diagrams) not in compilations:
            path = corpus / "xmi" / "magicdraw" / name
            request = Request(inputs=(path,), diagrams=diagrams, backends=(BACKEND,))
            compilations[name, diagrams] = compile_model(request)
        return compilations[name, diagrams]

    return compile_cached


def list_views(compilation):
    return [view for view in compilation.graph.of_kind(Kind.VIEW) if view.subkind == "diagram"]


@pytest.mark.parametrize("name", MODELS)
def test_every_diagram_has_its_name_and_type(name, corpus, compile_once):
    expected = read_diagrams(corpus / "xmi" / "magicdraw" / name)
    views = {
        view.id: (view.name, view.attrs["diagram_type"]) for view in list_views(compile_once(name))
    }
    assert views == {id: (title, type_) for id, (title, type_, _) in expected.items()}


def test_tank_control_has_fourteen_drawings_and_seven_tables(compile_once):
    words = Counter(
        view.attrs["diagram"] for view in list_views(compile_once("Tank_control_2.mdzip"))
    )
    assert words == {
        "bdd": 6, "ibd": 3, "sd": 2, "uc": 1, "par": 1, "req": 1, "table": 5, "matrix": 2
    }  # fmt: skip
    with_shapes = [
        view for view in list_views(compile_once("Tank_control_2.mdzip")) if is_drawn(view)
    ]
    assert len(with_shapes) == 14


def is_drawn(view):
    return view.attrs["diagram"] not in ("table", "matrix")


def test_the_archive_and_the_single_file_agree(corpus, compile_once):
    """Diagrams that are equal in both files show the same; the archive is a later revision."""
    names = ("Tank_control_2.mdzip", "Tank_control_2.xml")
    files = [read_diagrams(corpus / "xmi" / "magicdraw" / name) for name in names]
    equal_ids = [id for id in files[1] if files[0].get(id) == files[1][id]]
    assert (len(files[0]), len(files[1]), len(equal_ids)) == (21, 20, 19)
    archive, file = map(compile_once, names)
    for id in equal_ids:
        assert archive.graph[id].attrs["diagram"] == file.graph[id].attrs["diagram"]
        assert archive.graph[id].attrs["relations"] == file.graph[id].attrs["relations"]
        shown_in_file = {
            e.id for e in file.graph.targets(file.graph[id], Edge.REFERENCES) if e.source
        }
        assert shown_in_file <= {
            e.id for e in archive.graph.targets(archive.graph[id], Edge.REFERENCES)
        }


@pytest.mark.parametrize("name", MODELS)
def test_every_shown_element_is_in_the_graph_or_reported(name, corpus, compile_once):
    compilation = compile_once(name)
    expected = read_diagrams(corpus / "xmi" / "magicdraw" / name)
    relation_ids = {
        id
        for tree in parse_models(corpus / "xmi" / "magicdraw" / name)
        for id in iter_relation_ids(tree)
    }
    reported = Counter()
    for diagnostic in compilation.diagnostics:
        if diagnostic.rule.code == "SM162":
            reported[diagnostic.subject.id] += int(diagnostic.message.split(", ")[-1].split()[0])
    for id, (title, _, used) in expected.items():
        targets = compilation.graph.targets(compilation.graph[id], "references")
        shown = {element.id.rpartition("#")[2] for element in targets}
        shown |= {str(element.attrs.get("href", "")).rpartition("#")[2] for element in targets}
        assert len(used - shown - relation_ids) <= reported[id], title


def iter_relation_ids(tree):
    for feature in ("generalization", "packageImport", "include", "elementImport"):
        for element in tree.iter(feature):
            yield from (value for key, value in element.attrib.items() if key.endswith("}id"))


@pytest.mark.parametrize("name", MODELS)
def test_every_chosen_element_is_drawn(name, compile_once):
    """The only omission is a dependency without drawn ends."""
    omissions = [d.message for d in compile_once(name).diagnostics if d.rule.code == "SM703"]
    expected = {
        "TMT-Models-and-Analysis-Profile.mdzip": [
            "diagram 'Model Profile' is drawn without 1 of 4 elements: Dependency"
        ]
    }
    assert omissions == expected.get(name, [])


@pytest.mark.parametrize("name", MODELS)
def test_no_other_element_is_drawn(name, compile_once):
    compilation = compile_once(name)
    graph = compilation.graph
    for artefact in compilation.artefacts:
        view, *shown = artefact.trace
        if graph[view].attrs["diagram"] == "sd":
            continue
        chosen = {e.id for e in graph.targets(graph[view], Edge.REFERENCES)}
        allowed = {e.id for id in chosen for e in graph.subtree(graph[id])}
        allowed |= {e.id for id in chosen for e in graph.targets(graph[id], Edge.END)}
        allowed |= {e.id for id in chosen for e in graph.sources(graph[id], Edge.REALIZING)}
        unexpected = [graph[id] for id in shown if id not in allowed]
        assert [e for e in unexpected if e.kind is not Kind.PARTITION] == [], artefact.path


@pytest.mark.plantuml
@pytest.mark.parametrize("name", ["Tank_control_2.mdzip", "Wired_Camera_Example.mdzip"])
def test_plantuml_renders_the_drawings(name, compile_once, plantuml):
    drawings = {artefact.path: artefact.text for artefact in compile_once(name).artefacts}
    assert drawings
    assert set(plantuml.render(drawings)) == set(drawings)


def test_two_runs_write_the_same_bytes(corpus, compile_once):
    name = "Wired_Camera_Example.mdzip"
    first = {artefact.path: artefact.text for artefact in compile_once(name).artefacts}
    path = corpus / "xmi" / "magicdraw" / name
    second = compile_model(Request(inputs=(path,), diagrams="author", backends=(BACKEND,)))
    assert {artefact.path: artefact.text for artefact in second.artefacts} == first
