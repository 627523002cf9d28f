"""Formats of diagnostics (text, concise, github, json, sarif), colours and the limit."""

import json

import pytest
from jsonschema import Draft202012Validator
from msgspec.structs import replace

from json_documents import SARIF
from sysmlc.cli.reports import has_color
from sysmlc.diagnostics import Place, Severity, Sink, Subject, rule
from sysmlc.diagnostics.renderers import FORMATS, Report, make_report, render
from sysmlc.sources import Source
from sysmlc.support import resources

OPEN = rule(
    "SM944",
    "test-open-end",
    Severity.ERROR,
    "connector '{name}' has an open end",
    help="connect '{name}'",
    page="# SM944 test-open-end\n\n## Why\n\nSomething must be at both ends.\n",
)
ODD = rule("TEST945", "test-odd-name", Severity.INFO, "'{name}' is odd")
MODEL = """\
<uml:Model xmlns:uml="u">
  <ownedConnector name="belt"/>
</uml:Model>
"""
SOURCE = Source("plant.uml", MODEL.encode())
BELT = Subject("Plant::belt", "c1", Place("plant.uml", ordinal=1))


def make_sample_report(*reports):
    sink = Sink()
    for violated_rule, subject, facts in reports or [(OPEN, BELT, {"name": "belt"})]:
        sink.report(violated_rule, subject, notes=("seen in Papyrus",), **facts)
    return make_report(sink, [SOURCE])


def drop_xpaths(report):
    return Report(tuple(replace(diagnostic, xpath="") for diagnostic in report.findings))


def test_text_has_an_excerpt_and_a_caret():
    assert render(drop_xpaths(make_sample_report()), "text") == (
        "error[SM944 test-open-end]: connector 'belt' has an open end\n"
        "  --> plant.uml:2:3 (Plant::belt)\n"
        "   |\n"
        ' 2 |   <ownedConnector name="belt"/>\n'
        "   |   ^\n"
        "  note: seen in Papyrus\n"
        "  help: connect 'belt'\n"
        "\n"
        "1 error in 1 file\n"
    )


def test_text_shows_the_xpath_of_a_diagnostic():
    lines = render(make_sample_report(), "text").splitlines()
    assert lines[5] == "  xpath: /uml:Model/ownedConnector[1]"
    assert lines[:5] + lines[6:] == render(drop_xpaths(make_sample_report()), "text").splitlines()


def test_text_is_coloured_on_request():
    assert "\x1b[1;31merror[SM944 test-open-end]\x1b[0m" in render(
        make_sample_report(), "text", color=True
    )
    assert "\x1b" not in render(make_sample_report(), "text")


def test_a_long_line_is_cut_around_the_location():
    line = "<a>" + "<b/>" * 400 + "</a>"
    subject = Subject("x", "x", Place("one.uml", ordinal=300))
    sink = Sink()
    sink.report(ODD, subject, name="x")
    text = render(make_report(sink, [Source("one.uml", line.encode())]), "text")
    excerpt, caret = text.splitlines()[3:5]
    assert len(excerpt) < 115
    assert excerpt[caret.index("^") :].startswith("<b/>")


def test_wide_characters_move_the_caret():
    line = '<a n="テスト"><b/></a>'
    sink = Sink()
    sink.report(ODD, Subject("x", "x", Place("one.uml", ordinal=1)), name="x")
    caret = render(make_report(sink, [Source("one.uml", line.encode())]), "text").splitlines()[4]
    assert caret.index("^") == len(" 1 | ") + line.index("<b/>") + 3


def test_control_characters_of_names_do_not_reach_the_terminal():
    for format_name in ("text", "concise", "github"):
        report = make_sample_report((ODD, Subject("\x1b[2J"), {"name": "\x1b]0;x\x07"}))
        assert "\x1b" not in render(report, format_name)


def test_concise_is_one_line_for_each_diagnostic():
    assert render(make_sample_report(), "concise") == (
        "plant.uml:2:3: error[SM944 test-open-end]: connector 'belt' has an open end "
        "(Plant::belt)\n1 error in 1 file\n"
    )


