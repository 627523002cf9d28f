"""Recipes of parts that a process that stays has made before: as those of one that starts."""

import random
import re
import shutil
from pathlib import Path

import pytest
from edited_units import assert_is_as_from_a_clean_build, compiled_units, sysmlc, work_used_again
from test_driver_staying import with_an_edit

from sysmlc.recipe.model import FlowGraph, Node
from sysmlc.recipe.remembered import remembered

EXAMPLE = Path(__file__).parents[2] / "examples/lego-recipe-v2/lego-recipe.sysml"


@pytest.fixture
def used_again(monkeypatch, tmp_path):
    """A unit with a recipe; what was used again."""
    compiled_units(monkeypatch, tmp_path, {"recipe.sysml": EXAMPLE.read_text("utf-8")})
    return work_used_again(monkeypatch)


@pytest.mark.parametrize("seed", range(4))
def test_any_edits_of_a_recipe(used_again, seed):
    chosen = random.Random(seed)
    path, text = Path("unit/recipe.sysml"), EXAMPLE.read_text("utf-8")
    sysmlc("unit", "-o", "out")
    for _ in range(6):
        path.write_text(with_an_edit(path.read_text() if chosen.random() < 0.4 else text, chosen))
        shutil.rmtree("out", ignore_errors=True)
        assert_is_as_from_a_clean_build()
    assert any(reader.startswith("pass recipe ") for reader in used_again)


def test_numbers_after_parts_were_used_again(used_again):
    """Who asks for a number in a part of a recipe asks for the whole: the recipe follows it."""
    path, text = Path("unit/recipe.sysml"), EXAMPLE.read_text("utf-8")
    for number in range(3):
        with_more = text.replace("action def", f"action def More{number};\n    action def", 1)
        for edited in (with_more, re.sub(r"= \d+", f"= {number + 20}", with_more)):
            path.write_text(edited)
            assert_is_as_from_a_clean_build()
    assert used_again


def test_equal_is_not_enough_to_be_remembered():
    asked = []

    @remembered
    def nodes(graph):
        asked.append(graph)
        yield from graph.nodes

    one, other = (FlowGraph("g", nodes=(Node("a", "action", max_iterations=1),)) for _ in "ab")
    assert one == other
    for graph in (one, one, other, one):
        assert nodes(graph) == graph.nodes
    assert [id(graph) for graph in asked] == [id(one), id(other)]
