"""``sysmlc diff``: output formats, exit codes, models in several languages."""

import json
from random import Random

import jsonschema
import pytest

from dialects.random_models import random_model
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


DIFFERENCES = """\
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


@pytest.fixture
def plants(workspace, all_passes):
    workspace.write("old.aml", OLD)
    workspace.write("new.aml", NEW)
    return workspace


def test_equal_models_are_exit_code_0(plants):
    result = plants.sysmlc("diff", "old.aml", "old.aml")
    assert (result.exit_code, result.stdout, result.stderr) == (0, "no differences\n", "")


def test_differences_are_exit_code_1_and_grouped_by_owner(plants):
    result = plants.sysmlc("diff", "old.aml", "new.aml")
    assert result.exit_code == 1
    assert result.stdout == DIFFERENCES


def test_the_documentation_shows_the_printed_differences(plants):
    page = (resources.find_root() / "docs" / "compare-two-models.md").read_text("utf-8")
    assert indent(DIFFERENCES) in page


def indent(text):
    return "".join(f"    {line}\n" if line else "\n" for line in text.splitlines())


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("defualt", "'defualt': did you mean 'default'?"),
        ("colour", "'colour': these models have no such attribute"),
    ],
)
def test_an_unknown_attribute_cannot_be_ignored(plants, name, message):
    result = plants.sysmlc("diff", "old.aml", "new.aml", "--ignore", f"id,{name}")
    assert result.exit_code == 2
    assert f"Error: Invalid value for '--ignore': {message}" in result.stderr


IGNORABLE_NAMES = [
    "id",
    "default",
    "default_value",
    "unit",
    "typed-by",
    "Comment",
    "id,source,trace",
]


@pytest.mark.parametrize("name", IGNORABLE_NAMES)
def test_attributes_relations_and_kinds_can_be_ignored(plants, name):
    assert plants.sysmlc("diff", "old.aml", "old.aml", "--ignore", name).exit_code == 0


UNITS = """\
Lib::C
  ~ value plain: unit: m => mm
  ~ value typed: unit: m => mm

Types
  ~ value type L: unit: m => mm

3 changed
"""


def test_a_changed_unit_is_one_difference(plants):
    """Type and quantity follow from the unit, so they are no differences of their own."""
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


def test_a_changed_type_is_a_difference_beside_the_changed_unit(plants):
    body = (
        '<CAEXFile SchemaVersion="3.0" FileName="p.aml"><SystemUnitClassLib Name="Lib">'
        '<SystemUnitClass Name="C"><Attribute Name="v" AttributeDataType="xs:double" Unit="m"/>'
        "</SystemUnitClass></SystemUnitClassLib></CAEXFile>"
    )
    plants.folder.joinpath("m.aml").write_text(body)
    changed_body = body.replace('"m"', '"kg"').replace("xs:double", "xs:int")
    plants.folder.joinpath("kg.aml").write_text(changed_body)
    output = plants.sysmlc("diff", "m.aml", "kg.aml").stdout
    assert "  ~ value v: unit: m => kg\n" in output
    assert "  ~ value v: retyped, type: length[m] => Integer mass[kg]\n" in output


def test_markdown_is_a_table_for_each_owner(plants):
    result = plants.sysmlc("diff", "old.aml", "new.aml", "--format", "markdown")
    assert result.stdout == MARKDOWN


def test_names_with_markdown_characters_are_quoted(workspace):
    """A heading needs no escaped bar; a code fence is longer than its content (CommonMark 6.1)."""
    workspace.write("a.ir", 'Package p "P|q``"\n  Class c "C|d"\n')
    workspace.write("b.ir", 'Package p "P|q``"\n')
    result = workspace.sysmlc("diff", "a.ir", "b.ir", "--format", "markdown").stdout
    assert "\n#### ``` P|q`` ```\n" in result
    assert "\n| `-` | class `C\\|d` | removed |  |  |\n" in result


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
V2_DIFFERENCES = """\
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


def test_v2_texts_and_the_xmi_compiled_from_them_have_the_same_differences(plants):
    """Ids are derived from names in v2 and stored in XMI; the comparison depends on neither."""
    plants.write("old.sysml", V2)
    plants.write("new.sysml", V2_NEW)
    for name in ("old", "new"):
        assert plants.sysmlc(f"{name}.sysml", "-o", name, "--emit", "uml").exit_code == 0
    assert plants.sysmlc("diff", "old.sysml", "new.sysml").stdout == V2_DIFFERENCES
    assert plants.sysmlc("diff", "old/uml/old.uml", "new/uml/new.uml").stdout == V2_DIFFERENCES


