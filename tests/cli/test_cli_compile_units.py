"""Commands on folders that contain several compile units."""

import json

import pytest

TYPED = """\
Package pkg "{name}"
  Class gate "Gate"
    Port gate.in "in"
      -> typed-by pallet
  Signal pallet "Pallet"
"""
UNTYPED = TYPED.replace("      -> typed-by pallet\n", "")
SUPPRESS = """\
[[suppress]]
rule = "test-untyped-port"
element = "{name}::Gate::in"
reason = "test"
"""


@pytest.fixture
def models(workspace):
    """A folder with two independent models; the port in ``two.ir`` has no type."""
    (workspace.folder / "plant.ir").unlink()
    workspace.write("models/one.ir", TYPED.format(name="One"))
    workspace.write("models/two.ir", UNTYPED.format(name="Two"))
    return workspace


def test_check_reports_diagnostics_of_all_units(models):
    result = models.sysmlc("check", "models", "--format", "json")
    (finding,) = json.loads(result.stdout)["diagnostics"]
    assert (finding["name"], finding["file"]) == ("test-untyped-port", "models/two.ir")
    assert result.exit_code == 0
    assert models.sysmlc("check", "models", "--strict").exit_code == 1


def test_build_writes_several_units_to_folders_of_their_own(models):
    result = models.sysmlc("build", "models", "-o", "gen", "--emit", "graph")
    assert result.stdout == "gen/one.ir: 4 files, 4 changed\ngen/two.ir: 4 files, 4 changed\n"
    assert models.list_inputs("gen/two.ir") == ["two.ir"]
    models.sysmlc("build", "models/one.ir", "-o", "one", "--emit", "graph")
    assert "manifest.json" in models.list_files("one")


def test_outputs_of_a_unit_that_no_longer_exists_are_reported(models):
    models.sysmlc("build", "models", "-o", "gen", "--emit", "graph")
    (models.folder / "models/two.ir").rename(models.folder / "models/three.ir")
    result = models.sysmlc("build", "models", "-o", "gen", "--emit", "graph")
    assert "gen/two.ir: outputs of an earlier run; no model has this name now" in result.stderr
    assert "gen/one.ir: outputs" not in result.stderr
    result = models.sysmlc("build", "models", "-o", "gen", "--emit", "graph", "--check")
    assert result.exit_code == 1


def test_a_command_for_one_model_lists_the_units_to_choose_from(models):
    result = models.sysmlc("show", "models")
    assert result.exit_code == 2
    assert result.stderr == (
        "sysmlc: the models are 2 compile units; name the files of one, such as "
        "models/one.ir, models/two.ir\n"
    )


def test_coverage_counts_the_files_of_all_units(models):
    result = models.sysmlc("coverage", "models", "--format", "json")
    assert [file["file"] for file in json.loads(result.stdout)["files"]] == [
        "models/one.ir",
        "models/two.ir",
    ]


def test_diff_compares_the_units_of_two_folders(models):
    models.write("changed/one.ir", TYPED.format(name="One"))
    models.write("changed/two.ir", UNTYPED.format(name="Two").replace("Gate", "Door"))
    models.write("changed/three.ir", TYPED.format(name="Three"))
    result = models.sysmlc("diff", "models", "changed")
    assert result.exit_code == 1
    assert "Door: renamed, was Gate" in result.stdout
    assert "Three: added" in result.stdout
    assert "One" not in result.stdout


def test_units_declared_in_the_configuration_are_separate_units_of_a_named_folder(models):
    models.write("models/extra.ir", TYPED.format(name="Extra"))
    models.write(
        "sysmlc.toml",
        '[[model]]\nname = "both"\nfiles = ["models/one.ir", "models/two.ir"]\nemit = ["graph"]\n',
    )
    result = models.sysmlc("build", "models", "--emit", "graph")
    assert result.stdout == "out/both: 4 files, 4 changed\nout/models: 4 files, 4 changed\n"
    assert models.list_inputs("out/both") == ["models/one.ir", "models/two.ir"]
    assert models.list_inputs("out/models") == ["models/extra.ir"]


