"""A build replaces and removes only its own outputs, whatever a repository contains."""

import hashlib
import json
import os

import pytest

from sysmlc.cli import session
from sysmlc.cli.watching import Watch
from sysmlc.driver.registry import list_backend_names

OUTPUTS = ["coverage.json", "graph.json", "manifest.json", "trace.json"]


def build(project, *arguments):
    return project.run("build", "plant.ir", "--emit", "graph", *arguments)


def list_names(folder):
    return sorted(path.relative_to(folder).as_posix() for path in folder.rglob("*"))


def commit_manifest(project, path, folder="out", **entries):
    """Write a manifest that lists *path*, with the right digest if the file exists."""
    try:
        content = (project.folder / folder / path).read_bytes()
    except (OSError, ValueError):
        content = b""
    entry = {"path": path, "backend": "graph", "sha256": hashlib.sha256(content).hexdigest()}
    manifest = {"format": "sysmlc-manifest/2", "files": [entry], "kept": [], **entries}
    return project.write(f"{folder}/manifest.json", json.dumps(manifest))


def test_a_foreign_file_is_not_overwritten(project):
    project.write("out/trace.json", "by hand")
    before = project.snapshot()
    result = build(project)
    assert result.exit_code == 2
    assert "SM910 foreign-output-file" in result.stderr
    assert "'out/trace.json' is not overwritten: sysmlc did not write it" in result.stderr
    assert "build --force" in result.stderr
    assert project.snapshot() == before


def test_foreign_files_with_equal_content_or_other_names_are_accepted(project):
    build(project, "-o", "same")
    project.write("out/trace.json", (project.folder / "same/trace.json").read_text())
    project.write("out/own.json", "by hand")
    assert build(project).exit_code == 0
    assert list_names(project.folder / "out") == sorted([*OUTPUTS, "own.json"])


def test_force_replaces_a_foreign_file(project):
    project.write("out/trace.json", "by hand")
    assert build(project, "--force").exit_code == 0
    assert json.loads((project.folder / "out/trace.json").read_text())
    assert build(project).exit_code == 0


def test_force_replaces_the_outputs_of_version_1(project):
    build(project)
    manifest = json.loads((project.folder / "out/manifest.json").read_text())
    manifest["files"] = [entry for entry in manifest["files"] if entry["backend"]]
    version_1 = {"schema": "sysmlc-manifest/1", **manifest}
    del version_1["format"]
    project.write("out/manifest.json", json.dumps(version_1))
    project.write("plant.ir", 'Package pkg "Other"\n')
    assert "'out/coverage.json' is not overwritten" in build(project).stderr
    assert build(project, "--force").exit_code == 0
    assert build(project, "--check").exit_code == 0


def test_an_edited_output_is_not_overwritten_until_it_is_deleted(project):
    build(project)
    project.write("out/graph.json", "by hand")
    result = build(project)
    assert result.exit_code == 2
    assert "it was edited after sysmlc wrote it" in result.stderr
    assert (project.folder / "out/graph.json").read_text() == "by hand"
    (project.folder / "out/graph.json").unlink()
    assert build(project).exit_code == 0
    assert list_names(project.folder / "out") == OUTPUTS


def test_an_edited_output_that_is_no_longer_generated_stays(project):
    project.run("build", "plant.ir", "--emit", "graph,ir")
    project.write("out/graph.json", "by hand")
    result = project.run("build", "plant.ir", "--emit", "ir")
    assert (result.exit_code, "SM913 edited-stale-output" in result.stderr) == (0, True)
    assert (project.folder / "out/graph.json").read_text() == "by hand"
    result = project.run("build", "plant.ir", "--emit", "graph")
    assert (result.exit_code, "sysmlc did not write it" in result.stderr) == (2, True)


@pytest.mark.parametrize(
    "text",
    [
        '{"name": "my extension", "manifest_version": 3}',
        '{"format": 2}',
        '["sysmlc-manifest/2"]',
        "[" * 100_000,
        "",
        '{"format": "sysmlc-manifest/2", "files": [',
    ],
)
@pytest.mark.parametrize("name", ["manifest.json", "manifest.pending.json"])
@pytest.mark.parametrize("options", [(), ("--force",)])
def test_a_foreign_manifest_is_never_overwritten(project, name, text, options):
    project.write(f"out/{name}", text)
    before = project.snapshot()
    result = build(project, *options)
    assert result.exit_code == 2
    assert f"'out/{name}' is not written: it is not a manifest of sysmlc" in result.stderr
    assert project.snapshot() == before


def test_a_pipe_named_like_the_manifest_is_refused(project):
    (project.folder / "out").mkdir()
    os.mkfifo(project.folder / "out/manifest.json")
    assert "is not a manifest of sysmlc" in build(project).stderr


