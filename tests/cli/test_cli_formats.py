"""Findings in each form."""

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
ODD = rule("SM945", "test-odd-name", Severity.INFO, "'{name}' is odd")
MODEL = """\
<uml:Model xmlns:uml="u">
  <ownedConnector name="belt"/>
</uml:Model>
"""
SOURCE = Source("plant.uml", MODEL.encode())
BELT = Subject("Plant::belt", "c1", Place("plant.uml", ordinal=1))


def report(*findings):
    sink = Sink()
    for found, subject, facts in findings or [(OPEN, BELT, {"name": "belt"})]:
        sink.report(found, subject, notes=("seen in Papyrus",), **facts)
    return make_report(sink, [SOURCE])


def without_xpath(made):
    return Report(tuple(replace(finding, xpath="") for finding in made.findings))


def test_text_has_an_excerpt_and_a_caret():
    assert render(without_xpath(report()), "text") == (
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


def test_text_shows_the_xpath_that_it_is_given():
    made = render(report(), "text").splitlines()
    assert made[5] == "  xpath: /uml:Model/ownedConnector[1]"
    assert made[:5] + made[6:] == render(without_xpath(report()), "text").splitlines()


def test_text_is_coloured_when_asked():
    assert "\x1b[1;31merror[SM944 test-open-end]\x1b[0m" in render(report(), "text", color=True)
    assert "\x1b" not in render(report(), "text")


def test_a_long_line_is_cut_around_the_place():
    line = "<a>" + "<b/>" * 400 + "</a>"
    found = Subject("x", "x", Place("one.uml", ordinal=300))
    sink = Sink()
    sink.report(ODD, found, name="x")
    text = render(make_report(sink, [Source("one.uml", line.encode())]), "text")
    excerpt, caret = text.splitlines()[3:5]
    assert len(excerpt) < 115
    assert excerpt[caret.index("^") :].startswith("<b/>")


def test_wide_signs_move_the_caret():
    line = '<a n="テスト"><b/></a>'
    sink = Sink()
    sink.report(ODD, Subject("x", "x", Place("one.uml", ordinal=1)), name="x")
    caret = render(make_report(sink, [Source("one.uml", line.encode())]), "text").splitlines()[4]
    assert caret.index("^") == len(" 1 | ") + line.index("<b/>") + 3


def test_a_name_cannot_steer_the_terminal():
    for form in ("text", "concise", "github"):
        made = report((ODD, Subject("\x1b[2J"), {"name": "\x1b]0;x\x07"}))
        assert "\x1b" not in render(made, form)


def test_concise_is_one_line_each():
    assert render(report(), "concise") == (
        "plant.uml:2:3: error[SM944 test-open-end]: connector 'belt' has an open end "
        "(Plant::belt)\n1 error in 1 file\n"
    )


def test_json_follows_its_schema():
    content = json.loads(render(report(), "json"))
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


def test_sarif_has_the_shape_that_scanning_services_read():
    made = report(
        (OPEN, BELT, {"name": "belt"}),
        (ODD, Subject("x", "x", Place("my plant.mdzip!com.model", ordinal=0)), {"name": "x"}),
        (ODD, Subject(), {"name": "y"}),
    )
    log = json.loads(render(made, "sarif"))
    assert list(Draft202012Validator(SARIF).iter_errors(log)) == []
    run = log["runs"][0]
    assert [entry["id"] for entry in run["tool"]["driver"]["rules"]] == ["SM944", "SM945"]
    assert [result["ruleIndex"] for result in run["results"]] == [0, 1, 1]
    assert run["results"][0]["locations"][0]["properties"] == {
        "xpath": "/uml:Model/ownedConnector[1]"
    }
    archive = run["results"][1]["locations"][0]["physicalLocation"]
    assert archive == {"artifactLocation": {"uri": "my%20plant.mdzip"}}


def test_sarif_fingerprints_do_not_change_with_the_line():
    def fingerprint(text):
        sink = Sink()
        sink.report(OPEN, BELT, name="belt")
        log = json.loads(render(make_report(sink, [Source("plant.uml", text.encode())]), "sarif"))
        return log["runs"][0]["results"][0]["partialFingerprints"]

    assert fingerprint(MODEL) == fingerprint("<!-- moved -->\n" + MODEL)


def test_github_shows_findings_beside_the_lines():
    assert render(report(), "github").splitlines()[0] == (
        "::error file=plant.uml,line=2,col=3,title=SM944 test-open-end::"
        "connector 'belt' has an open end%0Aseen in Papyrus%0Aconnect 'belt'"
    )


@pytest.mark.parametrize("form", FORMATS)
def test_nothing_found_is_nothing_or_an_empty_document(form):
    text = render(make_report([], []), form)
    empty = {"json": {"diagnostics": []}, "sarif": {"version": "2.1.0"}}
    if form in empty:
        assert empty[form].items() <= json.loads(text).items()
    else:
        assert text == ""


@pytest.mark.parametrize("form", ["json", "sarif"])
def test_documents_go_to_standard_output_alone(here, form):
    here.write("faulty.ir", 'Package pkg "Plant"\n  Class gate "Gate"\n    Port gate.in\n')
    done = here.sysmlc("faulty.ir", "--emit", "graph", "--format", form)
    assert done.exit_code == 1
    assert json.loads(done.stdout)
    assert done.stderr == ""


def test_several_units_are_one_document(here):
    here.write(
        "sysmlc.toml",
        '[[model]]\nname="a"\nfiles=["no.ir"]\n[[model]]\nname="b"\nfiles=["nix.ir"]\n',
    )
    done = here.sysmlc("check", "--emit", "graph", "--format", "json")
    assert [d["file"] for d in json.loads(done.stdout)["diagnostics"]] == ["no.ir", "nix.ir"]


def test_colour_is_for_terminals_and_no_color_is_respected(monkeypatch):
    class Terminal:
        def isatty(self):
            return True

    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.delenv("NO_COLOR", raising=False)
    assert has_color(Terminal())
    assert not has_color(object())
    monkeypatch.setenv("NO_COLOR", "1")
    assert not has_color(Terminal())
