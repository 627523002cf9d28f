"""Requirement tables in CSV for programs and in Markdown for people."""

import csv
import io

import pytest

from backend_runs import emit
from examples.compiling import ROOT, compile_example, outputs
from refinement import run_all
from rule_examples import read_graphs
from sysmlc.backends.base import EmitOptions
from sysmlc.backends.reqtable import (
    BACKEND,
    BAD_TEMPLATE,
    UNSATISFIED,
    UNVERIFIED,
    format_markdown_cell,
)
from sysmlc.backends.reqtable.table import Cell
from sysmlc.diagnostics import Sink
from sysmlc.ir.text import parse_text

SYSML = "http://www.omg.org/spec/SysML/20150709/SysML"
MAGICDRAW = "http://www.magicdraw.com/spec/Customization/180/SysML"
PLANT = "http://example.org/plant"


def write_requirement(name, tags, stereotype="Requirement", namespace=SYSML):
    id = name.lower().replace(" ", "")
    return (
        f'  Class {id} "{name}"\n'
        f'    Application {id}.a stereotype="{stereotype}" namespace="{namespace}" {tags}\n'
        f"      -> subject {id}\n"
    )


def write_relation(stereotype, client, supplier):
    id = f"{stereotype}.{client}.{supplier}"
    return (
        f'  Dependency {id} subkind="abstraction"\n    -> client {client}\n'
        f'    -> supplier {supplier}\n    Application {id}.a stereotype="{stereotype}" '
        f'namespace="{SYSML}"\n      -> subject {id}\n'
    )


def emit_tables(text, templates=None):
    """Return the texts of the tables by path, and the diagnostics of the back end."""
    graph = parse_text(text)
    run_all(graph, Sink(), verify_each=True)
    artefacts, diagnostics = emit(BACKEND, graph, EmitOptions(templates))
    return {path: artefact.text for path, artefact in artefacts.items()}, diagnostics


def read_rows(text, name="Plant"):
    """Return the rows of a table in CSV by the name of the requirement."""
    files, _ = emit_tables(text)
    rows = list(csv.DictReader(io.StringIO(files[f"requirements/{name}.requirements.csv"])))
    return {row["name"]: row for row in rows}


PLANT_MODEL = (
    'Package p "Plant"\n'
    + write_requirement("No jam", 'tag.id="R2" tag.text="Pallets never jam."')
    + write_requirement("Quiet", 'tag.Id="R10" tag.Text="At most 60 dB | \\"A\\".\\nBy night 50."')
    + write_requirement(
        "Gentle", 'tag.id="R1" tag.text="=1+2"', "performanceRequirement", MAGICDRAW
    )
    + write_requirement("Copied", 'tag.id="R3" tag.risk="high" tag.DerivedFrom="nojam"')
    + write_relation("DeriveReqt", "quiet", "nojam")
    + write_relation("Satisfy", "gate", "nojam")
    + write_relation("Verify", "test", "quiet")
    + write_relation("Refine", "test", "quiet")
    + write_relation("Trace", "quiet", "gate")
    + write_relation("Copy", "copied", "nojam")
    + '  Class gate "Gate"\n  Activity test "Test jams"\n'
)


def test_one_csv_and_one_markdown_for_each_root_with_requirements():
    root = (
        write_requirement("Else", 'tag.id="E1"').replace("  Class", "Class").replace("\n  ", "\n")
    )
    files, _ = emit_tables(PLANT_MODEL + root + 'Package q "Empty"\n')
    assert list(files) == [
        "requirements/Else.requirements.csv",
        "requirements/Else.requirements.md",
        "requirements/Plant.requirements.csv",
        "requirements/Plant.requirements.md",
    ]


def test_rows_are_in_the_natural_order_of_their_ids():
    assert [row["id"] for row in read_rows(PLANT_MODEL).values()] == ["R1", "R2", "R3", "R10"]


