"""``platform.json``: a recipe in XMI, a plant in AutomationML and an overlay are one unit."""

import json
import shutil

import jsonschema
import pytest

from sysmlc.driver import Request, compile_model, select_backends
from sysmlc.support import resources

SCHEMA = json.loads(resources.read_text("metamodels", "sysmlc-platform.schema.json"))
ROOT = resources.find_root()
PAGE = (ROOT / "docs" / "map-a-recipe-to-a-plant.md").read_text("utf-8")
OVERLAY = PAGE.split("```yaml\n")[1].split("```")[0]
PLANT = """\
<?xml version="1.0" encoding="utf-8"?>
<CAEXFile xmlns="http://www.dke.de/CAEX" SchemaVersion="3.0" FileName="plant.aml">
  <SuperiorStandardVersion>AutomationML 2.10</SuperiorStandardVersion>
  <SourceDocumentInformation OriginName="x" OriginID="x" OriginVersion="1"/>
  <InstanceHierarchy Name="ICE">
    <InternalElement Name="Cell" ID="c0">
      <InternalElement Name="KukaLeft" ID="k1" RefBaseSystemUnitPath="Lib/Kuka"/>
      <InternalElement Name="KukaRight" ID="k2" RefBaseSystemUnitPath="Lib/Kuka"/>
      <InternalElement Name="Mill1" ID="m1" RefBaseSystemUnitPath="Lib/Mill"/>
      <InternalElement Name="Oven" ID="o1"><InternalElement Name="fan" ID="o2"/></InternalElement>
    </InternalElement>
  </InstanceHierarchy>
  <RoleClassLib Name="Roles"><RoleClass Name="Manipulation"/></RoleClassLib>
  <SystemUnitClassLib Name="Lib">
    <SystemUnitClass Name="Kuka">
      <SupportedRoleClass RefRoleClassPath="Roles/Manipulation"/>
    </SystemUnitClass>
    <SystemUnitClass Name="Mill"/>
  </SystemUnitClassLib>
</CAEXFile>
"""


@pytest.fixture
def unit(tmp_path):
    shutil.copy(ROOT / "examples" / "four-tasks" / "four-tasks.uml", tmp_path / "recipe.uml")
    (tmp_path / "plant.aml").write_text(PLANT)
    (tmp_path / "plant.overlay.yaml").write_text(OVERLAY)
    return tmp_path


def compiled(*inputs):
    backends = tuple(select_backends(["platform"]))
    return compile_model(Request(inputs=inputs, backends=backends))


def platform(*inputs):
    (made,) = compiled(*inputs).artefacts
    assert made.path == "platform.json"
    return json.loads(made.text)


def told(made):
    found = (one for one in made.diagnostics if "SM623" <= one.rule.code <= "SM630")
    return [f"{one.rule.code} {one.message}" for one in found]


def test_the_file_has_a_schema(unit):
    jsonschema.validate(platform(unit), SCHEMA)


def test_the_overlay_of_the_documentation_does_what_the_documentation_says(unit):
    (left, right) = platform(unit / "recipe.uml", unit / "plant.aml")["elements"]
    assert (left["id"], left["qualified_name"], left["type"]) == (
        "k1",
        "ICE::Cell::KukaLeft",
        "Lib::Kuka",
    )
    assert left["source"] == {"file": "plant.aml", "line": 7, "column": 7}
    assert left["machines"] == [
        {
            "machine": "FourTasks::Plant::Arm1",
            "bound_by": "overlay",
            "said_at": {"file": "plant.overlay.yaml", "line": 11, "column": 5},
        }
    ]
    offered = [
        (one["service"].rpartition(":")[2], one["operation"]["qualified_name"], one["bound_by"])
        for one in right["services"]
    ]
    assert offered == [
        ("Mount", "Roles::Manipulation::Mount", "name"),
        ("PickPin", "Lib::Kuka::takePin", "overlay"),
        ("Turn", "Roles::Manipulation::Turn", "name"),
    ]


