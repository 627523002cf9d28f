"""Passes and back ends of other distributions."""

from importlib import import_module
from pathlib import Path

import pytest

from sysmlc.config import ConfigError
from sysmlc.driver import BackendError, list_backend_names, registry

PASS = """\
from typing import ClassVar

from msgspec import Struct


class Census(Struct, frozen=True):
    name: ClassVar[str] = "census"
    after: ClassVar[tuple[str, ...]] = ("views",)
    limit: int = 10

    def run(self, graph, sink):
        pass


PASS = Census()
"""


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """A folder on the path of modules."""
    monkeypatch.syspath_prepend(tmp_path)
    return tmp_path


def install(folder: Path, name: str, group: str, *entries: str) -> None:
    info = folder / f"{name}-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {name}\nVersion: 1.0\n")
    (info / "entry_points.txt").write_text("\n".join([f"[{group}]", *entries, ""]))


def test_back_ends_of_other_distributions_are_found_and_not_loaded(folder):
    install(folder, "shouting", "sysmlc.backends", "shout = shouting:BACKEND")
    assert list(registry.find_plug_ins(registry.BACKEND_GROUP)) == ["shout"]
    assert "shout" in list_backend_names()


def test_back_ends_of_sysmlc_are_no_plug_ins(folder):
    install(folder, "sysmlc", "sysmlc.backends", "uml = sysmlc.backends.uml:BACKEND")
    assert registry.find_plug_ins(registry.BACKEND_GROUP) == {}


def test_a_plug_in_cannot_take_the_name_of_a_back_end(folder):
    install(folder, "shouting", "sysmlc.backends", "uml = shouting:BACKEND")
    with pytest.raises(BackendError, match="shouting:BACKEND takes the name of back end 'uml'"):
        list_backend_names()


def test_a_pass_of_another_distribution_runs_where_its_predecessors_ask(folder):
    (folder / "counting_elements.py").write_text(PASS)
    install(folder, "counting", "sysmlc.passes", "census = counting_elements:PASS")
    passes = registry.load_passes({"census": {"limit": 3}})
    assert passes[-1].name == "census"
    assert passes[-1].limit == 3


@pytest.mark.parametrize(
    ("entry", "message"),
    [
        ("inherit = counting:PASS", "counting:PASS takes the name of pass 'inherit'"),
        ("census = no_such_module:PASS", "pass 'census' cannot be loaded: ModuleNotFoundError"),
    ],
)
def test_a_pass_that_cannot_be_used_is_an_error_of_the_configuration(folder, entry, message):
    install(folder, "counting", "sysmlc.passes", entry)
    with pytest.raises(ConfigError, match=message):
        registry.load_passes({})


@pytest.fixture
def rules():
    """Remove the rule of the pass after the test."""
    yield
    catalogue = import_module("sysmlc.diagnostics.rule")
    catalogue._rules.pop("SM947", None)
    catalogue._names.discard("long-name")


def test_rules_of_a_pass_are_in_the_catalogue(folder, rules):
    (folder / "strict_names.py").write_text(
        "from sysmlc.diagnostics import Severity, rule\n"
        'LONG = rule("SM947", "long-name", Severity.INFO, "a long name")\n' + PASS
    )
    install(folder, "strictness", "sysmlc.passes", "census = strict_names:PASS")
    assert registry.load_full_catalogue()["SM947"].name == "long-name"