def test_relations_are_read_from_the_requirement():
    requirements = read_rows(PLANT_MODEL)
    assert requirements["Quiet"]["derived from"] == "R2 No jam"
    assert (
        requirements["Quiet"]["verified by"]
        == requirements["Quiet"]["refined by"]
        == "Plant::Test jams"
    )
    assert requirements["Quiet"]["traced to"] == "Plant::Gate"
    assert requirements["No jam"]["satisfied by"] == "Plant::Gate"
    assert requirements["No jam"]["owner"] == "Plant"


def test_a_copy_has_the_text_of_its_master_and_is_not_listed_as_a_trace():
    row = read_rows(PLANT_MODEL)["Copied"]
    assert (row["text"], row["copy of"], row["traced to"]) == (
        "Pallets never jam.",
        "R2 No jam",
        "",
    )


def test_custom_tags_have_columns_and_derived_tags_have_none():
    requirements = read_rows(PLANT_MODEL)
    assert requirements["Copied"]["risk"] == "high"
    assert requirements["Quiet"]["risk"] == ""
    assert "DerivedFrom" not in requirements["Copied"]


def test_tags_that_refer_to_elements_show_their_names():
    text = 'Package p "Plant"\n' + write_requirement(
        "Quiet", 'tag.id="R1" tag.owners=["gate","late"]'
    )
    requirements = read_rows(text + '  Class gate "Gate"\n')
    assert requirements["Quiet"]["owners"] == "Plant::Gate\nlate"


def test_the_kind_is_the_custom_stereotype_with_its_base():
    profile = (
        f'Profile pr "plant" uri="{PLANT}"\n'
        '  Stereotype s "SafetyRequirement"\n    -> specializes f\n'
        f'Profile md "SysML" uri="{MAGICDRAW}"\n'
        '  Stereotype f "functionalRequirement"\n    -> specializes r\n'
        '  Stereotype r "Requirement"\n'
    )
    text = 'Package p "Plant"\n' + write_requirement("Quiet", "", "SafetyRequirement", PLANT)
    requirements = read_rows(text + profile)
    assert requirements["Quiet"]["kind"] == "SafetyRequirement (functionalRequirement)"
    assert read_rows(PLANT_MODEL)["Gentle"]["kind"] == "performanceRequirement"
    assert read_rows(PLANT_MODEL)["No jam"]["kind"] == ""


def test_csv_has_the_line_ends_and_quotes_of_rfc_4180():
    files, _ = emit_tables(PLANT_MODEL)
    text = files["requirements/Plant.requirements.csv"]
    assert text.endswith("\r\n")
    assert '"At most 60 dB | ""A"".\nBy night 50."' in text


@pytest.mark.parametrize("start", ["=", "+", "-", "@", "＝"])
def test_no_cell_of_the_csv_is_a_formula(start):
    text = 'Package p "Plant"\n' + write_requirement("Quiet", f'tag.id="R1" tag.text="{start}1+2"')
    assert read_rows(text)["Quiet"]["text"] == f"'{start}1+2"


@pytest.mark.parametrize(
    ("text", "markdown"),
    [
        ("a | b", "a \\| b"),
        ("<script>", "\\<script>"),
        ("*a* `b` [c](d) [e]", "\\*a\\* \\`b\\` [c\\](d) [e]"),
        ("a &lt; b & c", "a &amp;lt; b & c"),
        ("one\n\n two ", "one<br>two"),
        ("back\\slash", "back\\\\slash"),
    ],
)
def test_markdown_shows_the_text_as_it_is(text, markdown):
    assert format_markdown_cell(Cell((text,))) == markdown


def test_markdown_has_no_column_without_values():
    files, _ = emit_tables('Package p "Plant"\n' + write_requirement("Quiet", 'tag.id="R1"'))
    assert files["requirements/Plant.requirements.md"] == (
        "# Requirements of Plant\n\n"
        "1 requirement; made by sysmlc: change the model, not this file.\n\n"
        "| id | name | owner |\n|---|---|---|\n| R1 | Quiet | Plant |\n"
    )


