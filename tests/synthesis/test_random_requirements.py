"""Random requirements of random blocks: ``contracts check`` and an exploration agree.

They agree on the verdicts and on the states, actions, transitions, guards of decisions and features
that no run reaches, satisfies or changes.
"""

import json
from random import Random

import pytest
from click.testing import CliRunner
from component_runs import make_block, move_to_part, write_block
from explicit_requirements import ExploredBlock, make_requirements

from sysmlc.cli import group

LIMIT = 60
"""States of a block; a larger block is drawn again."""
REQUIREMENTS = 5


def explore_random_block(random):
    """Return a random block that is small enough, and its exploration."""
    while True:
        block = make_block(random)
        try:
            return block, ExploredBlock(block, LIMIT)
        except ValueError:
            continue


def require(text, formulas):
    """Return the text of a block with requirements R0, R1 and so on."""
    lines = (
        f"requirement def R{number} {{ subject it : B; require constraint c "
        f'{{ language "ltl" /* {formula} */ }} }}'
        for number, formula in enumerate(formulas)
    )
    head, _, _ = text.rstrip().rpartition("}")
    return "\n".join((head, *lines, "}", ""))


ORDER = ("broken", "not-decided", "holds-if-actions-end", "holds")


def check(path):
    """Return the verdicts of ``contracts check``, and the names of what no run reaches.

    The second result is None if the behaviour is not described. A requirement has the verdict of
    its worst conjunct.
    """
    arguments = ["contracts", "check", "--format", "json", str(path)]
    result = CliRunner().invoke(group.sysmlc, arguments, catch_exceptions=False)
    verdicts = {}
    document = json.loads(result.stdout)
    for entry in document["requirements"]:
        verdicts.setdefault(entry["requirement"], []).append(entry["verdict"])
    members = "unreachable", "never_taken", "never_true", "never_changed"
    unreached = None
    for behaviour in document["behaviours"]:
        unreached = {member: sorted(behaviour[member]) for member in members}
    return [min(verdicts[name], key=ORDER.index) for name in sorted(verdicts)], unreached


def compare(seed, tmp_path):
    """Compare both answers about a random block, and what both find that no run reaches.

    Every second block has a part.
    """
    random = Random(seed)
    block, explored = explore_random_block(random)
    formulas = make_requirements(random, block, REQUIREMENTS)
    path = tmp_path / f"block{seed}.sysml"
    has_part = bool(seed % 2)
    rename = move_to_part if has_part else str
    text = write_block(block, has_part=has_part)
    path.write_text(require(text, map(rename, formulas)), "utf-8")
    expected = dict(zip(formulas, map(explored.decide, formulas), strict=True))
    verdicts, unreached = check(path)
    assert dict(zip(formulas, verdicts, strict=True)) == expected, path.read_text("utf-8")
    explored_names = explored.list_unreached().items()
    expected_names = {member: sorted(map(rename, names)) for member, names in explored_names}
    assert unreached == expected_names, path.read_text("utf-8")


@pytest.mark.parametrize("seed", range(3))
def test_requirements_have_the_verdicts_of_an_exploration(seed, tmp_path):
    compare(seed, tmp_path)


@pytest.mark.long
@pytest.mark.parametrize("start", range(1000, 1250, 25))
def test_requirements_of_many_blocks_have_the_verdicts_of_an_exploration(start, tmp_path):
    for seed in range(start, start + 25):
        compare(seed, tmp_path)
