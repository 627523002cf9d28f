"""The examples in SysML v2, compiled with and without the installed standard library."""

from pathlib import Path

import pytest
from click.testing import CliRunner

from sysmlc.cli.group import sysmlc

EXAMPLES = Path(__file__).parents[2] / "examples"
MODELS = ("lego-recipe-v2/lego-recipe.sysml", "robots/hall.sysml")


def build_example(model, folder):
    result = CliRunner().invoke(sysmlc, [str(EXAMPLES / model), "-o", str(folder)])
    outputs = {
        path.relative_to(folder): path.read_bytes() for path in folder.rglob("*") if path.is_file()
    }
    return result, outputs


@pytest.mark.parametrize("model", MODELS)
def test_the_bundled_core_gives_the_same_outputs_with_one_warning(model, tmp_path, monkeypatch):
    with_library, expected = build_example(model, tmp_path / "complete")
    monkeypatch.setattr("sysmlc.language.library._find_installed", lambda: None)
    result, outputs = build_example(model, tmp_path / "core")
    assert (with_library.exit_code, result.exit_code) == (0, 0)
    assert outputs == expected
    assert "SM207" not in with_library.stderr
    assert result.stderr.count("warning[SM207 no-standard-library]") == 1


@pytest.mark.parametrize(
    ("options", "label"),
    [((), "sysml "), (("--library", "metamodels/core"), "metamodels/core (--library), 6 files")],
)
def test_verbose_names_the_library(options, label, monkeypatch):
    monkeypatch.chdir(EXAMPLES.parent)
    model = "examples/robots/hall.sysml"
    result = CliRunner().invoke(sysmlc, ["check", "-v", *options, model])
    assert f"SysML v2 library: {label}" in result.stderr


def test_verbose_names_no_library_for_a_model_in_xmi():
    model = str(EXAMPLES / "baygate-behaviour/baygate-behaviour.uml")
    assert "library" not in CliRunner().invoke(sysmlc, ["check", "-v", model]).stderr
