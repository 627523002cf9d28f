"""Real plants are saved as UML or SysML v2 and then as AutomationML again, element by element."""

from collections import Counter

import pytest
from internal_elements import list_facts
from plants import list_units, load_unit, refine

from sysmlc.backends.aml import write_files
from sysmlc.backends.sysml import print_document
from sysmlc.backends.uml import write_document
from sysmlc.diagnostics import Sink
from sysmlc.frontends.sysml import FRONTEND as SYSML
from sysmlc.frontends.xmi import FRONTEND as XMI
from sysmlc.sources import Source

pytestmark = pytest.mark.corpus

MOVED_LINK = "an allocation is in the definition of both features, in SysML v2"
"""Links between a process and a resource become allocations; their owner is the nearest one."""
NO_ID = "an ID that the file lacks is computed from the id in the model, which is another one then"
DIFFERENCES = {
    ("uml", "minimal_AutomationMLComponent_WithDocuments.amlx"): ({"interface": 3}, NO_ID),
    ("uml", "sap_automation_component.aml"): ({"element": 14, "interface": 7}, NO_ID),
    ("sysml", "minimal_AutomationMLComponent_WithDocuments.amlx"): ({"interface": 3}, NO_ID),
    ("sysml", "sap_automation_component.aml"): ({"element": 14, "interface": 7}, NO_ID),
    ("sysml", "amlsec_casestudy_a.aml"): ({"link": 1}, MOVED_LINK),
    ("sysml", "amlsec_casestudy_d.aml"): ({"link": 6}, MOVED_LINK),
}
"""Number of the differences by subject, and their reason."""


def read_from_uml(graph):
    return refine([Source("plant.uml", write_document(graph, Sink()).encode())], XMI)


def read_from_sysml(graph):
    return refine([Source("plant.sysml", print_document(graph, Sink())[0].encode())], SYSML)


WAYS = {"uml": read_from_uml, "sysml": read_from_sysml}


@pytest.fixture(scope="module")
def plants(corpus):
    """Return the graph of each unit, and the facts of its AutomationML."""
    graphs = {name: refine(load_unit(corpus, paths)) for name, paths in list_units(corpus).items()}
    return {
        name: (graph, list_facts(write_files(graph, "plant", Sink()).values()))
        for name, graph in graphs.items()
    }


@pytest.mark.long
@pytest.mark.parametrize("way", WAYS)
def test_internal_elements_survive_the_way_back(way, plants):
    """Names, IDs, classes, roles, attributes with values and units, interfaces and links."""
    changes, total = {}, 0
    for name, (graph, before) in plants.items():
        after = list_facts(write_files(WAYS[way](graph), "plant", Sink()).values())
        total += sum(subject == "element" for _, subject, *_ in before.elements())
        lost, added = before - after, after - before
        counts = Counter(subject for _, subject, *_ in lost.elements())
        if lost or added:
            assert counts == Counter(subject for _, subject, *_ in added.elements()), name
            changes[way, name] = dict(counts)
    expected = {key: counts for key, (counts, _) in DIFFERENCES.items() if key[0] == way}
    assert total > 4_600
    assert changes == expected
