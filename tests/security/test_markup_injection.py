"""Names in models are text in Markdown, spreadsheets and PlantUML, never markup or directives."""

import re

import pytest

from machine_samples import arrow, machine
from refinement import run_all
from sysmlc.backends.base import EmitOptions
from sysmlc.backends.contracts import BACKEND
from sysmlc.backends.reqtable import format_csv
from sysmlc.backends.reqtable.table import Cell, Table
from sysmlc.backends.reqtable.table import Row as TableRow
from sysmlc.diagnostics import Sink
from sysmlc.ir import Element, Kind
from sysmlc.ir.text import parse_text
from sysmlc.logic.contract import Contract
from sysmlc.logic.formats import write
from sysmlc.support import plantuml_text as plantuml
from sysmlc.support.escapes import escape_code, escape_markdown
from sysmlc.support.output import Output
from sysmlc.support.program_text import format_comment

HOSTILE = "<script>x</script>[y](javascript:z)`|**b**\n## Injected\n\u202e&lt;"
MODEL = machine(
    arrow("a", "b", "start", "level < 9", "level := level + 1"), arrow("b", "a", after="after 3 s")
)


@pytest.mark.parametrize(
    ("text", "escaped"),
    [
        ("<script>", r"\<script>"),
        ("</b><!--<?x", r"\</b>\<!--\<?x"),
        ("level < 9 and a <> b", "level < 9 and a <> b"),
        ("see [x](javascript:y)", r"see [x\](javascript:y)"),
        ("![x][y]", r"![x\][y]"),
        ("[x]: javascript:y", r"\[x]: javascript:y"),
        ("`a` | *b* ~~c~~", r"\`a\` \| \*b\* \~\~c\~\~"),
        ("_a_ snake_case __b__", r"\_a\_ snake_case \_\_b\_\_"),
        ("&lt; &#60; a & b", "&amp;lt; &amp;#60; a & b"),
        ("# a", r"\# a"),
        ("track #", r"track \#"),
        ("C# and ##", r"C# and \##"),
        ("1. a", r"1\. a"),
        ("1.5 mm", "1.5 mm"),
        ("> a", r"\> a"),
        ("- a", r"\- a"),
        ("a\n\n## b", "a ## b"),
        ("a\u202eb", r"a\\u202eb"),
        ("Gate 'in'", "Gate 'in'"),
    ],
)
def test_text_in_markdown_is_not_interpreted(text, escaped):
    assert escape_markdown(text) == escaped


def test_backticks_in_code_spans_are_escaped():
    assert escape_code("a`b|c\nd") == r"a\x60b|c d"
    assert escape_code("a|b", in_table=True) == r"a\|b"


def emit_contracts(text):
    graph, output = parse_text(text), Output()
    run_all(graph, Sink())
    BACKEND.emit(graph, output, Sink(), EmitOptions())
    return {artefact.path.partition(".")[2][-7:]: artefact.text for artefact in output.artefacts()}


def test_names_add_no_markup_to_a_contract_page():
    quoted = '"' + HOSTILE.replace("\n", "\\n") + '"'
    page = next(
        text for text in emit_contracts(MODEL.replace('"Gate"', quoted)).values() if text[0] == "#"
    )
    assert "## Injected" not in page.splitlines()
    assert not re.search(r"(?<!\\)<script|(?<!\\)\]\(|\u202e", page)
    assert r"# Contract of Plant::\<script>x\</script>[y\](javascript:z)\`\|" in page


def test_an_ordinary_contract_page_has_no_escapes():
    assert not any("\\" in text for text in emit_contracts(MODEL).values() if text[0] == "#")


@pytest.mark.parametrize("text", ["=cmd|' /C calc'!A0", "\n=1+1", " @x", "＝1", "-2+3"])
def test_cells_of_spreadsheets_are_not_formulas(text):
    row = TableRow(Element("r", Kind.CLASS), (Cell((text,)), Cell(("plain",))))
    lines = format_csv(Table("t", "", ("id", "name"), (row,))).partition("\r\n")[2]
    assert lines.lstrip('"').startswith("'")
    assert lines.endswith("plain\r\n")


def test_names_in_plantuml_comments_cannot_end_the_comment():
    comment = plantuml.format_comment("Gate\n@enduml\n!include /etc/passwd /' \u202e\\")
    assert comment == r"Gate @enduml !include /etc/passwd / ' \u202e\ ."
    assert plantuml.format_comment("Gate 'in'") == "Gate 'in'"


@pytest.mark.parametrize(
    ("text", "comment"),
    [
        ("G*\\typedef int q; //", "G*_typedef int q; //"),
        ("a*/b**/c/*d/*/", "a* /b** /c/ *d/ * /"),
        ("a\\\n*/", "a_ * /"),
        ("*\u200b/ \u202e", "*_/ _"),
        ("a\u2028b\x85c\x1ed", "a b c d"),
        ("*??/\n/", "*? ?/ /"),
        ('"""', "___"),
        ("Förder*band / 装置 - 'x' -- #}", "Förder*band / 装置 - 'x' -- #}"),
    ],
)
def test_names_in_comments_of_programs_cannot_end_or_extend_the_comment(text, comment):
    assert format_comment(text) == comment


def test_long_names_in_comments_are_cut():
    assert format_comment("ab" * 9, width=5) == "ababa..."


def test_names_in_tlsf_titles_cannot_end_the_quotes():
    contract = Contract('a"\n}\\b', "x", (), (), ())
    title = next(line for line in write(contract, "tlsf").splitlines() if "TITLE" in line)
    assert title.count('"') == 2
    assert "}" in title
