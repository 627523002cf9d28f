"""Diagrams of real models are rendered, are not too large, and omit nothing silently."""

import re

import pytest
from diagrams import emit

from long_runs import quick_first
from sysmlc.backends.plantuml.partitioning import MAX_BOXES
from sysmlc.diagnostics import Coverage, Diagnostic, Sink
from sysmlc.driver.reading import read_unit
from sysmlc.frontends.xmi import FRONTEND
from sysmlc.ir import Graph, Kind
from sysmlc.passes import pipeline

MODELS = (
    "papyrus/Arrowhead-5.0.uml",
    "papyrus/AllDiagrams.uml",
    "papyrus/CraneModel.uml",
    "papyrus/TankBarrelExample.uml",
    "papyrus/fUML-Tests.uml",
    "papyrus/fUML-Exception-Tests.uml",
    "papyrus/AssertionLibrary.uml",
    "magicdraw/Tank_control_2.mdzip",
    "magicdraw/Wired_Camera_Example.mdzip",
)
_BOX = re.compile(r'^(?:class|state|rectangle) "', re.MULTILINE)
_MANY_NEIGHBOURS = 2 * MAX_BOXES


@pytest.mark.corpus
@pytest.mark.plantuml
@pytest.mark.parametrize("path", quick_first(MODELS))
def test_a_real_model_is_rendered_completely(path, corpus, plantuml):
    graph = refine(corpus / "xmi" / path)
    files, diagnostics = emit(graph)
    assert files
    assert len(plantuml.render({file.path: file.text for file in files})) == len(files)
    crowded = [file.path for file in files if len(_BOX.findall(file.text)) > _MANY_NEIGHBOURS]
    assert crowded == []
    check_every_element_is_drawn_or_counted(
        graph, {id for file in files for id in file.trace}, diagnostics
    )


def check_every_element_is_drawn_or_counted(
    graph: Graph, drawn_ids: set[str], diagnostics: list[Diagnostic]
) -> None:
    """Assert that every block, port, action and state is drawn, or counted in a diagnostic."""
    count = sum(int(diagnostic.message.split()[0]) for diagnostic in diagnostics)
    kinds = (Kind.CLASS, Kind.PORT, Kind.ACTION, Kind.CONTROL, Kind.STATE, Kind.TRANSITION)
    missing = [
        element
        for element in graph.of_kind(*kinds)
        if element.id not in drawn_ids
        and not any(owner.attrs.get("external") for owner in (element, *graph.ancestors(element)))
    ]
    assert len(missing) <= count


def refine(path) -> Graph:
    graph, sink = Graph(), Sink()
    FRONTEND.read(
        read_unit([path], path.parent, [FRONTEND], sink).sources(), graph, sink, Coverage()
    )
    pipeline.run(graph, sink, until="behaviours")
    return graph
