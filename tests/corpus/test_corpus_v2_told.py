"""Our own text of SysML v2 of real models: what it loses is told, and it keeps the rules of v2.

Each difference between a model and what is read of its text belongs to an element of which the
back end has told a loss (SM730 to SM737); the models where some are not told yet are named with
their number, which may only fall.
"""

import gc

import pytest
from test_corpus_v2_text import read, units
from told_losses import untold

from sysmlc.backends.sysml.document import write_document
from sysmlc.backends.sysml.printing import print_lines
from sysmlc.diagnostics import Coverage, Severity, Sink
from sysmlc.driver import Request, compile_model, select_backends
from sysmlc.frontends.sysml import FRONTEND
from sysmlc.ir import Graph
from sysmlc.ir.compare import compare
from sysmlc.passes import pipeline
from sysmlc.sources import Source

pytestmark = pytest.mark.corpus

NOT_TOLD = {
    "aml/mtp_tud_minimal.aml": 1,
    "aml/opak_festo_v35.aml": 2,
    "aml/opak_festo_v35_plc.aml": 2,
    "ea/EAExport.xmi": 4,
    "magicdraw/App_test_JD_v2.mdzip": 1,
    "magicdraw/TMT-Models-and-Analysis-Profile.mdzip": 4,
    "magicdraw/Wired_Camera_Example.mdzip": 1,
    "md-eclipse-export/Arrowhead.profile.uml": 3,
    "papyrus/Arrowhead-5.0.uml": 3,
    "papyrus/ArrowheadProfile_v5.0.profile.uml": 4,
    "papyrus/AssertionLibrary.uml": 2,
    "papyrus/RoboCab.uml": 5,
}
"""Differences that are not told, by model."""
KNOWN_RULES = {
    "aml/eplan_arapc_example.aml": (
        {"SM284"},
        "a member that redefines with more values has the name of another inherited one",
    ),
    "magicdraw/Wired_Camera_Example.mdzip": (
        {"SM280"},
        "ends without names that both classes call alike",
    ),
    "md-eclipse-export/Arrowhead.profile.uml": (
        {"SM280"},
        "ends without names that both classes call alike",
    ),
    "omg/fUML_Library.xmi": ({"SM249"}, "the target of a call is no parameter of the operation"),
    "papyrus/Arrowhead-5.0.uml": (
        {"SM281"},
        "a feature subsets one of its own owner with fewer values",
    ),
    "papyrus/AssertionLibrary.uml": ({"SM225", "SM283"}, "flows across structured nodes"),
    "papyrus/TankBarrelExample.uml": (
        {"SM249"},
        "the target of a call is no parameter of the operation",
    ),
    "papyrus/TutoFMU.uml": ({"SM249"}, "the target of a call is no parameter of the operation"),
    "papyrus/fUML-Exception-Tests.uml": (
        {"SM249"},
        "the target of a call is no parameter of the operation",
    ),
    "papyrus/moka-master.uml": ({"SM249"}, "the target of a call is no parameter of the operation"),
}
"""Rules of v2 that the text of a model breaks, and why."""


def made(files):
    gc.unfreeze()
    return compile_model(Request(tuple(files), backends=tuple(select_backends(("ir",)))))


@pytest.mark.long
def test_every_difference_is_told_as_a_loss_of_its_element(corpus):
    found = {}
    for name, files in units(corpus).items():
        graph = made(files).graph
        writer, lines = write_document(graph)
        changes = compare(graph, read(print_lines(lines)), ("id",))
        found[name] = len(untold(graph, writer.losses.by_element, changes))
    assert {name: count for name, count in found.items() if count > NOT_TOLD.get(name, 0)} == {}
    assert sum(found.values()) == sum(NOT_TOLD.values())


def rules_of(text):
    """Codes of errors and warnings about a text."""
    graph, sink = Graph(), Sink()
    FRONTEND.read([Source("model.sysml", text.encode())], graph, sink, Coverage())
    pipeline.build_pipeline(("resolve", "inherit", "classify", "ports", "flows")).run(graph, sink)
    return {one.rule.code for one in sink if one.severity is not Severity.INFO}


@pytest.mark.long
def test_our_own_text_keeps_the_rules_of_sysml_v2(corpus):
    """What the model itself is told of, by rules of SysML v1, is no fault of the text."""
    found = {}
    for name, files in units(corpus).items():
        model = made(files)
        _, lines = write_document(model.graph)
        codes = rules_of(print_lines(lines)) - {one.rule.code for one in model.diagnostics}
        if codes:
            found[name] = codes
    assert found == {name: codes for name, (codes, _) in KNOWN_RULES.items()}
