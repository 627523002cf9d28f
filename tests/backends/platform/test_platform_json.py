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


def compile_inputs(*inputs):
    backends = tuple(select_backends(["platform"]))
    return compile_model(Request(inputs=inputs, backends=backends))


def platform(*inputs):
    (artefact,) = compile_inputs(*inputs).artefacts
    assert artefact.path == "platform.json"
    return json.loads(artefact.text)


def list_findings(compilation):
    return [
        f"{diagnostic.rule.code} {diagnostic.message}"
        for diagnostic in compilation.diagnostics
        if "SM623" <= diagnostic.rule.code <= "SM630"
    ]


def test_the_file_has_a_schema(unit):
    jsonschema.validate(platform(unit), SCHEMA)


def test_the_overlay_of_the_documentation_does_what_the_documentation_says(unit):
    (left_arm, right_arm) = platform(unit / "recipe.uml", unit / "plant.aml")["elements"]
    assert (left_arm["id"], left_arm["qualified_name"], left_arm["type"]) == (
        "k1",
        "ICE::Cell::KukaLeft",
        "Lib::Kuka",
    )
    assert left_arm["source"] == {"file": "plant.aml", "line": 7, "column": 7}
    assert left_arm["machines"] == [
        {
            "machine": "FourTasks::Plant::Arm1",
            "bound_by": "overlay",
            "said_at": {"file": "plant.overlay.yaml", "line": 11, "column": 5},
        }
    ]
    offered = [
        (
            service["service"].rpartition(":")[2],
            service["operation"]["qualified_name"],
            service["bound_by"],
        )
        for service in right_arm["services"]
    ]
    assert offered == [
        ("Mount", "Roles::Manipulation::Mount", "name"),
        ("PickPin", "Lib::Kuka::takePin", "overlay"),
        ("Turn", "Roles::Manipulation::Turn", "name"),
    ]


def test_machines_and_services_of_the_recipe_are_listed_bound_or_not(unit):
    document = platform(unit)
    assert {m["machine"].rpartition(":")[2]: m["element"] for m in document["machines"]} == {
        "Arm1": "k1",
        "Arm2": "k2",
        "Cart": None,
        "Mill1": None,
        "Mill2": None,
    }
    assert {s["service"].rpartition(":")[2]: s["elements"] for s in document["services"]} == {
        "Mount": ["k1", "k2"],
        "PickPin": ["k1", "k2"],
        "ReadTorque": [],
        "Turn": ["k1", "k2"],
    }
    assert {tuple(machine["recipes"]) for machine in document["machines"]} == {
        ("FourTasks::Recipes::FourTasks",)
    }


def test_unused_elements_of_the_plant_are_listed(unit):
    unused = [(element["id"], element["contents"]) for element in platform(unit)["unused"]]
    assert unused == [("m1", 0), ("o1", 1)]


def test_what_is_not_bound_is_told_with_a_suggestion(unit):
    assert list_findings(compile_inputs(unit)) == [
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
    machines = {element["id"]: element["machines"] for element in platform(unit)["elements"]}
    assert [(machine["machine"], machine["bound_by"]) for machine in machines["m1"]] == [
        ("FourTasks::Plant::Mill1", "allocation")
    ]


def test_an_id_on_the_machine_binds_it(unit):
    recipe = unit / "recipe.uml"
    text = recipe.read_text()
    assert text.count('endpoint="opc.tcp://mill2:4840"') == 1
    end = 'endpoint="opc.tcp://mill2:4840"'
    recipe.write_text(text.replace(end, f'{end} amlId="m1"'))
    document = platform(unit)
    assert [
        m["bound_by"] for e in document["elements"] if e["id"] == "m1" for m in e["machines"]
    ] == ["id"]
    recipe.write_text(text.replace(end, f'{end} amlId="gone"'))
    assert (
        "SM628 machine 'FourTasks::Plant::Mill2' has the amlId 'gone', "
        "which no element of the plant has"
    ) in list_findings(compile_inputs(unit))


@pytest.mark.parametrize("alone", ["recipe.uml", "plant.aml"])
def test_without_the_other_half_there_is_no_file_and_no_finding(unit, alone):
    (unit / "plant.overlay.yaml").unlink()
    compilation = compile_inputs(unit / alone)
    assert compilation.artefacts == ()
    assert list_findings(compilation) == []


def test_the_order_of_the_inputs_does_not_matter(unit):
    artefacts = compile_inputs(unit / "recipe.uml", unit / "plant.aml").artefacts
    assert compile_inputs(unit / "plant.aml", unit / "recipe.uml").artefacts == artefacts


def test_the_file_is_traced_to_recipe_and_plant(unit):
    compilation = compile_inputs(unit)
    (artefact,) = compilation.artefacts
    files = {compilation.graph[id].source for id in artefact.trace}
    assert files == {"recipe.uml", "plant.aml", "plant.overlay.yaml"}
    assert {compilation.graph[id].name for id in artefact.trace} >= {"Arm1", "KukaLeft", "takePin"}
