"""The ICE laboratory (glacier-project/sysmlc-models): a real plant and its recipe DEMO_LEGO."""

import json

import pytest

from sysmlc.config import load
from sysmlc.driver import Request, compile_model, select_backends

pytestmark = pytest.mark.corpus
LEVELS = """
[recipe.levels]
recipe = "RecipePrimitives::Recipe"
task = "RecipePrimitives::Task"
machine-service = "RecipePrimitives::MachineService"
machine = "ISA95EquipmentHierarchy::ProductionEquipment"
opc-ua-call = "OpcUaBinding::OpcUaMethod"
"""


@pytest.fixture(scope="module")
def laboratory(corpus, tmp_path_factory):
    file = tmp_path_factory.mktemp("ice") / "sysmlc.toml"
    file.write_text(LEVELS)
    folder = corpus / "sysml2" / "ice-lab"
    backends = tuple(select_backends(("recipe", "contracts")))
    request = Request((folder,), config=load(file), backends=backends)
    return compile_model(request)


@pytest.fixture(scope="module")
def recipe(laboratory):
    made = {one.path: one.text for one in laboratory.written()}
    return json.loads(made["recipes/DemoLegoRecipe.DemoLego.json"])


def test_the_recipe_has_its_five_tasks_in_their_order(recipe):
    (only,) = recipe["recipes"]
    order = sorted(only["precedence"])
    assert [[one.rpartition("::")[2] for one in pair] for pair in order] == [
        ["opLD", "opRBTC"],
        ["opQC", "opRESRVPALLET"],
        ["opRBTC", "opQC"],
        ["opRESRVPALLET", "opDISASSEMBLE"],
    ]
    assert len(only["tasks"]) == 5


def test_functions_are_bound_down_to_the_nodes_of_opc_ua(recipe):
    calls = {one["id"].rpartition("::")[2]: one.get("opcua") for one in recipe["functions"]}
    assert len(calls) == 12
    waiting = [name for name, call in calls.items() if call is None]
    assert waiting == ["Delay", "WaitRoboticCellDone"]
    assert all(call["method"].startswith("ns=") for call in calls.values() if call)
    assert calls["clearPartOnPallet"]["object"].startswith("ns=7;g=")


def test_results_go_from_step_to_step_and_parameters_into_calls(recipe):
    graphs = {one["id"]: one for one in recipe["serviceGraphs"]}
    nodes = graphs["DemoLegoRecipe::TaskRBTC"]["nodes"]
    pick = next(one for one in nodes if one["id"].endswith("::pick"))
    assert pick["bind"]["shape"] == {"var": "shape1"}
    assert pick["bind"]["posPick"] == {"lit": "pos2"}
    assert len([one for one in nodes if one["kind"] == "service"]) == 13


def test_only_the_names_that_are_known_to_be_missing_are_unresolved(laboratory):
    found = [one for one in laboratory.diagnostics if one.rule.code == "SM205"]
    assert len(found) == 24
    told = [one for one in found if "OpcUaConnection" in one.message]
    assert len(told) == 9


def test_the_milling_cell_has_a_contract_with_what_it_is_given_and_told(laboratory):
    made = {one.path: one.text for one in laboratory.written()}
    text = made["contracts/MillingCellBehavior.MillingCellEngravingStates.contract.json"]
    owners = {name: one["owner"] for name, one in json.loads(text)["variables"].items()}
    assert owners["equipment_mesBusy"] == owners["engraveCmd_accepted"] == "sys"
    assert owners["time_pickDuration"] == owners["palletPresent"] == "env"


def test_nothing_but_unresolved_names_is_an_error(laboratory):
    errors = [one.rule.code for one in laboratory.diagnostics if one.is_error]
    assert errors == ["SM205"] * 24
