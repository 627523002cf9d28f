"""``platform.json`` for a recipe in XMI, a plant in AutomationML and an overlay."""

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
def folder(tmp_path):
    shutil.copy(ROOT / "examples" / "four-tasks" / "four-tasks.uml", tmp_path / "recipe.uml")
    (tmp_path / "plant.aml").write_text(PLANT)
    (tmp_path / "plant.overlay.yaml").write_text(OVERLAY)
    return tmp_path


def compile_inputs(*inputs):
    backends = tuple(select_backends(["platform"]))
    return compile_model(Request(inputs=inputs, backends=backends))


def read_platform(*inputs):
    """Return the content of the only output."""
    (artefact,) = compile_inputs(*inputs).artefacts
    assert artefact.path == "platform.json"
    return json.loads(artefact.text)


def list_messages(compilation):
    return [
        f"{diagnostic.rule.code} {diagnostic.message}"
        for diagnostic in compilation.diagnostics
        if "SM623" <= diagnostic.rule.code <= "SM630"
    ]


def test_the_file_follows_its_schema(folder):
    jsonschema.validate(read_platform(folder), SCHEMA)


def test_the_overlay_in_the_documentation_binds_machines_and_services(folder):
    (left_arm, right_arm) = read_platform(folder / "recipe.uml", folder / "plant.aml")["elements"]
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
    services = [
        (
            service["service"].rpartition(":")[2],
            service["operation"]["qualified_name"],
            service["bound_by"],
        )
        for service in right_arm["services"]
    ]
    assert services == [
        ("Mount", "Roles::Manipulation::Mount", "name"),
        ("PickPin", "Lib::Kuka::takePin", "overlay"),
        ("Turn", "Roles::Manipulation::Turn", "name"),
    ]


def test_bound_and_unbound_machines_and_services_are_listed(folder):
    document = read_platform(folder)
    assert {
        machine["machine"].rpartition(":")[2]: machine["element"]
        for machine in document["machines"]
    } == {
        "Arm1": "k1",
        "Arm2": "k2",
        "Cart": None,
        "Mill1": None,
        "Mill2": None,
    }
    assert {
        service["service"].rpartition(":")[2]: service["elements"]
        for service in document["services"]
    } == {
        "Mount": ["k1", "k2"],
        "PickPin": ["k1", "k2"],
        "ReadTorque": [],
        "Turn": ["k1", "k2"],
    }
    assert {tuple(machine["recipes"]) for machine in document["machines"]} == {
        ("FourTasks::Recipes::FourTasks",)
    }


def test_unused_elements_of_the_plant_are_listed(folder):
    unused = [(element["id"], element["contents"]) for element in read_platform(folder)["unused"]]
    assert unused == [("m1", 0), ("o1", 1)]


def test_unbound_machines_are_reported(folder):
    assert list_messages(compile_inputs(folder)) == [
        f"SM624 machine 'FourTasks::Plant::{name}' is bound to no element of the plant"
        for name in ("Mill1", "Mill2", "Cart")
    ]


def test_an_allocation_in_xmi_binds_a_machine(folder):
    recipe = folder / "recipe.uml"
    text = recipe.read_text()
    mill = text.partition('name="Mill1"')[0].rpartition('xmi:id="')[2].partition('"')[0]
    allocation = (
        f'<packagedElement xmi:type="uml:Abstraction" xmi:id="_a" client="{mill}">'
        '<supplier xmi:type="uml:Class" href="plant.aml#m1"/></packagedElement>'
    )
    stereotype = (
        '<a:Allocate xmlns:a="http://www.eclipse.org/papyrus/sysml/1.6/SysML/Allocations"'
        ' xmi:id="_b" base_Abstraction="_a"/>'
    )
    text = text.replace("</uml:Model>", f"{allocation}</uml:Model>{stereotype}")
    recipe.write_text(text)
    machines = {element["id"]: element["machines"] for element in read_platform(folder)["elements"]}
    assert [(machine["machine"], machine["bound_by"]) for machine in machines["m1"]] == [
        ("FourTasks::Plant::Mill1", "allocation")
    ]


def test_an_id_on_the_machine_binds_it(folder):
    recipe = folder / "recipe.uml"
    text = recipe.read_text()
    assert text.count('endpoint="opc.tcp://mill2:4840"') == 1
    end = 'endpoint="opc.tcp://mill2:4840"'
    recipe.write_text(text.replace(end, f'{end} amlId="m1"'))
    document = read_platform(folder)
    machines = {element["id"]: element["machines"] for element in document["elements"]}
    assert [machine["bound_by"] for machine in machines["m1"]] == ["id"]
    recipe.write_text(text.replace(end, f'{end} amlId="gone"'))
    assert (
        "SM628 machine 'FourTasks::Plant::Mill2' has the amlId 'gone', "
        "which no element of the plant has"
    ) in list_messages(compile_inputs(folder))


@pytest.mark.parametrize("name", ["recipe.uml", "plant.aml"])
def test_without_a_recipe_or_without_a_plant_there_is_no_file_and_no_diagnostic(folder, name):
    (folder / "plant.overlay.yaml").unlink()
    compilation = compile_inputs(folder / name)
    assert compilation.artefacts == ()
    assert list_messages(compilation) == []


def test_the_order_of_the_inputs_does_not_matter(folder):
    artefacts = compile_inputs(folder / "recipe.uml", folder / "plant.aml").artefacts
    assert compile_inputs(folder / "plant.aml", folder / "recipe.uml").artefacts == artefacts


def test_the_file_is_traced_to_recipe_and_plant(folder):
    compilation = compile_inputs(folder)
    (artefact,) = compilation.artefacts
    files = {compilation.graph[id].source for id in artefact.trace}
    assert files == {"recipe.uml", "plant.aml", "plant.overlay.yaml"}
    assert {compilation.graph[id].name for id in artefact.trace} >= {"Arm1", "KukaLeft", "takePin"}
