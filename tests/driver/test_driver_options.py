"""Options of passes from the configuration reach the passes, or say what is wrong with them."""

from dataclasses import dataclass

import pytest
from msgspec import Struct

from sysmlc import config
from sysmlc.config import ConfigError
from sysmlc.driver import registry
from sysmlc.passes import pipeline


def passes(folder, text):
    """The passes with the options of a configuration, by name."""
    (folder / "sysmlc.toml").write_text(text)
    options = config.read_config(folder / "sysmlc.toml").passes
    return {one.name: one for one in registry.load_passes(options)}


def test_options_are_fields_of_the_pass(tmp_path):
    made = passes(tmp_path, "[passes.activities]\nmax_markings = 7\n")
    assert made["activities"].max_markings == 7


class StructPass(Struct, frozen=True):
    name: str = "counting"
    after: tuple[str, ...] = ()
    limit: int = 1

    def run(self, graph, sink):
        """Change nothing."""


@dataclass(frozen=True)
class DataclassPass:
    name: str = "counting"
    after: tuple[str, ...] = ()
    limit: int = 1

    def run(self, graph, sink):
        """Change nothing."""


@pytest.mark.parametrize("written", [StructPass(), DataclassPass()])
def test_passes_are_structs_or_dataclasses(monkeypatch, written):
    monkeypatch.setattr(pipeline, "NAMES", ("counting",))
    monkeypatch.setattr(pipeline, "load", lambda name: written)
    (made,) = registry.load_passes({"counting": {"limit": 7}})
    assert (type(made), made.limit, written.limit) == (type(written), 7, 1)
    with pytest.raises(ConfigError, match="did you mean 'limit'"):
        registry.load_passes({"counting": {"limits": 7}})


def test_an_integer_serves_as_a_number(tmp_path):
    assert passes(tmp_path, "[passes.recipe]\ntolerance = 1\n")["recipe"].tolerance == 1


def test_recipe_levels_reach_the_recipe(tmp_path):
    made = passes(tmp_path, '[recipe.levels]\n"Plant::Assemble" = "task"\n')
    assert made["recipe"].levels == {"Plant::Assemble": "task"}


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("[passes.activity]\nx = 1\n", "passes.activity: .* did you mean 'activities'?"),
        ("[passes.activities]\nmax_marking = 1\n", "did you mean 'max_markings'?"),
        ("[passes.activities]\nmax_markings = true\n", "True is no int"),
        ('[passes.activities]\nmax_markings = "7"\n', "'7' is no int"),
        ('[recipe.levels]\nA = "taks"\n', "'taks' is not one of"),
    ],
)
def test_what_is_wrong_is_said(tmp_path, text, sentence):
    with pytest.raises(ConfigError, match=sentence):
        passes(tmp_path, text)


def test_passes_run_in_the_order_that_they_ask_for():
    order = [one.name for one in registry.load_passes({})]
    assert order[:5] == ["resolve", "kept", "overlay", "inherit", "classify"]
    assert order.index("activities") < order.index("contracts")
