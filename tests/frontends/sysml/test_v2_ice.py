"""The ICE laboratory (glacier-project/sysmlc-models): a real plant and its recipe DEMO_LEGO."""

import json

import pytest

from sysmlc.config import load
from sysmlc.diagnostics import Sink
from sysmlc.driver import Request, compile_model, select_backends
from sysmlc.logic.contract import Contract
from sysmlc.synthesis.contract_checks import check_contracts
from sysmlc.synthesis.decision import Options

pytestmark = pytest.mark.corpus
LEVELS = """\
[recipe.levels]
task = "RecipePrimitives::Task"
machine-service = "RecipePrimitives::MachineService"
machine-function = "RecipePrimitives::MachineFunction"
"""
ALL_LEVELS = f"""{LEVELS}
recipe = "RecipePrimitives::Recipe"
machine = "ISA95EquipmentHierarchy::ProductionEquipment"
opc-ua-call = "OpcUaBinding::OpcUaMethod"
opc-ua-variable = "OpcUaBinding::OpcUaVariable"
delay = "RecipePrimitives::Delay"
"""


def compiled(corpus, folder, levels, *backends):
    file = folder / "sysmlc.toml"
    file.write_text(levels)
    laboratory = corpus / "sysml2" / "ice-lab"
    chosen = tuple(select_backends(backends))
    return compile_model(Request((laboratory,), config=load(file), backends=chosen))


@pytest.fixture(scope="module")
def laboratory(corpus, tmp_path_factory):
    folder = tmp_path_factory.mktemp("ice")
    return compiled(corpus, folder, LEVELS, "recipe", "contracts", "plantuml")


@pytest.fixture(scope="module")
def recipe(laboratory):
    made = {one.path: one.text for one in laboratory.list_published()}
    return json.loads(made["recipes/DemoLegoRecipe.DemoLego.json"])


def test_four_lines_say_as_much_as_nine(corpus, tmp_path, recipe):
    assert len(LEVELS.splitlines()) == 4
    (told,) = compiled(corpus, tmp_path, ALL_LEVELS, "recipe").list_published()
    assert json.loads(told.text) == recipe


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


def test_values_go_from_task_to_task(recipe):
    (only,) = recipe["recipes"]
    tasks = {one["name"]: one for one in only["tasks"]}
    assert tasks["opLD"]["assign"]["palletID2"] == "opLD.palletID2"
    assert tasks["opQC"]["bind"]["palletID2"] == {"var": "opLD.palletID2"}
    assert tasks["opDISASSEMBLE"]["bind"]["palletID1"] == {"var": "opRESRVPALLET.palletID1"}
    names = [one["name"] for one in only["variables"]]
    assert names[:2] == ["opLD.palletID1", "opLD.palletID2"]
    assert [one["name"] for one in only["inputs"]] == [
        "conveyorEquipment",
        "roboticCellEquipment",
        "qualityControlEquipment",
    ]


def test_functions_are_bound_down_to_the_nodes_of_opc_ua(recipe):
    calls = {one["id"].rpartition("::")[2]: one["opcua"] for one in recipe["functions"]}
    assert len(calls) == 11
    assert all(call["method"].startswith("ns=") for call in calls.values())
    assert calls["clearPartOnPallet"]["object"].startswith("ns=7;g=")


def test_results_go_from_step_to_step_and_parameters_into_calls(recipe):
    graphs = {one["id"]: one for one in recipe["serviceGraphs"]}
    nodes = graphs["DemoLegoRecipe::TaskRBTC"]["nodes"]
    pick = next(one for one in nodes if one["id"].endswith("::pick"))
    assert pick["bind"]["shape"] == {"var": "shape1"}
    assert pick["bind"]["posPick"] == {"lit": 2}
    assert pick["bind"]["equipment"] == {"var": "roboticCellEquipment"}
    assert len([one for one in nodes if one["kind"] == "service"]) == 13


def test_outputs_of_a_task_are_computed_before_its_end(recipe):
    graphs = {one["id"]: one for one in recipe["serviceGraphs"]}
    nodes = graphs["DemoLegoRecipe::TaskLD"]["nodes"]
    made = {n["variable"]["name"]: n["value"] for n in nodes if n["kind"] == "assign"}
    assert made["palletID2"] == {"index": [{"var": "reserve.palletIds"}, {"lit": 2}]}


