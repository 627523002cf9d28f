"""Contracts of real models are realizable, and their checks report nothing suspicious."""

import re

import pytest

from examples.compiling import list_silent_contracts
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


def test_a_contract_of_the_laboratory_is_about_a_feature_or_says_why_it_is_not(laboratory):
    assert list_silent_contracts(laboratory) == []


def make_locator(graph):
    return lambda id: graph.subject(graph[id])


@pytest.mark.long
def test_every_contract_of_the_ice_laboratory_is_realizable_without_warnings(laboratory):
    contracts, sink = laboratory.derived(Contract), Sink()
    results = list(check_contracts(contracts, contracts, make_locator(laboratory), sink, Options()))
    verdicts = {result.verdict.component: result.verdict.is_realizable for result in results}
    assert len(verdicts) == 50
    assert [name for name, is_realizable in verdicts.items() if not is_realizable] == []
    assert [diagnostic.message for diagnostic in sink] == []


def test_machines_of_the_ice_laboratory_exchange_no_variables_of_their_contracts(laboratory):
    """The services call OPC UA methods; no connector and no flow leads to a behaviour."""
    sink = Sink()
    compositions = list(compose_blocks(laboratory, laboratory.derived(Contract), sink))
    results = [
        result.text()
        for result in check_compositions(compositions, make_locator(laboratory), sink, Options())
    ]
    assert results == [
        "PlantTopology::Cell1_FunctionalTesting: its 2 behaviours share no variables",
        "PlantTopology::Cell2_Milling: its 4 behaviours share no variables",
        "PlantTopology::Cell4_RoboticAssembly: its 10 behaviours share no variables",
        "PlantTopology::Cell5_QualityControl: its 2 behaviours share no variables",
        "PlantTopology::Cell6_Warehouse: its 3 behaviours share no variables",
        "PlantTopology::Cell7_ConveyorSystem: its 18 behaviours share no variables",
        "PlantTopology::ICEProductionLine: its 39 parts and behaviours share no variables",
        "PlantTopology::MobileLogistics: its 2 behaviours share no variables",
    ]
    assert {diagnostic.rule.code for diagnostic in sink} == {"SM508"}
    steps = [re.findall("'([^']*)'", diagnostic.message)[1] for diagnostic in sink]
    assert sorted(steps) == ["check"] * 4 + ["waitDone"] * 8
    (plant,) = (
        composition
        for composition in compositions
        if composition.component == "PlantTopology::ICEProductionLine"
    )
    parts = {part.name: part for part in plant.parts}
    assert "cell2" in parts
    assert "cell7.waitAckBay" in parts
    names = [v.name for part in plant.parts for v in part.contract.variables]
    assert len(names) == len(set(names))
