"""``sysmlc diff``: forms, exit codes, and models of several formats."""

import json
from random import Random

import jsonschema
import pytest

from dialects.random_models import random_model
from sysmlc.driver import registry
from sysmlc.support import resources

SCHEMA = json.loads(resources.read_text("metamodels", "sysmlc-diff.schema.json"))

OLD = """\
<CAEXFile SchemaVersion="2.15" FileName="plant.aml">
  <InstanceHierarchy Name="Plant">
    <InternalElement Name="Gate" ID="gate" RefBaseSystemUnitPath="Lib/Gate"/>
  </InstanceHierarchy>
  <InterfaceClassLib Name="Interfaces"><InterfaceClass Name="Port"/></InterfaceClassLib>
  <SystemUnitClassLib Name="Lib">
    <SystemUnitClass Name="Stopper">
      <Attribute Name="speed" AttributeDataType="xs:double"><Value>1.5</Value></Attribute>
      <ExternalInterface Name="in" ID="e3" RefBaseClassPath="Interfaces/Port"/>
    </SystemUnitClass>
    <SystemUnitClass Name="SmartStopper" RefBaseClassPath="Lib/Stopper"/>
    <SystemUnitClass Name="Gate">
      <ExternalInterface Name="p_in" ID="e1" RefBaseClassPath="Interfaces/Port"/>
      <ExternalInterface Name="p_out" ID="e2" RefBaseClassPath="Interfaces/Port"/>
      <InternalElement Name="st" ID="st" RefBaseSystemUnitPath="Lib/Stopper"/>
      <InternalLink Name="link" RefPartnerSideA="e1" RefPartnerSideB="st:in"/>
    </SystemUnitClass>
  </SystemUnitClassLib>
</CAEXFile>
"""
NEW = (
    OLD.replace("p_out", "outfeed")
    .replace("<Value>1.5</Value>", "<Value>2</Value>")
    .replace(
        'ID="st" RefBaseSystemUnitPath="Lib/Stopper"',
        'ID="s2" RefBaseSystemUnitPath="Lib/SmartStopper"',
    )
    .replace('"e1" RefPartnerSideB="st:in"', '"e2" RefPartnerSideB="s2:in"')
    .replace(
        '      <ExternalInterface Name="p_in"',
        '      <Attribute Name="width|mm"/>\n      <ExternalInterface Name="p_in"',
    )
)


TEXT = """\
Lib::Gate
  ~ connector link: rewired, ends: p_in -- st.in => outfeed -- st.in
  ~ port outfeed: renamed, was p_out
  ~ part st: retyped, type: Stopper => SmartStopper
  + value width|mm: added

Lib::Stopper
  ~ value speed: default: 1.5 => 2.0

1 added, 1 renamed, 1 retyped, 1 rewired, 1 changed
"""
MARKDOWN = """\
**1 added, 1 renamed, 1 retyped, 1 rewired, 1 changed**

#### `Lib::Gate`

| | element | change | before | after |
|---|---|---|---|---|
| `~` | connector `link` | rewired: ends | `p_in -- st.in` | `outfeed -- st.in` |
| `~` | port `outfeed` | renamed | `p_out` | `outfeed` |
| `~` | part `st` | retyped: type | `Stopper` | `SmartStopper` |
| `+` | value `width\\|mm` | added |  |  |

#### `Lib::Stopper`

| | element | change | before | after |
|---|---|---|---|---|
| `~` | value `speed` | changed: default | `1.5` | `2.0` |
"""
REAL_PASSES = registry.load_passes


@pytest.fixture
def plants(here, monkeypatch):
    monkeypatch.setattr(registry, "load_passes", REAL_PASSES)
    here.write("old.aml", OLD)
    here.write("new.aml", NEW)
    return here


def test_equal_models_are_0(plants):
    done = plants.sysmlc("diff", "old.aml", "old.aml")
    assert (done.exit_code, done.stdout, done.stderr) == (0, "no differences\n", "")


def test_differences_are_1_and_stand_below_their_owners(plants):
    done = plants.sysmlc("diff", "old.aml", "new.aml")
    assert done.exit_code == 1
    assert done.stdout == TEXT


def test_the_documentation_shows_what_is_printed(plants):
    page = (resources.find_root() / "docs" / "compare-two-models.md").read_text("utf-8")
    assert indented(TEXT) in page


def indented(text):
    return "".join(f"    {line}\n" if line else "\n" for line in text.splitlines())


@pytest.mark.parametrize(
    ("word", "found"),
    [
        ("defualt", "'defualt': did you mean 'default'?"),
        ("colour", "'colour': these models have no such attribute"),
    ],
)
def test_a_word_that_nothing_is_called_cannot_be_ignored(plants, word, found):
    done = plants.sysmlc("diff", "old.aml", "new.aml", "--ignore", f"id,{word}")
    assert done.exit_code == 2
    assert f"Error: Invalid value for '--ignore': {found}" in done.stderr


