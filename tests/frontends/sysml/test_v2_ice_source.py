"""The recipe of the ICE laboratory against its text, read again by a few regular expressions."""

import json
import re
from pathlib import Path

import ice_source as source
import jsonschema
import pytest

from sysmlc.config import read_config
from sysmlc.driver import Request, compile_model, select_backends

ROOT = Path(__file__).parents[3]
pytestmark = pytest.mark.corpus
LEVELS = """\
[recipe.levels]
task = "RecipePrimitives::Task"
machine-service = "RecipePrimitives::MachineService"
machine-function = "RecipePrimitives::MachineFunction"
"""
TASK = r"action def (\w+) :> Task"
SERVICE_CALL = r"then perform action (\w+) : (\w+)"
FUNCTION_CALL = r"(?:then )?action (\w+) :> equipment\.(\w+)"


@pytest.fixture(scope="module")
def folder(corpus):
    return corpus / "sysml2" / "ice-lab"


@pytest.fixture(scope="module")
def laboratory(folder, tmp_path_factory):
    file = tmp_path_factory.mktemp("ice") / "sysmlc.toml"
    file.write_text(LEVELS)
    backends = tuple(select_backends(("recipe",)))
    return compile_model(Request((folder,), config=read_config(file), backends=backends))


@pytest.fixture(scope="module")
def recipe(laboratory):
    (output,) = laboratory.list_published()
    return json.loads(output.text)


@pytest.fixture(scope="module")
def text(folder):
    """All files of the laboratory, and the literals of its enumerations."""
    files = {path.stem: source.read(path) for path in sorted(folder.rglob("*.sysml"))}
    return files, source.read_literals(files["enums"])


def find_nodes(recipe, name):
    graphs = {name["id"]: name for name in (*recipe["serviceGraphs"], *recipe["functionGraphs"])}
    return {node["id"].rpartition("::")[2]: node for node in graphs[name]["nodes"]}


def write_value(value, numbers, enumerations):
    """Return the value in the recipe for a value of the text: a literal or a variable."""
    if re.fullmatch(r"-?\d+", value):
        return {"lit": int(value)}
    if value in numbers:
        return {"lit": value.rpartition("::")[2] if enumerations else numbers[value]}
    return {"var": re.sub(r"^\w+::", "", value)}


def is_expected(bound, value, numbers, sources):
    """Whether a binding is that of the text; results of steps are the variables they set."""
    expected = [write_value(value, numbers, enumerations) for enumerations in (False, True)]
    step, dot, output = value.partition(".")
    if dot and output in sources.get(step, {}):
        expected.append({"var": sources[step][output]})
    return bound in expected


def check_bindings(steps, blocks, numbers):
    """Check that the recipe has exactly the arguments of each step; return their number."""
    sources = {name: step.get("assign", {}) for name, step in steps.items()}
    count = 0
    for name, block in blocks.items():
        arguments = source.read_arguments(block)
        bound = steps[name].get("bind", {})
        assert set(bound) == set(arguments), name
        for key, value in arguments.items():
            assert is_expected(bound[key], value, numbers, sources), (name, key, value, bound[key])
            count += 1
    return count


def test_the_recipe_is_valid_against_its_schema(recipe):
    schema = json.loads((ROOT / "metamodels" / "sysmlc-recipe.schema.json").read_text())
    jsonschema.validate(recipe, schema)


# -- tasks and services ------------------------------------------------------------------------


def test_the_recipe_has_the_five_tasks_of_the_text_in_their_order(recipe, text):
    (definition,) = text[0]["demo_lego"].find(r"action def DemoLego :> Recipe")
    written = [m[1] for m, _ in definition[1].find(r"then action (\w+) : Task\w+")]
    (recipe_of_text,) = recipe["recipes"]
    follows = {
        a.rpartition("::")[2]: b.rpartition("::")[2] for a, b in recipe_of_text["precedence"]
    }
    order = [next(iter(set(follows) - set(follows.values())))]
    while order[-1] in follows:
        order.append(follows[order[-1]])
    assert order == written
    assert len(written) == 5


def test_values_go_into_tasks_as_written(recipe, text):
    (definition,) = text[0]["demo_lego"].find(r"action def DemoLego :> Recipe")
    steps = {m[1]: block for m, block in definition[1].find(r"then action (\w+) : Task\w+")}
    tasks = {task["name"]: task for task in recipe["recipes"][0]["tasks"]}
    assert check_bindings(tasks, steps, text[1]) == 17