def test_json_follows_its_schema():
    content = json.loads(render(make_sample_report(), "json"))
    schema = json.loads(resources.read_text("metamodels", "sysmlc-diagnostics.schema.json"))
    Draft202012Validator.check_schema(schema)
    assert list(Draft202012Validator(schema).iter_errors(content)) == []
    assert content == {
        "format": "sysmlc-diagnostics/2",
        "diagnostics": [
            {
                "file": "plant.uml",
                "line": 2,
                "column": 3,
                "end_line": 2,
                "end_column": 32,
                "xpath": "/uml:Model/ownedConnector[1]",
                "severity": "error",
                "code": "SM944",
                "name": "test-open-end",
                "message": "connector 'belt' has an open end",
                "element": "Plant::belt",
                "notes": ["seen in Papyrus"],
                "help": "connect 'belt'",
            }
        ],
        "summary": {"errors": 1, "warnings": 0, "infos": 0, "files": 1},
    }


def test_sarif_has_the_fields_that_scanning_services_read():
    report = make_sample_report(
        (OPEN, BELT, {"name": "belt"}),
        (ODD, Subject("x", "x", Place("my plant.mdzip!com.model", ordinal=0)), {"name": "x"}),
        (ODD, Subject(), {"name": "y"}),
    )
    log = json.loads(render(report, "sarif"))
    assert list(Draft202012Validator(SARIF).iter_errors(log)) == []
    sarif_run = log["runs"][0]
    assert [entry["id"] for entry in sarif_run["tool"]["driver"]["rules"]] == ["SM944", "TEST945"]
    assert [result["ruleIndex"] for result in sarif_run["results"]] == [0, 1, 1]
    assert sarif_run["results"][0]["locations"][0]["properties"] == {
        "xpath": "/uml:Model/ownedConnector[1]"
    }
    archive = sarif_run["results"][1]["locations"][0]["physicalLocation"]
    assert archive == {"artifactLocation": {"uri": "my%20plant.mdzip"}}


def test_sarif_fingerprints_do_not_change_with_the_line():
    def fingerprint(text):
        sink = Sink()
        sink.report(OPEN, BELT, name="belt")
        log = json.loads(render(make_report(sink, [Source("plant.uml", text.encode())]), "sarif"))
        return log["runs"][0]["results"][0]["partialFingerprints"]

    assert fingerprint(MODEL) == fingerprint("<!-- moved -->\n" + MODEL)


def test_github_annotates_lines():
    assert render(make_sample_report(), "github").splitlines()[0] == (
        "::error file=plant.uml,line=2,col=3,title=SM944 test-open-end::"
        "connector 'belt' has an open end%0Aseen in Papyrus%0Aconnect 'belt'"
    )


@pytest.mark.parametrize("format_name", FORMATS)
def test_a_report_without_diagnostics_is_empty_text_or_an_empty_document(format_name):
    text = render(make_report([], []), format_name)
    empty = {"json": {"diagnostics": []}, "sarif": {"version": "2.1.0"}}
    if format_name in empty:
        assert empty[format_name].items() <= json.loads(text).items()
    else:
        assert text == ""


@pytest.mark.parametrize("format_name", ["json", "sarif"])
def test_documents_are_the_only_output(workspace, format_name):
    workspace.write("faulty.ir", 'Package pkg "Plant"\n  Class gate "Gate"\n    Port gate.in\n')
    result = workspace.sysmlc("faulty.ir", "--emit", "graph", "--format", format_name)
    assert result.exit_code == 1
    assert json.loads(result.stdout)
    assert result.stderr == ""


def test_diagnostics_of_several_units_are_one_document(workspace):
    workspace.write(
        "sysmlc.toml",
        '[[model]]\nname="a"\nfiles=["no.ir"]\n[[model]]\nname="b"\nfiles=["nix.ir"]\n',
    )
    result = workspace.sysmlc("check", "--emit", "graph", "--format", "json")
    assert [entry["file"] for entry in json.loads(result.stdout)["diagnostics"]] == [
        "no.ir",
        "nix.ir",
    ]


def test_colours_need_a_terminal_and_no_color_switches_them_off(monkeypatch):
    class Terminal:
        def isatty(self):
            return True

    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.delenv("NO_COLOR", raising=False)
    assert has_color(Terminal())
    assert not has_color(object())
    monkeypatch.setenv("NO_COLOR", "1")
    assert not has_color(Terminal())


