"""Verdicts, runs, controllers and counter-strategies: the same bytes whatever the hash seed."""

import os
import re
import subprocess
import sys

import pytest

from sysmlc.synthesis import composition_check as together_rules
from sysmlc.synthesis import contract_checks as check
from sysmlc.synthesis import rules

GRANTS = """\
{"variables": {"first": {"owner": "env", "type": "bool"},
  "second": {"owner": "env", "type": "bool"},
  "grant": {"owner": "sys", "type": ["none", "one", "two"]},
  "rounds": {"owner": "sys", "type": [0, 2]}},
 "assumptions": {"liveness": ["first", "second"]},
 "guarantees": {"init": ["rounds=0"],
  "safety": ["grant'=one -> first'", "grant'=two -> second'",
    "rounds'=rounds | rounds'=rounds+1 | rounds=2 & rounds'=0"],
  "liveness": ["grant=one", "grant=two", "rounds=2"]}}
"""
MODELS = {
    "grants.gr1.json": GRANTS,
    "dark.gr1.json": rules.UNREALIZABLE.read_page().wrong,
    "gate.ir": check.BREAKS.read_page().wrong,
    "open.sysml": together_rules.OPEN.read_page().wrong,
    "circle.sysml": together_rules.CIRCLE.read_page().wrong,
    "lost.sysml": together_rules.LOST.read_page().wrong,
}
# One process does them all: a process each would take most of its time to start.
COMMANDS = """\
import sys
from sysmlc.cli.group import sysmlc
for name in sys.argv[1:]:
    work = ["contracts", "check"] if not name.endswith(".gr1.json") else ["synth"]
    try:
        sysmlc([*work, name, "-o", f"out/{name}"], prog_name="sysmlc")
    except SystemExit as end:
        print(name, end.code)
"""


def made(folder, seed):
    """All files that the commands write, and what they say, without how long it took."""
    folder.mkdir()
    for name, text in MODELS.items():
        (folder / name).write_text(text, encoding="utf-8")
    done = subprocess.run(
        [sys.executable, "-c", COMMANDS, *MODELS],
        cwd=folder,
        env={**os.environ, "PYTHONHASHSEED": seed, "SYSMLC_CACHE": "off"},
        capture_output=True,
        text=True,
    )
    found = {
        str(one.relative_to(folder)): one.read_bytes() for one in folder.rglob("*") if one.is_file()
    }
    return found, re.sub(r"[0-9.]+ m?s\b", "", done.stdout), done.stderr


@pytest.mark.long
def test_three_hash_seeds_give_the_same_controllers_runs_and_reports(tmp_path):
    files, said, told = made(tmp_path / "1", "1")
    assert re.findall(r"^(\S+) (\d)$", said, re.MULTILINE) == [
        *(("grants.gr1.json", "0"), ("dark.gr1.json", "1"), ("gate.ir", "1")),
        *(("open.sysml", "1"), ("circle.sysml", "1"), ("lost.sysml", "0")),
    ]
    assert {"out/grants.gr1.json/grants.machine.json", "out/dark.gr1.json/dark.counter.puml"} <= {
        *files
    }
    assert sum(one.endswith("run1.puml") for one in files) == 4
    assert made(tmp_path / "2", "2") == (files, said, told)
    assert made(tmp_path / "3", "31") == (files, said, told)
