"""The lego recipe in SysML v2 gives the recipe, the contracts and the diagrams of the XMI."""

import json
import re

from examples.compiling import EXAMPLES, TEXT, compile_example, outputs

_OF_THE_FILE = frozenset({"element", "origin", "inputs", "source"})
"""Keys whose values are ids of elements and digests of files."""
_PLACE = re.compile(r"lego-recipe\.(uml|sysml)(:\d+)*")


def told(value):
    """A JSON value without ids and places."""
    if isinstance(value, dict):
        return {key: told(one) for key, one in value.items() if key not in _OF_THE_FILE}
    return [told(one) for one in value] if isinstance(value, list) else value


def said(compilation):
    """All texts without ids and places, by path."""
    found = {}
    for path, text in outputs(compilation).items():
        is_json = path.endswith(".json")
        found[path] = told(json.loads(text)) if is_json else _PLACE.sub("", text)
    return found


def test_both_notations_of_the_lego_recipe_give_the_same_outputs():
    xmi = next(path for path in EXAMPLES if path.parent.name == "lego-recipe")
    one, other = said(compile_example(xmi)), said(compile_example(TEXT))
    assert list(one) == list(other)
    assert [path for path in one if one[path] != other[path]] == []
    assert len(one) > 100


def test_findings_are_the_same_too():
    xmi = next(path for path in EXAMPLES if path.parent.name == "lego-recipe")
    messages = [
        sorted((found.rule.code, found.message) for found in compile_example(model).diagnostics)
        for model in (xmi, TEXT)
    ]
    assert messages[0] == messages[1]
