"""The lego recipe has the same recipe, contracts and diagrams in SysML v2 and in XMI."""

import json
import re

from examples.compiling import EXAMPLES, TEXT, compile_example, outputs

_FILE_SPECIFIC_KEYS = frozenset({"element", "origin", "inputs", "source"})
"""Keys whose values are ids of elements or digests of files."""
_LOCATION = re.compile(r"lego-recipe\.(uml|sysml)(:\d+)*")


def drop_ids(value):
    """Return a JSON value without ids and locations."""
    if isinstance(value, dict):
        return {
            key: drop_ids(item) for key, item in value.items() if key not in _FILE_SPECIFIC_KEYS
        }
    return [drop_ids(item) for item in value] if isinstance(value, list) else value


def normalise_outputs(compilation):
    """Return all outputs without ids and locations, by path."""
    normalised = {}
    for path, text in outputs(compilation).items():
        is_json = path.endswith(".json")
        normalised[path] = drop_ids(json.loads(text)) if is_json else _LOCATION.sub("", text)
    return normalised


def test_both_notations_of_the_lego_recipe_give_the_same_outputs():
    xmi = next(path for path in EXAMPLES if path.parent.name == "lego-recipe")
    v1 = normalise_outputs(compile_example(xmi))
    v2 = normalise_outputs(compile_example(TEXT))
    assert list(v1) == list(v2)
    assert [path for path in v1 if v1[path] != v2[path]] == []
    assert len(v1) > 100


def test_both_notations_have_the_same_diagnostics():
    xmi = next(path for path in EXAMPLES if path.parent.name == "lego-recipe")
    messages = [
        sorted(
            # SysML v1 has properties, SysML v2 attributes.
            (diagnostic.rule.code, diagnostic.message.replace("property", "attribute"))
            for diagnostic in compile_example(model).diagnostics
        )
        for model in (xmi, TEXT)
    ]
    assert messages[0] == messages[1]
