"""The glance at what is installed: no is certain, yes may be wrong."""

import sys
from importlib.metadata import entry_points
from pathlib import Path

import pytest

from sysmlc.driver import registry
from sysmlc.driver.distributions import may_be_named

GROUP = "sysmlc.test.group"


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """A folder on the path of modules."""
    monkeypatch.syspath_prepend(tmp_path)
    return tmp_path


def install(folder: Path, name: str, group: str = GROUP) -> None:
    info = folder / name
    info.mkdir()
    (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {name}\nVersion: 1.0\n")
    (info / "entry_points.txt").write_text(f"[{group}]\nshout = shouting:BACKEND\n")


@pytest.mark.parametrize("name", ["shouting-1.0.dist-info", "Shouting-1.0.EGG-INFO"])
def test_a_group_that_a_distribution_names_may_be_there(folder, name):
    install(folder, name)
    assert [entry.name for entry in entry_points(group=GROUP)] == ["shout"]
    assert may_be_named(GROUP)


def test_other_groups_and_folders_do_not_count(folder):
    install(folder, "shouting-1.0.dist-info", "another.group")
    install(folder, "notes")
    (folder / "silent-1.0.dist-info").mkdir()
    (folder / "old-1.0.egg-info").write_text("Metadata-Version: 1.0\n")
    assert not may_be_named(GROUP)


def test_our_own_back_ends_are_no_plug_ins(folder):
    install(folder, "sysmlc-9.9.dist-info")
    assert not may_be_named(GROUP)


def test_a_folder_that_is_not_there_holds_nothing(folder, monkeypatch):
    monkeypatch.syspath_prepend(folder / "nowhere")
    assert not may_be_named(GROUP)


@pytest.mark.parametrize("name", ["packed.zip", "old-1.0.egg"])
def test_what_cannot_be_looked_into_may_hold_anything(folder, monkeypatch, name):
    (folder / name).write_bytes(b"PK")
    monkeypatch.syspath_prepend(folder / name)
    assert may_be_named(GROUP)


def test_finders_of_their_own_may_find_anything(folder, monkeypatch):
    class Finder:
        def find_spec(self, name, path=None, target=None):
            return None

        def find_distributions(self, context=None):
            return iter(())

    monkeypatch.setattr(sys, "meta_path", [*sys.meta_path, Finder()])
    assert may_be_named(GROUP)


def test_plug_ins_are_found_when_there_is_one(folder):
    install(folder, "shouting-1.0.dist-info", registry.GROUP)
    assert [entry.name for entry in registry.plug_ins()] == ["shout"]
    assert "shout" in registry.backend_names()
