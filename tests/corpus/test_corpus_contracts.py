"""Contracts of real models can be kept, and nothing in them or between them is suspicious."""

import re

import pytest

from sysmlc.diagnostics import Sink
from sysmlc.driver import Request, compile_model
from sysmlc.logic.composition.derivation import compose_blocks
from sysmlc.logic.contract import Contract
from sysmlc.synthesis.composition_check import check_compositions
from sysmlc.synthesis.contract_checks import check_contracts
from sysmlc.synthesis.decision import Options

pytestmark = pytest.mark.corpus


@pytest.fixture(scope="module")
def laboratory(corpus):
    return compile_model(Request((corpus / "sysml2" / "ice-lab",))).graph


def place(graph):
    return lambda id: graph.subject(graph[id])


@pytest.mark.long
def test_every_contract_of_the_ice_laboratory_can_be_kept_and_none_is_suspicious(laboratory):
    found, sink = laboratory.derived(Contract), Sink()
    results = list(check_contracts(found, found, place(laboratory), sink, Options()))
    verdicts = {one.verdict.component: one.verdict.is_realizable for one in results}
    assert len(verdicts) == 50
    assert [name for name, is_kept in verdicts.items() if not is_kept] == []
    assert [one.message for one in sink] == []


def test_machines_of_the_ice_laboratory_exchange_nothing_that_a_contract_speaks_of(laboratory):
    """Its services call OPC UA methods; connectors and flows lead to no behaviour."""
    sink = Sink()
    made = list(compose_blocks(laboratory, laboratory.derived(Contract), sink))
    told = [one.text() for one in check_compositions(made, place(laboratory), sink, Options())]
    assert told == [
        "PlantTopology::Cell1_FunctionalTesting: its 2 parts are not connected",
        "PlantTopology::Cell2_Milling: its 4 parts are not connected",
        "PlantTopology::Cell4_RoboticAssembly: its 10 parts are not connected",
        "PlantTopology::Cell5_QualityControl: its 2 parts are not connected",
        "PlantTopology::Cell6_Warehouse: its 3 parts are not connected",
        "PlantTopology::Cell7_ConveyorSystem: its 18 parts are not connected",
        "PlantTopology::ICEProductionLine: its 39 parts are not connected",
        "PlantTopology::MobileLogistics: its 2 parts are not connected",
    ]
    assert {one.rule.code for one in sink} == {"SM508"}
    steps = [re.findall("'([^']*)'", one.message)[1] for one in sink]
    assert sorted(steps) == ["check"] * 4 + ["waitDone"] * 8
    (whole,) = (one for one in made if one.component == "PlantTopology::ICEProductionLine")
    line = {one.name: one for one in whole.parts}
    assert "cell2" in line
    assert "cell7.waitAckBay" in line
    names = [v.name for part in whole.parts for v in part.contract.variables]
    assert len(names) == len(set(names))
