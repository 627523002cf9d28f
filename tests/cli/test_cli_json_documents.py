"""Every JSON document of the examples and of the commands follows its schema in metamodels/."""

import pytest
from jsonschema import Draft202012Validator

from json_documents import (
    EXAMPLES,
    ROOT,
    SCHEMAS,
    Document,
    command_documents,
    compile_documents,
    find_violations,
)
from sysmlc.driver import registry

MODELS = [folder for folder in sorted(EXAMPLES.iterdir()) if folder.name != "robots"]
MODELS += sorted(EXAMPLES.glob("robots/hall.*"))
FORMATS = {
    version: name
    for name, schema in SCHEMAS.items()
    if (form := schema.get("properties", {}).get("format")) is not None
    for version in form.get("enum") or [form["const"]]
}


@pytest.mark.parametrize("model", MODELS, ids=lambda path: path.name)
def test_documents_of_an_example_follow_their_schemas(model, tmp_path):
    documents = list(compile_documents(model, tmp_path / "out"))
    assert {"sysmlc-manifest", "sysmlc-graph", "sarif"} <= {
        document.schema for document in documents
    }
    assert [line for document in documents for line in find_violations(document)] == []


def test_documents_of_other_commands_follow_their_schemas(tmp_path):
    documents = list(command_documents(tmp_path))
    assert {"gr1c-strategy", "sysmlc-machine", "sysmlc-controller", "sysmlc-diff"} <= {
        document.schema for document in documents
    }
    assert [line for document in documents for line in find_violations(document)] == []


def test_a_violation_names_the_document_and_the_property():
    manifest = {"format": "sysmlc-manifest/2", "files": 1}
    lines = find_violations(Document("manifest.json", "sysmlc-manifest", manifest))
    assert "manifest.json: $.files: 1 is not of type 'array'" in lines


@pytest.mark.parametrize("name", SCHEMAS)
def test_a_schema_is_valid_and_its_id_names_its_format(name):
    schema = SCHEMAS[name]
    Draft202012Validator.check_schema(schema)
    assert schema["$id"].startswith(f"urn:sysmlc:{name.removeprefix('sysmlc-')}:")
    if name in FORMATS.values():
        assert f"{name}/{schema['$id'].rpartition(':')[2]}" in FORMATS


def test_schemas_list_the_languages_of_the_front_ends():
    languages = [frontend.name for frontend in registry.load_frontends()] + ["overlay", "diagrams"]
    manifest, recipe = SCHEMAS["sysmlc-manifest"], SCHEMAS["sysmlc-recipe"]
    of_results = ["contract", "scenario"]
    for inputs, more in (
        (manifest["properties"]["inputs"], of_results),
        (recipe["properties"]["source"], []),
    ):
        assert inputs["items"]["properties"]["language"]["enum"] == [*languages, *more]


@pytest.mark.parametrize("name", SCHEMAS)
def test_the_documentation_lists_every_schema_and_format(name):
    (row,) = [
        line
        for line in (ROOT / "docs" / "outputs.md").read_text().splitlines()
        if line.startswith("|") and f"metamodels/{name}.schema.json" in line
    ]
    formats = [f"`{format_id}`" for format_id, schema in FORMATS.items() if schema == name]
    assert all(format_id in row for format_id in formats)
