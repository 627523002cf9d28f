"""Real models of Papyrus have the same graph in the dialects of other tools."""

import pytest
from reading_corpus import lower

from dialects.comparison import DIALECT_ATTRIBUTES, WRITERS, is_dialect_difference
from graph_differences import diff
from long_runs import quick_first
from sysmlc.sources import Source

pytestmark = pytest.mark.corpus

MODELS = (
    "Arrowhead-5.0.uml",
    "ArrowheadPrinciples.uml",
    "AssertionLibrary.uml",
    "CraneModel.uml",
    "SmartCityDSL-2.uml",
    "Studio4EducationAHTModel.uml",
    "TankBarrelExample.uml",
    "TutoFMU.uml",
    "moka-master.uml",
)
"""Models in UML2 5.0 with all types, which the translators require."""
UNAVOIDABLE = {("Arrowhead-5.0.uml", "xmi"): "tag."}
"""Differences that a dialect cannot avoid: applications of Enterprise Architect have no ids."""


def read_graph(name, data):
    return lower([Source(name, data)], ("resolve", "classify"))[0]


@pytest.mark.parametrize("dialect", ["xml", "xmi"])
@pytest.mark.parametrize("name", quick_first(MODELS, 2))
def test_a_real_model_has_the_same_graph_in_every_dialect(corpus, name, dialect):
    papyrus = (corpus / "xmi" / "papyrus" / name).read_bytes()
    original = read_graph("model.uml", papyrus)
    translated = read_graph(f"model.{dialect}", WRITERS[dialect](papyrus))
    assert len(original) > 80
    changes = diff(original, translated, {"id", "source", "trace", *DIALECT_ATTRIBUTES})
    unavoidable = UNAVOIDABLE.get((name, dialect), "nothing")
    assert [
        change
        for change in changes
        if not is_dialect_difference(change) and not change.detail.startswith(unavoidable)
    ] == []
