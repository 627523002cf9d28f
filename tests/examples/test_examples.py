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


CELL = ROOT / "examples" / "four-tasks" / "cell.aml"


def test_the_recipes_of_four_tasks_are_mapped_to_a_plant(golden):
    """The overlay beside the plant names the recipes, so that both are one unit."""
    compilation = compile_example(CELL, "platform")
    assert {found.rule.code for found in compilation.diagnostics} == {"SM469"}
    golden.check("examples/four-tasks-platform", outputs(compilation))


@pytest.mark.parametrize(
    ("line", "code"), [("Plant::Cart", "SM624"), ("Turn: ", "SM623"), ("takePin}", "SM623")]
)
def test_the_plant_of_four_tasks_without_a_line_of_its_overlay(tmp_path, line, code):
    (tmp_path / ".git").mkdir()
    for path in CELL.parent.iterdir():
        kept = path.read_text("utf-8").splitlines(keepends=True)
        is_overlay = path.name == "cell.overlay.yaml"
        text = "".join(one for one in kept if not (is_overlay and line in one))
        (tmp_path / path.name).write_text(text, "utf-8")
    found = compile_example(tmp_path / CELL.name, "platform").diagnostics
    assert {one.rule.code for one in found} == {"SM469", code}


def test_there_are_six_examples():
    names = [path.parent.name for path in (PLANT, *EXAMPLES, TEXT)]
    assert names == ["baygate", "baygate-behaviour", "four-tasks", "lego-recipe", "lego-recipe-v2"]
    assert {path.name for path in (ROOT / "examples").iterdir()} == {*names, "robots"}


@pytest.mark.parametrize("model", [*EXAMPLES, PLANT, TEXT], ids=lambda path: path.parent.name)
def test_an_example_is_in_the_graph_whole(model):
    total = compile_example(model, "ir").coverage.as_json()["total"]
    assert total["unsupported"] == 0
    assert total["approximated"] == 0
