"""The SysML v2 text of real models: losses are reported, and the text keeps the rules of v2.

Each difference between a model and its text read back belongs to an element for which the back end
reports a loss (SM730 to SM737). Models with unreported differences are listed with their number,
which may only fall.
"""

import gc

import pytest
from reported_losses import find_unreported
from test_corpus_v2_text import read, units

from sysmlc.backends.sysml.backend import write_document
from sysmlc.backends.sysml.printing import print_lines
from sysmlc.diagnostics import Coverage, Severity, Sink
from sysmlc.driver import Request, compile_model, select_backends
from sysmlc.frontends.sysml import FRONTEND
from sysmlc.ir import Graph
from sysmlc.ir.compare import compare
from sysmlc.passes import pipeline
from sysmlc.sources import Source

pytestmark = pytest.mark.corpus

UNREPORTED = {
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
    "papyrus/RoboCab.uml": 3,
}
"""Number of unreported differences by model."""
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
"""Rules of v2 that the text of a model violates, and why."""


def compile_unit(files):
    gc.unfreeze()
    return compile_model(Request(tuple(files), backends=tuple(select_backends(("ir",)))))


@pytest.mark.long
def test_every_difference_is_reported_as_a_loss_of_its_element(corpus):
    counts = {}
    for name, files in units(corpus).items():
        graph = compile_unit(files).graph
        writer, lines = write_document(graph)
        changes = compare(graph, read(print_lines(lines)), ("id",))
        counts[name] = len(find_unreported(graph, writer.losses.by_element, changes))
    assert {name: count for name, count in counts.items() if count > UNREPORTED.get(name, 0)} == {}
    assert sum(counts.values()) == sum(UNREPORTED.values())


def find_violations(text):
    """Return the codes of errors and warnings about a text."""
    graph, sink = Graph(), Sink()
    FRONTEND.read([Source("model.sysml", text.encode())], graph, sink, Coverage())
    pipeline.build_pipeline(("resolve", "inherit", "classify", "ports", "flows")).run(graph, sink)
    return {diagnostic.rule.code for diagnostic in sink if diagnostic.severity is not Severity.INFO}


@pytest.mark.long
def test_the_text_keeps_the_rules_of_sysml_v2(corpus):
    """A rule of SysML v1 that the model violates is no fault of the text."""
    violations = {}
    for name, files in units(corpus).items():
        model = compile_unit(files)
        _, lines = write_document(model.graph)
        own_codes = {diagnostic.rule.code for diagnostic in model.diagnostics}
        codes = find_violations(print_lines(lines)) - own_codes
        if codes:
            violations[name] = codes
    assert violations == {name: codes for name, (codes, _) in KNOWN_RULES.items()}
