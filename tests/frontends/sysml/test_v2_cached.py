"""What was parsed before comes from the cache, and nothing that is made of it differs."""

import pytest

from sysmlc.cache import Cache
from sysmlc.driver import Request, compile_model, select_backends
from sysmlc.language import text as notation

CELL = """
package Cell {
    private import ScalarValues::*;
    private import Machines::*;
    doc /* A cell with an arm. */
    part def Line { part arm : Arm; attribute count : Integer = 3; // pieces
        action work { first start; then action pick; then done; } }
}
"""
MACHINES = """
package Machines {
    part def Arm { port tool; }
    state def Modes { entry; then off; state off; }
}
"""


def made(folder, cache):
    request = Request((folder,), backends=tuple(select_backends(("+sysmlx",))), cache=cache)
    run = compile_model(request)
    found = [(one.rule.code, one.message, one.subject) for one in run.diagnostics]
    return found, [(one.path, one.text, one.trace) for one in run.written()], run.coverage.as_json()


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "unit").mkdir()
    (tmp_path / "unit" / "cell.sysml").write_text(CELL)
    (tmp_path / "unit" / "machines.sysml").write_text(MACHINES)
    return tmp_path / "unit"


def test_outputs_are_the_same_with_a_cache_that_is_empty_one_that_is_full_and_none(
    folder, tmp_path
):
    store = Cache(tmp_path / "cache")
    without = made(folder, None)
    assert without[1]
    assert made(folder, store) == without
    assert made(folder, store) == without


def test_after_an_edit_only_the_edited_file_is_parsed(folder, tmp_path, monkeypatch):
    store = Cache(tmp_path / "cache")
    made(folder, store)
    (folder / "machines.sysml").write_text(MACHINES.replace("port tool;", "port tool; port power;"))
    without = made(folder, None)
    parsed, real = [], notation.parse

    def parse(text, path, *others):
        parsed.append(path)
        return real(text, path, *others)

    monkeypatch.setattr(notation, "parse", parse)
    assert made(folder, store) == without
    assert [path for path in parsed if path.endswith(("cell.sysml", "machines.sysml"))] == [
        "machines.sysml"
    ]
