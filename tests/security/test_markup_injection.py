"""Names of a model are text in Markdown, spreadsheets and PlantUML, never markup or directives."""

import re

import pytest

from machine_samples import arrow, machine
from sysmlc.backends.base import EmitOptions
from sysmlc.backends.contracts import BACKEND
from sysmlc.backends.reqtable.backend import format_csv
from sysmlc.backends.reqtable.table import Cell, Table
from sysmlc.backends.reqtable.table import Row as TableRow
from sysmlc.diagnostics import Sink
from sysmlc.ir import Element, Kind
from sysmlc.ir.text import parse_text
from sysmlc.logic.formats import write
from sysmlc.passes import pipeline
from sysmlc.support import plantuml_text as plantuml
from sysmlc.support.escapes import escape_code, escape_markdown
from sysmlc.support.output import Output

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
        ("1. a", r"1\. a"),
        ("1.5 mm", "1.5 mm"),
        ("> a", r"\> a"),
        ("- a", r"\- a"),
        ("a\n\n## b", "a ## b"),
        ("a\u202eb", r"a\\u202eb"),
        ("Gate 'in'", "Gate 'in'"),
    ],
)
def test_markdown_shows_text_as_it_is(text, escaped):
    assert escape_markdown(text) == escaped


def test_code_spans_hold_no_backtick():
    assert escape_code("a`b|c\nd") == r"a\x60b|c d"
    assert escape_code("a|b", in_table=True) == r"a\|b"


def emit(text):
    graph, output = parse_text(text), Output()
    pipeline.run(graph, Sink())
    BACKEND.emit(graph, output, Sink(), EmitOptions())
    return {one.path.partition(".")[2][-7:]: one.text for one in output.artefacts()}


def test_a_contract_page_has_only_our_markup():
    quoted = '"' + HOSTILE.replace("\n", "\\n") + '"'
    page = next(t for t in emit(MODEL.replace('"Gate"', quoted)).values() if t[0] == "#")
    assert "## Injected" not in page.splitlines()
    assert not re.search(r"(?<!\\)<script|(?<!\\)\]\(|\u202e", page)
    assert r"# Contract of Plant::\<script>x\</script>[y\](javascript:z)\`\|" in page


def test_an_ordinary_contract_page_has_no_escapes():
    assert not any("\\" in text for text in emit(MODEL).values() if text[0] == "#")


@pytest.mark.parametrize("text", ["=cmd|' /C calc'!A0", "\n=1+1", " @x", "＝1", "-2+3"])
def test_cells_of_spreadsheets_are_no_formulas(text):
    row = TableRow(Element("r", Kind.CLASS), (Cell((text,)), Cell(("plain",))))
    lines = format_csv(Table("t", "", ("id", "name"), (row,))).partition("\r\n")[2]
    assert lines.lstrip('"').startswith("'")
    assert lines.endswith("plain\r\n")


def test_comments_of_plantuml_end_with_their_line():
    comment = plantuml.format_comment("Gate\n@enduml\n!include /etc/passwd /' \u202e\\")
    assert comment == r"Gate @enduml !include /etc/passwd / ' \u202e\ ."
    assert plantuml.format_comment("Gate 'in'") == "Gate 'in'"


def test_titles_of_tlsf_stay_in_their_quotes():
    from sysmlc.logic.contract import Contract

    contract = Contract('a"\n}\\b', "x", (), (), ())
    title = next(line for line in write(contract, "tlsf").splitlines() if "TITLE" in line)
    assert title.count('"') == 2
    assert "}" in title
