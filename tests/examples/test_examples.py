"""Each shipped example gives the outputs that were read and found right (tests/golden/examples).

Kept are the files that people read: recipes, diagrams, contracts as text, and one contract in
every form. ``files.txt`` lists them all, ``findings.txt`` what was found in the model.
"""

import re

import pytest

from examples.compiling import EXAMPLES, PLANT, ROOT, TEXT, compile_example, findings, outputs

_TELLING = re.compile(r"recipes/.*|diagrams/.*|contracts/.*\.md|contracts/.*(Stopper|Gripper)\..*")


@pytest.mark.parametrize("model", [*EXAMPLES, PLANT], ids=lambda path: path.parent.name)
def test_an_example_gives_its_golden_outputs(model, golden):
    compilation = compile_example(model)
    made = outputs(compilation)
    kept = {path: text for path, text in made.items() if _TELLING.fullmatch(path)}
    kept["files.txt"] = "".join(f"{path}\n" for path in sorted(made))
    kept["findings.txt"] = findings(compilation)
    assert compilation.exit_code() == 0
    assert not compilation.withheld
    golden.check(f"examples/{model.parent.name}", kept)


def test_there_are_five_examples():
    names = [path.parent.name for path in (PLANT, *EXAMPLES, TEXT)]
    assert names == ["baygate", "baygate-behaviour", "four-tasks", "lego-recipe", "lego-recipe-v2"]
    assert {path.name for path in (ROOT / "examples").iterdir()} == set(names)


@pytest.mark.parametrize("model", [*EXAMPLES, PLANT, TEXT], ids=lambda path: path.parent.name)
def test_an_example_is_in_the_graph_whole(model):
    total = compile_example(model, "ir").coverage.as_json()["total"]
    assert total["unsupported"] == 0
    assert total["approximated"] == 0
