"""Real models: every diagram that is emitted renders, none is too large, nothing is lost."""

import re

import pytest
from diagrams import emitted

from long_runs import quick_first
from sysmlc.backends.plantuml.partitioning import MAX_BOXES
from sysmlc.diagnostics import Coverage, Sink
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
def test_a_real_model_renders(path, corpus, plantuml):
    graph = _compiled(corpus / "xmi" / path)
    files, sink = emitted(graph)
    assert files
    assert len(plantuml.render({file.path: file.text for file in files})) == len(files)
    crowded = [file.path for file in files if len(_BOX.findall(file.text)) > _MANY_NEIGHBOURS]
    assert crowded == []
    _check_nothing_is_lost(graph, {id for file in files for id in file.trace}, sink)


def _check_nothing_is_lost(graph: Graph, shown: set[str], sink: Sink) -> None:
    """Every block, port, action and state is in a diagram, or a finding covers its owner."""
    counted = sum(int(found.message.split()[0]) for found in sink)
    kinds = (Kind.CLASS, Kind.PORT, Kind.ACTION, Kind.CONTROL, Kind.STATE, Kind.TRANSITION)
    lost = [item for item in graph.of_kind(*kinds) if item.id not in shown]
    lost = [item for item in lost if not item.attrs.get("external")]
    inside = [item for item in lost if any(a.attrs.get("external") for a in graph.ancestors(item))]
    assert len(lost) - len(inside) <= counted


def _compiled(path) -> Graph:
    graph, sink = Graph(), Sink()
    FRONTEND.read(
        read_unit([path], path.parent, [FRONTEND], sink).sources(), graph, sink, Coverage()
    )
    pipeline.run(graph, sink, until="behaviours")
    return graph
