"""The SysML v2 text of real models: a faithful round trip, reported losses, and the rules of v2.

The text is the output of ``--emit +sysml`` for the XMI and AutomationML of the corpus. The first
writing reports its losses (SM730 to SM737, docs/write-sysml-v2.md): each difference between a model
and its text belongs to an element with a loss. The second writing may lose nothing.
"""

import pytest
from plants import list_baygate
from reading_corpus import lower
from reported_losses import find_unreported

from sysmlc.backends.sysml import print_document, write_document
from sysmlc.backends.sysml.printing import print_lines
from sysmlc.diagnostics import Severity, Sink
from sysmlc.driver import Request, compile_model, select_backends
from sysmlc.frontends.sysml import FRONTEND
from sysmlc.ir.compare import compare
from sysmlc.sources import Source

pytestmark = pytest.mark.corpus

PASSES = ("resolve", "inherit", "classify", "ports", "flows")
LARGEST = 300 * 1024
"""Bytes of the largest model; larger ones take seconds each and add no new constructs."""
UNREPORTED = {
    "ea/EAExport.xmi": 3,
    "magicdraw/TMT-Models-and-Analysis-Profile.mdzip": 1,
    "papyrus/AssertionLibrary.uml": 1,
}
"""Number of unreported differences by model; the table may only shrink."""
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
    "magicdraw/TestProject2.mdzip": ({"SM244"}, "flows between ports of unrelated types"),
    "papyrus/AssertionLibrary.uml": (
        {"SM244", "SM283"},
        "flows across structured nodes, and between numbers of unrelated types",
    ),
    "papyrus/TankBarrelExample.uml": (
        {"SM244", "SM249"},
        "self is the action, and the target of a call is no parameter of the operation",
    ),
    "papyrus/TutoFMU.uml": (
        {"SM244", "SM249"},
        "self is the action, and the target of a call is no parameter of the operation",
    ),
    "papyrus/fUML-Exception-Tests.uml": (
        {"SM249"},
        "the target of a call is no parameter of the operation",
    ),
    "papyrus/moka-master.uml": ({"SM249"}, "the target of a call is no parameter of the operation"),
}
"""Rules of v2 that the text of a model violates, and why."""


def list_units(corpus):
    """Map the names of units to their files."""
    folder = corpus / "xmi"
    models = [path for path in sorted(folder.glob("*/*")) if path.suffix not in (".md", ".ecore")]
    units = {path.relative_to(folder).as_posix(): [path] for path in models}
    units |= {f"aml/{name}": files for name, files in list_baygate(corpus).items()}
    units |= {f"aml/{path.name}": [path] for path in sorted((corpus / "aml/dev").iterdir())}
    return {
        name: files
        for name, files in units.items()
        if sum(file.stat().st_size for file in files) <= LARGEST
    }


def compile_unit(files):
    return compile_model(Request(tuple(files), backends=tuple(select_backends(("ir",)))))


def read_text(text):
    """Return the graph of a text in SysML v2, and its diagnostics."""
    return lower([Source("model.sysml", text.encode())], PASSES, FRONTEND)


def find_differences(files):
    """Return the differences between the text of a model and the text of that text."""
    text, _ = print_document(compile_unit(files).graph, Sink())
    first, _ = read_text(text)
    second, _ = read_text(print_document(first, Sink())[0])
    return [str(change) for change in compare(first, second, ("id", "declaration"))]


@pytest.mark.long
def test_text_that_is_read_and_written_again_is_the_same_model(corpus):
    differences = {name: find_differences(files) for name, files in list_units(corpus).items()}
    assert len(differences) == 64
    assert {name: changes for name, changes in differences.items() if changes} == {}


@pytest.mark.long
def test_every_difference_is_reported_as_a_loss_of_its_element(corpus):
    counts = {}
    for name, files in list_units(corpus).items():
        graph = compile_unit(files).graph
        writer, lines = write_document(graph)
        changes = compare(graph, read_text(print_lines(lines))[0], ("id",))
        counts[name] = len(find_unreported(graph, writer.losses.by_element, changes))
    assert {name: count for name, count in counts.items() if count > UNREPORTED.get(name, 0)} == {}
    assert sum(counts.values()) == sum(UNREPORTED.values())


def find_violations(text):
    """Return the codes of errors and warnings about a text."""
    _, sink = read_text(text)
    return {diagnostic.rule.code for diagnostic in sink if diagnostic.severity is not Severity.INFO}


@pytest.mark.long
def test_the_text_follows_the_rules_of_sysml_v2(corpus):
    """Violations of rules that the model itself violates are not faults of the text."""
    violations = {}
    for name, files in list_units(corpus).items():
        model = compile_unit(files)
        _, lines = write_document(model.graph)
        own_codes = {diagnostic.rule.code for diagnostic in model.diagnostics}
        codes = find_violations(print_lines(lines)) - own_codes
        if codes:
            violations[name] = codes
    assert violations == {name: codes for name, (codes, _) in KNOWN_RULES.items()}
