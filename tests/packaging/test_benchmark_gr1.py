"""Other programs beside ours in the benchmark of contracts: what they are told and what they say.

The programs here are small stand-ins; what is looked at is the file they get and how they are read.
"""

import json
import sys
from pathlib import Path

import pytest

BENCHMARKS = Path(__file__).parents[2] / "benchmarks"
CONTRACT = json.dumps(
    {
        "name": "door",
        "variables": {
            "request": {"owner": "env", "type": "bool"},
            "floor": {"owner": "sys", "type": [0, 3]},
        },
        "assumptions": {"init": [], "safety": [], "liveness": ["request"]},
        "guarantees": {"init": ["floor = 0"], "safety": [], "liveness": ["floor = 2"]},
    }
)
ANSWERS = {
    "gr1c": (
        ("Realizable.", "realizable"),
        ("Not realizable.", "unrealizable"),
        ("gr1c: unknown option", "no verdict"),
    ),
    "slugs": (
        ("SLUGS: SmalL bUt complete GROne Synthesizer\nRESULT: Specification is realizable.",
         "realizable"),
        ("RESULT: Specification is unrealizable.", "unrealizable"),
    ),
}  # fmt: skip
FIRST = {"gr1c": "ENV: request;", "slugs": "[INPUT]"}
"""How a contract begins in the form that a program reads."""


@pytest.fixture
def peer(monkeypatch):
    monkeypatch.syspath_prepend(str(BENCHMARKS))
    from gr1_peers import Peer

    return Peer


def program(folder, body):
    """A program that does this with its arguments."""
    path = folder / "peer"
    path.write_text(f"#!{sys.executable}\nimport sys\n{body}\n", encoding="utf-8")
    path.chmod(0o755)
    return str(path)


@pytest.mark.parametrize(
    ("name", "said", "verdict"),
    [(name, *answer) for name, answers in ANSWERS.items() for answer in answers],
)
def test_what_a_program_says_is_its_verdict(peer, tmp_path, name, said, verdict):
    found = peer(name, program(tmp_path, f"print({said!r})"), 60).decided("d.gr1.json", CONTRACT)
    time, unit, words = found.removeprefix(f"{name} ").split(" ", 2)
    assert (float(time) >= 0, unit, words) == (True, "s", verdict)


@pytest.mark.parametrize("name", ANSWERS)
def test_a_program_is_told_the_contract_in_its_own_form(peer, tmp_path, name):
    seen = tmp_path / "seen"
    body = f"open({str(seen)!r}, 'w').write(repr(sys.argv[1:-1]) + open(sys.argv[-1]).read())"
    peer(name, program(tmp_path, body), 60).decided("d.gr1.json", CONTRACT)
    options, text = seen.read_text().split("]", 1)
    assert options == ("['-r'" if name == "gr1c" else "[")
    assert FIRST[name] in text


def test_a_program_that_is_not_there_or_takes_too_long_is_told(peer, tmp_path):
    assert "does not run" in peer("gr1c", str(tmp_path / "none"), 60).decided(
        "d.gr1.json", CONTRACT
    )
    slow = program(tmp_path, "import time; time.sleep(600)")
    assert peer("slugs", slow, 0.2).decided("d.gr1.json", CONTRACT) == "slugs over 0.2 s"
