"""``sysmlc coverage``: the verdict on every element, with locations, reasons and shares."""

import json
import re

import pytest
from jsonschema import Draft202012Validator

from sysmlc.diagnostics.coverage import compute_covered_permille, compute_permille
from sysmlc.diagnostics.coverage_report import FileReport
from sysmlc.diagnostics.renderers import coverage
from sysmlc.driver import Request
from sysmlc.driver.coverage import measure_coverage
from sysmlc.support import resources

PLANT = """\
<xmi:XMI xmlns:xmi="http://www.omg.org/spec/XMI/20131001"
    xmlns:uml="http://www.eclipse.org/uml2/5.0.0/UML" xmlns:B="http://blocks">
  <uml:Model xmi:id="m" name="Plant">
    <eAnnotations source="settings"/>
    <packagedElement xmi:type="uml:Class" xmi:id="gate" name="Gate">
      <ownedAttribute xmi:type="uml:Property" xmi:id="p" name="item">
        <type xmi:type="uml:Class" href="pallets.uml#pallet"/>
      </ownedAttribute>
    </packagedElement>
    <packagedElement xmi:type="uml:Nonsense" xmi:id="n" name="settling">
      <part xmi:id="n2"/>
    </packagedElement>
    <packagedElement xmi:type="uml:Nonsense" xmi:id="n3" name="opening"/>
  </uml:Model>
  <B:Block xmi:id="b" base_Class="gone"/>
</xmi:XMI>
"""
TEXT = """\
55.5 % covered: 5 of 9 elements with a meaning

type           covered  unsupported  approximated  external  mapped  notation  elements
uml:Nonsense     0.0 %            2             -         -       -         -         2
Block            0.0 %            1             -         -       -         -         1
part             0.0 %            1             -         -       -         -         1
uml:Class      100.0 %            -             -         1       1         -         2
Model          100.0 %            -             -         -       1         -         1
XMI            100.0 %            -             -         -       1         -         1
uml:Property   100.0 %            -             -         -       1         -         1
eAnnotations         -            -             -         -       -         1         1
total           55.5 %            4             -         1       4         1        10
per cent                       40.0           0.0      10.0    40.0      10.0     100.0

uml:Nonsense: 2 unsupported, not read [SM111 unsupported-element]
  plant.uml:10:5  Plant::settling, 2 with all that it contains
  plant.uml:13:5  Plant::opening

Block: 1 unsupported, applied to a missing element [SM113 stereotype-without-element]
  plant.uml:15:3  plant.uml

uml:Class: 1 external, stands for an element in no file of the unit [SM160 external-element]
  plant.uml:7:9  Plant::Gate::item
"""


def collapse_blanks(text):
    return [" ".join(line.split()) for line in text.splitlines()]


@pytest.fixture
def plant(workspace):
    workspace.write("plant.uml", PLANT)
    return workspace


def test_types_are_sorted_by_coverage_with_locations_and_rules(plant):
    result = plant.sysmlc("coverage", "plant.uml")
    assert (result.exit_code, result.stderr) == (0, "")
    assert collapse_blanks(result.stdout) == collapse_blanks(TEXT)


def test_columns_are_aligned(plant):
    lines = plant.sysmlc("coverage", "plant.uml").stdout.splitlines()
    table = lines[2 : lines.index("", 3)]
    assert {len(line) for line in table} == {len(table[0])}


def test_colours_are_optional_and_move_no_column(plant):
    files = measure_coverage(Request(inputs=(plant.folder / "plant.uml",))).files
    plain, coloured = coverage.render_text(files), coverage.render_text(files, color=True)
    assert "\x1b" not in plain
    assert "\x1b[31munsupported\x1b[0m" in coloured
    assert re.sub(r"\x1b\[\d+m", "", coloured) == plain


def test_elements_that_are_only_counted_are_shown_as_having_no_place():
    totals = {"mapped": 5, "approximated": 1, "unsupported": 2, "external": 0}
    totals["ignored_notation"] = 4
    file = FileReport("big.xml", totals, {"sysml.Slot": totals}, ())
    last_line = coverage.render_text([file]).splitlines()[-1]
    assert last_line == "big.xml: 3 of these elements without a place"


