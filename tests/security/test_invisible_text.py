"""Control, bidirectional and zero-width characters of models are displayed as escapes."""

import json

import pytest
from click.testing import CliRunner

from sysmlc.cli.group import sysmlc
from sysmlc.support.escapes import escape_invisible, escape_undecodable

HOSTILE = "a\u202eb\u200bc\x1b[31md\x9be\ue000f\u2028g\ufeffh\u3164i"
SHOWN = r"a\u202eb\u200bc\x1b[31md\u009be" + "\ue000" + r"f\u2028g\ufeffh\u3164i"


def test_invisible_characters_become_escapes():
    assert escape_invisible(HOSTILE) == SHOWN
    assert escape_invisible("x\ny\tz", "\n\t") == "x\ny\tz"
    assert escape_invisible("x\ny") == r"x\ny".replace("n", "x0a")
    assert escape_invisible("\U000e0041") == r"\U000e0041"


def test_visible_text_stays():
    text = "Größe 槽 αβγ «block» → 'x' 🤖 é"
    assert escape_invisible(text) == text


def test_bytes_of_file_names_become_escapes():
    assert escape_undecodable(b"pl\xffnt.sysml".decode("utf-8", "surrogateescape")) == (
        r"pl\xffnt.sysml"
    )
    assert escape_undecodable("Größe\ud800") == r"Größe\ud800"


@pytest.fixture
def run(tmp_path, monkeypatch):
    """Run a command on a model with two elements of the same hostile name."""
    monkeypatch.chdir(tmp_path)
    name = json.dumps(HOSTILE)
    (tmp_path / "m.ir").write_text(f"Class a {name}\nClass b {name}\n  -> specializes b\n")

    def invoke(*args):
        ended = CliRunner().invoke(sysmlc, args)
        return ended.stdout + ended.stderr

    return invoke


@pytest.mark.parametrize("form", ["text", "concise", "github"])
def test_reports_for_terminals_show_escapes(run, form):
    report = run("check", "m.ir", "--format", form)
    assert SHOWN in report.replace("%3A", ":")
    assert not any(sign in report for sign in "\x1b\u202e\u200b\x9b\u2028\ufeff")


@pytest.mark.parametrize("form", ["json", "sarif"])
def test_reports_for_programs_hold_the_name_itself(run, form):
    texts = json.dumps(json.loads(run("check", "m.ir", "--format", form)))
    assert json.dumps(HOSTILE).strip('"') in texts


@pytest.mark.parametrize("args", [("show", "m.ir"), ("show", "m.ir", "-e", "nothing")])
def test_other_commands_show_escapes(run, args):
    printed = run(*args)
    assert r"\u202e" in printed
    assert not any(sign in printed for sign in "\x1b\u202e\u200b\x9b")


def test_workflow_commands_of_github_are_not_injected(run, tmp_path):
    name = json.dumps("x\n::error::owned%0A::error::owned\r::stop-commands::x")
    (tmp_path / "m.ir").write_text(f"Class b {name}\n  -> specializes b\n")
    lines = run("check", "m.ir", "--format", "github").splitlines()
    assert [line for line in lines if line.startswith("::")] == lines[:1]
    assert "%250A" in lines[0]
