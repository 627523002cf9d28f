"""Verdicts, runs, controllers and counter-strategies do not depend on the hash seed."""

import os
import re
import subprocess
import sys

import pytest

from sysmlc.synthesis import composition_check, contract_checks, rules

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
    "gate.ir": contract_checks.BREAKS.read_page().wrong,
    "open.sysml": composition_check.OPEN.read_page().wrong,
    "circle.sysml": composition_check.CIRCLE.read_page().wrong,
    "lost.sysml": composition_check.LOST.read_page().wrong,
}
# One process runs all commands, because a process for each would mostly start up.
COMMANDS = """\
import sys
from sysmlc.cli.group import sysmlc
for name in sys.argv[1:]:
    command = ["synth"] if name.endswith(".gr1.json") else ["contracts", "check"]
    try:
        sysmlc([*command, name, "-o", f"out/{name}"], prog_name="sysmlc")
    except SystemExit as end:
        print(name, end.code)
"""


def run_commands(folder, seed):
    """Return the files that the commands write, and their output without the durations."""
    folder.mkdir()
    for name, text in MODELS.items():
        (folder / name).write_text(text, encoding="utf-8")
    process = subprocess.run(
        [sys.executable, "-c", COMMANDS, *MODELS],
        cwd=folder,
        env={**os.environ, "PYTHONHASHSEED": seed, "SYSMLC_CACHE": "off"},
        capture_output=True,
        text=True,
    )
    files = {
        str(path.relative_to(folder)): path.read_bytes()
        for path in folder.rglob("*")
        if path.is_file()
    }
    return files, re.sub(r"[0-9.]+ m?s\b", "", process.stdout), process.stderr


@pytest.mark.long
def test_three_hash_seeds_give_the_same_files_and_messages(tmp_path):
    files, stdout, stderr = run_commands(tmp_path / "1", "1")
    assert re.findall(r"^(\S+) (\d)$", stdout, re.MULTILINE) == [
        *(("grants.gr1.json", "0"), ("dark.gr1.json", "1"), ("gate.ir", "1")),
        *(("open.sysml", "1"), ("circle.sysml", "1"), ("lost.sysml", "0")),
    ]
    assert {"out/grants.gr1.json/grants.machine.json", "out/dark.gr1.json/dark.counter.puml"} <= {
        *files
    }
    assert sum(path.endswith("run1.puml") for path in files) == 4
    assert run_commands(tmp_path / "2", "2") == (files, stdout, stderr)
    assert run_commands(tmp_path / "3", "31") == (files, stdout, stderr)