def test_three_examples_are_shown_unless_all_elements_are_requested(workspace):
    many = "".join(f'<packagedElement xmi:type="uml:Nonsense" name="n{n}"/>' for n in range(5))
    workspace.write("plant.uml", PLANT.replace("</uml:Model>", f"{many}</uml:Model>"))
    shortened = workspace.sysmlc("coverage", "plant.uml").stdout
    assert "  and 4 more\n" in shortened
    assert "Plant::n4" not in shortened
    complete = workspace.sysmlc("coverage", "plant.uml", "--elements").stdout
    assert "Plant::n4" in complete
    assert "more\n" not in complete


def test_json_follows_the_schema_of_coverage_json_and_adds_up(plant):
    content = json.loads(plant.sysmlc("coverage", "plant.uml", "--format", "json").stdout)
    schema = json.loads(resources.read_text("metamodels", "sysmlc-coverage.schema.json"))
    Draft202012Validator.check_schema(schema)
    assert list(Draft202012Validator(schema).iter_errors(content)) == []
    (file,) = content["files"]
    for verdict in ("approximated", "ignored_notation", "unsupported", "external"):
        losses = [loss for loss in file["losses"] if loss["verdict"] == verdict]
        assert (
            sum(loss["elements"] for loss in losses) == file[verdict] == content["total"][verdict]
        )
    assert sum(content["shares"].values()) == 100
    assert file["losses"][2] == {
        "type": "uml:Nonsense",
        "verdict": "unsupported",
        "elements": 2,
        "element": "Plant::settling",
        "line": 10,
        "column": 5,
        "xpath": "/xmi:XMI/uml:Model[1]/packagedElement[2]",
        "code": "SM111",
        "reason": "not read",
    }


UNKNOWN = """<?xml version="1.0" encoding="UTF-8"?>
<xmi:XMI xmi:version="20131001" xmlns:xmi="http://www.omg.org/spec/XMI/20131001"
 xmlns:flows="http://www.eclipse.org/papyrus/sysml/1.6/SysML/PortsAndFlows"
 xmlns:uml="http://www.eclipse.org/uml2/5.0.0/UML">
<uml:Model xmi:id="m" name="M"><packagedElement xmi:type="uml:Class" xmi:id="c" name="C">
<ownedAttribute xmi:id="p" name="p" colour="red"><unit>mm</unit></ownedAttribute>
</packagedElement></uml:Model>
<flows:FlowProperty xmi:id="f" base_Property="p" directon="in"/></xmi:XMI>"""


def test_unknown_attributes_features_and_tags_have_rules_of_their_own_even_when_nested(workspace):
    workspace.write("m.uml", UNKNOWN)
    (file,) = json.loads(workspace.sysmlc("coverage", "m.uml", "--format", "json").stdout)["files"]
    assert [(x["elements"], x["code"], x["element"], x["reason"]) for x in file["losses"]] == [
        (1, "SM124", "M::C::p", "read without 'colour'"),
        (1, "SM123", "M::C::p", "kept as text: no feature of UML has its name"),
        (1, "SM125", "M::C::p::FlowProperty", "SysML has no tag 'directon'"),
    ]


def test_coverage_json_of_a_build_has_the_same_counts(plant):
    plant.sysmlc("plant.uml", "--emit", "graph")
    built = json.loads(plant.read("out/coverage.json"))
    shown = json.loads(plant.sysmlc("coverage", "plant.uml", "--format", "json").stdout)
    for file in shown["files"]:
        del file["losses"], file["covered"]
    del shown["total"]["covered"], shown["types"], shown["shares"]
    assert built == shown


def test_sarif_has_one_result_for_each_lost_element(plant):
    log = json.loads(plant.sysmlc("coverage", "plant.uml", "--format", "sarif").stdout)
    results = log["runs"][0]["results"]
    lines = [r["locations"][0]["physicalLocation"]["region"]["startLine"] for r in results]
    assert lines == [7, 10, 13, 15]
    assert [r["ruleId"] for r in results] == ["SM160", "SM111", "SM111", "SM113"]
    assert results[0]["message"]["text"] == (
        "uml:Class stands for 'pallets.uml#pallet', which is in no file of the unit"
    )
    assert len({r["partialFingerprints"]["sysmlc/v1"] for r in results}) == 4


