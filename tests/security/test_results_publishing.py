"""The results of ``synth``, ``simulate``, ``robots`` and ``contracts`` are published as builds are.

No result is written through a link of the repository, no foreign file is replaced without
``--force``, and a manifest lists what was written.
"""

import json
import os
from typing import NamedTuple

import pytest
from jsonschema import Draft202012Validator

from json_documents import SCHEMAS
from sysmlc.driver import publishing
from sysmlc.synthesis import composition_check

LINE = """{"variables": {"order": {"owner": "env", "type": "bool"},
 "filled": {"owner": "sys", "type": "bool"}, "packed": {"owner": "sys", "type": "bool"}},
 "guarantees": {"safety": ["order -> filled'", "filled -> packed'"]}}
"""
FILLER = """{"variables": {"order": {"owner": "env", "type": "bool"},
 "filled": {"owner": "sys", "type": "bool"}}, "guarantees": {"safety": ["order -> filled'"]}}
"""
LAMP = """\
package Lamps {
    item def On;
    part def Lamp {
        exhibit state light { entry; then off; state off; accept On then on; state on; }
    }
}
"""
SCENARIO = """\
scenarios:
  - name: pushed
    component: Lamps::Lamp
    steps:
      - inputs: {event: "On"}
"""
HALL = """\
package Plant {
    private import Floors::*;
    part def Hall :> Floor {
        constant attribute :>> columns = 2;
        constant attribute :>> rows = 1;
        part r1 : Robot { :>> row = 0; :>> column = 0; }
        part work : Mission {
            constant attribute :>> deadline = 20;
            part left : Target { :>> row = 0; :>> column = 1; }
        }
    }
}
"""
FILES = {
    "line.gr1.json": LINE,
    "filler.gr1.json": FILLER,
    "cell.sysml": composition_check.OPEN.read_page().wrong,
    "hall.sysml": HALL,
    "lamp.sysml": LAMP,
    "lamp.yaml": SCENARIO,
}


class Command(NamedTuple):
    """A command with the option of its output, and a file that it writes."""

    arguments: str
    output: str
    file: str


COMMANDS = {
    "synth": Command("synth filler.gr1.json", "-o gen", "gen/filler.machine.json"),
    "check": Command("contracts check cell.sysml", "-o gen", "gen/Line.Cell.run1.puml"),
    "refine": Command(
        "contracts refine line.gr1.json filler.gr1.json", "-o gen", "gen/filler.run1.puml"
    ),
    "merge": Command(
        "contracts merge line.gr1.json filler.gr1.json", "-o gen/both.json", "gen/both.json"
    ),
    "robots": Command(
        "robots hall.sysml --no-relations --no-cache", "-o gen", "gen/robots/Plant.Hall.md"
    ),
    "junit": Command(
        "simulate lamp.sysml --scenario lamp.yaml", "--junit gen/report.xml", "gen/report.xml"
    ),
    "simulate": Command("simulate lamp.sysml --scenario lamp.yaml", "-o gen", "gen/lamp.seq.puml"),
}


@pytest.fixture(params=COMMANDS)
def command(request, project):
    (project.folder / "plant.ir").unlink()
    for name, text in FILES.items():
        project.write(name, text)
    return COMMANDS[request.param]


def run(project, command, *options):
    return project.run(*command.arguments.split(), *command.output.split(), *options)


def read_manifest(project, folder="gen"):
    return json.loads((project.folder / folder / "manifest.results.json").read_text())


def assert_refused(project, command, before, *messages, options=()):
    """Run the command, which must write nothing and end with exit code 2."""
    result = run(project, command, *options)
    assert result.exit_code == 2, result.output
    for message in messages:
        assert message in result.stderr
    assert project.snapshot() == before


def test_a_manifest_lists_inputs_and_results(project, command):
    assert run(project, command).exit_code < 2
    manifest = read_manifest(project)
    Draft202012Validator(SCHEMAS["sysmlc-manifest"]).validate(manifest)
    assert manifest["inputs"]
    paths = {entry["path"] for entry in manifest["files"]}
    assert command.file.removeprefix("gen/") in paths
    written = {name for name in project.snapshot(project.folder / "gen") if "." in name}
    assert paths == written - {"manifest.results.json"}
    before = project.snapshot()
    assert run(project, command).exit_code < 2
    assert project.snapshot() == before


def test_a_foreign_file_is_replaced_with_force_only(project, command):
    project.write(command.file, "by hand")
    before = project.snapshot()
    word = command.arguments.split()[0]
    help = f"use '{word} --force'"
    assert_refused(project, command, before, "SM910", "sysmlc did not write it", help)
    assert run(project, command, "--force").exit_code < 2
    assert (project.folder / command.file).read_text() != "by hand"


def test_an_edited_result_is_not_replaced(project, command):
    run(project, command)
    project.write(command.file, "by hand")
    reason = "it was edited after sysmlc wrote it"
    assert_refused(project, command, project.snapshot(), "SM910", reason)


@pytest.mark.parametrize("options", [(), ("--force",)])
@pytest.mark.parametrize("target", ["../outside/secret.ir", "../outside/new", "line.gr1.json"])
def test_a_link_in_place_of_a_result_is_not_followed(project, command, target, options):
    path = project.folder / command.file
    path.parent.mkdir(parents=True)
    path.symlink_to(os.path.relpath(project.folder / target, path.parent))
    before = project.snapshot()
    assert_refused(project, command, before, "SM911", "it is a link", options=options)


