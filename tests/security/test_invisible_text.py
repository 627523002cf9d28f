"""Control, bidirectional and zero-width characters in models are displayed as escapes."""

import json

import pytest
from click.testing import CliRunner

from sysmlc.cli.group import sysmlc
from sysmlc.support.escapes import escape_invisible, escape_undecodable

HOSTILE = "a\u202eb\u200bc\x1b[31md\x9be\ue000f\u2028g\ufeffh\u3164i"
ESCAPED = r"a\u202eb\u200bc\x1b[31md\u009be" + "\ue000" + r"f\u2028g\ufeffh\u3164i"


def test_invisible_characters_become_escapes():
    assert escape_invisible(HOSTILE) == ESCAPED
    assert escape_invisible("x\ny\tz", "\n\t") == "x\ny\tz"
    assert escape_invisible("x\ny") == r"x\ny".replace("n", "x0a")
    assert escape_invisible("\U000e0041") == r"\U000e0041"


def test_visible_text_is_not_escaped():
    text = "Größe 槽 αβγ «block» → 'x' 🤖 é"
    assert escape_invisible(text) == text


def test_undecodable_bytes_of_file_names_become_escapes():
    assert escape_undecodable(b"pl\xffnt.sysml".decode("utf-8", "surrogateescape")) == (
        r"pl\xffnt.sysml"
    )
    assert escape_undecodable("Größe\ud800") == r"Größe\ud800"


@pytest.fixture
def run_sysmlc(tmp_path, monkeypatch):
    """Return a function that runs a command on a model with two elements of a hostile name."""
    monkeypatch.chdir(tmp_path)
    name = json.dumps(HOSTILE)
    (tmp_path / "m.ir").write_text(f"Class a {name}\nClass b {name}\n  -> specializes b\n")

    def invoke(*args):
        result = CliRunner().invoke(sysmlc, args)
        return result.stdout + result.stderr

    return invoke


@pytest.mark.parametrize("format_name", ["text", "concise", "github"])
def test_reports_for_terminals_show_escapes(run_sysmlc, format_name):
    report = run_sysmlc("check", "m.ir", "--format", format_name)
    assert ESCAPED in report.replace("%3A", ":")
    assert not any(character in report for character in "\x1b\u202e\u200b\x9b\u2028\ufeff")


@pytest.mark.parametrize("format_name", ["json", "sarif"])
def test_reports_for_programs_contain_the_original_name(run_sysmlc, format_name):
    texts = json.dumps(json.loads(run_sysmlc("check", "m.ir", "--format", format_name)))
    assert json.dumps(HOSTILE).strip('"') in texts


@pytest.mark.parametrize("args", [("show", "m.ir"), ("show", "m.ir", "-e", "nothing")])
def test_other_commands_show_escapes(run_sysmlc, args):
    output = run_sysmlc(*args)
    assert r"\u202e" in output
    assert not any(character in output for character in "\x1b\u202e\u200b\x9b")


def test_workflow_commands_of_github_are_not_injected(run_sysmlc, tmp_path):
    name = json.dumps("x\n::error::owned%0A::error::owned\r::stop-commands::x")
    (tmp_path / "m.ir").write_text(f"Class b {name}\n  -> specializes b\n")
    lines = run_sysmlc("check", "m.ir", "--format", "github").splitlines()
    assert [line for line in lines if line.startswith("::")] == lines[:1]
    assert "%250A" in lines[0]
