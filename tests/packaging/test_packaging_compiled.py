"""Compiled modules are for who asks for them: else the package is Python and needs no more."""

import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


@pytest.fixture
def hook(monkeypatch):
    monkeypatch.setattr(sys, "path", [str(ROOT / "compiler"), *sys.path])
    import hatch_build

    yield hatch_build.TablesHook(str(ROOT), {}, None, None, "", "wheel")
    for name in ("hatch_build", "hatch_compiled"):
        sys.modules.pop(name, None)


def test_without_the_variable_building_needs_nothing_more(hook, monkeypatch):
    monkeypatch.delenv("SYSMLC_COMPILED", raising=False)
    assert hook.dependencies() == []


def test_with_the_variable_building_needs_mypyc(hook, monkeypatch):
    monkeypatch.setenv("SYSMLC_COMPILED", "1")
    assert any("mypyc" in one for one in hook.dependencies())


def test_all_modules_that_would_be_compiled_are_there(hook):
    import hatch_compiled

    assert [one for one in hatch_compiled.MODULES if not (ROOT / "compiler" / one).is_file()] == []
    assert len(set(hatch_compiled.MODULES)) == len(hatch_compiled.MODULES)