WORDS = ["id", "default", "default_value", "unit", "typed-by", "Comment", "id,source,trace"]


@pytest.mark.parametrize("word", WORDS)
def test_what_a_model_may_say_can_be_ignored(plants, word):
    assert plants.sysmlc("diff", "old.aml", "old.aml", "--ignore", word).exit_code == 0


UNITS = """\
Lib::C
  ~ value plain: unit: m => mm
  ~ value typed: unit: m => mm

Types
  ~ value type L: unit: m => mm

3 changed
"""


def test_another_unit_is_told_once(plants):
    """And not as another type and another quantity, too; nothing of it counts when ignored."""
    body = (
        '<CAEXFile SchemaVersion="3.0" FileName="p.aml"><SystemUnitClassLib Name="Lib">'
        '<SystemUnitClass Name="C"><Attribute Name="plain" AttributeDataType="xs:double" Unit="m"/>'
        '<Attribute Name="typed" RefAttributeType="Types/L" Unit="m"/></SystemUnitClass>'
        '</SystemUnitClassLib><AttributeTypeLib Name="Types">'
        '<AttributeType Name="L" AttributeDataType="xs:double" Unit="m"/></AttributeTypeLib>'
        "</CAEXFile>"
    )
    plants.folder.joinpath("m.aml").write_text(body)
    plants.folder.joinpath("mm.aml").write_text(body.replace('"m"', '"mm"'))
    assert plants.sysmlc("diff", "m.aml", "mm.aml").stdout == UNITS
    assert plants.sysmlc("diff", "m.aml", "mm.aml", "--ignore", "unit").exit_code == 0


def test_another_type_with_another_unit_is_told_too(plants):
    body = (
        '<CAEXFile SchemaVersion="3.0" FileName="p.aml"><SystemUnitClassLib Name="Lib">'
        '<SystemUnitClass Name="C"><Attribute Name="v" AttributeDataType="xs:double" Unit="m"/>'
        "</SystemUnitClass></SystemUnitClassLib></CAEXFile>"
    )
    plants.folder.joinpath("m.aml").write_text(body)
    changed = body.replace('"m"', '"kg"').replace("xs:double", "xs:int")
    plants.folder.joinpath("kg.aml").write_text(changed)
    told = plants.sysmlc("diff", "m.aml", "kg.aml").stdout
    assert "  ~ value v: unit: m => kg\n" in told
    assert "  ~ value v: retyped, type: length[m] => Integer mass[kg]\n" in told


def test_markdown_is_a_table_for_each_owner(plants):
    done = plants.sysmlc("diff", "old.aml", "new.aml", "--format", "markdown")
    assert done.stdout == MARKDOWN


def test_names_with_the_signs_of_markdown_are_shown_as_they_are(here):
    """In a heading a bar is a bar; a fence is longer than what it holds (CommonMark 6.1)."""
    here.write("a.ir", 'Package p "P|q``"\n  Class c "C|d"\n')
    here.write("b.ir", 'Package p "P|q``"\n')
    done = here.sysmlc("diff", "a.ir", "b.ir", "--format", "markdown").stdout
    assert "\n#### ``` P|q`` ```\n" in done
    assert "\n| `-` | class `C\\|d` | removed |  |  |\n" in done


V2 = """\
package Plant {
  part def Motor { port p; attribute speed = 1.5; }
  part def Servo :> Motor;
  part def Belt;
  part def Gate {
    part m : Motor;
    port q;
    port r;
    connection c connect q to m.p;
  }
}
"""
V2_NEW = (
    V2.replace("part def Belt", "item def Pallet;\n  part def Conveyor")
    .replace("m : Motor", "m : Servo")
    .replace("connect q", "connect r")
    .replace(" attribute speed = 1.5;", "")
)
V2_TOLD = """\
Plant
  ~ block Conveyor: renamed, was Belt
  + signal Pallet: added

Plant::Gate
  ~ connector c: rewired, ends: q -- m.p => r -- m.p
  ~ property m: retyped, type: Motor => Servo

Plant::Motor
  - property speed: removed

1 added, 1 removed, 1 renamed, 1 retyped, 1 rewired
"""


def test_texts_of_v2_and_the_xmi_made_of_them_differ_alike(plants):
    """Renamed, retyped, rewired ..., whether ids come from names (v2) or are kept (XMI)."""
    plants.write("old.sysml", V2)
    plants.write("new.sysml", V2_NEW)
    for name in ("old", "new"):
        assert plants.sysmlc(f"{name}.sysml", "-o", name, "--emit", "uml").exit_code == 0
    assert plants.sysmlc("diff", "old.sysml", "new.sysml").stdout == V2_TOLD
    assert plants.sysmlc("diff", "old/uml/old.uml", "new/uml/new.uml").stdout == V2_TOLD