def test_json_follows_its_schema_and_has_the_locations_in_both_models(plants):
    result = plants.sysmlc("diff", "old.aml", "new.aml", "--format", "json")
    document = json.loads(result.stdout)
    jsonschema.validate(document, SCHEMA)
    assert document["summary"]["renamed"] == 1
    renamed = next(
        change
        for owner in document["owners"]
        for change in owner["changes"]
        if change["what"] == "renamed"
    )
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


def test_json_of_equal_models_follows_the_schema_too(plants):
    document = json.loads(plants.sysmlc("diff", "old.aml", "old.aml", "--format", "json").stdout)
    jsonschema.validate(document, SCHEMA)
    assert document["owners"] == []


def test_a_model_that_cannot_be_read_is_exit_code_2(workspace):
    workspace.write("bad.ir", "Klass x\n")
    result = workspace.sysmlc("diff", "plant.ir", "bad.ir")
    assert (result.exit_code, result.stdout) == (2, "")
    assert "bad.ir" in result.stderr
    assert workspace.sysmlc("diff", "plant.ir", "missing.ir").exit_code == 2


def test_models_with_errors_can_be_compared(plants):
    plants.write("dangling.aml", NEW.replace('RefPartnerSideA="e2"', 'RefPartnerSideA="gone"'))
    result = plants.sysmlc("diff", "new.aml", "dangling.aml")
    assert (result.exit_code, result.stderr) == (1, "")
    assert "dependency link: retyped, kind: Connector => Dependency" in result.stdout


def test_a_model_saved_in_another_format_has_no_differences(plants):
    result = plants.sysmlc("new.aml", "-o", "saved", "--emit", "uml,aml")
    assert result.exit_code == 0
    for saved in ("saved/uml/new.uml", "saved/aml/new.aml"):
        assert plants.sysmlc("diff", "new.aml", saved).stdout == "no differences\n"


def test_overlays_are_compared_too(plants):
    overlay = "overlay: 1\nblocks:\n  Lib/Gate:\n    operations:\n      readId:\n"
    plants.write("old.overlay.yaml", overlay)
    plants.write("same.aml", OLD)
    assert plants.sysmlc("diff", "old.aml", "same.aml").exit_code == 0
    plants.write("same.overlay.yaml", overlay.replace("readId", "getInPallet"))
    result = plants.sysmlc("diff", "old.aml", "same.aml")
    assert result.stdout == (
        "Lib::Gate\n  + operation getInPallet: added\n  - operation readId: removed\n"
        "\n1 added, 1 removed\n"
    )


def test_output_is_coloured_on_a_terminal_only(plants, monkeypatch):
    plain = plants.sysmlc("diff", "old.aml", "new.aml").stdout
    monkeypatch.setattr("sysmlc.cli.reports.has_color", lambda stream: True)
    coloured = plants.sysmlc("diff", "old.aml", "new.aml").stdout
    assert "\x1b[" not in plain
    assert "\x1b[32m+ value width|mm: added\x1b[0m" in coloured


def test_long_texts_are_shortened_to_the_difference(workspace):
    body = "x" * 300
    workspace.write("a.ir", f'Class c "C" body="{body}y{body}"\n')
    workspace.write("b.ir", f'Class c "C" body="{body}z{body}"\n')
    line = workspace.sysmlc("diff", "a.ir", "b.ir").stdout.splitlines()[1]
    cut = "..." + "x" * 40
    assert line.startswith(f"  ~ class C: body: {cut}y")
    assert f"=> {cut}z" in line


def test_a_comment_is_shown_with_what_it_is_about(workspace):
    old = "package P { part def A; part def B; part def C { comment about A, B /* two */ } }"
    new = old.replace("about A, B", "about A")
    workspace.write("old.sysml", old)
    workspace.write("new.sysml", new)
    lines = workspace.sysmlc("diff", "old.sysml", "new.sysml").stdout.splitlines()
    assert "  ~ block C: comment: two (about A, B) => two (about A)" in lines


def test_folders_with_models_can_be_compared(plants):
    model = random_model(Random(3)).decode()
    plants.write("old/plant.uml", model)
    plants.write("new/plant.uml", model.replace('name="Random plant"', 'name="Plant"'))
    result = plants.sysmlc("diff", "old", "new")
    assert (result.exit_code, result.stdout) == (
        1,
        "(model)\n  ~ package Plant: renamed, was Random plant\n\n1 renamed\n",
    )


def test_the_comparison_skips_passes_that_only_check(workspace, monkeypatch):
    """The pass of these tests would report the port without a name as an error."""
    workspace.write("faulty.ir", workspace.read("plant.ir").replace('gate.in "in"', "gate.in"))
    result = workspace.sysmlc("diff", "plant.ir", "faulty.ir")
    assert (result.exit_code, result.stderr) == (1, "")
