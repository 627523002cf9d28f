"""2,500 nasty names stay inside comments, strings, identifiers and cells of all outputs."""

import ast
import csv
import io
import json
import re
import shutil
import subprocess
from collections import Counter

import pytest
from lxml import etree
from nasty_names import build_model, draw_names

from backend_runs import emit
from long_runs import quick_first
from refinement import run_all
from sysmlc.diagnostics import Sink
from sysmlc.driver.registry import list_backend_names, load_backends
from sysmlc.ir.text import parse_text
from sysmlc.language.text import parse
from sysmlc.logic import formats
from sysmlc.support.escapes import escape_invisible

BATCHES = 9
NAMES_OF_A_BATCH = 288
C_MODES = ("gcc -std=c99 -Wpedantic", "gcc -std=gnu17", "g++ -x c++")


def emit_batch(batch):
    """Return the graph of a model with new names, and the outputs of all back ends by path."""
    graph, artefacts = parse_text(build_model(draw_names(NAMES_OF_A_BATCH, batch))), {}
    run_all(graph, Sink())
    for backend in load_backends(list_backend_names()):
        artefacts |= emit(backend, graph)[0]
    return graph, artefacts


@pytest.mark.parametrize("batch", quick_first(range(BATCHES), BATCHES // 6))
def test_names_stay_where_they_belong(tmp_path, batch):
    _, artefacts = emit_batch(batch)
    for path, artefact in artefacts.items():
        for ending, check in CHECKS.items():
            if path.endswith(ending):
                check(artefact)
        (tmp_path / path).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / path).write_bytes(artefact.text.encode())
    monitors = sorted(tmp_path.glob("monitors/*.c"))
    assert len(monitors) >= NAMES_OF_A_BATCH // 12
    check_c(monitors)
    check_promela(sorted(tmp_path.glob("contracts/*.pml")))


@pytest.mark.long
@pytest.mark.plantuml
@pytest.mark.parametrize("batch", range(2))
def test_plantuml_draws_the_diagrams_of_nasty_names(plantuml, batch):
    _, artefacts = emit_batch(batch)
    texts = {path: item.text for path, item in artefacts.items() if path.endswith(".puml")}
    numbered = {str(number): text for number, text in enumerate(texts.values())}
    assert len(plantuml.render(numbered)) == len(texts)


# -- programs --------------------------------------------------------------------------------------


def check_c(sources):
    """Compile monitors: a name that leaves its place is an error or an unused declaration."""
    for mode in C_MODES:
        compiler, *flags = mode.split()
        if shutil.which(compiler):
            warnings = ["-Wall", "-Wno-overlength-strings", "-Werror", "-fsyntax-only"]
            subprocess.run([compiler, *flags, *warnings, *map(str, sources)], check=True)


def check_python(artefact):
    """Run a monitor: it defines the same names as any other."""
    names = {}
    exec(compile(artefact.text, artefact.path, "exec"), names)
    assert names.keys() - {"divide", "__builtins__"} == {
        *("__doc__", "VARIABLES", "CHECKS", "Monitor", "_find_broken")
    }
    names["Monitor"]().observe(dict.fromkeys(names["VARIABLES"], False))
    assert "\n" not in names["__doc__"]
    comments = [line for line in artefact.text.splitlines() if line.startswith("#")]
    assert len(artefact.text.splitlines()) >= ast.parse(artefact.text).body[-1].end_lineno
    assert all(comment.startswith(("# Not monitored", "# - ")) for comment in comments)


def check_promela(paths):
    if shutil.which("spin"):
        for path in paths:
            command = ["spin", "-a", path.name]
            result = subprocess.run(command, cwd=path.parent, capture_output=True, text=True)
            assert (result.returncode, "error" in result.stdout) == (0, False), result.stdout


# -- contracts and models --------------------------------------------------------------------------


def check_contract(artefact):
    sink = Sink()
    (contract,) = formats.read(artefact.text, artefact.path, sink)
    assert not any(diagnostic.is_error for diagnostic in sink)
    assert contract.guarantees


def check_sysml(artefact):
    sink = Sink()
    parse(artefact.text, artefact.path, "sysml", sink)
    assert list(sink) == []


# -- texts for people ------------------------------------------------------------------------------


MARKDOWN = {
    *("heading_open", "heading_close", "paragraph_open", "paragraph_close", "inline", "text"),
    *("bullet_list_open", "bullet_list_close", "list_item_open", "list_item_close", "softbreak"),
    *("table_open", "table_close", "thead_open", "thead_close", "tbody_open", "tbody_close"),
    *("tr_open", "tr_close", "th_open", "th_close", "td_open", "td_close", "code_inline"),
    *("em_open", "em_close", "strong_open", "strong_close", "html_block", "html_inline"),
}
"""What the templates write: no links, pictures, quotations and blocks of code."""
HTML = re.compile(r"<br>|</?details>|<details>\n<summary>[\w ,]*</summary>")


def check_markdown(artefact):
    """Parse a page: it has no more markup than the template, and shows the name as it is."""
    markdown_it = pytest.importorskip("markdown_it")
    parser = markdown_it.MarkdownIt("commonmark").enable(["table", "strikethrough"])
    blocks = parser.parse(artefact.text)
    tokens = [token for block in blocks for token in (block, *(block.children or ()))]
    kinds = Counter(token.type for token in tokens)
    lines = artefact.text.splitlines()
    assert kinds.keys() <= MARKDOWN
    for token in tokens:
        assert not token.type.startswith("html") or HTML.fullmatch(token.content.strip())
    assert kinds["heading_open"] == sum(line.startswith("#") for line in lines)
    assert kinds["strong_open"] == sum(line.startswith("**") for line in lines)
    assert len({count_cells(line) for line in lines if line.startswith("|")}) <= 2
    title = "".join(token.content for token in blocks[1].children)
    name = escape_invisible(" ".join(artefact.name.split()))
    assert title.partition(" of ")[2].strip() == name
    assert artefact.text == escape_invisible(artefact.text, "\n")


def count_cells(row):
    return len(re.findall(r"(?<!\\)(?:\\\\)*\|", row))


def check_csv(artefact):
    header, *rows = csv.reader(io.StringIO(artefact.text, newline=""))
    assert {len(row) for row in rows} == {len(header)}
    assert not any(cell.startswith(("=", "+", "-", "@")) for row in rows for cell in row)


def check_plantuml(artefact):
    first, *lines, last = artefact.text.rstrip("\n").split("\n")
    assert (first, last) == ("@startuml", "@enduml")
    assert not any(line.lstrip().startswith(("@", "!include", "!define")) for line in lines)
    assert len(artefact.text.splitlines()) == len(lines) + 2


FORMATS = (".slugsin", ".structuredslugs", ".smv", ".tlsf", ".spc", ".chase.ltl", ".spin.ltl")
XML = (".aml", ".uml", ".xmi", ".sysmlx")
CHECKS = {
    ".py": check_python,
    ".sysml": check_sysml,
    ".md": check_markdown,
    ".csv": check_csv,
    ".puml": check_plantuml,
    ".json": lambda artefact: json.loads(artefact.text),
    ".ir": lambda artefact: parse_text(artefact.text),
    **dict.fromkeys(FORMATS, check_contract),
    **dict.fromkeys(XML, lambda artefact: etree.fromstring(artefact.text.encode())),
}
