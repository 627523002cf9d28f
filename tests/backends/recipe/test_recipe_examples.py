"""The recipes of the examples have the content that the thesis and their README describe."""

import pytest
from recipe_files import compile_recipe, find_example, list_faults, list_recipes

from dialects.magicdraw import write_xml


def simplify(value: object) -> object:
    """Return the content without traces, and with the last part of every qualified name."""
    if isinstance(value, dict):
        return {key: simplify(entry) for key, entry in value.items() if key != "trace"}
    if isinstance(value, list):
        return [simplify(entry) for entry in value]
    return value.rpartition("::")[2] if isinstance(value, str) else value


def read_recipe(model) -> dict:
    """Return the simplified content of the only recipe file of a model."""
    (content,) = list_recipes(compile_recipe(model))
    return simplify(content)


@pytest.fixture(scope="module")
def lego() -> dict:
    return read_recipe(find_example("lego-recipe"))


@pytest.fixture(scope="module")
def four() -> dict:
    return read_recipe(find_example("four-tasks"))


def list_tasks(file: dict) -> dict[str, dict]:
    return {task["id"]: task for task in file["recipes"][0]["tasks"]}


def list_equipment(task: dict) -> dict[tuple[str, ...], int | None]:
    """Return the duration by the machines of each alternative."""
    return {tuple(mode["machines"]): mode.get("duration") for mode in task["equipment"]}


def list_materials(task: dict) -> set[tuple[str, float, str]]:
    return {
        (material["material"], material["quantity"], material["use"])
        for material in task.get("materials", ())
    }


def find_graph(file: dict, level: str, name: str) -> dict:
    return next(entry for entry in file[level] if entry["id"] == name)


def list_edges(graph: dict) -> set[tuple[str, str]]:
    return {(edge["from"], edge["to"]) for edge in graph["edges"]}


@pytest.mark.parametrize("name", ["lego-recipe", "four-tasks"])
def test_the_file_is_valid_and_the_recipe_has_no_diagnostics(name):
    compilation = compile_recipe(find_example(name))
    codes = [diagnostic.rule.code for diagnostic in compilation.diagnostics]
    assert [code for code in codes if code.startswith("SM6")] == []
    assert [list_faults(content) for content in list_recipes(compilation)] == [[]]


# -- four tasks --------------------------------------------------------------------------------


def test_the_precedence_of_four_tasks_is_a_fork_and_a_join(four):
    precedence = {tuple(pair) for pair in four["recipes"][0]["precedence"]}
    assert precedence == {("t1", "t2"), ("t1", "t3"), ("t2", "t4"), ("t3", "t4")}


def test_four_tasks_have_alternatives_with_their_own_durations(four):
    four_tasks = list_tasks(four)
    assert list_equipment(four_tasks["t1"]) == {("Mill1",): 12000, ("Mill2",): 15000}
    assert list_equipment(four_tasks["t2"]) == {("Arm1",): 14000, ("Arm2",): 13500}
    assert list_equipment(four_tasks["t3"]) == {("Cart", "Mill1"): 25000, ("Cart", "Mill2"): 30000}
    assert list_equipment(four_tasks["t4"]) == {("Arm2",): None}


def test_the_actions_that_hold_the_pin_need_the_same_machine(four):
    derived = list_tasks(four)["t2"]["derived"]
    assert [set(group["nodes"]) for group in derived["sameMachine"]] == [
        {"pickPin", "turn", "mount"}
    ]


def test_t2_takes_one_to_four_turns(four):
    pick, turn, read, mount = (500, 500), (2400, 2500), (200, 200), (2300, 2400)
    shortest = pick[0] + turn[0] + read[0] + mount[0]
    longest = pick[1] + 4 * (turn[1] + read[1]) + mount[1]
    assert list_tasks(four)["t2"]["derived"]["duration"] == {"min": shortest, "max": longest}


def test_turn_is_a_sequence_of_four_machine_functions(four):
    turn = find_graph(four, "functionGraphs", "Turn")
    names = [node["ref"] for node in turn["nodes"] if node["kind"] == "function"]
    assert names == ["Unlock", "Rotate", "Lock", "Settle"]


# -- lego --------------------------------------------------------------------------------------


def test_assemble_precedes_store(lego):
    assert lego["recipes"][0]["precedence"] == [["assemble", "store"]]


def test_assemble_makes_a_stack_of_three_pieces_and_store_consumes_it(lego):
    lego_tasks = list_tasks(lego)
    pieces = {(name, 1, "consumed") for name in ("BasePiece", "MiddlePiece", "TopPiece")}
    assert list_materials(lego_tasks["assemble"]) == {*pieces, ("LegoStack", 1, "produced")}
    assert list_materials(lego_tasks["store"]) == {("LegoStack", 1, "consumed")}


def test_assemble_has_two_alternative_robots_and_store_needs_two_machines_together(lego):
    lego_tasks = list_tasks(lego)
    assert list_equipment(lego_tasks["assemble"]) == {("Robot1",): 70000, ("Robot2",): 72000}
    assert list_equipment(lego_tasks["store"]) == {("Conveyor", "Warehouse"): 18000}
    assert lego_tasks["store"]["equipment"][0]["power"] == {"min": 190, "max": 1020}


