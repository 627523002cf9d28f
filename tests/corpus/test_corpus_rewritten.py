"""Real models of Papyrus, written again as the other tools write them, are the same graph."""

import pytest

from dialects.comparison import DIALECT_ATTRIBUTES, WRITERS, is_dialect_difference
from graph_differences import diff
from long_runs import quick_first
from sysmlc.diagnostics import Coverage, Sink
from sysmlc.frontends.xmi import FRONTEND
from sysmlc.ir import Graph
from sysmlc.passes import pipeline
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
"""Those in UML2 5.0 that write all types: what the writers start from."""
UNSAYABLE = {("Arrowhead-5.0.uml", "xmi"): "tag."}
"""Enterprise Architect's applications have no ids: no tag can name an application."""


def graph(name, data):
    made, sink = Graph(), Sink()
    FRONTEND.read([Source(name, data)], made, sink, Coverage())
    pipeline.build_pipeline(("resolve", "classify")).run(made, sink)
    return made


@pytest.mark.parametrize("dialect", ["xml", "xmi"])
@pytest.mark.parametrize("name", quick_first(MODELS, 2))
def test_a_real_model_is_the_same_in_every_dialect(corpus, name, dialect):
    papyrus = (corpus / "xmi" / "papyrus" / name).read_bytes()
    one = graph("model.uml", papyrus)
    other = graph(f"model.{dialect}", WRITERS[dialect](papyrus))
    assert len(one) > 80
    changes = diff(one, other, {"id", "source", "trace", *DIALECT_ATTRIBUTES})
    unsayable = UNSAYABLE.get((name, dialect), "nothing")
    assert [
        change
        for change in changes
        if not is_dialect_difference(change) and not change.detail.startswith(unsayable)
    ] == []
