"""The shipped recipes against what the thesis and their README say, stated here by hand."""

import json
from pathlib import Path

import pytest
from jsonschema import Draft202012Validator

from dialects.magicdraw import write_xml
from sysmlc.driver import Request, compile_model, select_backends
from sysmlc.support import resources

EXAMPLES = Path(__file__).parents[3] / "examples"
SCHEMA = json.loads(resources.read_text("metamodels", "sysmlc-recipe.schema.json"))


def compile_example(name: str):
    """The compilation of an example with the back end recipe only."""
    model = EXAMPLES / name / f"{name}.uml"
    return compile_model(Request((model,), backends=tuple(select_backends(["recipe"]))))


def short(value: object) -> object:
    """The file without traces, and with the last part of every qualified name."""
    if isinstance(value, dict):
        return {key: short(inner) for key, inner in value.items() if key != "trace"}
    if isinstance(value, list):
        return [short(inner) for inner in value]
    return value.rpartition("::")[2] if isinstance(value, str) else value


def content(name: str) -> dict:
    """The only recipe file of an example."""
    (artefact,) = [
        artefact
        for artefact in compile_example(name).list_published()
        if artefact.path.startswith("recipes/")
    ]
    return json.loads(artefact.text)


@pytest.fixture(scope="module")
def lego() -> dict:
    return short(content("lego-recipe"))


@pytest.fixture(scope="module")
def four() -> dict:
    return short(content("four-tasks"))


def tasks(file: dict) -> dict[str, dict]:
    return {task["id"]: task for task in file["recipes"][0]["tasks"]}


def equipment(task: dict) -> dict[tuple[str, ...], int | None]:
    return {tuple(mode["machines"]): mode.get("duration") for mode in task["equipment"]}


def materials(task: dict) -> set[tuple[str, float, str]]:
    return {(m["material"], m["quantity"], m["use"]) for m in task.get("materials", ())}


def graph(file: dict, level: str, name: str) -> dict:
    return next(entry for entry in file[level] if entry["id"] == name)


def list_edges(graph: dict) -> set[tuple[str, str]]:
    return {(edge["from"], edge["to"]) for edge in graph["edges"]}


@pytest.mark.parametrize("name", ["lego-recipe", "four-tasks"])
def test_the_file_is_valid_and_nothing_is_said_against_the_recipe(name):
    diagnostics = compile_example(name).diagnostics
    assert [d for d in diagnostics if d.rule.code.startswith("SM6")] == []
    assert list(Draft202012Validator(SCHEMA).iter_errors(content(name))) == []


# -- four tasks --------------------------------------------------------------------------------


def test_four_tasks_fork_and_join(four):
    precedence = {tuple(pair) for pair in four["recipes"][0]["precedence"]}
    assert precedence == {("t1", "t2"), ("t1", "t3"), ("t2", "t4"), ("t3", "t4")}


def test_four_tasks_have_alternatives_with_their_own_durations(four):
    four_tasks = tasks(four)
    assert equipment(four_tasks["t1"]) == {("Mill1",): 12000, ("Mill2",): 15000}
    assert equipment(four_tasks["t2"]) == {("Arm1",): 14000, ("Arm2",): 13500}
    assert equipment(four_tasks["t3"]) == {("Cart", "Mill1"): 25000, ("Cart", "Mill2"): 30000}
    assert equipment(four_tasks["t4"]) == {("Arm2",): None}


def test_the_pin_stays_in_one_hand(four):
    derived = tasks(four)["t2"]["derived"]
    assert [set(group["nodes"]) for group in derived["sameMachine"]] == [
        {"pickPin", "turn", "mount"}
    ]


def test_t2_takes_one_to_four_turns(four):
    pick, turn, read, mount = (500, 500), (2400, 2500), (200, 200), (2300, 2400)
    shortest = pick[0] + turn[0] + read[0] + mount[0]
    longest = pick[1] + 4 * (turn[1] + read[1]) + mount[1]
    assert tasks(four)["t2"]["derived"]["duration"] == {"min": shortest, "max": longest}


def test_turn_is_a_sequence_of_four_machine_functions(four):
    turn = graph(four, "functionGraphs", "Turn")
    names = [node["ref"] for node in turn["nodes"] if node["kind"] == "function"]
    assert names == ["Unlock", "Rotate", "Lock", "Settle"]


# -- lego --------------------------------------------------------------------------------------


def test_assemble_goes_before_store(lego):
    assert lego["recipes"][0]["precedence"] == [["assemble", "store"]]


def test_three_pieces_become_a_stack_that_is_stored(lego):
    lego_tasks = tasks(lego)
    pieces = {(name, 1, "consumed") for name in ("BasePiece", "MiddlePiece", "TopPiece")}
    assert materials(lego_tasks["assemble"]) == {*pieces, ("LegoStack", 1, "produced")}
    assert materials(lego_tasks["store"]) == {("LegoStack", 1, "consumed")}


