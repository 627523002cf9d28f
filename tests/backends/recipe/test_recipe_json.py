"""The recipe file is valid and traced to the model, and the schema rejects faulty files."""

import copy
import json
import re
from random import Random

import pytest
from jsonschema import Draft202012Validator
from recipe_files import SCHEMA, compile_recipe, find_example, list_faults, list_recipes

import backend_runs
import recipe_samples as samples
from rule_examples import read_graphs
from sysmlc.analyses.recipe import Recipe
from sysmlc.backends.base import EmitOptions, InputFile
from sysmlc.backends.recipe import BACKEND
from sysmlc.diagnostics import Sink
from sysmlc.driver import load_full_catalogue
from sysmlc.ir import parse_text

INPUTS = (InputFile("b.uml", "0" * 64, "xmi"), InputFile("a.uml", "1" * 64, "xmi"))
LOOP = ("s m", "m l", "l d", "d m ok", "d g else", "g a", "a b", "b e")
COMBINED = ("s g", "g l", "l m", "m a ok", "m d else", "d b", "a e", "b e")
"""Two flows leave the merge, which stands for a merge and a decision."""


def emit(text: str):
    """Return the artefacts of a model in IR text by path, and the codes of the diagnostics."""
    graph = parse_text(text)
    Recipe().run(graph, Sink())
    artefacts, diagnostics = backend_runs.emit(BACKEND, graph, EmitOptions(inputs=INPUTS))
    return artefacts, [diagnostic.rule.code for diagnostic in diagnostics]


def write_recipe(text: str) -> dict:
    """Return the content of the only recipe file."""
    (artefact,) = emit(text)[0].values()
    return json.loads(artefact.text)


def test_the_schema_is_valid_json_schema():
    Draft202012Validator.check_schema(SCHEMA)


VALID = [samples.task(), samples.task(steps=LOOP), samples.task(steps=COMBINED), samples.recipe()]
VALID += [
    rule.read_page().right
    for rule in load_full_catalogue().values()
    if "SM601" <= rule.code <= "SM622" and rule.read_page().language == "ir"
]


@pytest.mark.parametrize("text", dict.fromkeys(VALID), ids=lambda text: str(len(text)))
def test_a_valid_recipe_gives_a_valid_file(text):
    assert list_faults(write_recipe(text)) == []


def test_the_file_has_the_name_of_the_recipe_and_its_sources_in_order():
    artefacts, _ = emit(samples.task())
    assert list(artefacts) == ["recipes/Plant.Build.json"]
    sources = write_recipe(samples.task())["source"]
    assert [source["file"] for source in sources] == ["a.uml", "b.uml"]


def test_a_recipe_without_tasks_is_reported_and_not_written():
    example = read_graphs(load_full_catalogue()["SM621"])
    assert emit(example.wrong) == ({}, ["SM621"])
    assert emit(example.right)[1] == []


def test_an_opc_ua_call_with_an_invalid_node_id_is_omitted():
    text = samples.task().replace('tag.object="ns=2;s=Robot"', 'tag.object="Robot"')
    content = write_recipe(text)
    providers = {service["id"]: service.get("providers") for service in content["services"]}
    assert "opcua" not in providers["Plant::Grip"][0]
    assert list_faults(content) == []


def test_every_part_names_its_element():
    content = write_recipe(samples.task())
    parts = [*content["machines"], *content["services"], *content["functions"], *content["recipes"]]
    parts += [node for graph in content["serviceGraphs"] for node in graph["nodes"]]
    assert all(part["trace"]["element"] for part in parts)


def test_the_trace_of_the_file_contains_machines_nodes_and_edges():
    (artefact,) = emit(samples.task())[0].values()
    assert {"r", "r.a", "robot", "plate", "grip", "close", "mount", "g", "d-a-3"} <= {
        *artefact.trace
    }


# -- faulty files -----------------------------------------------------------------------------


def find_entry(content: object, *path: object):
    """Return the entry on a path of keys and indices."""
    for step in path:
        content = content[step]
    return content