def test_machines_and_services_of_the_recipe_are_listed_bound_or_not(unit):
    made = platform(unit)
    assert {one["machine"].rpartition(":")[2]: one["element"] for one in made["machines"]} == {
        "Arm1": "k1",
        "Arm2": "k2",
        "Cart": None,
        "Mill1": None,
        "Mill2": None,
    }
    assert {one["service"].rpartition(":")[2]: one["elements"] for one in made["services"]} == {
        "Mount": ["k1", "k2"],
        "PickPin": ["k1", "k2"],
        "ReadTorque": [],
        "Turn": ["k1", "k2"],
    }
    assert {tuple(one["recipes"]) for one in made["machines"]} == {
        ("FourTasks::Recipes::FourTasks",)
    }


def test_unused_elements_of_the_plant_are_listed(unit):
    found = [(one["id"], one["contents"]) for one in platform(unit)["unused"]]
    assert found == [("m1", 0), ("o1", 1)]


def test_what_is_not_bound_is_told_with_a_suggestion(unit):
    assert told(compiled(unit)) == [
        f"SM624 machine 'FourTasks::Plant::{name}' is bound to no element of the plant"
        for name in ("Mill1", "Mill2", "Cart")
    ]


def test_an_allocation_in_xmi_may_lead_to_the_plant(unit):
    recipe = unit / "recipe.uml"
    text = recipe.read_text()
    mill = text.partition('name="Mill1"')[0].rpartition('xmi:id="')[2].partition('"')[0]
    allocation = (
        f'<packagedElement xmi:type="uml:Abstraction" xmi:id="_a" client="{mill}">'
        '<supplier xmi:type="uml:Class" href="plant.aml#m1"/></packagedElement>'
    )
    applied = (
        '<a:Allocate xmlns:a="http://www.eclipse.org/papyrus/sysml/1.6/SysML/Allocations"'
        ' xmi:id="_b" base_Abstraction="_a"/>'
    )
    text = text.replace("</uml:Model>", f"{allocation}</uml:Model>{applied}")
    recipe.write_text(text)
    bound = {one["id"]: one["machines"] for one in platform(unit)["elements"]}
    assert [(one["machine"], one["bound_by"]) for one in bound["m1"]] == [
        ("FourTasks::Plant::Mill1", "allocation")
    ]


def test_an_id_on_the_machine_binds_it(unit):
    recipe = unit / "recipe.uml"
    text = recipe.read_text()
    assert text.count('endpoint="opc.tcp://mill2:4840"') == 1
    end = 'endpoint="opc.tcp://mill2:4840"'
    recipe.write_text(text.replace(end, f'{end} amlId="m1"'))
    made = platform(unit)
    assert [
        one["bound_by"] for e in made["elements"] if e["id"] == "m1" for one in e["machines"]
    ] == ["id"]
    recipe.write_text(text.replace(end, f'{end} amlId="gone"'))
    assert (
        "SM628 machine 'FourTasks::Plant::Mill2' has the amlId 'gone', "
        "which no element of the plant has"
    ) in told(compiled(unit))


@pytest.mark.parametrize("alone", ["recipe.uml", "plant.aml"])
def test_without_the_other_half_there_is_no_file_and_no_finding(unit, alone):
    (unit / "plant.overlay.yaml").unlink()
    made = compiled(unit / alone)
    assert made.artefacts == ()
    assert told(made) == []


def test_the_order_of_the_inputs_does_not_matter(unit):
    one = compiled(unit / "recipe.uml", unit / "plant.aml").artefacts
    assert compiled(unit / "plant.aml", unit / "recipe.uml").artefacts == one


def test_the_file_is_traced_to_recipe_and_plant(unit):
    compilation = compiled(unit)
    (made,) = compilation.artefacts
    files = {compilation.graph[id].source for id in made.trace}
    assert files == {"recipe.uml", "plant.aml", "plant.overlay.yaml"}
    assert {compilation.graph[id].name for id in made.trace} >= {"Arm1", "KukaLeft", "takePin"}
