"""The back end ``sysmlx``: v2 inputs as their syntax says them, others as their text would."""

from uuid import NAMESPACE_URL, uuid5

import pytest

from sysmlc.backends.base import EmitOptions, InputFile
from sysmlc.backends.sysmlx import BACKEND
from sysmlc.diagnostics import Coverage, Sink
from sysmlc.driver import Request, compile_model
from sysmlc.frontends.sysml import FRONTEND
from sysmlc.ir import Graph
from sysmlc.ir.text import parse_text
from sysmlc.language.interchange import link, read
from sysmlc.sources import Source
from sysmlc.support.output import Output

SCALARS = uuid5(NAMESPACE_URL, "https://www.omg.org/spec/KerML/ScalarValues")
REAL = uuid5(SCALARS, "ScalarValues::Real")
"""As KerML 1.0, 9.1, gives ids to the elements of its libraries."""

ROBOTS = """\
package Robots {
    private import ScalarValues::Real;
    part def Robot {
        attribute reach : Real = 1.5;
        port tool : ~Tool;
    }
    port def Tool;
}
"""
CELL = """\
package Cells {
    private import Robots::*;
    part def Cell {
        part arm : Robot[2];
    }
}
"""


def compiled(*files):
    graph, sink = Graph(), Sink()
    sources = [Source(path, text.encode()) for path, text in files]
    FRONTEND.read(sources, graph, sink, Coverage())
    inputs = tuple(InputFile(path, "", "sysml") for path, _ in files)
    return graph, inputs


def emitted(graph, inputs=()):
    output, sink = Output(), Sink()
    BACKEND.emit(graph, output, sink, EmitOptions(inputs=inputs))
    return {one.path: one.text for one in output.artefacts()}, [one.rule.code for one in sink]


def again(files):
    sink = Sink()
    documents = [read(Source(path, text.encode()), sink) for path, text in files.items()]
    link(documents, sink)
    assert [found.message for found in sink] == []
    return documents


def test_each_file_of_a_v2_model_becomes_one_of_its_own():
    graph, inputs = compiled(("cells/cell.sysml", CELL), ("robots.sysml", ROBOTS))
    files, codes = emitted(graph, inputs)
    assert (list(files), codes) == (["sysmlx/cells/cell.sysmlx", "sysmlx/robots.sysmlx"], [])
    assert 'href="../robots.sysmlx#' in files["sysmlx/cells/cell.sysmlx"]
    cells, robots = again(files)
    (arm,) = (node for node in cells.root.walk() if node.name == "arm")
    (robot,) = (node for node in robots.root.walk() if node.name == "Robot")
    assert arm.relations[0].reference.target is robot


def test_references_to_the_standard_library_lead_to_its_released_files():
    files, _ = emitted(*compiled(("robots.sysml", ROBOTS)))
    text = files["sysmlx/robots.sysmlx"]
    assert 'href="sysml.library.xmi/' in text
    assert f"ScalarValues.kermlx#{REAL}" in text


def test_what_was_written_is_read_to_the_same_graph():
    graph, inputs = compiled(("robots.sysml", ROBOTS))
    files, _ = emitted(graph, inputs)
    (path, text), read_again = next(iter(files.items())), Graph()
    FRONTEND.read([Source(path, text.encode())], read_again, Sink(), Coverage())
    assert names(read_again) == names(graph)


def names(graph):
    return sorted((str(one.kind), graph.qualified_name(one)) for one in graph)


def test_other_models_are_written_as_their_text_would_be():
    graph = parse_text('Package p "Plant"\n  Class a "Gate"\n    Property b "open"\n')
    files, _ = emitted(graph)
    (document,) = again(files)
    assert next((node.kind, node.name) for node in document.root.walk() if node.name) == (
        "Package",
        "Plant",
    )
    assert "Gate" in {node.name for node in document.root.walk()}


def test_what_the_text_cannot_say_is_told():
    graph = parse_text('Package p "Plant"\n  Class a "A"\n    TemplateParameter t ""\n')
    assert emitted(graph)[1] == ["SM730"]


@pytest.mark.long
@pytest.mark.corpus
def test_the_ice_laboratory_is_valid_for_the_metamodel(corpus, tmp_path):
    from pyecore.resources import URI, ResourceSet

    folder = corpus / "sysml2/ice-lab"
    paths = sorted(folder.rglob("*.sysml"))
    graph, inputs = compiled(
        *((path.relative_to(folder).as_posix(), path.read_text("utf-8")) for path in paths)
    )
    files, codes = emitted(graph, inputs)
    assert (len(files), set(codes)) == (18, {"SM758"})
    resources = ResourceSet()
    metamodel = corpus / "sysml2/interchange/metamodel/SysML.ecore"
    package = resources.get_resource(URI(str(metamodel))).contents[0]
    resources.metamodel_registry[package.nsURI] = package
    for path, text in list(files.items())[:8]:
        file = tmp_path / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, "utf-8")
        (root,) = resources.get_resource(URI(str(file))).contents
        assert sum(1 for _ in root.eAllContents()) == text.count("xmi:id=") - 1


@pytest.mark.corpus
@pytest.mark.parametrize(
    "name", ["ArrowheadProfile_v5.0.profile.uml", "SmartCityDSL-2.uml", "TankBarrelExample.uml"]
)
def test_models_of_other_languages_are_said_without_a_broken_reference(name, corpus):
    made = compile_model(Request((corpus / "xmi/papyrus" / name,)))
    files, codes = emitted(made.graph)
    assert "SM758" not in codes
    assert len(list(again(files)[0].root.walk())) > 100


def nested(depth):
    rows = (f'{"  " * level}Package p{level} "P{level}"' for level in range(depth))
    return parse_text("\n".join(rows) + "\n")


def test_what_is_nested_deeper_than_text_is_read_is_not_written_but_told():
    assert emitted(nested(202)) == ({}, ["SM748"])


def test_what_is_nested_as_deep_as_text_is_read_is_written():
    files, codes = emitted(nested(200))
    assert list(files) == ["sysmlx/P0.sysmlx"]
    assert codes == []


class Wrong:
    """A writer of text that makes a mistake."""

    def emit(self, _graph, output, _sink, _options):
        output.add("sysml/plant.sysml", "package Plant {\n  part def Gate { part : ; }\n}\n")


def test_an_error_in_the_text_of_our_own_is_told_at_its_element(monkeypatch):
    monkeypatch.setattr("sysmlc.backends.sysmlx.backend.TEXT", Wrong())
    graph = parse_text('Package plant "Plant"\n  Class gate "Gate"\n')
    output, sink = Output(), Sink()
    BACKEND.emit(graph, output, sink, EmitOptions())
    assert output.artefacts() == []
    (found,) = sink
    assert (found.rule.code, found.subject.name) == ("SM749", "Plant::Gate")
    assert found.message.startswith(
        "the text that says 'Gate' in SysML v2 cannot be read (line 2: ';' "
    )
