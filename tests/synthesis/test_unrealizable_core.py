"""Unrealizable cores: minimal sets of guarantees that cannot be satisfied together."""

import os
from pathlib import Path

import pytest
import small_games
from contracts_in_lines import parse_contract
from explicit import ExplicitGame
from msgspec.structs import replace

from sysmlc.diagnostics import Sink, Subject
from sysmlc.logic import formats
from sysmlc.synthesis import Manager, make_game, unrealizable
from sysmlc.synthesis.decision import Options, decide
from sysmlc.synthesis.unrealizable import find_unrealizable_core

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


def find_core(contract):
    return find_unrealizable_core(make_game(contract, Manager()))


def test_the_core_contains_the_conflicting_guarantees():
    contract = parse_contract(LIFT)
    core = find_core(contract)
    assert [guarantee.text for guarantee in core] == [
        "floor=0",
        "floor'<=floor + 1",
        "called -> open'",
        "floor!=3 -> !open",
    ]


@pytest.mark.parametrize("start", range(0, 200, 50))
def test_random_cores_are_unrealizable_and_minimal(start):
    for seed in range(start, start + 50):
        contract = small_games.random_contract(seed)
        if ExplicitGame(contract).is_realizable():
            continue
        core = find_core(contract)
        assert not ExplicitGame(replace(contract, guarantees=core)).is_realizable()
        for removed in core:
            smaller_core = tuple(guarantee for guarantee in core if guarantee is not removed)
            assert ExplicitGame(replace(contract, guarantees=smaller_core)).is_realizable()


def test_a_core_of_many_guarantees_needs_few_games(monkeypatch):
    lines = [f"promise always a -> x{index}'" for index in range(64)]
    declarations = [f"sys x{index}: bool" for index in range(64)]
    contract = parse_contract(
        "\n".join(["env a: bool", *declarations, *lines, "promise always a' -> !x40'"])
    )
    games = []
    is_won = unrealizable.is_won
    monkeypatch.setattr(unrealizable, "is_won", lambda game: games.append(game) or is_won(game))
    assert [guarantee.text for guarantee in find_core(contract)] == ["a -> x40'", "a' -> !x40'"]
    assert len(games) < 32


def test_a_limited_search_returns_a_superset_of_the_core():
    contract = parse_contract(LIFT)
    most = find_unrealizable_core(make_game(contract, Manager()), max_checks=2)
    assert set(find_core(contract)) <= set(most)
    assert not ExplicitGame(replace(contract, guarantees=most)).is_realizable()


def test_the_diagnostic_lists_the_core():
    sink = Sink()
    decide(parse_contract(LIFT), lambda origin: Subject(), sink, Options(is_explained=True))
    (diagnostic,) = sink
    assert diagnostic.notes == (
        "these 4 of 6 guarantees cannot be satisfied together; without any one of them the "
        "rest can:",
        "at first: floor=0",
        "always: floor'<=floor + 1",
        "always: called -> open'",
        "always: floor!=3 -> !open",
    )


@pytest.mark.corpus
def test_every_unrealizable_contract_of_din_8580_has_a_core():
    sizes = {}
    for path in sorted(Path(CORPUS, "gr1", "din8580").glob("*.json")):
        (contract,) = formats.read(path.read_text(encoding="utf-8"), path.name, Sink())
        game = make_game(contract, Manager())
        if not unrealizable.is_won(game):
            sizes[path.stem] = len(find_unrealizable_core(game))
    assert len(sizes) == 18
    assert all(0 < size < 12 for size in sizes.values()), sizes