def test_every_call_of_a_service_has_the_arguments_of_the_text(recipe, text):
    files, numbers = text
    calls = count = 0
    for task, block in files["demo_lego"].find(TASK):
        steps = {m[1]: (m[2], inside) for m, inside in block.find(SERVICE_CALL)}
        lowered = find_nodes(recipe, f"DemoLegoRecipe::{task[1]}")
        services = {name: node for name, node in lowered.items() if node["kind"] == "service"}
        assert list(services) == list(steps)
        for name, (service, _) in steps.items():
            assert services[name]["ref"].rpartition("::")[2] == service
        inside = {name: node for name, (_, node) in steps.items()}
        count += check_bindings(services, inside, numbers)
        calls += len(steps)
    assert (calls, count) == (31, 103)


def test_the_plant_states_which_operation_of_which_cell_performs_each_of_the_31(recipe, text):
    files, _ = text
    (line,) = files["ice_lab"].find(r"perform action demoLego : DemoLego")
    arguments = {m[1]: m[2] for m, _ in line[1].find(r"in ref :>> (\w+) = ([\w.]+)")}
    task_of = {m[1]: m[2] for m, _ in files["demo_lego"].find(r"then action (op\w+) : (Task\w+)")}
    written = {
        f"DemoLegoRecipe::{task_of[task[1]]}::{step[1]}": step[2]
        for task, block in line[1].find(r"action :>> (op\w+)")
        for step, _ in block.find(r"action :>> (\w+) references ([\w.]+)")
    }
    (performed,) = recipe["recipes"][0]["performedBy"]
    assert performed["block"] == "PlantTopology::ICEProductionLine"
    assert performed["arguments"] == arguments
    assert performed["steps"] == written
    assert len(written) == 31


# -- services and functions --------------------------------------------------------------------


def find_definitions(recipe, text):
    """Services and helpers of the recipe with their text."""
    definitions = {
        m[1]: block
        for file in text[0].values()
        for m, block in file.find(r"action def (\w+)(?: :> MachineService)?")
    }
    return {
        graph["id"]: definitions[graph["id"].rpartition("::")[2]]
        for graph in recipe["functionGraphs"]
    }


def test_every_service_calls_the_functions_of_the_text_with_their_arguments(recipe, text):
    calls = count = 0
    for graph, block in find_definitions(recipe, text).items():
        steps = {m[1]: (m[2], inside) for m, inside in block.find(FUNCTION_CALL)}
        lowered = find_nodes(recipe, graph)
        functions = {name: node for name, node in lowered.items() if node["kind"] == "function"}
        assert set(functions) == set(steps)
        for name, (function, _) in steps.items():
            assert functions[name]["ref"].rpartition("::")[2] == function
        count += check_bindings(functions, {n: node for n, (_, node) in steps.items()}, text[1])
        calls += len(steps)
    assert (calls, count) == (12, 28)


def test_every_function_has_the_node_ids_of_its_definition(recipe, text):
    equipment = text[0]["equipment_interfaces"]
    ids = {}
    for machine, block in equipment.find(r"part def (\w+) :> ProductionEquipment"):
        methods = {}
        for definition, inside in block.find(r"action def (\w+) :> MachineFunction"):
            tags = dict(_read_tag(m) for m, _ in inside.find(r'(\w+) = "(.*)"'))
            methods[definition[1]] = tags
        for action, _ in block.find(r"action (\w+) : (\w+)"):
            ids[f"EquipmentInterfaces::{machine[1]}::{action[1]}"] = methods[action[2]]
    written = {
        function["id"]: {
            "nodeId": function["opcua"]["method"],
            "parentNodeId": function["opcua"]["object"],
        }
        for function in recipe["functions"]
    }
    assert written == {id: ids[id] for id in written}
    assert len(written) == 11


def _read_tag(match):
    return match[1], re.sub(r"\\(.)", r"\1", match[2])


def test_results_of_services_are_those_of_the_text(recipe, text):
    count = 0
    for graph, block in find_definitions(recipe, text).items():
        lowered = find_nodes(recipe, graph)
        for bound, _ in block.find(r"bind (\w+) = (\w+)\.(\w+)"):
            output, step, result = bound.groups()
            if lowered.get(step, {}).get("kind") == "function":
                assert lowered[step]["assign"][result] == output, (graph, output)
                count += 1
    assert count == 14