# -- limit of diagnostics -------------------------------------------------------------------------


def write_model_with_many_diagnostics(workspace, ports):
    lines = [f'  Port g.p{n} "p{n}" direction="in" @many.ir:{n}\n' for n in range(ports)]
    wrong = "  Port g.nameless\n"
    workspace.write("many.ir", 'Class g "Gate"\n' + "".join(lines) + wrong)


def test_the_most_severe_diagnostics_are_shown_and_the_rest_is_counted(workspace):
    write_model_with_many_diagnostics(workspace, 5)
    result = workspace.sysmlc("check", "many.ir", "--max-diagnostics", "2", "--format", "concise")
    shown = [line.split(": ")[1] for line in result.stderr.splitlines()[:2]]
    assert sorted(shown) == ["error[SM942 test-nameless-port]", "warning[SM943 test-untyped-port]"]
    assert result.stderr.splitlines()[2:] == [
        "1 error, 5 warnings in 1 file",
        "4 more are not shown; --max-diagnostics 0 shows all",
    ]
    assert result.exit_code == 1


@pytest.mark.parametrize("limit", ["6", "0"])
def test_all_diagnostics_are_shown_when_the_limit_allows(workspace, limit):
    write_model_with_many_diagnostics(workspace, 5)
    result = workspace.sysmlc("check", "many.ir", "--max-diagnostics", limit, "--format", "concise")
    assert len(result.stderr.splitlines()) == 7
    assert "not shown" not in result.stderr


def test_text_shows_a_thousand_diagnostics_and_json_all(workspace):
    write_model_with_many_diagnostics(workspace, 1_010)
    assert workspace.sysmlc("check", "many.ir").stderr.count("SM943") == 999
    result = workspace.sysmlc("check", "many.ir", "--format", "json")
    assert len(json.loads(result.stdout)["diagnostics"]) == 1_011
    assert result.stderr == ""


@pytest.mark.parametrize("command", ["check", "build"])
def test_a_command_that_fails_prints_a_document_with_the_reason(workspace, command):
    """A service that reads the output must not get an empty file."""
    arguments = (command, "plant.ir", "--select", "SM999x")
    result = workspace.sysmlc(*arguments, "--format", "sarif")
    (invocation,) = json.loads(result.stdout)["runs"][0]["invocations"]
    reason = "unknown rule 'SM999x'; 'sysmlc explain' lists the rules"
    assert result.exit_code == 2
    assert invocation == {
        "executionSuccessful": False,
        "toolExecutionNotifications": [{"level": "error", "message": {"text": reason}}],
    }
    document = json.loads(workspace.sysmlc(*arguments, "--format", "json").stdout)
    schema = json.loads(resources.read_text("metamodels", "sysmlc-diagnostics.schema.json"))
    assert list(Draft202012Validator(schema).iter_errors(document)) == []
    assert (document["diagnostics"], document["failure"]) == ([], reason)


@pytest.mark.parametrize(
    ("option", "variables", "is_colored"),
    [
        ("always", {"NO_COLOR": "1"}, True),
        ("never", {"FORCE_COLOR": "1"}, False),
        ("auto", {"FORCE_COLOR": "1"}, True),
        ("auto", {"FORCE_COLOR": "1", "NO_COLOR": "1"}, False),
        ("auto", {}, False),
    ],
)
def test_the_option_color_comes_before_the_environment(
    workspace, monkeypatch, option, variables, is_colored
):
    for name in ("NO_COLOR", "FORCE_COLOR"):
        monkeypatch.delenv(name, raising=False)
    for name, value in variables.items():
        monkeypatch.setenv(name, value)
    result = workspace.sysmlc("check", "missing.uml", "--color", option)
    assert ("\x1b[" in result.stderr) == is_colored


def test_messages_name_files_as_their_locations_do(workspace):
    workspace.write("models/empty.uml", "")
    result = workspace.sysmlc("check", "models", "--format", "concise")
    assert "models/empty.uml: warning" in result.stderr
    assert "'models/empty.uml' is named like a model" in result.stderr
