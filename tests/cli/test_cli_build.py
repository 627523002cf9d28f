"""``sysmlc build`` and ``sysmlc check``: a model, the command, the expected lines."""

import json
import os

import pytest

from sysmlc.driver import registry

FAULTY = """\
Package pkg "Plant"
  Class gate "Gate"
    Port gate.in
"""
UNTYPED = FAULTY.replace("gate.in", 'gate.in "in"')
OUTPUTS = ["coverage.json", "graph.json", "manifest.json", "trace.json"]


def test_a_model_without_a_command_word_is_built(here):
    done = here.sysmlc("plant.ir", "-o", "out", "--emit", "graph")
    assert (done.exit_code, done.stdout, done.stderr) == (0, "out: 4 files, 4 changed\n", "")
    assert here.files() == OUTPUTS


def test_so_it_is_when_an_option_comes_first(here):
    assert here.sysmlc("--emit", "graph", "plant.ir").exit_code == 0
    assert here.files() == OUTPUTS


def test_a_second_run_changes_nothing(here):
    here.sysmlc("plant.ir", "--emit", "graph")
    os.utime(here.folder / "out/graph.json", (1, 1))
    assert here.sysmlc("plant.ir", "--emit", "graph").stdout == "out: 4 files, 0 changed\n"
    assert (here.folder / "out/graph.json").stat().st_mtime == 1


def test_an_error_is_exit_code_1(here):
    here.write("faulty.ir", FAULTY)
    done = here.sysmlc("faulty.ir", "--emit", "graph")
    assert done.exit_code == 1
    assert done.stderr == (
        "error[SM942 test-nameless-port]: a port of 'Gate' has no name\n"
        "  --> faulty.ir (Plant::Gate::<Port>)\n"
        "  help: name the port\n"
        "\n"
        "1 error in 1 file\n"
    )


@pytest.mark.parametrize(("option", "code"), [([], 0), (["--strict"], 1)])
def test_a_warning_is_exit_code_0_and_with_strict_1(here, option, code):
    here.write("untyped.ir", UNTYPED)
    assert here.sysmlc("check", "untyped.ir", *option).exit_code == code


@pytest.mark.parametrize(
    ("args", "sentence"),
    [
        (["no.ir"], "there is no file or folder 'no.ir'"),
        (["plant.ir", "--emit", "grph"], "unknown back end 'grph'; did you mean 'graph'?"),
        (["plant.ir", "--emit", "+recipes"], "unknown back end 'recipes'; did you mean 'recipe'?"),
        (["plant.ir", "--templates", "no"], "there is no folder 'no' for templates"),
        (["plant.ir", "--print-after", "port"], "unknown pass 'port'; did you mean 'ports'?"),
        (["plant.ir", "--fromat", "json"], "No such option"),
        (["plant.ir", "--format", "xml"], "is not one of"),
        (["explain", "missing-fiel"], "did you mean 'missing-file'?"),
        (["show", "plant.ir", "-e", "Gata"], "no element 'Gata'; did you mean 'Gate'?"),
        (["build"], "name a model, or list [[model]] units in sysmlc.toml"),
        (["check"], "name a model, or list [[model]] units in sysmlc.toml"),
        (["plant.ir", "-o", "plant.ir", "--emit", "graph"], "Directory 'plant.ir' is a file"),
        (["plant.ir", "--config", "no.toml"], "no.toml: cannot be opened"),
    ],
)
def test_what_cannot_be_done_is_one_sentence_and_exit_code_2(here, args, sentence):
    done = here.sysmlc(*args)
    assert done.exit_code == 2
    assert sentence in done.stderr
    assert "Traceback" not in done.stderr


def test_nothing_is_written_when_a_file_is_missing(here):
    here.sysmlc("plant.ir", "no.ir", "--emit", "graph")
    assert not (here.folder / "out").exists()


def test_a_misspelt_command_is_answered_with_the_right_one(here):
    assert "did you mean 'check'?" in here.sysmlc("chekc", "plant.ir").stderr


def test_a_command_word_beats_a_folder_of_that_name(here):
    here.write("check/plant.ir", here.read("plant.ir"))
    assert "name a model" in here.sysmlc("check").stderr
    assert here.sysmlc("./check", "--emit", "graph").exit_code == 0


# -- build --check -------------------------------------------------------------------------------


def test_check_passes_when_the_committed_outputs_are_up_to_date(here):
    here.sysmlc("plant.ir", "--emit", "graph")
    assert here.sysmlc("build", "plant.ir", "--emit", "graph", "--check").exit_code == 0


def test_check_lists_what_is_stale_missing_or_too_much_and_writes_nothing(here):
    here.sysmlc("plant.ir", "--emit", "graph,ir")
    (here.folder / "out/graph.json").write_text("{}")
    (here.folder / "out/trace.json").unlink()
    done = here.sysmlc("build", "plant.ir", "--emit", "graph", "--check")
    assert done.exit_code == 1
    assert done.stderr == "".join(
        f"not up to date: out/{name}\n"
        for name in ("graph.ir", "graph.json", "manifest.json", "trace.json")
    )
    assert here.read("out/graph.json") == "{}"


# -- what is emitted -----------------------------------------------------------------------------


