"""``sysmlc build`` and ``sysmlc check``: a model, the command, the expected lines."""

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


def test_a_model_without_a_command_word_is_built(workspace):
    result = workspace.sysmlc("plant.ir", "-o", "out", "--emit", "graph")
    assert (result.exit_code, result.stdout, result.stderr) == (0, "out: 4 files, 4 changed\n", "")
    assert workspace.list_files() == OUTPUTS


def test_an_option_before_the_model_builds_it_too(workspace):
    assert workspace.sysmlc("--emit", "graph", "plant.ir").exit_code == 0
    assert workspace.list_files() == OUTPUTS


def test_a_second_run_changes_nothing(workspace):
    workspace.sysmlc("plant.ir", "--emit", "graph")
    os.utime(workspace.folder / "out/graph.json", (1, 1))
    assert workspace.sysmlc("plant.ir", "--emit", "graph").stdout == "out: 4 files, 0 changed\n"
    assert (workspace.folder / "out/graph.json").stat().st_mtime == 1


def test_removed_files_of_an_earlier_run_are_counted_apart(workspace):
    workspace.sysmlc("plant.ir", "--emit", "graph,plantuml")
    summary = workspace.sysmlc("plant.ir", "--emit", "graph").stdout
    assert summary == "out: 4 files, 2 changed, 1 removed\n"
    assert workspace.list_files() == OUTPUTS


def test_an_error_is_exit_code_1(workspace):
    workspace.write("faulty.ir", FAULTY)
    result = workspace.sysmlc("faulty.ir", "--emit", "graph")
    assert result.exit_code == 1
    assert result.stderr == (
        "error[SM942 test-nameless-port]: a port of 'Gate' has no name\n"
        "  --> faulty.ir (Plant::Gate::<Port>)\n"
        "  help: name the port\n"
        "\n"
        "1 error in 1 file\n"
    )


@pytest.mark.parametrize(("option", "code"), [([], 0), (["--strict"], 1)])
def test_a_warning_is_exit_code_0_and_with_strict_1(workspace, option, code):
    workspace.write("untyped.ir", UNTYPED)
    assert workspace.sysmlc("check", "untyped.ir", *option).exit_code == code


@pytest.mark.parametrize(
    ("args", "sentence"),
    [
        (["no.ir"], "there is no file or folder 'no.ir'"),
        (["plant.ir", "--emit", "grph"], "unknown back end 'grph'; did you mean 'graph'?"),
        (["plant.ir", "--emit", "+recipes"], "unknown back end 'recipes'; did you mean 'recipe'?"),
        (["plant.ir", "--templates", "no"], "there is no folder 'no' for templates"),
        (["plant.ir", "--print-after", "port"], "unknown pass 'port'; did you mean 'ports'?"),
        (["plan.ir"], "did you mean 'plant.ir'?"),
        (["plant.ir", "--fromat", "json"], "No such option"),
        (["plant.ir", "--emt", "graph"], "Did you mean one of: '--emit'"),
        (["plant.ir", "--format", "xml"], "is not one of"),
        (["explain", "missing-fiel"], "did you mean 'missing-file'?"),
        (["show", "plant.ir", "-e", "Gata"], "no element 'Gata'; did you mean 'Gate'?"),
        (["build"], "name a model, or list [[model]] units in sysmlc.toml"),
        (["check"], "name a model, or list [[model]] units in sysmlc.toml"),
        (["plant.ir", "-o", "plant.ir", "--emit", "graph"], "Directory 'plant.ir' is a file"),
        (["plant.ir", "--config", "no.toml"], "no.toml: cannot be opened"),
    ],
)
def test_a_wrong_argument_is_one_sentence_and_exit_code_2(workspace, args, sentence):
    result = workspace.sysmlc(*args)
    assert result.exit_code == 2
    assert sentence in result.stderr
    assert "Traceback" not in result.stderr


def test_nothing_is_written_when_a_file_is_missing(workspace):
    workspace.sysmlc("plant.ir", "no.ir", "--emit", "graph")
    assert not (workspace.folder / "out").exists()


def test_an_output_folder_that_is_a_file_is_not_overwritten(workspace):
    model = workspace.read("plant.ir")
    assert workspace.sysmlc("plant.ir", "-o", "plant.ir").exit_code == 2
    assert workspace.read("plant.ir") == model


def test_a_misspelt_command_is_answered_with_a_suggestion(workspace):
    assert "did you mean 'check'?" in workspace.sysmlc("chekc", "plant.ir").stderr


def test_a_command_word_takes_precedence_over_a_folder_of_that_name(workspace):
    workspace.write("check/plant.ir", workspace.read("plant.ir"))
    assert "name a model" in workspace.sysmlc("check").stderr
    assert workspace.sysmlc("./check", "--emit", "graph").exit_code == 0


