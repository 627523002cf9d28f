"""The recipe file: valid against its schema, stable, complete; what is wrong the schema rejects."""

import copy
import json

import pytest
from jsonschema import Draft202012Validator

import recipe_samples as samples
from sysmlc.backends.base import EmitOptions, InputFile
from sysmlc.backends.recipe import BACKEND
from sysmlc.diagnostics import Sink
from sysmlc.driver import load_full_catalogue
from sysmlc.ir import parse_text
from sysmlc.passes.recipe import Recipe
from sysmlc.support import resources
from sysmlc.support.output import Output

SCHEMA = json.loads(resources.read_text("metamodels", "sysmlc-recipe.schema.json"))
INPUTS = (InputFile("b.uml", "0" * 64, "xmi"), InputFile("a.uml", "1" * 64, "xmi"))
LOOP = ("s m", "m l", "l d", "d m ok", "d g else", "g a", "a b", "b e")


def emit(text: str) -> tuple[dict[str, dict], list[str]]:
    """Files that the back end makes of a model in IR text, and the codes it reports."""
    graph, sink, output = parse_text(text), Sink(), Output()
    Recipe().run(graph, Sink())
    BACKEND.emit(graph, output, sink, EmitOptions(inputs=INPUTS))
    files = {artefact.path: json.loads(artefact.text) for artefact in output.artefacts()}
    return files, [diagnostic.rule.code for diagnostic in sink]


def recipe_file(text: str) -> dict:
    """The only file."""
    ((_, content),) = emit(text)[0].items()
    return content


def complaints(content: object) -> list[str]:
    """What the schema says against a file."""
    return [error.message for error in Draft202012Validator(SCHEMA).iter_errors(content)]


def test_the_schema_is_a_schema():
    Draft202012Validator.check_schema(SCHEMA)


RIGHT = [samples.task(), samples.task(steps=LOOP), samples.recipe()]
RIGHT += [
    rule.read_page().right
    for rule in load_full_catalogue().values()
    if "SM601" <= rule.code <= "SM622"
]


@pytest.mark.parametrize("text", dict.fromkeys(RIGHT), ids=lambda text: str(len(text)))
def test_a_right_model_gives_a_valid_file(text):
    assert complaints(recipe_file(text)) == []


def test_the_file_has_the_name_of_the_recipe_and_its_sources_in_order():
    files, _ = emit(samples.task())
    assert list(files) == ["recipes/Plant.Build.json"]
    sources = files["recipes/Plant.Build.json"]["source"]
    assert [source["file"] for source in sources] == ["a.uml", "b.uml"]


def test_a_recipe_without_tasks_is_told_and_not_written():
    rule = load_full_catalogue()["SM621"]
    assert emit(rule.read_page().wrong) == ({}, ["SM621"])
    assert emit(rule.read_page().right)[1] == []


def test_an_opc_ua_call_that_nobody_can_make_is_left_out():
    text = samples.task().replace('tag.object="ns=2;s=Robot"', 'tag.object="Robot"')
    providers = {s["id"]: s.get("providers") for s in recipe_file(text)["services"]}
    assert "opcua" not in providers["Plant::Grip"][0]
    assert complaints(recipe_file(text)) == []


def test_every_part_names_its_element():
    content = recipe_file(samples.task())
    parts = [*content["machines"], *content["services"], *content["functions"], *content["recipes"]]
    parts += [node for graph in content["serviceGraphs"] for node in graph["nodes"]]
    assert all(part["trace"]["element"] for part in parts)


def test_the_trace_of_the_file_names_machines_nodes_and_edges():
    graph, output = parse_text(samples.task()), Output()
    Recipe().run(graph, Sink())
    BACKEND.emit(graph, output, Sink(), EmitOptions(inputs=INPUTS))
    (artefact,) = output.artefacts()
    assert {"r", "r.a", "robot", "plate", "grip", "close", "mount", "g", "d-a-3"} <= {
        *artefact.trace
    }


# -- mutations: each must be rejected ----------------------------------------------------------


def at(content: object, *path: object):
    """Something inside a file."""
    for step in path:
        content = content[step]
    return content


TASK = ("recipes", 0, "tasks", 0)
MUTATIONS = {
    "no recipes": lambda c: c.pop("recipes"),
    "two recipes": lambda c: c["recipes"].append(c["recipes"][0]),
    "another format": lambda c: c.update(format="sysmlc-recipe/2"),
    "short hash": lambda c: c["source"][0].update(sha256="abc"),
    "task without equipment": lambda c: at(c, *TASK).pop("equipment"),
    "empty equipment": lambda c: at(c, *TASK).update(equipment=[]),
    "mode without machines": lambda c: at(c, *TASK, "equipment", 0).update(machines=[]),
    "fraction of a millisecond": lambda c: at(c, *TASK, "equipment", 0).update(duration=1.5),
    "negative time": lambda c: at(c, *TASK).update(maxDuration=-1),
    "material of no use": lambda c: at(c, *TASK, "materials", 0).update(use="lost"),
    "no quantity": lambda c: at(c, *TASK, "materials", 0).update(quantity=0),
    "precedence of one": lambda c: at(c, "recipes", 0)["precedence"].append(["x"]),
    "empty id": lambda c: at(c, *TASK).update(id=""),
    "group of one": lambda c: at(c, *TASK, "derived", "sameMachine", 0).update(nodes=["x"]),
    "call without method": lambda c: opcua(c).pop("method"),
    "no node id": lambda c: opcua(c).update(object="Robot"),
    "machine service without providers": lambda c: service(c, "machine").pop("providers"),
    "loop without bound": lambda c: node(c, "loop").pop("unbounded"),
    "loop bounded and not": lambda c: node(c, "loop").update(maxIterations=2),
    "service node without service": lambda c: node(c, "service").pop("ref"),
    "unknown node": lambda c: node(c, "merge").update(kind="goto"),
    "unknown operator": lambda c: node(c, "loop").update({"while": {"op": "xor", "args": []}}),
    "unknown member": lambda c: c.update(extra=1),
    "edge without end": lambda c: at(c, "serviceGraphs", 0, "edges", 0).pop("to"),
    "unknown resource mode": lambda c: resource(c).update(mode="steal"),
}


def service(content: dict, kind: str) -> dict:
    """First service of a kind."""
    return next(service for service in content["services"] if service["kind"] == kind)


def opcua(content: dict) -> dict:
    """First OPC UA call of a provider."""
    offers = [p for service in content["services"] for p in service.get("providers", ())]
    return next(provider["opcua"] for provider in offers if "opcua" in provider)


def node(content: dict, kind: str) -> dict:
    """First node of a kind in the service graph."""
    return next(node for node in at(content, "serviceGraphs", 0, "nodes") if node["kind"] == kind)


def resource(content: dict) -> dict:
    """First resource of a function."""
    return next(f["resources"][0] for f in content["functions"] if "resources" in f)


@pytest.mark.parametrize("name", MUTATIONS)
def test_the_schema_rejects_a_mutation(name):
    content = recipe_file(samples.task(steps=LOOP))
    assert complaints(content) == []
    wrong = copy.deepcopy(content)
    MUTATIONS[name](wrong)
    assert complaints(wrong)