def test_pallets_are_looked_at_one_after_the_other(recipe):
    graphs = {one["id"]: one for one in recipe["functionGraphs"]}
    graph = graphs["Conveyor::ReserveFreePalletOfType2"]
    (each,) = [one for one in graph["nodes"] if one["kind"] == "forEach"]
    assert (each["in"], each["maxIterations"]) == ({"var": "equipment.pallets"}, 10)
    assert each["variable"]["name"] == "p"
    roles = [edge.get("role") for edge in graph["edges"] if edge["from"] == each["id"]]
    assert sorted(roles) == ["body", "exit"]
    check = next(one for one in graph["nodes"] if one["kind"] == "call")
    assert (check["ref"], check["bind"]["pallet"]) == ("Conveyor::CheckPalletMatch", {"var": "p"})
    assert check["ref"] in graphs


def test_machines_are_polled_at_the_nodes_of_their_variables(recipe):
    graphs = {one["id"]: one for one in recipe["functionGraphs"]}
    waiting = graphs["RoboticCell::WaitRoboticCellDone"]["nodes"]
    assert [one["unbounded"] for one in waiting if one["kind"] == "loop"] == [True, True]
    machines = {one["id"].rpartition("::")[2]: one for one in recipe["machines"]}
    (done,) = machines["RoboticCellEquipment"]["variables"]
    assert (done["name"], done["node"]) == (
        "plcOperationDone",
        'ns=3;s="DB_ROBOTS"."plcOperationDone"',
    )
    pallets = {one["name"]: one for one in machines["ConveyorBeltEquipment"]["variables"]}
    assert pallets["pallets"]["elements"][:2] == ["pallet1", "pallet2"]
    assert pallets["pallet2.reserved"]["node"].endswith("/Pallet2/reserved")
    assert pallets["pallet2.palletNumber"]["value"] == 2


def test_a_pause_is_in_milliseconds(recipe):
    graphs = {one["id"]: one for one in recipe["functionGraphs"]}
    nodes = graphs["Conveyor::ReserveFreePalletOfType2"]["nodes"]
    assert [one["time"] for one in nodes if one["kind"] == "delay"] == [{"lit": 1000}]


def test_nothing_of_a_service_stays_outside_of_the_recipe(laboratory):
    codes = {one.rule.code for one in laboratory.diagnostics}
    assert codes.isdisjoint({"SM453", "SM606", "SM614", "SM615", "SM616"})


def test_only_the_names_that_are_known_to_be_missing_are_unresolved(laboratory):
    found = [one for one in laboratory.diagnostics if one.rule.code == "SM205"]
    assert len(found) == 24
    told = [one for one in found if "OpcUaConnection" in one.message]
    assert len(told) == 9


def test_the_milling_cell_has_a_contract_with_what_it_is_given_and_told(laboratory):
    made = {one.path: one.text for one in laboratory.list_published()}
    text = made["contracts/MillingCellBehavior.MillingCellEngravingStates.contract.json"]
    owners = {name: one["owner"] for name, one in json.loads(text)["variables"].items()}
    assert owners["equipment_mesBusy"] == owners["engraveCmd_accepted"] == "sys"
    assert owners["time_pickDuration"] == owners["palletPresent"] == "env"


def test_nothing_but_unresolved_names_is_an_error(laboratory):
    errors = [one.rule.code for one in laboratory.diagnostics if one.is_error]
    assert errors == ["SM205"] * 24


def test_only_what_an_unknown_name_is_in_is_withheld(laboratory):
    assert {path.partition(".")[0].rpartition("/")[2] for path in laboratory.withheld} == {
        "RoboticCellStates"
    }
    written = {one.path for one in laboratory.list_published()}
    plant = {"diagrams/PlantTopology.bdd.puml", "diagrams/PlantTopology.ICEProductionLine.ibd.puml"}
    assert plant <= written


def test_every_condition_and_effect_of_the_laboratory_has_a_meaning(laboratory):
    codes = {one.rule.code for one in laboratory.diagnostics}
    assert codes.isdisjoint({"SM411", "SM412", "SM413", "SM414", "SM415", "SM416", "SM458"})


@pytest.mark.parametrize(
    "component",
    [
        "MillingCellBehavior::MillingCellEngravingStates",
        "RoboticCellStates::RoboticCellStates",
        "DemoLegoRecipe::DemoLego",
        "DemoLegoRecipe::TaskQC",
    ],
)
def test_state_machines_and_tasks_can_be_kept_and_are_not_suspicious(laboratory, component):
    graph, sink = laboratory.graph, Sink()
    (contract,) = [one for one in graph.derived(Contract) if one.component == component]
    (result,) = check_contracts(
        [contract], [contract], lambda origin: graph.subject(graph[origin]), sink, Options()
    )
    assert result.verdict.is_realizable
    assert [(one.rule.code, one.message) for one in sink] == []