def test_assemble_is_a_retry_loop_inside_a_loop_over_the_pieces(lego):
    assemble = find_graph(lego, "serviceGraphs", "Assemble")
    loops = {
        node["id"]: node["maxIterations"] for node in assemble["nodes"] if node["kind"] == "loop"
    }
    assert loops == {"pieceAccepted?": 3, "allPlaced?": 3}
    roles = {
        (edge["from"], edge["to"]): edge["role"] for edge in assemble["edges"] if "role" in edge
    }
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


def test_assemble_places_three_pieces_and_repeats_at_most_two_attempts(lego):
    reserve, check = 500, 800
    pick, turn, place, remove = (2400, 2500), (2600, 2600), (2500, 2600), (1250, 1300)
    attempts = [turn[n] + place[n] + check for n in (0, 1)]
    derived = list_tasks(lego)["assemble"]["derived"]
    # Nothing resets 'attempts' between pieces, so that all pieces together have two more attempts.
    assert derived["duration"] == {
        "min": reserve + 3 * (pick[0] + attempts[0]),
        "max": reserve + 3 * (pick[1] + attempts[1]) + 2 * (remove[1] + attempts[1]),
    }
    assert derived["duration"]["min"] == 25400
    runs = {
        sub_task["node"]: (sub_task["runs"]["min"], sub_task["runs"]["max"])
        for sub_task in derived["subTasks"]
    }
    assert runs["checkQuality"] == (3, 5)
    assert runs["remove"] == (0, 2)


def test_a_rejected_stack_ends_assemble_early(lego):
    reserve, pick, attempt, remove, reject = 500, 2400, 2600 + 2500 + 800, 1250, 200
    ends = {end["node"]: end for end in list_tasks(lego)["assemble"]["derived"]["ends"]}
    assert "early" not in ends["assembled"]
    assert ends["rejected"]["early"]
    shortest = reserve + pick + 3 * attempt + 2 * remove + reject
    assert ends["rejected"]["duration"]["min"] == shortest


def test_the_actions_on_a_gripped_piece_need_the_same_robot(lego):
    (group,) = list_tasks(lego)["assemble"]["derived"]["sameMachine"]
    assert set(group["nodes"]) == {"pick", "turn", "place", "remove"}
    assert len(group["because"]) == 7
    assert "sameMachine" not in list_tasks(lego)["store"]["derived"]


def test_turn_chooses_a_function_by_actual_and_target_angle(lego):
    turn = find_graph(lego, "functionGraphs", "Turn")
    guards = {edge["to"]: edge["guard"]["text"] for edge in turn["edges"] if "guard" in edge}
    assert guards == {"clockwise": "target > actual", "counterClockwise": "target < actual"}
    bound = next(node["bind"] for node in turn["nodes"] if node["id"] == "clockwise")
    assert bound == {"actual": {"var": "actual"}, "target": {"var": "target"}}


def test_sub_tasks_list_their_robots_and_follow_their_predecessors(lego):
    sub_tasks = list_tasks(lego)["assemble"]["derived"]["subTasks"]
    machines = {
        sub_task["node"]: [mode["machines"][0] for mode in sub_task["alternatives"]]
        for sub_task in sub_tasks
    }
    assert machines == {
        "reservePieces": [],
        "pick": ["Robot1", "Robot2"],
        "turn": ["Robot1", "Robot2"],
        "place": ["Robot1", "Robot2"],
        "checkQuality": [],
        "remove": ["Robot1", "Robot2"],
        "reportReject": [],
    }
    predecessors = {sub_task["node"]: sub_task.get("after", []) for sub_task in sub_tasks}
    assert predecessors["turn"] == ["pick"]
    assert predecessors["remove"] == ["checkQuality"]
    preceding: set[str] = set()
    for sub_task in sub_tasks:
        assert set(sub_task.get("after", ())) <= preceding
        preceding.add(sub_task["node"])


def test_services_have_their_opc_ua_calls(lego):
    services = {service["id"]: service for service in lego["services"]}
    assert services["CheckQuality"]["kind"] == "infrastructure"
    assert services["CheckQuality"]["opcua"]["method"] == "ns=3;s=Camera.Inspect"
    calls = {
        provider["machine"]: provider["opcua"]["method"]
        for provider in services["Pick"]["providers"]
    }
    assert calls == {"Robot1": "ns=2;s=Robot1.Pick", "Robot2": "ns=2;s=Robot2.Pick"}


@pytest.mark.parametrize("name", ["lego-recipe", "four-tasks"])
def test_the_model_in_the_format_of_magicdraw_gives_the_same_recipe(name, tmp_path):
    model = tmp_path / f"{name}.xml"
    model.write_bytes(write_xml(find_example(name).read_bytes()))
    from_magicdraw, from_papyrus = read_recipe(model), read_recipe(find_example(name))
    assert {**from_magicdraw, "source": None} == {**from_papyrus, "source": None}