# -- projects below a named folder ---------------------------------------------------------------


def test_a_folder_with_its_own_configuration_is_compiled_with_it(models):
    models.write("models/cells/a.ir", UNTYPED.format(name="A"))
    models.write("models/cells/sysmlc.toml", '[rules]\ntest-untyped-port = "error"\n')
    result = models.sysmlc("check", "models", "--format", "concise")
    assert result.exit_code == 1
    assert "models/cells/a.ir: error[SM943" in result.stderr
    assert "models/two.ir: warning[SM943" in result.stderr


def test_a_nested_project_writes_to_its_own_output_folder(models):
    models.write("models/cells/a.ir", TYPED.format(name="A"))
    models.write("models/cells/sysmlc.toml", 'output = "gen"\n')
    (models.folder / "models/two.ir").unlink()
    result = models.sysmlc("build", "models", "--emit", "graph")
    assert result.stdout == "out: 4 files, 4 changed\nmodels/cells/gen: 4 files, 4 changed\n"
    result = models.sysmlc("build", "models", "--emit", "graph", "-o", "all")
    assert result.stdout == "all/models: 4 files, 4 changed\nall/cells: 4 files, 4 changed\n"


def test_a_named_configuration_replaces_those_of_nested_projects(models):
    models.write("models/cells/a.ir", UNTYPED.format(name="A"))
    models.write("models/cells/sysmlc.toml", '[rules]\ntest-untyped-port = "error"\n')
    models.write("mine.toml", '[rules]\ntest-untyped-port = "off"\n')
    assert models.sysmlc("check", "models", "--config", "mine.toml").stderr == "no findings\n"
    isolated = models.sysmlc("check", "models", "--isolated", "--format", "concise")
    assert "models/cells/a.ir: warning[SM943" in isolated.stderr


# -- diagnostics about the configuration ---------------------------------------------------------


def test_a_suppression_of_one_unit_is_not_unused_in_another(models):
    models.write("sysmlc.toml", SUPPRESS.format(name="Two"))
    result = models.sysmlc("check", ".", "--strict")
    assert (result.exit_code, result.stderr) == (0, "no findings\n")


def test_a_suppression_for_another_file_is_not_unused_when_one_file_is_compiled(models):
    models.write("sysmlc.toml", SUPPRESS.format(name="Two"))
    result = models.sysmlc("check", "models/one.ir", "--strict")
    assert (result.exit_code, result.stderr) == (0, "no findings\n")


def test_a_suppression_that_no_unit_uses_is_reported_once(models):
    models.write("sysmlc.toml", SUPPRESS.format(name="Gone"))
    models.write("notes.xml", "<notes/>")
    result = models.sysmlc("check", "models", "--format", "concise")
    assert result.stderr.count("SM902") == 1


def test_suppressions_are_unused_only_if_no_declared_unit_uses_them(models):
    units = "".join(
        f'[[model]]\nname = "{name}"\nfiles = ["models/{name}.ir"]\n' for name in ("one", "two")
    )
    models.write("sysmlc.toml", SUPPRESS.format(name="Two") + units)
    assert models.sysmlc("check", "--strict").exit_code == 0
    assert models.sysmlc("check", "models/one.ir", "--strict").exit_code == 0
    models.write("sysmlc.toml", SUPPRESS.format(name="Gone") + units)
    assert models.sysmlc("check", "--format", "concise").stderr.count("SM902") == 1


def test_levels_of_elements_of_another_unit_are_no_errors(models):
    models.write("sysmlc.toml", '[recipe.levels]\n"Two::Gate" = "task"\n')
    assert "SM903" not in models.sysmlc("check", ".").stderr
    assert "SM903" not in models.sysmlc("check", "models/one.ir").stderr
    models.write("sysmlc.toml", '[recipe.levels]\n"Three::Gate" = "task"\n')
    assert models.sysmlc("check", ".").stderr.count("SM903") == 1
