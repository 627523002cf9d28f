"""The SysML v2 text of real models: a faithful round trip, reported losses, and the rules of v2.

The text is the output of ``--emit +sysml`` for the XMI and AutomationML of the corpus. The first
writing reports its losses (SM730 to SM737, docs/write-sysml-v2.md): each difference between a model
and its text belongs to an element with a loss. The second writing may lose nothing.
"""

from dataclasses import dataclass

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


@dataclass(frozen=True)
class WrittenUnit:
    """What was found when a unit was written as text, read, written and read again."""

    differences: list[str]
    """Differences between the graphs of the two texts."""
    unreported: int
    """Differences between the model and its text without a loss of the element."""
    violated: set[str]
    """Codes of errors and warnings about the text that the model itself does not have."""


def write_unit(files):
    model = compile_unit(files)
    writer, lines = write_document(model.graph)
    first, sink = read_text(print_lines(lines))
    second, _ = read_text(print_document(first, Sink())[0])
    changes = compare(model.graph, first, ("id",))
    codes = {found.rule.code for found in sink if found.severity is not Severity.INFO}
    return WrittenUnit(
        [str(change) for change in compare(first, second, ("id", "declaration"))],
        len(find_unreported(model.graph, writer.losses.by_element, changes)),
        codes - {found.rule.code for found in model.diagnostics},
    )


@pytest.fixture(scope="module")
def written_units(corpus):
    return {name: write_unit(files) for name, files in list_units(corpus).items()}


@pytest.mark.long
def test_text_that_is_read_and_written_again_is_the_same_model(written_units):
    assert len(written_units) == 64
    assert {
        name: unit.differences for name, unit in written_units.items() if unit.differences
    } == {}


@pytest.mark.long
def test_every_difference_is_reported_as_a_loss_of_its_element(written_units):
    counts = {name: unit.unreported for name, unit in written_units.items() if unit.unreported}
    assert counts == UNREPORTED


@pytest.mark.long
def test_the_text_follows_the_rules_of_sysml_v2(written_units):
    """Violations of rules that the model itself violates are not faults of the text."""
    violations = {name: unit.violated for name, unit in written_units.items() if unit.violated}
    assert violations == {name: codes for name, (codes, _) in KNOWN_RULES.items()}
