"""A configuration that would exhaust the TOML parser is refused with file and line."""

import subprocess
import sys
import time

import pytest
from click.testing import CliRunner

from sysmlc.cli.group import sysmlc
from sysmlc.documents import DocumentError, parse_toml

DEEP = ": more than 50 nested brackets"
LONG_KEY = ": a dotted key of more than 50 parts"
LONG_WORD = ":1:5: a number or key of more than 1,000 characters"
ATTACKS = {
    "arrays": ("a = " + "[" * 100_000, DEEP),
    "inline tables": ("a = {a" * 100_000, DEEP),
    "dotted key": (".".join("a" * 100_000) + " = 1", LONG_KEY),
    "quoted dotted key": (".".join(['"a"'] * 100_000) + " = 1", LONG_KEY),
    "table header": ("\n\n[" + ".".join("a" * 100_000) + "]", LONG_KEY),
    "integer": ("a = " + "1" * 5_000, LONG_WORD),
    "size": ("# " + "x" * 1_000_000, "1:1: the file has more than 1,000,000 characters"),
    "unterminated": ('a = "b', ":1:7: Unterminated string"),
    "value": ("a = 1\nb = = 2\n", ":2:5: Invalid value"),
}


@pytest.mark.parametrize("attack", ATTACKS)
@pytest.mark.parametrize("name", ["sysmlc.toml", "pyproject.toml"])
def test_hostile_toml_is_a_located_message(tmp_path, monkeypatch, name, attack):
    text, message = ATTACKS[attack]
    monkeypatch.chdir(tmp_path)
    (tmp_path / name).write_text(text)
    (tmp_path / "m.ir").write_text('Class a "A"\n')
    start = time.process_time()
    result = CliRunner().invoke(sysmlc, ["check", "m.ir"])
    assert result.exit_code == 2
    assert result.stderr.startswith(f"sysmlc: {tmp_path / name}:")
    assert message in result.stderr
    assert len(result.stderr) < 1_000
    assert time.process_time() - start < 5


@pytest.mark.parametrize("path", ["a" * 241, "/".join("a" * 101), "ä" * 121])
@pytest.mark.parametrize(
    ("key", "text"),
    [
        ("output", 'output = "{}"'),
        ("templates", 'templates = "{}"'),
        ("name", '[[model]]\nname = "{}"\nfiles = ["m.ir"]'),
        ("files", '[[model]]\nname = "m"\nfiles = ["{}*"]'),
    ],
)
def test_paths_that_no_file_system_holds_are_refused(tmp_path, monkeypatch, key, text, path):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "m.ir").write_text('Class a "A"\n')
    (tmp_path / "sysmlc.toml").write_text(text.format(path))
    result = CliRunner().invoke(sysmlc, ["check", "m.ir"])
    assert result.exit_code == 2
    assert f"'{key}': '{path[:100]}...' is longer than file systems allow" in result.stderr


@pytest.mark.parametrize("option", ["", "--config", "--overlay", "--schema"])
def test_long_paths_on_the_command_line_are_one_message(tmp_path, monkeypatch, option):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "m.ir").write_text('Class a "A"\n')
    command = [sys.executable, "-m", "sysmlc", "check", "m.ir", *filter(None, [option]), "a" * 300]
    result = subprocess.run(command, capture_output=True, text=True)
    assert result.returncode == 2
    assert "Please report" not in result.stderr
    assert "a" * 100 in result.stderr


def test_ordinary_toml_is_within_the_limits():
    strings = '"""' + "[" * 60 + '"""'
    text = f"a = {strings} # {'[' * 60}\nb = [{', '.join(['1.5'] * 200)}]\n[c.'d.e'.f]\ng = ']'\n"
    assert parse_toml(text).as_json()["c"] == {"d.e": {"f": {"g": "]"}}}


def test_positions_are_those_of_the_parser():
    with pytest.raises(DocumentError, match="Invalid statement") as raised:
        parse_toml("a = 1\n  ?")
    assert raised.value.spot[:2] == (2, 3)


def test_a_long_value_is_cut_in_the_message(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "sysmlc.toml").write_text(f"output = [{', '.join(['12'] * 90_000)}]\n")
    result = CliRunner().invoke(sysmlc, ["check"])
    assert result.exit_code == 2
    assert "is not of type 'string'" in result.stderr
    assert len(result.stderr) < 500