def test_assemble_has_two_robots_to_choose_from_and_store_needs_two_machines_at_once(lego):
    lego_tasks = tasks(lego)
    assert equipment(lego_tasks["assemble"]) == {("Robot1",): 70000, ("Robot2",): 72000}
    assert equipment(lego_tasks["store"]) == {("Conveyor", "Warehouse"): 18000}
    assert lego_tasks["store"]["equipment"][0]["power"] == {"min": 190, "max": 1020}


def test_assemble_is_a_retry_loop_inside_a_loop_over_the_pieces(lego):
    assemble = graph(lego, "serviceGraphs", "Assemble")
    loops = {n["id"]: n["maxIterations"] for n in assemble["nodes"] if n["kind"] == "loop"}
    assert loops == {"pieceAccepted?": 3, "allPlaced?": 3}
    roles = {(e["from"], e["to"]): e["role"] for e in assemble["edges"] if "role" in e}
    assert roles == {
        ("pieceAccepted?", "countPiece"): "exit",
        ("pieceAccepted?", "remove"): "body",
        ("pieceAccepted?", "reportReject"): "exit",
        ("allPlaced?", "nextPiece"): "body",
        ("allPlaced?", "assembled"): "exit",
    }
    assert {("start", "reservePieces"), ("turn", "place"), ("place", "checkQuality")} <= list_edges(
        assemble
    )


def test_assemble_takes_as_long_as_its_loops_allow(lego):
    reserve, pick, turn, place, check, remove, reject = 500, 2500, 2600, 2600, 800, 1300, 200
    piece = pick + 3 * (turn + place + check) + 2 * remove
    longest = reserve + 3 * piece + reject
    shortest = reserve + 2400 + 2600 + 2500 + check
    duration = tasks(lego)["assemble"]["derived"]["duration"]
    assert duration == {"min": shortest, "max": longest}


def test_a_gripped_piece_stays_on_its_robot(lego):
    (group,) = tasks(lego)["assemble"]["derived"]["sameMachine"]
    assert set(group["nodes"]) == {"pick", "turn", "place", "remove"}
    assert len(group["because"]) == 7
    assert "sameMachine" not in tasks(lego)["store"]["derived"]


def test_turn_chooses_a_function_by_actual_and_target_angle(lego):
    turn = graph(lego, "functionGraphs", "Turn")
    guards = {e["to"]: e["guard"]["text"] for e in turn["edges"] if "guard" in e}
    assert guards == {"clockwise": "target > actual", "counterClockwise": "target < actual"}
    bound = next(node["bind"] for node in turn["nodes"] if node["id"] == "clockwise")
    assert bound == {"actual": {"var": "actual"}, "target": {"var": "target"}}


def test_sub_tasks_offer_the_robots_and_stand_in_order(lego):
    sub_tasks = tasks(lego)["assemble"]["derived"]["subTasks"]
    offers = {s["node"]: [m["machines"][0] for m in s["alternatives"]] for s in sub_tasks}
    assert offers == {
        "reservePieces": [],
        "pick": ["Robot1", "Robot2"],
        "turn": ["Robot1", "Robot2"],
        "place": ["Robot1", "Robot2"],
        "checkQuality": [],
        "remove": ["Robot1", "Robot2"],
        "reportReject": [],
    }
    before = {sub_task["node"]: sub_task.get("after", []) for sub_task in sub_tasks}
    assert before["turn"] == ["pick"]
    assert before["remove"] == ["checkQuality"]
    seen: set[str] = set()
    for sub_task in sub_tasks:
        assert set(sub_task.get("after", ())) <= seen
        seen.add(sub_task["node"])


def test_services_know_their_opc_ua_calls(lego):
    services = {service["id"]: service for service in lego["services"]}
    assert services["CheckQuality"]["kind"] == "infrastructure"
    assert services["CheckQuality"]["opcua"]["method"] == "ns=3;s=Camera.Inspect"
    calls = {p["machine"]: p["opcua"]["method"] for p in services["Pick"]["providers"]}
    assert calls == {"Robot1": "ns=2;s=Robot1.Pick", "Robot2": "ns=2;s=Robot2.Pick"}


@pytest.mark.parametrize("name", ["lego-recipe", "four-tasks"])
def test_the_same_model_as_magicdraw_saves_it_gives_the_same_recipe(name, tmp_path):
    model = tmp_path / f"{name}.xml"
    model.write_bytes(write_xml((EXAMPLES / name / f"{name}.uml").read_bytes()))
    compilation = compile_model(Request((model,), backends=tuple(select_backends(["recipe"]))))
    (artefact,) = [
        artefact
        for artefact in compilation.list_published()
        if artefact.path.startswith("recipes/")
    ]
    theirs, ours = short(json.loads(artefact.text)), short(content(name))
    assert {**theirs, "source": None} == {**ours, "source": None}
