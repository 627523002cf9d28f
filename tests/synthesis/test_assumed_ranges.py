"""No answer without a reservation is contradicted by a block that is played in a wider range."""

import json
import re
from random import Random

import pytest
from assumed_blocks import LEVELS, REQUIRED, ExploredBlock, make_block, write_block
from click.testing import CliRunner

from long_runs import quick_first
from sysmlc.cli import group

BLOCKS = 8
WIDE = range(LEVELS[0], LEVELS[-1] + 1)


def read_ranges(texts):
    """Return the ranges of ``level`` and ``count`` in which an answer holds, wide if not named."""
    named = (re.fullmatch(r"(\w+) in (-?\d+)\.\.(-?\d+)", text).groups() for text in texts)
    ranges = {name: range(int(low), int(high) + 1) for name, low, high in named}
    return {"level": WIDE, "count": WIDE} | ranges


@pytest.mark.parametrize("seed", quick_first(range(20), 2))
def test_answers_without_reservation_hold_in_a_wider_range(seed, tmp_path):
    random = Random(seed)
    path = tmp_path / "block.sysml"
    for _ in range(BLOCKS):
        block = make_block(random)
        text = write_block(block)
        path.write_text(text, "utf-8")
        arguments = ["contracts", "check", "--format", "json", str(path)]
        result = CliRunner().invoke(group.sysmlc, arguments, catch_exceptions=False)
        document = json.loads(result.stdout)
        wide = ExploredBlock(block, WIDE, WIDE)
        for formula, entry in zip(REQUIRED, document["requirements"], strict=True):
            answer = entry["verdict"], bool(entry["assumed_ranges"])
            narrow = ExploredBlock(block, **read_ranges(entry["assumed_ranges"]))
            if answer == ("holds", False):
                assert not wide.violates(formula), (formula, text)
            elif answer == ("holds-within-assumed-ranges", True):
                assert not narrow.violates(formula), (formula, text)
            elif answer == ("broken", False):
                assert wide.violates(formula), (formula, text)
            else:
                assert entry["verdict"] == "not-decided", (formula, text)
                assert entry["reason"], (formula, text)
        for behaviour in document["behaviours"]:
            explored = ExploredBlock(block, **read_ranges(behaviour["assumed_ranges"]))
            states = {state for state, _ in explored.reached}
            assert states.isdisjoint(name[-1] for name in behaviour["unreachable"]), text