# -- build --check -------------------------------------------------------------------------------


def test_check_passes_when_the_committed_outputs_are_up_to_date(workspace):
    workspace.sysmlc("plant.ir", "--emit", "graph")
    assert workspace.sysmlc("build", "plant.ir", "--emit", "graph", "--check").exit_code == 0


def test_check_lists_stale_missing_and_superfluous_files_and_writes_nothing(workspace):
    workspace.sysmlc("plant.ir", "--emit", "graph,ir")
    (workspace.folder / "out/graph.json").write_text("{}")
    (workspace.folder / "out/trace.json").unlink()
    result = workspace.sysmlc("build", "plant.ir", "--emit", "graph", "--check")
    assert result.exit_code == 1
    assert result.stderr == "".join(
        f"not up to date: out/{name}\n"
        for name in ("graph.ir", "graph.json", "manifest.json", "trace.json")
    )
    assert workspace.read("out/graph.json") == "{}"


# -- what is emitted -----------------------------------------------------------------------------


def test_emit_with_plus_adds_to_the_default_and_without_replaces_it(workspace, monkeypatch):
    monkeypatch.setattr(
        registry,
        "_BACKENDS",
        {"graph": "sysmlc.backends.graph:JSON", "ir": "sysmlc.backends.graph:TEXT"},
    )
    monkeypatch.setattr(registry, "_DEFAULT", frozenset({"graph"}))
    workspace.sysmlc("plant.ir", "-o", "none")
    workspace.sysmlc("plant.ir", "-o", "added", "--emit", "+ir")
    workspace.sysmlc("plant.ir", "-o", "both", "--emit", "graph,+ir")
    assert "graph.ir" not in workspace.list_files("none")
    assert "graph.ir" in workspace.list_files("added")
    assert {"graph.ir", "graph.json"} <= set(workspace.list_files("both"))


@pytest.mark.parametrize(
    ("options", "present", "absent"),
    [
        (["--emit", "graph", "--emit", "ir"], {"graph.json", "graph.ir"}, {"contracts"}),
        (["--emit", "graph", "--emit", "+ir"], {"graph.json", "graph.ir"}, {"contracts"}),
        (["--emit", "+graph", "--emit", "+ir"], {"graph.json", "graph.ir", "diagrams"}, set()),
        (["--emit", "ir"], {"graph.ir"}, {"graph.json", "diagrams"}),
    ],
)
def test_repeated_emit_options_add_up(workspace, all_passes, options, present, absent):
    workspace.write("m.sysml", "package P { part def A { part b : B; } part def B; }")
    assert workspace.sysmlc("build", "m.sysml", *options).exit_code == 0
    names = {path.name for path in (workspace.folder / "out").iterdir()}
    assert present <= names
    assert not absent & names


def test_backends_lists_the_back_ends(workspace, monkeypatch):
    monkeypatch.setattr(registry, "_BACKENDS", {"graph": "sysmlc.backends.graph:JSON"})
    assert workspace.sysmlc("backends").stdout == "  graph  the refined graph as graph.json\n"


def test_print_after_shows_the_graph_on_standard_output(workspace):
    result = workspace.sysmlc("check", "plant.ir", "--emit", "graph", "--print-after", "read")
    assert result.stdout.startswith('// after read\nPackage pkg "Plant" @plant.ir:-1\n')


def test_verbose_lists_steps_and_changed_files(workspace):
    result = workspace.sysmlc("plant.ir", "--emit", "graph", "-v")
    steps = [line.split("  ")[-1] for line in result.stderr.splitlines()]
    assert steps[:3] == ["read 1 ir", "pass ports", "emit graph"]
    assert steps[3] == "changed out/graph.json"


def test_strict_input_is_clean_when_everything_is_mapped(workspace):
    assert workspace.sysmlc("check", "plant.ir", "--emit", "graph", "--strict-input").exit_code == 0


# -- configuration -------------------------------------------------------------------------------


def test_the_configuration_sets_back_ends_folder_and_severities(workspace):
    workspace.write(
        "sysmlc.toml",
        'output = "gen"\nemit = ["ir"]\nstrict = true\n\n[rules]\nmissing-file = "error"\n',
    )
    workspace.write("models/plant.ir", workspace.read("plant.ir"))
    result = workspace.sysmlc("models/plant.ir")
    assert result.stdout == "gen: 4 files, 4 changed\n"
    assert workspace.list_inputs("gen") == ["models/plant.ir"]


def test_options_take_precedence_over_the_configuration(workspace):
    workspace.write("sysmlc.toml", 'output = "gen"\nemit = ["ir"]\n')
    workspace.sysmlc("plant.ir", "-o", "other", "--emit", "graph")
    assert workspace.list_files("other") == OUTPUTS