def test_json_has_a_schema_and_the_places_of_both(plants):
    done = plants.sysmlc("diff", "old.aml", "new.aml", "--format", "json")
    made = json.loads(done.stdout)
    jsonschema.validate(made, SCHEMA)
    assert made["summary"]["renamed"] == 1
    renamed = next(c for o in made["owners"] for c in o["changes"] if c["what"] == "renamed")
    assert renamed["new"] == {
        "id": "e2",
        "qualified_name": "Lib::Gate::outfeed",
        "file": "new.aml",
        "line": 15,
        "column": 7,
    }
    assert (renamed["old"]["file"], renamed["old"]["qualified_name"]) == (
        "old.aml",
        "Lib::Gate::p_out",
    )


def test_json_of_equal_models_fits_the_schema_too(plants):
    made = json.loads(plants.sysmlc("diff", "old.aml", "old.aml", "--format", "json").stdout)
    jsonschema.validate(made, SCHEMA)
    assert made["owners"] == []


def test_a_model_that_cannot_be_read_is_2(here):
    here.write("bad.ir", "Klass x\n")
    done = here.sysmlc("diff", "plant.ir", "bad.ir")
    assert (done.exit_code, done.stdout) == (2, "")
    assert "bad.ir" in done.stderr
    assert here.sysmlc("diff", "plant.ir", "missing.ir").exit_code == 2


def test_what_is_wrong_inside_a_model_is_no_hindrance(plants):
    plants.write("dangling.aml", NEW.replace('RefPartnerSideA="e2"', 'RefPartnerSideA="gone"'))
    done = plants.sysmlc("diff", "new.aml", "dangling.aml")
    assert (done.exit_code, done.stderr) == (1, "")
    assert "dependency link: retyped, kind: Connector => Dependency" in done.stdout


def test_a_plant_that_is_saved_in_another_format_is_the_same_plant(plants):
    done = plants.sysmlc("new.aml", "-o", "saved", "--emit", "uml,aml")
    assert done.exit_code == 0
    for other in ("saved/uml/new.uml", "saved/aml/new.aml"):
        assert plants.sysmlc("diff", "new.aml", other).stdout == "no differences\n"


def test_overlays_count_when_both_have_one(plants):
    overlay = "overlay: 1\nblocks:\n  Lib/Gate:\n    operations:\n      readId:\n"
    plants.write("old.overlay.yaml", overlay)
    plants.write("same.aml", OLD)
    assert plants.sysmlc("diff", "old.aml", "same.aml").exit_code == 0
    plants.write("same.overlay.yaml", overlay.replace("readId", "getInPallet"))
    done = plants.sysmlc("diff", "old.aml", "same.aml")
    assert done.stdout == (
        "Lib::Gate\n  + operation getInPallet: added\n  - operation readId: removed\n"
        "\n1 added, 1 removed\n"
    )


def test_colours_on_a_terminal_only(plants, monkeypatch):
    plain = plants.sysmlc("diff", "old.aml", "new.aml").stdout
    monkeypatch.setattr("sysmlc.cli.reports.has_color", lambda stream: True)
    coloured = plants.sysmlc("diff", "old.aml", "new.aml").stdout
    assert "\x1b[" not in plain
    assert "\x1b[32m+ value width|mm: added\x1b[0m" in coloured


def test_long_texts_show_what_differs(here):
    body = "x" * 300
    here.write("a.ir", f'Class c "C" body="{body}y{body}"\n')
    here.write("b.ir", f'Class c "C" body="{body}z{body}"\n')
    line = here.sysmlc("diff", "a.ir", "b.ir").stdout.splitlines()[1]
    cut = "..." + "x" * 40
    assert line.startswith(f"  ~ class C: body: {cut}y")
    assert f"=> {cut}z" in line


def test_folders_and_other_formats_are_compared_too(plants):
    model = random_model(Random(3)).decode()
    plants.write("old/plant.uml", model)
    plants.write("new/plant.uml", model.replace('name="Random plant"', 'name="Plant"'))
    done = plants.sysmlc("diff", "old", "new")
    assert (done.exit_code, done.stdout) == (
        1,
        "(model)\n  ~ package Plant: renamed, was Random plant\n\n1 renamed\n",
    )


def test_the_comparison_does_not_depend_on_what_else_is_refined(here, monkeypatch):
    """Only what completes the model runs: the pass of these tests finds fault with the port."""
    here.write("faulty.ir", here.read("plant.ir").replace('gate.in "in"', "gate.in"))
    done = here.sysmlc("diff", "plant.ir", "faulty.ir")
    assert (done.exit_code, done.stderr) == (1, "")