@pytest.mark.parametrize("options", [(), ("--force",)])
@pytest.mark.parametrize("marker", [".git", "sysmlc.toml", "none"])
@pytest.mark.parametrize("target", ["../outside", "../outside/new"])
def test_a_link_in_place_of_the_folder_does_not_lead_out(project, command, target, marker, options):
    """The project of a model has a root even if no file marks it."""
    if marker != ".git":
        (project.folder / ".git").rename(project.outside / "git")
    if marker == "sysmlc.toml":
        project.write("sysmlc.toml", "")
    (project.folder / "gen").symlink_to(target)
    before = project.snapshot()
    assert_refused(project, command, before, "SM911", "it lies outside", options=options)


def test_an_intermediate_link_does_not_lead_out(project, command):
    (project.folder / "link").symlink_to("../outside")
    command = command._replace(output=command.output.replace("gen", "link/deep"))
    assert_refused(project, command, project.snapshot(), "SM911", "it lies outside")


def test_a_dangling_link_inside_the_project_is_not_written_through(project, command):
    (project.folder / "gen").symlink_to("missing")
    assert_refused(project, command, project.snapshot(), "SM912")


def test_a_foreign_manifest_is_not_replaced(project, command):
    project.write("gen/manifest.results.json", '{"format": "something else"}')
    for options in ((), ("--force",)):
        before = project.snapshot()
        assert_refused(project, command, before, "not a manifest of sysmlc", options=options)


def test_a_committed_manifest_removes_nothing(project, command):
    run(project, command)
    manifest = read_manifest(project)
    project.write("gen/own.txt", "by hand")
    digest = publishing.compute_digest(project.folder / "gen", "own.txt")
    paths = ["own.txt", "../line.gr1.json", ".git/HEAD", str(project.outside / "secret.ir")]
    manifest["files"] += [{"path": path, "sha256": digest} for path in paths]
    project.write("gen/manifest.results.json", json.dumps(manifest))
    before = project.snapshot()
    assert run(project, command).exit_code < 2
    after = project.snapshot()
    assert {name for name in before if after.get(name, b"") != before[name]} <= {
        "project/gen/manifest.results.json"
    }


def test_a_full_disk_leaves_no_half_written_file(project, command, monkeypatch):
    monkeypatch.setattr(os, "fsync", fail_with_full_disk)
    result = run(project, command)
    assert (result.exit_code, "SM912" in result.stderr) == (2, True)
    assert not list((project.folder / "gen").rglob("*.*"))
    monkeypatch.undo()
    os.chdir(project.folder)
    assert run(project, command).exit_code < 2


def fail_with_full_disk(_handle):
    raise OSError(28, "No space left on device")


def test_one_of_two_commands_waits_for_the_other(project, command, monkeypatch):
    fcntl = pytest.importorskip("fcntl")
    monkeypatch.setattr(publishing, "_PATIENCE", 0.05)
    (project.folder / "gen").mkdir()
    handle = os.open(project.folder / "gen", os.O_RDONLY)
    fcntl.flock(handle, fcntl.LOCK_EX)
    try:
        before = project.snapshot()
        assert_refused(project, command, before, "another sysmlc is writing to the folder")
    finally:
        os.close(handle)


def test_commands_and_builds_share_a_folder(project, command):
    """A build neither removes results nor finds its own outputs out of date."""
    project.write("plant.ir", 'Package pkg "Plant"\n')
    build = ("build", "plant.ir", "--emit", "graph", "-o", "gen")
    assert project.run(*build).exit_code == 0
    assert run(project, command).exit_code < 2
    assert project.run(*build, "--check").exit_code == 0
    before = project.snapshot()
    assert project.run(*build).exit_code == 0
    assert project.snapshot() == before


def test_results_of_earlier_runs_stay_and_stay_owned(project, command):
    merge = ("contracts", "conjoin", "line.gr1.json", "filler.gr1.json", "-o", "gen/conjoined.json")
    assert run(project, command).exit_code < 2
    before = (project.folder / command.file).read_bytes()
    assert project.run(*merge).exit_code == 0
    assert (project.folder / command.file).read_bytes() == before
    assert run(project, command).exit_code < 2
    assert project.run(*merge).exit_code == 0


def test_results_beside_the_inputs_stay_owned(project, command):
    command = command._replace(output=command.output.replace("gen/", "").replace("gen", "."))
    conjoin = ("contracts", "conjoin", "line.gr1.json", "filler.gr1.json", "-o", "conjoined.json")
    for _ in range(2):
        assert run(project, command).exit_code < 2
        assert project.run(*conjoin).exit_code == 0


def test_a_result_never_replaces_an_input(project, command):
    merge = ("contracts", "merge", "line.gr1.json", "filler.gr1.json", "-o", "line.gr1.json")
    for options in ((), ("--force",)):
        before = project.snapshot()
        result = project.run(*merge, *options)
        assert (result.exit_code, "it is an input" in result.stderr) == (2, True)
        assert project.snapshot() == before


@pytest.mark.parametrize("name", ["manifest.json", "manifest.results.json"])
def test_a_result_is_not_called_like_a_manifest(project, command, name):
    merge = ("contracts", "merge", "line.gr1.json", "filler.gr1.json", "-o", f"gen/{name}")
    result = project.run(*merge, "--force")
    assert (result.exit_code, "this is the name of a manifest" in result.stderr) == (2, True)


def test_a_refusal_is_a_finding_in_json(project, command):
    project.write(command.file, "by hand")
    result = run(project, command, "--format", "json")
    codes = [finding["code"] for finding in json.loads(result.stdout)["diagnostics"]]
    assert (result.exit_code, "SM910" in codes) == (2, True)