def test_units_of_the_configuration_are_built_without_a_model(workspace):
    workspace.write("b/extra.ir", 'Package b "B"\n')
    workspace.write(
        "sysmlc.toml",
        'emit = ["graph"]\n\n[[model]]\nname = "a"\nfiles = ["plant.ir"]\n\n'
        '[[model]]\nname = "b"\nfiles = ["b/*.ir", "plant.ir"]\noutput = "gen/b"\n',
    )
    result = workspace.sysmlc("build")
    assert result.stdout == "out/a: 4 files, 4 changed\ngen/b: 4 files, 4 changed\n"
    assert workspace.list_inputs("gen/b") == ["b/extra.ir", "plant.ir"]


def test_naming_a_file_of_a_unit_compiles_the_whole_unit(workspace):
    workspace.write("extra.ir", 'Package b "B"\n')
    workspace.write("sysmlc.toml", 'emit = ["graph"]\n[[model]]\nname = "all"\nfiles = ["*.ir"]\n')
    workspace.sysmlc("plant.ir", "-o", "out")
    assert workspace.list_inputs() == ["extra.ir", "plant.ir"]


def test_a_wildcard_of_the_configuration_that_matches_nothing_is_reported(workspace):
    workspace.write(
        "sysmlc.toml",
        'emit = ["graph"]\n[[model]]\nname = "a"\nfiles = ["plant.ir"]\n'
        '[[model]]\nname = "b"\nfiles = [\n  "plant.ir",\n  "lines/*.ir",\n]\n',
    )
    result = workspace.sysmlc("check")
    assert "sysmlc.toml:7:1: 'lines/*.ir' in 'files' matches no file\n" in result.stderr
    assert result.stderr.count("matches no file") == 1
    assert result.exit_code == 0


def test_a_suppression_that_matches_nothing_is_reported(workspace):
    workspace.write("untyped.ir", UNTYPED)
    workspace.write(
        "sysmlc.toml",
        '[[suppress]]\nrule = "missing-file"\nelement = "Plant::*"\nreason = "test"\n',
    )
    result = workspace.sysmlc("check", ".", "--emit", "graph", "--format", "concise")
    assert "SM902 unused-suppression" in result.stderr


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        (
            'emitt = ["graph"]\n',
            "sysmlc.toml:1:1: at the top: unknown key 'emitt'; did you mean 'emit'?",
        ),
        ("strict = 1\n", "sysmlc.toml:1:10: at 'strict': 1 is not of type 'boolean'"),
        (
            '\n[[model]]\nname = "a"\nfile = "x"\n',
            "sysmlc.toml:4:1: at 'model[1]': unknown key 'file'",
        ),
        (
            '[rules]\nuntyped = "off"\n',
            "sysmlc.toml:2:1: unknown rule 'untyped'; 'sysmlc explain' lists the rules",
        ),
        (
            '[rules]\nmissing-file = "of"\n',
            "sysmlc.toml:2:16: at 'rules.missing-file': unknown value 'of'; did you mean 'off'?",
        ),
        (
            '[[suppress]]\nrule = "SM410"\nelement = "A"\nreason = "r"\n[[suppress]]\nrule = "a"\n',
            "sysmlc.toml:5:3: at 'suppress[2]': lacks 'reason'",
        ),
        ('emit = ["plantmul"]\n', "sysmlc.toml:1:1: unknown back end 'plantmul'; did you mean"),
        ("strict = \n", "sysmlc.toml:1:10: Invalid value"),
    ],
)
def test_a_fault_in_the_configuration_has_a_location_and_a_suggestion(workspace, text, sentence):
    workspace.write("sysmlc.toml", text)
    result = workspace.sysmlc("plant.ir")
    assert result.exit_code == 2
    assert sentence in result.stderr


def test_pyproject_is_used_when_there_is_no_sysmlc_toml(workspace):
    workspace.write("pyproject.toml", '[tool.sysmlc]\noutput = "gen"\n')
    workspace.sysmlc("plant.ir", "--emit", "graph")
    assert workspace.list_files("gen") == OUTPUTS
    workspace.write("sysmlc.toml", 'output = "own"\n')
    workspace.sysmlc("plant.ir", "--emit", "graph")
    assert workspace.list_files("own") == OUTPUTS


@pytest.mark.parametrize("word", ["lint", "chekc", "graph-it"])
def test_an_unknown_word_is_no_model_and_nothing_is_built(workspace, word):
    result = workspace.sysmlc(word, "plant.ir", "--emit", "graph")
    assert result.exit_code == 2
    assert f"no command, file or folder '{word}'; " in result.stderr
    assert workspace.list_files("out") == []
