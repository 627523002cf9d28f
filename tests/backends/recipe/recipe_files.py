"""The recipe files that the back end ``recipe`` writes, and their schema."""

import json
from pathlib import Path

from jsonschema import Draft202012Validator

from examples.compiling import ROOT, compile_example, outputs
from sysmlc.driver import Compilation
from sysmlc.support import resources

SCHEMA = json.loads(resources.read_text("metamodels", "sysmlc-recipe.schema.json"))
_VALIDATOR = Draft202012Validator(SCHEMA)


def find_example(name: str) -> Path:
    """Return the model of an example in UML."""
    return ROOT / "examples" / name / f"{name}.uml"


def compile_recipe(model: Path) -> Compilation:
    """Compile a model with the back end ``recipe`` only."""
    return compile_example(model, "recipe")


def list_recipes(compilation: Compilation) -> list[dict]:
    """Return the contents of all recipe files."""
    texts = outputs(compilation)
    return [json.loads(text) for path, text in texts.items() if path.startswith("recipes/")]


def list_faults(content: object) -> list[str]:
    """Return the messages of the schema about the content of a recipe file."""
    return [error.message for error in _VALIDATOR.iter_errors(content)]