def test_an_element_in_another_input_is_not_external(plant):
    plant.write(
        "pallets.uml",
        '<uml:Model xmlns:uml="http://www.eclipse.org/uml2/5.0.0/UML"'
        ' xmlns:xmi="http://www.omg.org/spec/XMI/20131001" xmi:id="m2" name="Pallets">'
        '<packagedElement xmi:type="uml:Class" xmi:id="pallet" name="Pallet"/></uml:Model>',
    )
    (plant.folder / "alone").mkdir()
    plant.write("alone/plant.uml", PLANT)
    assert "SM160" in plant.sysmlc("coverage", "alone/plant.uml").stdout
    assert "SM160" not in plant.sysmlc("coverage", "plant.uml", "pallets.uml").stdout


@pytest.mark.parametrize(("limit", "code"), [("55.5", 0), ("55.6", 1), ("0", 0), ("100", 1)])
def test_too_little_coverage_is_exit_code_1(plant, limit, code):
    assert plant.sysmlc("coverage", "plant.uml", "--fail-under", limit).exit_code == code


def test_an_impossible_limit_is_refused(plant):
    assert plant.sysmlc("coverage", "plant.uml", "--fail-under", "101").exit_code == 2


def test_several_files_are_listed_and_none_counts_twice(plant):
    plant.write("good.uml", '<uml:Model xmlns:uml="http://www.eclipse.org/uml2/5.0.0/UML"/>')
    lines = plant.sysmlc("coverage", "plant.uml", "good.uml").stdout.splitlines()
    assert lines[0] == "60.0 % covered: 6 of 10 elements with a meaning"
    assert [line.split()[0] for line in lines[2:6]] == ["file", "plant.uml", "good.uml", "total"]


def test_a_long_name_leaves_room_for_the_numbers(plant):
    plant.write("good.uml", '<uml:Model xmlns:uml="http://www.eclipse.org/uml2/5.0.0/UML"/>')
    plant.write(f"a{'x' * 90}.uml", PLANT)
    result = plant.sysmlc("coverage", "good.uml", f"a{'x' * 90}.uml")
    assert result.stdout.splitlines()[3].startswith(f"a{'x' * 40}...{'x' * 16}.uml  ")


def test_a_damaged_file_is_reported_and_exit_code_1(plant):
    plant.write("bad.uml", PLANT[:400])
    result = plant.sysmlc("coverage", "plant.uml", "bad.uml", "--format", "json")
    assert result.exit_code == 1
    assert [file["file"] for file in json.loads(result.stdout)["files"]] == ["plant.uml"]
    assert "error[SM100 malformed-file]" in result.stderr


def test_a_missing_file_is_exit_code_2(workspace):
    result = workspace.sysmlc("coverage", "nix.uml")
    assert (result.exit_code, result.stdout) == (2, "")
    assert "SM170" in result.stderr


def test_a_folder_without_models_has_no_table(workspace):
    (workspace.folder / "empty").mkdir()
    result = workspace.sysmlc("coverage", "empty")
    assert (result.exit_code, result.stdout) == (1, "")
    assert "SM173" in result.stderr


def test_control_characters_of_names_do_not_reach_the_terminal(workspace):
    workspace.write("plant.uml", PLANT.replace('name="settling"', 'name="&#x9b;2J"'))
    assert "\x9b" not in workspace.sysmlc("coverage", "plant.uml").stdout


@pytest.mark.parametrize(
    "counts", [{"a": 1, "b": 1, "c": 1}, {"a": 0, "b": 0}, {"a": 999, "b": 1, "c": 1000}]
)
def test_shares_add_up(counts):
    assert sum(compute_permille(counts).values()) == (1000 if sum(counts.values()) else 0)


def test_a_small_loss_is_not_rounded_to_full_coverage():
    counts = {"mapped": 999_999, "approximated": 0, "unsupported": 1, "external": 0}
    assert compute_covered_permille(counts) == 999
    assert compute_covered_permille({"ignored_notation": 7}) == 1000
