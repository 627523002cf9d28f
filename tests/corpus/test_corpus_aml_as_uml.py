"""Real plants are saved as UML and read back; every difference has a reason."""

from collections import Counter

import pytest
from plants import list_baygate, list_units, load_unit, refine

from graph_differences import diff
from sysmlc.backends.uml import write_document
from sysmlc.diagnostics import Sink
from sysmlc.frontends.xmi import FRONTEND
from sysmlc.ir.verify import verify
from sysmlc.sources import Source

pytestmark = pytest.mark.corpus

IGNORED = {"id", "source", "trace", "caex_id"}
RESPELT_ID = "a value names an ID that xmi:id does not allow, so another id is written"


KEPT_TEXT = "a value of an interface names an ID; it stays as it is, as the IDs come back too"


def save(graph):
    sink = Sink()
    return write_document(graph, sink), Counter(diagnostic.rule.code for diagnostic in sink)


def read_back(text):
    graph = refine([Source("model.uml", text.encode())], FRONTEND)
    assert verify(graph) == []
    return graph


@pytest.mark.long
def test_every_difference_after_reading_back_has_a_reason(corpus, golden):
    lines = []
    for name, paths in sorted(list_units(corpus).items()):
        graph = refine(load_unit(corpus, paths))
        text, codes = save(graph)
        assert set(codes) <= {"SM723", "SM724", "SM726", "SM747"}, name
        changes = diff(graph, read_back(text), IGNORED)
        reasons = Counter(find_reason(graph, change) for change in changes)
        assert (reasons[RESPELT_ID] > 0) == ("SM747" in codes), name
        lines.append(f"{name}: {len(graph)} elements, {len(changes)} differences")
        lines += [f"  {count} {reason}" for reason, count in sorted(reasons.items())]
    assert len([line for line in lines if not line.startswith(" ")]) == 34
    assert [line for line in lines if "without a reason" in line] == []
    golden.check("aml-uml", {"corpus.txt": "\n".join(lines) + "\n"})


def find_reason(graph, change):
    key, _, values = change.detail.partition(": ")
    before, _, after = values.rpartition(" -> ")
    is_value = change.what == "attribute" and key in ("default", "value")
    if is_value and "Kind." in before and after.strip("'") in graph:
        return RESPELT_ID
    if change.what == "attribute" and key.startswith("value.") and "Kind." in before:
        return KEPT_TEXT
    return f"without a reason: {change}"


@pytest.mark.parametrize("name", ["BayGate.aml", "BayGate.amlx", "BayGate_extlibs.aml"])
def test_baygate_is_read_back_without_differences(name, corpus):
    graph = refine(load_unit(corpus, list_baygate(corpus)[name]))
    assert diff(graph, read_back(save(graph)[0]), IGNORED) == []


@pytest.mark.parametrize("old", [' name="length"', "xs:double", "system-unit-class-lib"])
def test_the_comparison_detects_a_difference(old, corpus):
    graph = refine(load_unit(corpus, list_baygate(corpus)["BayGate.aml"]))
    text, _ = save(graph)
    assert old in text
    changed = text.replace(old, old.replace("t", "d").replace("d", "x"), 1)
    assert changed != text
    assert diff(graph, read_back(changed), IGNORED) != []
