"""The back end ``sysmlx`` writes v2 inputs directly, and other models from their v2 text."""

from uuid import NAMESPACE_URL, uuid5

import pytest

import backend_runs
from sysml_metamodel import count_ids, count_with_metamodel
from sysmlc.backends.base import EmitOptions, InputFile
from sysmlc.backends.sysmlx import BACKEND
from sysmlc.diagnostics import Coverage, Sink
from sysmlc.driver import Request, compile_model
from sysmlc.frontends.sysml import FRONTEND
from sysmlc.ir import Graph
from sysmlc.ir.text import parse_text
from sysmlc.language.interchange import link, read
from sysmlc.sources import Source

SCALARS = uuid5(NAMESPACE_URL, "https://www.omg.org/spec/KerML/ScalarValues")
REAL = uuid5(SCALARS, "ScalarValues::Real")
"""The id of a library element as KerML 1.0, 9.1, derives it."""

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


def read_v2(*files):
    graph, sink = Graph(), Sink()
    sources = [Source(path, text.encode()) for path, text in files]
    FRONTEND.read(sources, graph, sink, Coverage())
    inputs = tuple(InputFile(path, "", "sysml") for path, _ in files)
    return graph, inputs


def emit(graph, inputs=()):
    """Return the interchange files by path, and the codes of the diagnostics."""
    artefacts, diagnostics = backend_runs.emit(BACKEND, graph, EmitOptions(inputs=inputs))
    files = {path: artefact.text for path, artefact in artefacts.items()}
    return files, [diagnostic.rule.code for diagnostic in diagnostics]


def read_interchange(files):
    sink = Sink()
    documents = [read(Source(path, text.encode()), sink) for path, text in files.items()]
    link(documents, sink)
    assert [diagnostic.message for diagnostic in sink] == []
    return documents


def test_each_file_of_a_v2_model_becomes_an_interchange_file():
    graph, inputs = read_v2(("cells/cell.sysml", CELL), ("robots.sysml", ROBOTS))
    files, codes = emit(graph, inputs)
    assert (list(files), codes) == (["sysmlx/cells/cell.sysmlx", "sysmlx/robots.sysmlx"], [])
    assert 'href="../robots.sysmlx#' in files["sysmlx/cells/cell.sysmlx"]
    cells, robots = read_interchange(files)
    (arm,) = (node for node in cells.root.walk() if node.name == "arm")
    (robot,) = (node for node in robots.root.walk() if node.name == "Robot")
    assert arm.relations[0].reference.target is robot


def test_references_to_the_standard_library_lead_to_its_released_files():
    files, _ = emit(*read_v2(("robots.sysml", ROBOTS)))
    text = files["sysmlx/robots.sysmlx"]
    assert 'href="sysml.library.xmi/' in text
    assert f"ScalarValues.kermlx#{REAL}" in text


def test_reading_the_interchange_file_gives_the_same_graph():
    graph, inputs = read_v2(("robots.sysml", ROBOTS))
    files, _ = emit(graph, inputs)
    (path, text), graph_read_back = next(iter(files.items())), Graph()
    FRONTEND.read([Source(path, text.encode())], graph_read_back, Sink(), Coverage())
    assert list_names(graph_read_back) == list_names(graph)


def list_names(graph):
    return sorted((str(element.kind), graph.qualified_name(element)) for element in graph)


def test_other_models_are_written_from_their_v2_text():
    graph = parse_text('Package p "Plant"\n  Class a "Gate"\n    Property b "open"\n')
    files, _ = emit(graph)
    (document,) = read_interchange(files)
    assert next((node.kind, node.name) for node in document.root.walk() if node.name) == (
        "Package",
        "Plant",
    )
    assert "Gate" in {node.name for node in document.root.walk()}


def test_losses_of_the_text_are_reported():
    graph = parse_text('Package p "Plant"\n  Class a "A"\n    TemplateParameter t ""\n')
    assert emit(graph)[1] == ["SM730"]


@pytest.mark.long
@pytest.mark.corpus
def test_the_ice_laboratory_is_valid_for_the_metamodel(corpus, tmp_path):
    folder = corpus / "sysml2/ice-lab"
    paths = sorted(folder.rglob("*.sysml"))
    graph, inputs = read_v2(
        *((path.relative_to(folder).as_posix(), path.read_text("utf-8")) for path in paths)
    )
    files, codes = emit(graph, inputs)
    assert (len(files), set(codes)) == (18, {"SM758"})
    # Eight of the 18 files, because pyecore is slow.
    files = dict(list(files.items())[:8])
    assert count_with_metamodel(files, tmp_path, corpus) == count_ids(files)


@pytest.mark.corpus
@pytest.mark.parametrize(
    "name", ["ArrowheadProfile_v5.0.profile.uml", "SmartCityDSL-2.uml", "TankBarrelExample.uml"]
)
def test_models_of_other_languages_have_no_broken_references(name, corpus):
    compilation = compile_model(Request((corpus / "xmi/papyrus" / name,)))
    files, codes = emit(compilation.graph)
    assert "SM758" not in codes
    assert len(list(read_interchange(files)[0].root.walk())) > 100


def nest_packages(depth):
    rows = (f'{"  " * level}Package p{level} "P{level}"' for level in range(depth))
    return parse_text("\n".join(rows) + "\n")


def test_a_model_nested_deeper_than_the_parser_allows_is_reported():
    assert emit(nest_packages(202)) == ({}, ["SM748"])


def test_a_model_nested_as_deep_as_the_parser_allows_is_written():
    files, codes = emit(nest_packages(200))
    assert list(files) == ["sysmlx/P0.sysmlx"]
    assert codes == []


class FaultyBackend:
    """A text back end whose text has a syntax error."""

    def emit(self, _graph, output, _sink, _options):
        output.add("sysml/plant.sysml", "package Plant {\n  part def Gate { part : ; }\n}\n")


def test_a_syntax_error_in_the_text_is_reported_at_its_element(monkeypatch):
    monkeypatch.setattr("sysmlc.backends.sysmlx.TEXT", FaultyBackend())
    graph = parse_text('Package plant "Plant"\n  Class gate "Gate"\n')
    artefacts, (diagnostic,) = backend_runs.emit(BACKEND, graph)
    assert artefacts == {}
    assert (diagnostic.rule.code, diagnostic.subject.name) == ("SM749", "Plant::Gate")
    assert diagnostic.message.startswith(
        "the SysML v2 text generated for 'Gate' cannot be read (line 2: unexpected ';'"
    )
