"""Each example has the outputs in tests/golden/examples, which were reviewed by reading.

The golden files are those that people read: recipes, diagrams, contracts as text, and one contract
in every format. ``files.txt`` lists all outputs, ``findings.txt`` the diagnostics.
"""

import re

import pytest

from examples.compiling import (
    EXAMPLES,
    PLANT,
    ROOT,
    TANKS,
    TEXT,
    compile_example,
    format_diagnostics,
    outputs,
)

MODELS = [*EXAMPLES, PLANT, TANKS, TEXT]

_GOLDEN_OUTPUTS = re.compile(
    r"recipes/.*|diagrams/.*|contracts/.*\.md|contracts/.*(Stopper|Gripper)\..*"
)


@pytest.mark.parametrize("model", [*EXAMPLES, PLANT, TANKS], ids=lambda path: path.parent.name)
def test_an_example_has_its_golden_outputs(model, golden):
    compilation = compile_example(model)
    texts = outputs(compilation)
    reviewed = {path: text for path, text in texts.items() if _GOLDEN_OUTPUTS.fullmatch(path)}
    reviewed["files.txt"] = "".join(f"{path}\n" for path in sorted(texts))
    reviewed["findings.txt"] = format_diagnostics(compilation)
    assert compilation.exit_code() == 0
    assert not compilation.withheld
    golden.check(f"examples/{model.parent.name}", reviewed)


CELL = ROOT / "examples" / "four-tasks" / "cell.aml"


def test_the_recipes_of_four_tasks_are_mapped_to_a_plant(golden):
    """The overlay of the plant names the recipes, so that both are one unit."""
    compilation = compile_example(CELL, "platform")
    assert {diagnostic.rule.code for diagnostic in compilation.diagnostics} == {"SM469"}
    golden.check("examples/four-tasks-platform", outputs(compilation))


@pytest.mark.parametrize(
    ("removed", "code"), [("Plant::Cart", "SM624"), ("Turn: ", "SM623"), ("takePin}", "SM623")]
)
def test_a_missing_line_in_the_overlay_of_four_tasks_is_reported(tmp_path, removed, code):
    (tmp_path / ".git").mkdir()
    for path in CELL.parent.iterdir():
        lines = path.read_text("utf-8").splitlines(keepends=True)
        is_overlay = path.name == "cell.overlay.yaml"
        text = "".join(line for line in lines if not (is_overlay and removed in line))
        (tmp_path / path.name).write_text(text, "utf-8")
    diagnostics = compile_example(tmp_path / CELL.name, "platform").diagnostics
    assert {diagnostic.rule.code for diagnostic in diagnostics} == {"SM469", code}


def test_the_examples_are_those_in_the_folder():
    names = [path.parent.name for path in (PLANT, *EXAMPLES, TEXT)]
    assert names == ["baygate", "baygate-behaviour", "four-tasks", "lego-recipe", "lego-recipe-v2"]
    assert {path.name for path in (ROOT / "examples").iterdir()} == {*names, "robots", "two-tanks"}


@pytest.mark.parametrize("model", MODELS, ids=lambda path: path.parent.name)
def test_an_example_has_no_unsupported_and_no_approximated_elements(model):
    total = compile_example(model, "ir").coverage.as_json()["total"]
    assert total["unsupported"] == 0
    assert total["approximated"] == 0
