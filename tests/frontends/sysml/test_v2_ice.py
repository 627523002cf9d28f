"""The ICE laboratory (glacier-project/sysmlc-models): a real plant and its recipe DEMO_LEGO."""

import json

import pytest

from sysmlc.config import read_config
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


def compile_laboratory(corpus, folder, levels, *backends):
    file = folder / "sysmlc.toml"
    file.write_text(levels)
    laboratory = corpus / "sysml2" / "ice-lab"
    chosen = tuple(select_backends(backends))
    return compile_model(Request((laboratory,), config=read_config(file), backends=chosen))


@pytest.fixture(scope="module")
def laboratory(corpus, tmp_path_factory):
    folder = tmp_path_factory.mktemp("ice")
    return compile_laboratory(corpus, folder, LEVELS, "recipe", "contracts", "plantuml")


@pytest.fixture(scope="module")
def recipe(laboratory):
    outputs = {output.path: output.text for output in laboratory.list_published()}
    return json.loads(outputs["recipes/DemoLegoRecipe.DemoLego.json"])


def test_four_lines_of_levels_are_equivalent_to_nine(corpus, tmp_path, recipe):
    assert len(LEVELS.splitlines()) == 4
    (output,) = compile_laboratory(corpus, tmp_path, ALL_LEVELS, "recipe").list_published()
    assert json.loads(output.text) == recipe


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
    tasks = {task["name"]: task for task in only["tasks"]}
    assert tasks["opLD"]["assign"]["palletID2"] == "opLD.palletID2"
    assert tasks["opQC"]["bind"]["palletID2"] == {"var": "opLD.palletID2"}
    assert tasks["opDISASSEMBLE"]["bind"]["palletID1"] == {"var": "opRESRVPALLET.palletID1"}
    names = [variable["name"] for variable in only["variables"]]
    assert names[:2] == ["opLD.palletID1", "opLD.palletID2"]
    assert [variable["name"] for variable in only["inputs"]] == [
        "conveyorEquipment",
        "roboticCellEquipment",
        "qualityControlEquipment",
    ]


def test_functions_are_bound_down_to_the_nodes_of_opc_ua(recipe):
    calls = {
        function["id"].rpartition("::")[2]: function["opcua"] for function in recipe["functions"]
    }
    assert len(calls) == 11
    assert all(call["method"].startswith("ns=") for call in calls.values())
    assert calls["clearPartOnPallet"]["object"].startswith("ns=7;g=")


def test_results_go_from_step_to_step_and_parameters_into_calls(recipe):
    graphs = {graph["id"]: graph for graph in recipe["serviceGraphs"]}
    nodes = graphs["DemoLegoRecipe::TaskRBTC"]["nodes"]
    pick = next(node for node in nodes if node["id"].endswith("::pick"))
    assert pick["bind"]["shape"] == {"var": "shape1"}
    assert pick["bind"]["posPick"] == {"lit": 2}
    assert pick["bind"]["equipment"] == {"var": "roboticCellEquipment"}
    assert len([node for node in nodes if node["kind"] == "service"]) == 13


def test_outputs_of_a_task_are_computed_before_its_end(recipe):
    graphs = {graph["id"]: graph for graph in recipe["serviceGraphs"]}
    nodes = graphs["DemoLegoRecipe::TaskLD"]["nodes"]
    assigned = {n["variable"]["name"]: n["value"] for n in nodes if n["kind"] == "assign"}
    assert assigned["palletID2"] == {"index": [{"var": "reserve.palletIds"}, {"lit": 2}]}


def test_pallets_are_looked_at_one_after_the_other(recipe):
    graphs = {graph["id"]: graph for graph in recipe["functionGraphs"]}
    graph = graphs["Conveyor::ReserveFreePalletOfType2"]
    (loop,) = [node for node in graph["nodes"] if node["kind"] == "forEach"]
    assert (loop["in"], loop["maxIterations"]) == ({"var": "equipment.pallets"}, 10)
    assert loop["variable"]["name"] == "p"
    roles = [edge.get("role") for edge in graph["edges"] if edge["from"] == loop["id"]]
    assert sorted(roles) == ["body", "exit"]
    check = next(node for node in graph["nodes"] if node["kind"] == "call")
    assert (check["ref"], check["bind"]["pallet"]) == ("Conveyor::CheckPalletMatch", {"var": "p"})
    assert check["ref"] in graphs


