"""Spoilt copies of the shipped recipes: no crash, and a file that is written is valid."""

import json
import re
from pathlib import Path
from random import Random

import pytest
from jsonschema import Draft202012Validator

from sysmlc.driver import Request, compile_model, select_backends
from sysmlc.support import resources

EXAMPLES = Path(__file__).parents[3] / "examples"
SCHEMA = Draft202012Validator(
    json.loads(resources.read_text("metamodels", "sysmlc-recipe.schema.json"))
)
ATTRIBUTE = re.compile(r' (?!xmi:)\w+="[^"]*"')


def spoilt(text: str, random: Random) -> str:
    """One to three lines without an element, without an attribute, or with another number."""
    lines = text.split("\n")
    for _ in range(random.randint(1, 3)):
        number = random.randrange(5, len(lines) - 3)
        line, attributes = lines[number], list(ATTRIBUTE.finditer(lines[number]))
        choice = random.random()
        if choice < 0.5:
            lines[number] = "" if line.strip().endswith("/>") else line
        elif choice < 0.8 and attributes:
            gone = random.choice(attributes)
            lines[number] = line[: gone.start()] + line[gone.end() :]
        else:
            value = random.choice(["-1", "0", "99999999", "x"])
            lines[number] = re.sub(r'="\d+"', f'="{value}"', line)
    return "\n".join(lines)


@pytest.mark.parametrize("seed", range(30))
def test_a_spoilt_recipe_gives_a_valid_file_or_none(seed, tmp_path):
    random = Random(seed)
    name = random.choice(["lego-recipe", "four-tasks"])
    model = tmp_path / f"{name}.uml"
    text = (EXAMPLES / name / f"{name}.uml").read_text(encoding="utf-8")
    model.write_text(spoilt(text, random), encoding="utf-8")
    compilation = compile_model(Request((model,), backends=tuple(select_backends(["recipe"]))))
    for artefact in compilation.list_published():
        if artefact.path.startswith("recipes/"):
            assert list(SCHEMA.iter_errors(json.loads(artefact.text))) == []
