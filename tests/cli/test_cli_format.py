"""``sysmlc format``: files formatted in place, checked or compared."""

from pathlib import Path

import pytest
from click.testing import CliRunner

from sysmlc.cli.group import sysmlc

ROOT = Path(__file__).parents[2]
UGLY = "package P{part def A;}\n"
NEAT = "package P {\n    part def A;\n}\n"


def run_format(*arguments, text=None):
    return CliRunner().invoke(sysmlc, ["format", *map(str, arguments)], input=text)


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "ugly.sysml").write_text(UGLY)
    (tmp_path / "neat.kerml").write_text("package P {\n    class A;\n}\n")
    (tmp_path / "other.txt").write_text(UGLY)
    return tmp_path


def test_files_of_a_folder_are_formatted_in_place(folder):
    result = run_format(folder)
    assert (result.exit_code, result.stderr) == (0, "1 of 2 files reformatted\n")
    assert (folder / "ugly.sysml").read_text() == NEAT
    assert (folder / "other.txt").read_text() == UGLY
    assert run_format(folder).stderr == "0 of 2 files reformatted\n"


def test_check_lists_the_files_to_format_and_writes_nothing(folder):
    result = run_format(folder, "--check")
    assert (result.exit_code, result.stdout) == (1, f"{folder.as_posix()}/ugly.sysml\n")
    assert (folder / "ugly.sysml").read_text() == UGLY
    assert run_format(folder / "neat.kerml", "--check").exit_code == 0


def test_diff_shows_the_changes_and_writes_nothing(folder):
    result = run_format(folder / "ugly.sysml", "--diff")
    assert result.exit_code == 1
    assert result.stdout.splitlines()[3:] == [
        "-package P{part def A;}",
        "+package P {",
        "+    part def A;",
        "+}",
    ]
    assert (folder / "ugly.sysml").read_text() == UGLY


def test_diff_marks_a_missing_line_end(tmp_path):
    (tmp_path / "a.sysml").write_text("part a ;")
    assert "\\ No newline at end of file\n" in run_format(tmp_path / "a.sysml", "--diff").stdout


def test_standard_input_goes_to_standard_output():
    result = run_format("-", text=UGLY)
    assert (result.exit_code, result.stdout, result.stderr) == (0, NEAT, "")
    assert run_format("-", "--language", "kerml", text="class A ;").stdout == "class A;\n"


def test_a_file_with_syntax_errors_is_not_changed_while_the_rest_is_formatted(folder):
    (folder / "wrong.sysml").write_text("package P{part def ;;}")
    result = run_format(folder)
    assert result.exit_code == 1
    assert "wrong.sysml:1:21" in result.stderr
    assert (folder / "wrong.sysml").read_text() == "package P{part def ;;}"
    assert (folder / "ugly.sysml").read_text() == NEAT


@pytest.mark.parametrize(
    ("name", "content", "message"),
    [
        ("gone.sysml", None, "cannot be opened: No such file or directory"),
        ("model.uml", b"", "ends neither in .sysml nor in .kerml: say --language"),
        ("latin.sysml", b"part '\xe4';", "is not UTF-8: byte 6 does not start a character"),
    ],
)
def test_a_file_that_cannot_be_read_is_exit_code_2(tmp_path, name, content, message):
    if content is not None:
        (tmp_path / name).write_bytes(content)
    result = run_format(tmp_path / name)
    assert (result.exit_code, result.stderr) == (
        2,
        f"sysmlc: {(tmp_path / name).as_posix()} {message}\n",
    )


def test_permissions_are_preserved(tmp_path):
    real = tmp_path / "real.sysml"
    real.write_text(UGLY)
    real.chmod(0o600)
    run_format(real)
    assert (real.read_text(), real.stat().st_mode & 0o777) == (NEAT, 0o600)


def test_links_in_a_folder_are_named_and_not_followed(tmp_path):
    outside, folder = tmp_path / "outside.sysml", tmp_path / "models"
    outside.write_text(UGLY)
    folder.mkdir()
    (folder / "neat.sysml").write_text(NEAT)
    (folder / "link.sysml").symlink_to(outside)
    result = run_format(folder)
    link = f"'{folder.as_posix()}/link.sysml' is a link; it is not formatted"
    assert result.stderr == f"sysmlc: warning: {link}\n0 of 1 file reformatted\n"
    assert outside.read_text() == UGLY


def test_a_symbolic_link_is_refused(tmp_path):
    """A link in a repository may lead to any file of the user."""
    real, link = tmp_path / "real.sysml", tmp_path / "link.sysml"
    real.write_text(UGLY)
    link.symlink_to(real)
    result = run_format(link)
    message = f"sysmlc: '{link.as_posix()}' is a link; name what it leads to\n"
    assert (result.exit_code, result.stderr) == (2, message)
    assert (link.is_symlink(), real.read_text()) == (True, UGLY)


def test_a_folder_without_models_is_exit_code_2(tmp_path):
    result = run_format(tmp_path, "--check")
    message = f"sysmlc: {tmp_path.as_posix()} holds no .sysml or .kerml file\n"
    assert (result.exit_code, result.stderr) == (2, message)


def test_suffixes_in_capitals_are_recognised(tmp_path):
    (tmp_path / "PLANT.SYSML").write_text(UGLY)
    assert run_format(tmp_path).stderr == "1 of 1 file reformatted\n"


def test_a_read_only_file_is_not_changed(tmp_path):
    file = tmp_path / "plant.sysml"
    file.write_text(UGLY)
    file.chmod(0o444)
    result = run_format(file)
    assert (result.exit_code, result.stderr) == (2, f"sysmlc: {file.as_posix()} is read-only\n")
    assert file.read_text() == UGLY


def test_a_full_disk_leaves_the_file_unchanged(tmp_path, monkeypatch):
    def raise_disk_full(*_):
        raise OSError(28, "No space left on device")

    file = tmp_path / "plant.sysml"
    file.write_text(UGLY)
    monkeypatch.setattr("sysmlc.support.atomic_files._write_all", raise_disk_full)
    result = run_format(file)
    message = f"sysmlc: {file.as_posix()} cannot be written: No space left on device\n"
    assert (result.exit_code, result.stderr) == (2, message)
    assert [path.name for path in tmp_path.iterdir()] == ["plant.sysml"]
    assert file.read_text() == UGLY


def test_the_example_of_the_documentation_is_the_output():
    page = (ROOT / "docs/format-sysml-v2.md").read_text(encoding="utf-8")
    before, after = (part.partition("```")[0] for part in page.split("```sysml\n")[1:])
    assert run_format("-", text=before).stdout == after


def test_fix_writes_the_visibility_that_imports_lack(tmp_path):
    old = tmp_path / "old.sysml"
    old.write_text("package P { import Q::*; private import R::A; package Q; }\n")
    result = run_format(tmp_path, "--fix")
    assert (result.exit_code, result.stderr) == (0, "1 of 1 file reformatted\n")
    assert old.read_text().splitlines()[1:3] == [
        "    public import Q::*;",
        "    private import R::A;",
    ]


def test_without_fix_imports_stay_as_they_are(tmp_path):
    old = tmp_path / "old.sysml"
    old.write_text("package P {\n    import Q::*;\n}\n")
    assert run_format(old, "--check").exit_code == 0