def test_html_text_of_magicdraw_is_shown_without_its_tags():
    html = (
        "<html><head><style>p {x}</style></head><body><p>Never &lt; 2 <b>bar</b>.</p><p>Ever.</p>"
    )
    text = 'Package p "Plant"\n' + write_requirement("Quiet", f'tag.Id="R1" tag.Text="{html}"')
    assert read_rows(text)["Quiet"]["text"] == "Never < 2 bar.\nEver."


def test_packages_of_the_same_name_have_files_of_their_own():
    first = write_requirement("Quiet", 'tag.id="R1"')
    second = first.replace("quiet", "quiet2")
    files, _ = emit_tables(f'Package p "Plant"\n{first}Package q "Plant"\n{second}')
    assert [path for path in files if path.endswith(".csv")] == [
        "requirements/Plant-2.requirements.csv",
        "requirements/Plant.requirements.csv",
    ]


# -- rules -------------------------------------------------------------------------------------


@pytest.mark.parametrize("rule", [UNSATISFIED, UNVERIFIED], ids=lambda rule: rule.name)
def test_open_requirements_are_reported(rule):
    assert rule in [diagnostic.rule for diagnostic in emit_tables(read_graphs(rule).wrong)[1]]
    assert [diagnostic.rule for diagnostic in emit_tables(read_graphs(rule).right)[1]] == []


def list_open_requirements(text):
    return [(diagnostic.rule.name, diagnostic.subject.name) for diagnostic in emit_tables(text)[1]]


def test_derived_requirements_and_parts_answer_for_their_source_and_their_whole():
    text = (
        'Package p "P"\n'
        '  Class whole "Whole" role="requirement" req_id="1"\n'
        '    Class a "A" role="requirement" req_id="1.1"\n'
        '    Class b "B" role="requirement" req_id="1.2"\n'
        '  Class c "C" role="requirement" req_id="2"\n    -> derives b\n'
        '  Class gate "Gate" role="block"\n    -> satisfies a\n    -> satisfies c\n'
        '  Activity t "T"\n    -> verifies a\n'
    )
    assert list_open_requirements(text) == [
        ("unverified-requirement", "P::Whole"),
        ("unverified-requirement", "P::Whole::B"),
        ("unverified-requirement", "P::C"),
    ]


def test_cyclic_derivations_terminate():
    text = (
        'Class a "A" role="requirement" req_id="1"\n  -> derives b\n'
        'Class b "B" role="requirement" req_id="2"\n  -> derives a\n'
        'Class gate "Gate" role="block"\n  -> satisfies b\n'
        'Activity t "T"\n  -> verifies a\n'
    )
    assert list_open_requirements(text) == []


def test_a_faulty_template_is_reported_and_the_csv_is_written(tmp_path):
    (tmp_path / "requirements.md.j2").write_text(BAD_TEMPLATE.read_page().wrong, encoding="utf-8")
    files, diagnostics = emit_tables(PLANT_MODEL, tmp_path)
    assert [diagnostic.rule for diagnostic in diagnostics if diagnostic.is_error] == [BAD_TEMPLATE]
    assert list(files) == ["requirements/Plant.requirements.csv"]
    (tmp_path / "requirements.md.j2").write_text(BAD_TEMPLATE.read_page().right, encoding="utf-8")
    assert emit_tables(PLANT_MODEL, tmp_path)[0]["requirements/Plant.requirements.md"] == "Plant\n"


def test_the_tables_of_an_example_have_their_golden_texts(golden):
    texts = outputs(compile_example(ROOT / "examples/lego-recipe/lego-recipe.uml", "reqtable"))
    tables = {
        path.rpartition("/")[2]: text for path, text in texts.items() if "requirements/" in path
    }
    golden.check("reqtable/lego", tables)