def test_plus_adds_and_plain_names_replace(here, monkeypatch):
    monkeypatch.setattr(
        registry,
        "_BACKENDS",
        {"graph": "sysmlc.backends.graph:JSON", "ir": "sysmlc.backends.graph:TEXT"},
    )
    here.sysmlc("plant.ir", "-o", "none")
    here.sysmlc("plant.ir", "-o", "added", "--emit", "+ir")
    here.sysmlc("plant.ir", "-o", "both", "--emit", "graph,+ir")
    assert "graph.ir" not in here.files("none")
    assert "graph.ir" in here.files("added")
    assert {"graph.ir", "graph.json"} <= set(here.files("both"))


def test_backends_lists_them_with_the_default_ones_marked(here, monkeypatch):
    monkeypatch.setattr(registry, "_BACKENDS", {"graph": "sysmlc.backends.graph:JSON"})
    assert here.sysmlc("backends").stdout == "  graph  the refined graph as graph.json\n"


def test_print_after_shows_the_graph_on_standard_output(here):
    done = here.sysmlc("check", "plant.ir", "--emit", "graph", "--print-after", "read")
    assert done.stdout.startswith('// after read\nPackage pkg "Plant" @plant.ir:-1\n')


def test_verbose_says_steps_and_files(here):
    done = here.sysmlc("plant.ir", "--emit", "graph", "-v")
    steps = [line.split("  ")[-1] for line in done.stderr.splitlines()]
    assert steps[:3] == ["read 1 ir", "pass ports", "emit graph"]
    assert steps[3] == "changed out/graph.json"


def test_strict_input_is_clean_when_everything_is_mapped(here):
    assert here.sysmlc("check", "plant.ir", "--emit", "graph", "--strict-input").exit_code == 0


# -- configuration -------------------------------------------------------------------------------


def test_the_configuration_sets_back_ends_folder_and_severities(here):
    here.write(
        "sysmlc.toml",
        'output = "gen"\nemit = ["ir"]\nstrict = true\n\n[rules]\nmissing-file = "error"\n',
    )
    here.write("models/plant.ir", here.read("plant.ir"))
    done = here.sysmlc("models/plant.ir")
    assert done.stdout == "gen: 4 files, 4 changed\n"
    assert json.loads(here.read("gen/manifest.json"))["inputs"][0]["path"] == "models/plant.ir"


def test_the_command_line_beats_the_configuration(here):
    here.write("sysmlc.toml", 'output = "gen"\nemit = ["ir"]\n')
    here.sysmlc("plant.ir", "-o", "other", "--emit", "graph")
    assert here.files("other") == OUTPUTS


def test_units_of_the_configuration_are_built_without_a_model(here):
    here.write("b/extra.ir", 'Package b "B"\n')
    here.write(
        "sysmlc.toml",
        'emit = ["graph"]\n\n[[model]]\nname = "a"\nfiles = ["plant.ir"]\n\n'
        '[[model]]\nname = "b"\nfiles = ["b/*.ir", "plant.ir"]\noutput = "gen/b"\n',
    )
    done = here.sysmlc("build")
    assert done.stdout == "out/a: 4 files, 4 changed\ngen/b: 4 files, 4 changed\n"
    names = [entry["path"] for entry in json.loads(here.read("gen/b/manifest.json"))["inputs"]]
    assert names == ["b/extra.ir", "plant.ir"]


def test_a_file_of_a_unit_brings_the_unit_with_it(here):
    here.write("extra.ir", 'Package b "B"\n')
    here.write("sysmlc.toml", 'emit = ["graph"]\n[[model]]\nname = "all"\nfiles = ["*.ir"]\n')
    here.sysmlc("plant.ir", "-o", "out")
    assert len(json.loads(here.read("out/manifest.json"))["inputs"]) == 2


def test_an_accepted_finding_is_not_shown(here):
    here.write("untyped.ir", UNTYPED)
    here.write(
        "sysmlc.toml",
        '[[suppress]]\nrule = "missing-file"\nelement = "Plant::*"\nreason = "test"\n',
    )
    done = here.sysmlc("check", ".", "--emit", "graph", "--format", "concise")
    assert "SM902 unused-suppression" in done.stderr


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ('emitt = ["graph"]\n', "sysmlc.toml:1: unknown key 'emitt'; did you mean 'emit'?"),
        ("strict = 1\n", "sysmlc.toml:1: 'strict': 1 is not of type 'boolean'"),
        ('\n[[model]]\nname = "a"\nfile = "x"\n', "sysmlc.toml:4: unknown key 'model.0.file'"),
        ('[rules]\nuntyped = "off"\n', "unknown rule 'untyped'; "),
        ('[rules]\nmissing-file = "of"\n', "sysmlc.toml:2: 'rules.missing-file': 'of' is not one"),
        ("strict = \n", "sysmlc.toml:1:10: Invalid value"),
    ],
)
def test_a_wrong_configuration_says_where_and_what_was_meant(here, text, sentence):
    here.write("sysmlc.toml", text)
    done = here.sysmlc("plant.ir", "--emit", "graph")
    assert done.exit_code == 2
    assert sentence in done.stderr


def test_pyproject_serves_when_there_is_no_file_of_our_own(here):
    here.write("pyproject.toml", '[tool.sysmlc]\noutput = "gen"\n')
    here.sysmlc("plant.ir", "--emit", "graph")
    assert here.files("gen") == OUTPUTS
    here.write("sysmlc.toml", 'output = "own"\n')
    here.sysmlc("plant.ir", "--emit", "graph")
    assert here.files("own") == OUTPUTS