# -- loops, for-each, times --------------------------------------------------------------------


def test_every_loop_of_the_text_is_an_unbounded_loop_with_its_condition(recipe, text):
    """A merge that a guarded succession behind it leads back to is where a loop begins."""
    count = 0
    for graph, block in find_definitions(recipe, text).items():
        loops = [node for node in find_nodes(recipe, graph).values() if node["kind"] == "loop"]
        assert all(loop["unbounded"] is True for loop in loops)
        heads = _list_loops(block)
        assert len(loops) == len(heads), (graph, heads)
        count += len(loops)
    assert count == 5


def _list_loops(block):
    """Names of merges that are led back to from what stands behind them."""
    merges = []
    for child in block.walk():
        order = [inner.head for inner in child.inside]
        for index, head in enumerate(order):
            merge = re.fullmatch(r"merge (\w+)", head)
            back = rf"(?:if .+ then|else|then) {merge[1]}" if merge else "(?!)"
            merges += (
                [merge[1]] if any(re.fullmatch(back, after) for after in order[index:]) else []
            )
    return merges


def test_for_each_over_pallets_is_as_written(recipe, text):
    written = [
        (graph, m[1], m[2])
        for graph, block in find_definitions(recipe, text).items()
        for m, _ in block.find(r"(?:then )?for (\w+) in ([\w.]+)")
    ]
    loops = [
        (graph["id"], node["variable"]["name"], node["in"]["var"])
        for graph in recipe["functionGraphs"]
        for node in graph["nodes"]
        if node["kind"] == "forEach"
    ]
    assert loops == written
    assert [(graph_id.rpartition("::")[2], *rest) for graph_id, *rest in loops] == [
        ("ReadPalletContent", "p", "equipment.pallets"),
        ("ReserveFreePalletOfType2", "p", "equipment.pallets"),
    ]


def test_times_that_the_text_has_none_of_are_left_open(recipe):
    """The only time of the text is the pause of a second before a pallet is asked for again."""

    def iter_items(value):
        if isinstance(value, dict):
            yield from value.items()
        for item in value.values() if isinstance(value, dict) else value:
            if isinstance(item, dict | list):
                yield from iter_items(item)

    times = ("duration", "minDuration", "maxDuration", "timeout", "time")
    assert [(key, one) for key, one in iter_items(recipe) if key in times] == [
        ("time", {"lit": 1000})
    ]


def test_polled_variables_have_the_nodes_of_the_text(recipe, text):
    equipment = text[0]["equipment_interfaces"]
    count = 0
    for machine in recipe["machines"]:
        name = machine["id"].rpartition("::")[2]
        (block,) = [b for m, b in equipment.find(r"part def (\w+) :> .+") if m[1] == name]
        for variable in machine.get("variables", ()):
            if "node" in variable:
                assert variable["node"] == _find_node(block, variable["name"].split(".")), variable[
                    "name"
                ]
                count += 1
    assert count == 53


def _find_node(block, path):
    for part in path:
        pattern = rf"attribute (?:{part} : .+|:>> {part})"
        block = next(child for child in block.inside if re.fullmatch(pattern, child.head))
    (node_id,) = [_read_tag(m)[1] for m, _ in block.find(r'(nodeId) = "(.*)"')]
    return node_id


# -- names that are missing --------------------------------------------------------------------

MISSING = r"\b(?:OpcUaConnection|RoboticCell(?:Cmd|State)Port|(?:cmd|state)Port)\b"


def test_every_use_of_a_missing_name_is_reported_at_its_location_and_nothing_else(
    laboratory, folder
):
    """25 words in all; one of them, ``the equipment's statePort``, is in a comment."""
    written, words = set(), 0
    for path in sorted(folder.rglob("*.sysml")):
        name, whole = path.relative_to(folder).as_posix(), path.read_text()
        words += len(re.findall(MISSING, whole))
        for found in re.finditer(rf"(?:\w+::)*{MISSING}", source.blank_comments(whole)):
            written.add((name, len(whole[: found.start()].encode())))
    errors = [diagnostic for diagnostic in laboratory.diagnostics if diagnostic.is_error]
    assert {diagnostic.rule.code for diagnostic in errors} == {"SM205"}
    reported = [
        (diagnostic.subject.place.file, diagnostic.subject.place.offset) for diagnostic in errors
    ]
    assert sorted(reported) == sorted(written)
    assert (words, len(reported)) == (25, 24)
