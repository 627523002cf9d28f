"""The benchmark of contracts runs other synthesis programs: their inputs and their outputs.

Small scripts take the place of the programs. The tests check the file that a script receives, and
the verdict that the benchmark reads from its output.
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
FIRST_LINES = {"gr1c": "ENV: request;", "slugs": "[INPUT]"}
"""The first line of a contract in the format that a program reads."""


@pytest.fixture
def peer_class(monkeypatch):
    monkeypatch.syspath_prepend(str(BENCHMARKS))
    from gr1_peers import Peer

    return Peer


def write_program(folder, body):
    """Write an executable script with this body and return its path."""
    path = folder / "peer"
    path.write_text(f"#!{sys.executable}\nimport sys\n{body}\n", encoding="utf-8")
    path.chmod(0o755)
    return str(path)


@pytest.mark.parametrize(
    ("name", "output", "verdict"),
    [(name, *answer) for name, answers in ANSWERS.items() for answer in answers],
)
def test_the_verdict_is_read_from_the_output_of_the_program(
    peer_class, tmp_path, name, output, verdict
):
    result = peer_class(name, write_program(tmp_path, f"print({output!r})"), 60).decide(
        "d.gr1.json", CONTRACT
    )
    seconds, unit, reported = result.removeprefix(f"{name} ").split(" ", 2)
    assert (float(seconds) >= 0, unit, reported) == (True, "s", verdict)


@pytest.mark.parametrize("name", ANSWERS)
def test_a_program_gets_the_contract_in_its_own_format(peer_class, tmp_path, name):
    received = tmp_path / "received"
    body = f"open({str(received)!r}, 'w').write(repr(sys.argv[1:-1]) + open(sys.argv[-1]).read())"
    peer_class(name, write_program(tmp_path, body), 60).decide("d.gr1.json", CONTRACT)
    options, text = received.read_text().split("]", 1)
    assert options == ("['-r'" if name == "gr1c" else "[")
    assert FIRST_LINES[name] in text


def test_a_missing_or_slow_program_is_reported(peer_class, tmp_path):
    assert "does not run" in peer_class("gr1c", str(tmp_path / "none"), 60).decide(
        "d.gr1.json", CONTRACT
    )
    slow = write_program(tmp_path, "import time; time.sleep(600)")
    assert peer_class("slugs", slow, 0.2).decide("d.gr1.json", CONTRACT) == "slugs over 0.2 s"