TASK = ("recipes", 0, "tasks", 0)
MUTATIONS = {
    "no recipes": lambda c: c.pop("recipes"),
    "two recipes": lambda c: c["recipes"].append(c["recipes"][0]),
    "another format": lambda c: c.update(format="sysmlc-recipe/2"),
    "short hash": lambda c: c["source"][0].update(sha256="abc"),
    "task without equipment": lambda c: find_entry(c, *TASK).pop("equipment"),
    "mode without machines": lambda c: find_entry(c, *TASK, "equipment", 0).update(machines=[]),
    "fraction of a millisecond": lambda c: find_entry(c, *TASK, "equipment", 0).update(
        duration=1.5
    ),
    "negative time": lambda c: find_entry(c, *TASK).update(maxDuration=-1),
    "material of no use": lambda c: find_entry(c, *TASK, "materials", 0).update(use="lost"),
    "no quantity": lambda c: find_entry(c, *TASK, "materials", 0).update(quantity=0),
    "precedence of one": lambda c: find_entry(c, "recipes", 0)["precedence"].append(["x"]),
    "empty id": lambda c: find_entry(c, *TASK).update(id=""),
    "group of one": lambda c: find_entry(c, *TASK, "derived", "sameMachine", 0).update(nodes=["x"]),
    "call without method": lambda c: find_opcua(c).pop("method"),
    "no node id": lambda c: find_opcua(c).update(object="Robot"),
    "machine service without providers": lambda c: find_service(c, "machine").pop("providers"),
    "loop without bound": lambda c: find_node(c, "loop").pop("unbounded"),
    "loop bounded and not": lambda c: find_node(c, "loop").update(maxIterations=2),
    "service node without service": lambda c: find_node(c, "service").pop("ref"),
    "unknown node": lambda c: find_node(c, "merge").update(kind="goto"),
    "unknown operator": lambda c: find_node(c, "loop").update({"while": {"op": "xor", "args": []}}),
    "unknown member": lambda c: c.update(extra=1),
    "edge without end": lambda c: find_entry(c, "serviceGraphs", 0, "edges", 0).pop("to"),
    "unknown resource mode": lambda c: find_resource(c).update(mode="steal"),
}


def find_service(content: dict, kind: str) -> dict:
    """Return the first service of a kind."""
    return next(service for service in content["services"] if service["kind"] == kind)


def find_opcua(content: dict) -> dict:
    """Return the first OPC UA call of a provider."""
    providers = (
        provider for service in content["services"] for provider in service.get("providers", ())
    )
    return next(provider["opcua"] for provider in providers if "opcua" in provider)


def find_node(content: dict, kind: str) -> dict:
    """Return the first node of a kind in the service graph."""
    nodes = find_entry(content, "serviceGraphs", 0, "nodes")
    return next(node for node in nodes if node["kind"] == kind)


def find_resource(content: dict) -> dict:
    """Return the first resource of a function."""
    functions = content["functions"]
    return next(function["resources"][0] for function in functions if "resources" in function)


@pytest.mark.parametrize("name", MUTATIONS)
def test_the_schema_rejects_a_mutation(name):
    content = write_recipe(samples.task(steps=LOOP))
    assert list_faults(content) == []
    mutation = copy.deepcopy(content)
    MUTATIONS[name](mutation)
    assert list_faults(mutation)


# -- damaged models ----------------------------------------------------------------------------

ATTRIBUTE = re.compile(r' (?!xmi:)\w+="[^"]*"')


def damage(text: str, random: Random) -> str:
    """Remove an element or an attribute, or change a number, in one to three lines."""
    lines = text.split("\n")
    for _ in range(random.randint(1, 3)):
        number = random.randrange(5, len(lines) - 3)
        line, attributes = lines[number], list(ATTRIBUTE.finditer(lines[number]))
        choice = random.random()
        if choice < 0.5:
            lines[number] = "" if line.strip().endswith("/>") else line
        elif choice < 0.8 and attributes:
            attribute = random.choice(attributes)
            lines[number] = line[: attribute.start()] + line[attribute.end() :]
        else:
            value = random.choice(["-1", "0", "99999999", "x"])
            lines[number] = re.sub(r'="\d+"', f'="{value}"', line)
    return "\n".join(lines)


@pytest.mark.parametrize("seed", range(30))
def test_a_damaged_recipe_gives_a_valid_file_or_none(seed, tmp_path):
    random = Random(seed)
    example = find_example(random.choice(["lego-recipe", "four-tasks"]))
    model = tmp_path / example.name
    model.write_text(damage(example.read_text(encoding="utf-8"), random), encoding="utf-8")
    recipes = list_recipes(compile_recipe(model))
    assert [fault for content in recipes for fault in list_faults(content)] == []
