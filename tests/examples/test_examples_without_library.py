"""The examples in SysML v2 where the distribution ``sysml`` comes without its library files."""

from pathlib import Path

import pytest
from click.testing import CliRunner

from sysmlc.cli.group import sysmlc

EXAMPLES = Path(__file__).parents[2] / "examples"
MODELS = ("lego-recipe-v2/lego-recipe.sysml", "robots/hall.sysml")


def build(model, folder):
    done = CliRunner().invoke(sysmlc, [str(EXAMPLES / model), "-o", str(folder)])
    outputs = {
        path.relative_to(folder): path.read_bytes() for path in folder.rglob("*") if path.is_file()
    }
    return done, outputs


@pytest.mark.parametrize("model", MODELS)
def test_the_bundled_core_gives_the_same_outputs_with_one_warning(model, tmp_path, monkeypatch):
    complete, expected = build(model, tmp_path / "complete")
    monkeypatch.setattr("sysmlc.language.library._find_installed", lambda: None)
    done, outputs = build(model, tmp_path / "core")
    assert (complete.exit_code, done.exit_code) == (0, 0)
    assert outputs == expected
    assert "SM207" not in complete.stderr
    assert done.stderr.count("warning[SM207 no-standard-library]") == 1


@pytest.mark.parametrize(
    ("options", "label"),
    [((), "sysml "), (("--library", "metamodels/core"), "metamodels/core (--library), 6 files")],
)
def test_verbose_names_the_library(options, label, monkeypatch):
    monkeypatch.chdir(EXAMPLES.parent)
    model = "examples/robots/hall.sysml"
    done = CliRunner().invoke(sysmlc, ["check", "-v", *options, model])
    assert f"SysML v2 library: {label}" in done.stderr


def test_verbose_names_no_library_for_a_model_in_xmi():
    model = str(EXAMPLES / "baygate-behaviour/baygate-behaviour.uml")
    assert "library" not in CliRunner().invoke(sysmlc, ["check", "-v", model]).stderr
