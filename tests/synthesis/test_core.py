"""Why contracts cannot be kept: small sets of guarantees, none of which can be left out."""

import os
from pathlib import Path

import pytest
import small_games
from contracts_in_lines import contract
from explicit import Explicit
from msgspec.structs import replace

from sysmlc.diagnostics import Sink, Subject
from sysmlc.logic import formats
from sysmlc.synthesis import Manager, make_game, unrealizable
from sysmlc.synthesis.decision import Options, decide
from sysmlc.synthesis.unrealizable import unrealizable_core

CORPUS = os.environ.get("SYSMLC_CORPUS")
LIFT = """
    env called: bool
    sys floor: 0..3
    sys open: bool
    promise at first floor=0
    promise always floor'<=floor + 1
    promise always floor'>=floor - 1
    promise always called -> open'
    promise always floor!=3 -> !open
    promise recurs floor=3
"""


def found(made):
    return unrealizable_core(make_game(made, Manager()))


def test_the_core_says_which_guarantees_cannot_be_kept_together():
    made = contract(LIFT)
    core = found(made)
    assert [one.text for one in core] == [
        "floor=0",
        "floor'<=floor + 1",
        "called -> open'",
        "floor!=3 -> !open",
    ]


@pytest.mark.parametrize("start", range(0, 200, 50))
def test_random_cores_are_lost_and_no_smaller_ones_are(start):
    for seed in range(start, start + 50):
        made = small_games.contract(seed)
        if Explicit(made).is_realizable():
            continue
        core = found(made)
        assert not Explicit(replace(made, guarantees=core)).is_realizable()
        for left in core:
            less = tuple(one for one in core if one is not left)
            assert Explicit(replace(made, guarantees=less)).is_realizable()


def test_a_core_of_many_takes_few_games(monkeypatch):
    lines = [f"promise always a -> x{at}'" for at in range(64)]
    declared = [f"sys x{at}: bool" for at in range(64)]
    made = contract("\n".join(["env a: bool", *declared, *lines, "promise always a' -> !x40'"]))
    played = []
    decided = unrealizable.is_won
    monkeypatch.setattr(unrealizable, "is_won", lambda game: played.append(game) or decided(game))
    assert [one.text for one in found(made)] == ["a -> x40'", "a' -> !x40'"]
    assert len(played) < 32


def test_the_search_ends_with_too_many_rather_than_too_few():
    made = contract(LIFT)
    most = unrealizable_core(make_game(made, Manager()), max_checks=2)
    assert set(found(made)) <= set(most)
    assert not Explicit(replace(made, guarantees=most)).is_realizable()


def test_the_message_names_the_core():
    sink = Sink()
    decide(contract(LIFT), lambda origin: Subject(), sink, Options(is_explained=True))
    (told,) = sink
    assert told.notes == (
        "these 4 of 6 guarantees cannot be satisfied together; without any one of them the "
        "rest can:",
        "at first: floor=0",
        "always: floor'<=floor + 1",
        "always: called -> open'",
        "always: floor!=3 -> !open",
    )


@pytest.mark.corpus
@pytest.mark.skipif(not CORPUS, reason="SYSMLC_CORPUS names no folder")
def test_every_unrealizable_contract_of_din_8580_has_a_core():
    sizes = {}
    for path in sorted(Path(CORPUS, "gr1", "din8580").glob("*.json")):
        (made,) = formats.read(path.read_text(encoding="utf-8"), path.name, Sink())
        game = make_game(made, Manager())
        if not unrealizable.is_won(game):
            sizes[path.stem] = len(unrealizable_core(game))
    assert len(sizes) == 18
    assert all(0 < size < 12 for size in sizes.values()), sizes
