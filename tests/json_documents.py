"""The JSON documents that sysmlc writes, and the schemas in metamodels/ that describe them."""

import json
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from click.testing import CliRunner
from jsonschema import Draft202012Validator
from lxml import etree

from sysmlc.cli import group

ROOT = Path(__file__).parents[1]
METAMODELS, EXAMPLES = ROOT / "metamodels", ROOT / "examples"
SCHEMAS: dict[str, dict] = {
    path.name.removesuffix(".schema.json"): json.loads(path.read_text())
    for path in sorted(METAMODELS.glob("*.schema.json"))
}
BACK_ENDS = "contracts,recipe,platform,graph,chase,uml"
"""The back ends that write JSON: ``uml`` does so in a comment of a plant."""

_SCHEMAS_BY_SUFFIX = {".chase.json": "chase-contract", ".gr1c.json": "gr1c-strategy"}
"""Formats of other tools, which have no member ``format``."""
_COMMENT_PREFIX = "sysmlc-kept/1 "
COUNTER = {
    "format": "sysmlc-contract/1",
    "name": "Counter",
    "origin": "counter",
    "variables": {
        "go": {"owner": "env", "type": "bool", "origin": "go"},
        "n": {"owner": "sys", "type": [0, 20], "origin": "n"},
    },
    "assumptions": {"init": [], "safety": [], "liveness": [], "other": []},
    "guarantees": {
        "init": [{"formula": "n = 0", "class": "init", "origin": "n", "text": ""}],
        "safety": [
            {"formula": formula, "class": "safety", "origin": "n", "text": ""}
            for formula in ("go' & n < 20 -> n' = n + 1", "!(go' & n < 20) -> n' = n")
        ],
        "liveness": [],
        "other": [],
    },
}
"""A contract whose machine has a register."""
BLOCK = """Package p "Plant"
  Class c "Cell" role="block"
    Property c.v "v"
"""
_COMBINATIONS = ("allOf", "anyOf", "oneOf")

SARIF = {
    "type": "object",
    "required": ["$schema", "version", "runs"],
    "properties": {
        "version": {"const": "2.1.0"},
        "runs": {
            "type": "array",
            "minItems": 1,
            "items": {
                "type": "object",
                "required": ["tool", "results"],
                "properties": {
                    "tool": {
                        "type": "object",
                        "required": ["driver"],
                        "properties": {
                            "driver": {
                                "type": "object",
                                "required": ["name", "rules"],
                                "properties": {
                                    "rules": {
                                        "items": {
                                            "required": ["id"],
                                            "properties": {
                                                "shortDescription": {"required": ["text"]}
                                            },
                                        }
                                    }
                                },
                            }
                        },
                    },
                    "columnKind": {"enum": ["utf16CodeUnits", "unicodeCodePoints"]},
                    "results": {
                        "type": "array",
                        "items": {
                            "type": "object",
                            "required": ["ruleId", "level", "message", "partialFingerprints"],
                            "properties": {
                                "level": {"enum": ["none", "note", "warning", "error"]},
                                "ruleIndex": {"type": "integer", "minimum": 0},
                                "message": {"required": ["text"]},
                                "locations": {
                                    "type": "array",
                                    "items": {
                                        "properties": {
                                            "physicalLocation": {
                                                "required": ["artifactLocation"],
                                                "properties": {
                                                    "artifactLocation": {
                                                        "properties": {
                                                            "uri": {
                                                                "type": "string",
                                                                "pattern": "^[^/:\\\\ ][^:\\\\ ]*$",
                                                            }
                                                        }
                                                    },
                                                    "region": {
                                                        "properties": {
                                                            "startLine": {"minimum": 1},
                                                            "startColumn": {"minimum": 1},
                                                            "endLine": {"minimum": 1},
                                                            "endColumn": {"minimum": 1},
                                                        }
                                                    },
                                                },
                                            }
                                        }
                                    },
                                },
                            },
                        },
                    },
                },
            },
        },
    },
}
"""The members of SARIF 2.1.0 that sysmlc writes; the official schema is not shipped."""

_VALIDATORS = {
    name: Draft202012Validator(schema) for name, schema in {**SCHEMAS, "sarif": SARIF}.items()
}


class Document(NamedTuple):
    """A JSON document, the path that messages show, and the name of its schema."""

    path: str
    schema: str
    content: dict


# -- writing documents ---------------------------------------------------------------------------


def run(*arguments: object) -> str:
    """Run a command of sysmlc and return its standard output."""
    result = CliRunner().invoke(group.sysmlc, [str(argument) for argument in arguments])
    assert result.exit_code in (0, 1), result.output
    return result.stdout


def compile_documents(model: Path, out: Path, *options: object) -> Iterator[Document]:
    """Yield all documents that compiling a model writes and prints."""
    build = ("build", "--no-cache", "--emit", BACK_ENDS, "-o", out, *options, model)
    yield _run_json(f"{model.name}: findings", *build)
    yield from read_documents(out)
    yield _run_json(f"{model.name}: coverage", "coverage", model)
    yield _run_sarif(f"{model.name}: coverage as SARIF", "coverage", model)


