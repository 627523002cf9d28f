"""A SysML v2 file that is named alone is compiled with the files of its project that it needs."""

from pathlib import Path

import pytest

WORDS = "package Words { attribute def Go; }"
PUMPS = "package Pumps { private import Words::*; part def Pump; part x : Lost; }"
PLANT = """\
package Plant {
    private import Pumps::*;
    private import ScalarValues::*;
    part pump : Pump;
    part valve : Valve;
}
"""
LAMP = """\
package Lamps {
    private import Words::*;
    part def Lamp {
        exhibit state Run { entry; then off; state off; accept Go then lit; state lit; }
    }
}
"""


@pytest.fixture
def project(workspace, all_passes):
    """A project of four files, one of which has nothing to do with the others."""
    workspace.write("words.sysml", WORDS)
    workspace.write("parts/pumps.sysml", PUMPS)
    workspace.write("plant.sysml", PLANT)
    workspace.write("parts/garden.sysml", "package Garden { part rose : Flower; }")
    return workspace


def check(workspace, *files):
    """Return the findings of ``sysmlc check``."""
    result = workspace.sysmlc("check", *files, "--format", "concise")
    return [
        line for line in result.stdout.splitlines() + result.stderr.splitlines() if ": " in line
    ]


def test_only_findings_about_the_named_file_are_shown(project):
    assert check(project, "plant.sysml") == [
        "plant.sysml:5:18: error[SM205 unresolved-name]: unknown name 'Valve' (valve)"
    ]
    assert check(project, "words.sysml") == []


def test_named_files_and_folders_show_their_own_findings(project):
    lost = "parts/pumps.sysml:1:66: error[SM205 unresolved-name]: unknown name 'Lost' (x)"
    assert check(project, "plant.sysml", "parts/pumps.sysml")[0] == lost
    everything = [line for line in check(project, ".") if "SM205" in line]
    assert len(everything) == 3


def test_files_outside_of_the_project_are_not_read(project):
    project.write("parts/sysmlc.toml", "")
    result = check(project, "parts/pumps.sysml")
    assert any("unknown name 'Words'" in line for line in result)
    project.write("sysmlc.toml", "")
    (project.folder / "parts/sysmlc.toml").unlink()
    result = check(project, "parts/pumps.sysml")
    assert [line for line in result if "Words" in line] == []


def test_outside_of_projects_only_the_folder_of_the_file_is_searched(project):
    (project.folder / ".git").rmdir()
    assert any("unknown name 'Pumps'" in line for line in check(project, "plant.sysml"))
    project.write("pumps.sysml", PUMPS)
    assert not any("Pumps" in line for line in check(project, "plant.sysml"))


@pytest.mark.parametrize("problem", [PermissionError, FileNotFoundError])
def test_a_folder_that_cannot_be_listed_has_no_siblings(project, monkeypatch, problem):
    (project.folder / ".git").rmdir()
    project.write("pumps.sysml", PUMPS)

    def refuse(_folder):
        raise problem(13, "refused")

    monkeypatch.setattr(Path, "iterdir", refuse)
    assert any("unknown name 'Pumps'" in line for line in check(project, "plant.sysml"))


def test_a_copy_of_the_standard_library_is_no_sibling(project):
    project.write("library/ScalarValues.sysml", "library package ScalarValues;")
    project.write("flag.sysml", "part def Flag { attribute isUp : ScalarValues::Boolean; }")
    assert check(project, "flag.sysml") == []


def test_a_model_of_the_configuration_is_the_unit(project):
    project.write("sysmlc.toml", '[[model]]\nname = "plant"\nfiles = ["plant.sysml"]\n')
    assert any("unknown name 'Pumps'" in line for line in check(project, "plant.sysml"))


def test_the_outcome_of_a_file_named_alone_is_not_that_of_both(project):
    assert len(check(project, "plant.sysml")) == 1
    assert len(check(project, "plant.sysml", "parts/pumps.sysml")) == 2
    assert len(check(project, "plant.sysml")) == 1


@pytest.mark.parametrize(
    "files",
    [("lamp.sysml",), ("lamp.sysml", "words.sysml"), ("models",)],
    ids=["alone", "both", "folder"],
)
@pytest.mark.parametrize(
    "command",
    [
        ("contracts", "check"),
        ("synth", "--realizable"),
    ],
    ids=["contracts", "synth"],
)
def test_contracts_of_several_files_and_folders_are_decided(workspace, all_passes, files, command):
    for folder in ("", "models/"):
        workspace.write(f"{folder}lamp.sysml", LAMP)
        workspace.write(f"{folder}words.sysml", WORDS)
    result = workspace.sysmlc(*command, *files)
    assert result.exit_code == 0
    assert result.stdout.startswith("Lamps::Lamp: realizable")


def test_several_contract_files_are_refused(workspace):
    for name in ("a.ltl", "b.ltl"):
        workspace.write(name, "G a")
    result = workspace.sysmlc("synth", "a.ltl", "b.ltl")
    assert result.exit_code == 2
    assert "name one contract file at a time" in result.stderr