@pytest.mark.parametrize(
    "path",
    [
        "../plant.ir",
        "../../outside/secret.ir",
        "{outside}/secret.ir",
        "linked/secret.ir",
        "link.ir",
        ".git/HEAD",
        "sub/.GIT/HEAD",
        "manifest.json",
        "..\\plant.ir",
        "",
        ".",
        "own.txt/x",
        "a" * 5000,
        "\ud800",
        "x\0y",
    ],
)
def test_a_manifest_that_lists_foreign_files_removes_nothing(project, path):
    project.write("out/.git/HEAD", "ref: refs/heads/main\n")
    project.write("out/sub/.GIT/HEAD", "ref: refs/heads/main\n")
    project.write("out/own.txt", "by hand")
    (project.folder / "out/linked").symlink_to(project.outside)
    (project.folder / "out/link.ir").symlink_to("../plant.ir")
    commit_manifest(project, path.replace("{outside}", str(project.outside)))
    before = project.snapshot()
    assert build(project).exit_code == 0
    after = project.snapshot()
    assert {name for name in before if after.get(name, b"") != before[name]} <= {
        "project/out/manifest.json"
    }


@pytest.mark.parametrize(
    "entry",
    [{}, [], "x", None, {"path": 1, "sha256": "x"}, {"path": "own.txt"}, {"path": ["own.txt"]}],
)
def test_a_manifest_with_entries_of_wrong_types_removes_nothing(project, entry):
    project.write("out/own.txt", "by hand")
    for manifest in (
        {"files": [entry], "kept": entry},
        {"files": entry, "kept": {"path": "own.txt"}},
    ):
        manifest = {"format": "sysmlc-manifest/2", **manifest}
        project.write("out/manifest.json", json.dumps(manifest))
        assert build(project).exit_code == 0
        assert (project.folder / "out/own.txt").read_text() == "by hand"


def test_a_file_whose_content_differs_from_the_manifest_is_not_removed(project):
    project.write("out/own.txt", "by hand")
    commit_manifest(project, "own.txt")
    project.write("out/own.txt", "by hand, later")
    assert build(project).exit_code == 0
    assert (project.folder / "out/own.txt").exists()


def test_an_obsolete_output_is_removed(project):
    """The manifest lists the file with its digest, and the build does not write it any more."""
    project.write("out/own/graph.txt", "generated")
    commit_manifest(project, "own/graph.txt")
    assert build(project).exit_code == 0
    assert list_names(project.folder / "out") == OUTPUTS


@pytest.mark.parametrize(
    "path",
    ["plant.ir", "sysmlc.toml", "README.md", ".github/ci.yml", ".git/HEAD", "sysml/own.ir"],
)
@pytest.mark.parametrize("name", ["manifest.json", "manifest.pending.json"])
def test_no_file_is_removed_if_the_project_root_is_the_output_folder(project, path, name):
    project.write(
        "sysmlc.toml",
        'output = "."\n[[model]]\nname = "p"\nfiles = ["*.ir", "sysml"]\noutput = "."\n',
    )
    for file in ("README.md", ".github/ci.yml"):
        project.write(file, "by hand\n")
    project.write("sysml/own.ir", 'Package own "Own"\n')
    commit_manifest(project, path, ".").rename(project.folder / name)
    before = project.snapshot()
    assert project.run("build", "--emit", "graph").exit_code == 0
    after = project.snapshot()
    changed = {file for file in before if after.get(file) != before[file]}
    assert changed <= {f"project/{name}"}


def test_an_input_is_never_an_output(project):
    """A file that is both would be compiled from its own output at the next build."""
    project.write("graph.ir")
    commit_manifest(project, "graph.ir", ".")
    before = project.snapshot()
    for options in ((), ("--force",)):
        result = project.run("build", "graph.ir", "--emit", "ir", "-o", ".", *options)
        assert result.exit_code == 2
        assert "'graph.ir' is not written: it is an input or a configuration" in result.stderr
        assert project.snapshot() == before


@pytest.mark.parametrize("options", [(), ("--force",)])
@pytest.mark.parametrize("target", ["../../outside", "../own"])
def test_a_linked_folder_in_the_output_folder_is_not_written_to(project, target, options):
    project.write("own/notes.txt", "by hand")
    project.write("sysmlc.toml", "")
    (project.folder / "out").mkdir()
    (project.folder / "out/diagrams").symlink_to(target)
    before = project.snapshot()
    result = project.run("build", "plant.ir", "--emit", "plantuml", *options)
    assert "'out/diagrams' is not written: it is a link" in result.stderr
    assert (result.exit_code, project.snapshot() == before) == (2, True)


