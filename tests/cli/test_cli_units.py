"""Commands on folders with several compile units."""

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
def models(here):
    """A folder with two models that have nothing to do with one another."""
    (here.folder / "plant.ir").unlink()
    here.write("models/one.ir", TYPED.format(name="One"))
    here.write("models/two.ir", UNTYPED.format(name="Two"))
    return here


def inputs(here, manifest):
    return [entry["path"] for entry in json.loads(here.read(manifest))["inputs"]]


def test_check_reports_findings_of_all_units_in_their_files(models):
    done = models.sysmlc("check", "models", "--format", "json")
    (finding,) = json.loads(done.stdout)["diagnostics"]
    assert (finding["name"], finding["file"]) == ("test-untyped-port", "models/two.ir")
    assert done.exit_code == 0
    assert models.sysmlc("check", "models", "--strict").exit_code == 1


def test_build_writes_several_units_to_folders_of_their_own(models):
    done = models.sysmlc("build", "models", "-o", "gen", "--emit", "graph")
    assert done.stdout == "gen/one.ir: 4 files, 4 changed\ngen/two.ir: 4 files, 4 changed\n"
    assert inputs(models, "gen/two.ir/manifest.json") == ["two.ir"]
    models.sysmlc("build", "models/one.ir", "-o", "one", "--emit", "graph")
    assert "manifest.json" in models.files("one")


def test_outputs_of_earlier_units_are_mentioned(models):
    models.sysmlc("build", "models", "-o", "gen", "--emit", "graph")
    (models.folder / "models/two.ir").rename(models.folder / "models/three.ir")
    done = models.sysmlc("build", "models", "-o", "gen", "--emit", "graph")
    assert "gen/two.ir: outputs of an earlier run; no model has this name now" in done.stderr
    assert "gen/one.ir: outputs" not in done.stderr
    checked = models.sysmlc("build", "models", "-o", "gen", "--emit", "graph", "--check")
    assert checked.exit_code == 1


def test_commands_for_one_model_ask_for_the_files_of_one_unit(models):
    done = models.sysmlc("show", "models")
    assert done.exit_code == 2
    assert done.stderr == (
        "sysmlc: the models are 2 compile units; name the files of one, such as "
        "models/one.ir, models/two.ir\n"
    )


def test_coverage_counts_the_files_of_all_units(models):
    done = models.sysmlc("coverage", "models", "--format", "json")
    assert [file["file"] for file in json.loads(done.stdout)["files"]] == [
        "models/one.ir",
        "models/two.ir",
    ]


def test_diff_compares_the_units_of_two_folders(models):
    models.write("changed/one.ir", TYPED.format(name="One"))
    models.write("changed/two.ir", UNTYPED.format(name="Two").replace("Gate", "Door"))
    models.write("changed/three.ir", TYPED.format(name="Three"))
    done = models.sysmlc("diff", "models", "changed")
    assert done.exit_code == 1
    assert "Door: renamed, was Gate" in done.stdout
    assert "Three: added" in done.stdout
    assert "One" not in done.stdout


def test_units_of_a_named_folder_that_the_configuration_declares(models):
    models.write("models/extra.ir", TYPED.format(name="Extra"))
    models.write(
        "sysmlc.toml",
        '[[model]]\nname = "both"\nfiles = ["models/one.ir", "models/two.ir"]\nemit = ["graph"]\n',
    )
    done = models.sysmlc("build", "models", "--emit", "graph")
    assert done.stdout == "out/both: 4 files, 4 changed\nout/models: 4 files, 4 changed\n"
    assert inputs(models, "out/both/manifest.json") == ["models/one.ir", "models/two.ir"]
    assert inputs(models, "out/models/manifest.json") == ["models/extra.ir"]


# -- projects below a named folder ---------------------------------------------------------------


def test_a_folder_with_its_own_configuration_is_compiled_with_it(models):
    models.write("models/cells/a.ir", UNTYPED.format(name="A"))
    models.write("models/cells/sysmlc.toml", '[rules]\ntest-untyped-port = "error"\n')
    done = models.sysmlc("check", "models", "--format", "concise")
    assert done.exit_code == 1
    assert "models/cells/a.ir: error[SM943" in done.stderr
    assert "models/two.ir: warning[SM943" in done.stderr


def test_a_nested_project_writes_to_its_own_output_folder(models):
    models.write("models/cells/a.ir", TYPED.format(name="A"))
    models.write("models/cells/sysmlc.toml", 'output = "gen"\n')
    (models.folder / "models/two.ir").unlink()
    done = models.sysmlc("build", "models", "--emit", "graph")
    assert done.stdout == "out: 4 files, 4 changed\nmodels/cells/gen: 4 files, 4 changed\n"
    done = models.sysmlc("build", "models", "--emit", "graph", "-o", "all")
    assert done.stdout == "all/models: 4 files, 4 changed\nall/cells: 4 files, 4 changed\n"


def test_a_named_configuration_replaces_those_of_nested_projects(models):
    models.write("models/cells/a.ir", UNTYPED.format(name="A"))
    models.write("models/cells/sysmlc.toml", '[rules]\ntest-untyped-port = "error"\n')
    models.write("mine.toml", '[rules]\ntest-untyped-port = "off"\n')
    assert models.sysmlc("check", "models", "--config", "mine.toml").stderr == "no findings\n"
    isolated = models.sysmlc("check", "models", "--isolated", "--format", "concise")
    assert "models/cells/a.ir: warning[SM943" in isolated.stderr


# -- findings about the configuration ------------------------------------------------------------


def test_a_suppression_of_one_unit_is_not_unused_in_another(models):
    models.write("sysmlc.toml", SUPPRESS.format(name="Two"))
    done = models.sysmlc("check", ".", "--strict")
    assert (done.exit_code, done.stderr) == (0, "no findings\n")


def test_a_suppression_for_another_file_is_no_finding_about_a_single_file(models):
    models.write("sysmlc.toml", SUPPRESS.format(name="Two"))
    done = models.sysmlc("check", "models/one.ir", "--strict")
    assert (done.exit_code, done.stderr) == (0, "no findings\n")


def test_a_suppression_that_no_unit_uses_is_reported_once(models):
    models.write("sysmlc.toml", SUPPRESS.format(name="Gone"))
    models.write("notes.xml", "<notes/>")
    done = models.sysmlc("check", "models", "--format", "concise")
    assert done.stderr.count("SM902") == 1


def test_suppressions_of_declared_models_are_judged_together(models):
    units = "".join(
        f'[[model]]\nname = "{name}"\nfiles = ["models/{name}.ir"]\n' for name in ("one", "two")
    )
    models.write("sysmlc.toml", SUPPRESS.format(name="Two") + units)
    assert models.sysmlc("check", "--strict").exit_code == 0
    assert models.sysmlc("check", "models/one.ir", "--strict").exit_code == 0
    models.write("sysmlc.toml", SUPPRESS.format(name="Gone") + units)
    assert models.sysmlc("check", "--format", "concise").stderr.count("SM902") == 1


def test_levels_of_elements_of_another_unit_are_known(models):
    models.write("sysmlc.toml", '[recipe.levels]\n"Two::Gate" = "task"\n')
    assert "SM903" not in models.sysmlc("check", ".").stderr
    assert "SM903" not in models.sysmlc("check", "models/one.ir").stderr
    models.write("sysmlc.toml", '[recipe.levels]\n"Three::Gate" = "task"\n')
    assert models.sysmlc("check", ".").stderr.count("SM903") == 1