def test_machines_are_polled_at_the_nodes_of_their_variables(recipe):
    graphs = {graph["id"]: graph for graph in recipe["functionGraphs"]}
    waiting = graphs["RoboticCell::WaitRoboticCellDone"]["nodes"]
    assert [node["unbounded"] for node in waiting if node["kind"] == "loop"] == [True, True]
    machines = {machine["id"].rpartition("::")[2]: machine for machine in recipe["machines"]}
    (done,) = machines["RoboticCellEquipment"]["variables"]
    assert (done["name"], done["node"]) == (
        "plcOperationDone",
        'ns=3;s="DB_ROBOTS"."plcOperationDone"',
    )
    pallets = {
        variable["name"]: variable for variable in machines["ConveyorBeltEquipment"]["variables"]
    }
    assert pallets["pallets"]["elements"][:2] == ["pallet1", "pallet2"]
    assert pallets["pallet2.reserved"]["node"].endswith("/Pallet2/reserved")
    assert pallets["pallet2.palletNumber"]["value"] == 2


def test_a_pause_is_in_milliseconds(recipe):
    graphs = {graph["id"]: graph for graph in recipe["functionGraphs"]}
    nodes = graphs["Conveyor::ReserveFreePalletOfType2"]["nodes"]
    assert [node["time"] for node in nodes if node["kind"] == "delay"] == [{"lit": 1000}]


def test_nothing_of_a_service_stays_outside_of_the_recipe(laboratory):
    codes = {diagnostic.rule.code for diagnostic in laboratory.diagnostics}
    assert codes.isdisjoint({"SM453", "SM606", "SM614", "SM615", "SM616"})


def test_only_the_names_that_are_known_to_be_missing_are_unresolved(laboratory):
    unresolved = [
        diagnostic for diagnostic in laboratory.diagnostics if diagnostic.rule.code == "SM205"
    ]
    assert len(unresolved) == 24
    about_connection = [
        diagnostic for diagnostic in unresolved if "OpcUaConnection" in diagnostic.message
    ]
    assert len(about_connection) == 9


def test_the_contract_of_the_milling_cell_has_its_outputs_and_inputs(laboratory):
    outputs = {output.path: output.text for output in laboratory.list_published()}
    text = outputs["contracts/MillingCellBehavior.MillingCellEngravingStates.contract.json"]
    owners = {name: variable["owner"] for name, variable in json.loads(text)["variables"].items()}
    assert owners["equipment_mesBusy"] == owners["engraveCmd_accepted"] == "sys"
    assert owners["time_pickDuration"] == owners["palletPresent"] == "env"


def test_nothing_but_unresolved_names_is_an_error(laboratory):
    errors = [diagnostic.rule.code for diagnostic in laboratory.diagnostics if diagnostic.is_error]
    assert errors == ["SM205"] * 24


def test_only_what_an_unknown_name_is_in_is_withheld(laboratory):
    assert {path.partition(".")[0].rpartition("/")[2] for path in laboratory.withheld} == {
        "RoboticCellStates"
    }
    written = {output.path for output in laboratory.list_published()}
    plant = {"diagrams/PlantTopology.bdd.puml", "diagrams/PlantTopology.ICEProductionLine.ibd.puml"}
    assert plant <= written


def test_every_condition_and_effect_of_the_laboratory_has_a_meaning(laboratory):
    codes = {diagnostic.rule.code for diagnostic in laboratory.diagnostics}
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
    (contract,) = [
        contract for contract in graph.derived(Contract) if contract.component == component
    ]
    (result,) = check_contracts(
        [contract], [contract], lambda origin: graph.subject(graph[origin]), sink, Options()
    )
    assert result.verdict.is_realizable
    assert [(diagnostic.rule.code, diagnostic.message) for diagnostic in sink] == []