def command_documents(out: Path) -> Iterator[Document]:
    """Yield the documents of the commands that do not compile to an output folder."""
    gate, behaviour = EXAMPLES / "baygate" / "gate.uml", EXAMPLES / "baygate-behaviour"
    hall = EXAMPLES / "robots" / "hall.sysml"
    simulate = ("simulate", behaviour, "--scenario", behaviour / "scenarios" / "stopper.yaml")
    yield _run_sarif("check", "check", "--no-cache", gate)
    yield _run_json("contracts check", "contracts", "check", gate)
    yield _run_json("simulate", *simulate)
    yield _run_json("robots", "robots", hall, "--no-cache", "-o", out / "hall")
    yield _run_json("diff", "diff", hall.with_suffix(".uml"), hall)
    contract = out / "counter.contract.json"
    contract.write_text(json.dumps(COUNTER))
    for form in ("own", "table", "gr1c"):
        yield _run_json("synth", "synth", contract, "--machine", form, "-o", out / form)
    yield from read_documents(out)
    yield from _build_faulty_model(out / "kept")


def _build_faulty_model(folder: Path) -> Iterator[Document]:
    """Yield the manifest of a build that does not update its outputs, since the model is faulty."""
    folder.mkdir()
    model, out = folder / "plant.ir", folder / "out"
    for text in (BLOCK, "no model"):
        model.write_text(text)
        CliRunner().invoke(group.sysmlc, ["build", str(model), "-o", str(out)])
    yield from read_documents(out)


def _run_json(name: str, *arguments: object) -> Document:
    return _make_document(name, json.loads(run(*arguments, "--format", "json")))


def _run_sarif(name: str, *arguments: object) -> Document:
    return Document(name, "sarif", json.loads(run(*arguments, "--format", "sarif")))


def read_documents(folder: Path) -> Iterator[Document]:
    """Yield the JSON files in a folder, and the JSON in comments of its UML files."""
    for path in sorted(folder.rglob("*.json")):
        name = path.relative_to(folder.parent).as_posix()
        yield _make_document(name, json.loads(path.read_text(encoding="utf-8")))
    for path in sorted(folder.rglob("*.uml")):
        for body in etree.parse(path).iter("body"):
            if (body.text or "").startswith(_COMMENT_PREFIX):
                content = json.loads(body.text.removeprefix(_COMMENT_PREFIX))
                yield Document(path.name, "sysmlc-kept", content)


def _make_document(path: str, content: dict) -> Document:
    for suffix, name in _SCHEMAS_BY_SUFFIX.items():
        if path.endswith(suffix):
            return Document(path, name, content)
    return Document(path, str(content.get("format", "no format")).partition("/")[0], content)


# -- checking documents --------------------------------------------------------------------------


def find_violations(document: Document) -> list[str]:
    """Return one line for each place where a document violates its schema."""
    path, schema, content = document
    if schema not in _VALIDATORS:
        return [f"{path}: there is no schema for {schema}"]
    errors = _VALIDATORS[schema].iter_errors(content)
    return [f"{path}: {error.json_path}: {error.message[:200]}" for error in errors]


def declared_properties(name: str) -> set[str]:
    """Return all properties that a schema declares, as ``name#path``."""
    schema = SCHEMAS[name]
    definitions = schema.get("$defs", {}).items()
    roots = [("", schema), *((f"/{key}", definition) for key, definition in definitions)]
    return {f"{name}#{path}" for prefix, root in roots for path in _iter_declared(root, prefix)}


def _iter_declared(schema: object, path: str) -> Iterator[str]:
    if not isinstance(schema, dict):
        return
    for key, inner in schema.get("properties", {}).items():
        yield f"{path}/{key}"
        yield from _iter_declared(inner, f"{path}/{key}")
    for keyword in ("items", "additionalProperties"):
        yield from _iter_declared(schema.get(keyword), path)
    for keyword in _COMBINATIONS:
        for branch in schema.get(keyword, ()):
            yield from _iter_declared(branch, path)


def written_properties(document: Document) -> set[str]:
    """Return the properties of its schema that a valid document has, as ``name#path``."""
    name = document.schema
    if name not in SCHEMAS:
        return set()
    written = _iter_written(_VALIDATORS[name], SCHEMAS[name], document.content, "")
    return {f"{name}#{path}" for path in written}


def _iter_written(
    validator: Draft202012Validator, schema: object, value: object, path: str
) -> Iterator[str]:
    if not isinstance(schema, dict):
        return
    if "$ref" in schema:
        key = schema["$ref"].removeprefix("#/$defs/")
        yield from _iter_written(validator, validator.schema["$defs"][key], value, f"/{key}")
    for keyword in _COMBINATIONS:
        for branch in schema.get(keyword, ()):
            if validator.evolve(schema=branch).is_valid(value):
                yield from _iter_written(validator, branch, value, path)
    if isinstance(value, dict):
        properties = schema.get("properties", {})
        for key, inner in value.items():
            if key in properties:
                yield f"{path}/{key}"
                yield from _iter_written(validator, properties[key], inner, f"{path}/{key}")
            else:
                yield from _iter_written(validator, schema.get("additionalProperties"), inner, path)
    elif isinstance(value, list):
        for item in value:
            yield from _iter_written(validator, schema.get("items"), item, path)