@pytest.mark.parametrize("options", [(), ("--force",)])
def test_a_linked_file_in_the_output_folder_is_not_replaced(project, options):
    project.write("out/x", "")
    (project.folder / "out/graph.json").symlink_to("../plant.ir")
    before = project.snapshot()
    result = build(project, *options)
    assert "SM911 protected-output-file" in result.stderr
    assert "'out/graph.json' is not written: it is a link" in result.stderr
    assert (result.exit_code, project.snapshot() == before) == (2, True)


@pytest.mark.parametrize("configuration", ["", 'output = "out"\n', None])
def test_a_linked_output_folder_is_followed_inside_the_root_only(project, configuration):
    if configuration is not None:
        project.write("sysmlc.toml", configuration)
    (project.folder / "out").symlink_to("../outside")
    before = project.snapshot()
    result = build(project)
    assert result.exit_code == 2
    assert "out" in result.stderr
    assert project.snapshot() == before
    assert build(project, "-o", "out").exit_code == 2  # the repository may contain the link
    assert project.snapshot() == before
    assert build(project, "-o", "../outside").exit_code == 0
    (project.folder / "out").unlink()
    (project.folder / "gen").mkdir()
    (project.folder / "out").symlink_to("gen")
    assert build(project).exit_code == 0
    assert list_names(project.folder / "gen") == OUTPUTS


def test_a_linked_folder_of_a_unit_does_not_lead_out_of_the_named_folder(project):
    project.write("two.ir", 'Package two "Two"\n')
    project.write(
        "sysmlc.toml",
        "".join(
            f'[[model]]\nname = "{name}"\nfiles = ["{file}"]\n'
            for name, file in (("a", "plant.ir"), ("b", "two.ir"))
        ),
    )
    (project.folder / "gen").mkdir()
    (project.folder / "gen/a").symlink_to("../../outside")
    before = project.snapshot(project.outside)
    result = project.run("build", "-o", "gen", "--emit", "graph")
    assert (result.exit_code, "'gen/a' is not written: it lies outside" in result.stderr) == (
        2,
        True,
    )
    assert project.snapshot(project.outside) == before
    assert list_names(project.folder / "gen/b") == OUTPUTS


def test_check_lists_unlisted_files_of_our_folders(project):
    build(project)
    assert build(project, "--check").exit_code == 0
    project.write("out/contracts/Old.md", "left by an earlier version")
    project.write("out/notes.txt", "by hand")
    result = build(project, "--check")
    listed = [line for line in result.stderr.splitlines() if line.startswith("not up to date")]
    assert (result.exit_code, listed) == (1, ["not up to date: out/contracts/Old.md"])


def test_check_writes_nothing(project):
    project.write("out/trace.json", "by hand")
    before = project.snapshot()
    result = build(project, "--check")
    assert result.exit_code == 1
    assert "not up to date: out/trace.json\n" in result.stderr
    assert project.snapshot() == before
    commit_manifest(project, "../plant.ir").rename(project.folder / "out/manifest.pending.json")
    assert "not up to date: out/manifest.json\n" in build(project, "--check").stderr


def test_watch_does_not_replace_foreign_files(project):
    project.write("out/trace.json", "by hand")
    before = project.snapshot()
    Watch((project.folder / "plant.ir",), None, session.Settings(emit=("graph",)), 0).build()
    assert project.snapshot() == before


def test_other_commands_do_not_write_through_a_link(project):
    project.write("gate.ltl", "G (request -> F grant)\n")
    project.write("gate.part", ".inputs request\n.outputs grant\n")
    assert project.run("synth", "gate.ltl", "-o", "gen").exit_code == 0
    (machine,) = (project.folder / "gen").glob("*.machine.json")
    machine.unlink()
    machine.symlink_to("../plant.ir")
    before = project.snapshot()
    result = project.run("synth", "gate.ltl", "-o", "gen")
    assert (result.exit_code, "is not written: it is a link" in result.stderr) == (2, True)
    assert project.snapshot() == before


GATE = """\
package Plant { private import ScalarValues::*; part def Gate {
  in attribute ready : Boolean;
  state def Behaviour { entry; then shut; state shut; state open;
    transition first shut if ready then open; transition first open if not ready then shut; }
  exhibit state behaviour : Behaviour; }
  requirement def Safe { doc /* The gate is safe. */ } }
"""


def test_stale_outputs_of_all_back_ends_are_removed_from_a_shared_folder(project):
    project.write("gate.sysml", GATE)
    before = list_names(project.folder)
    names = ",".join(list_backend_names())
    assert project.run("build", "gate.sysml", "-o", ".", "--emit", names).exit_code == 0
    assert {"monitors", "contracts", "aml"} <= set(list_names(project.folder))
    assert project.run("build", "gate.sysml", "-o", ".", "--emit", "graph").exit_code == 0
    assert sorted({*before, *OUTPUTS}) == list_names(project.folder)
