"""Plants of AutomationML that are written as SysML v2 are read back with their metadata."""

from pathlib import Path

import pytest

from examples.compiling import compile_example, compile_text, outputs
from long_runs import quick_first
from sysmlc.backends.sysml import print_document
from sysmlc.diagnostics import Coverage, Severity, Sink
from sysmlc.frontends.caex import FRONTEND as CAEX
from sysmlc.frontends.sysml import FRONTEND
from sysmlc.ir import Edge, Graph, Kind
from sysmlc.ir.compare import compare
from sysmlc.ir.query.classifiers import quantity_kind_of, unit_of
from sysmlc.ir.text import parse_text
from sysmlc.passes import pipeline
from sysmlc.sources import Source

ROOT = Path(__file__).parents[3]
REAL_PLANTS = ["amlsec_casestudy_a", "vera_plant", "opak_festo_v35"]
PLANT = """\
<CAEXFile SchemaVersion="3.0" FileName="plant.aml">
 <SuperiorStandardVersion>AutomationML 2.10</SuperiorStandardVersion>
 <SourceDocumentInformation OriginName="t" OriginID="t" OriginVersion="1"
  LastWritingDateTime="2026-01-01T00:00:00Z"/>
 <InstanceHierarchy Name="Plant">
  <InternalElement Name="cell" ID="c" RefBaseSystemUnitPath="Units/Cell">
   <InternalElement Name="belt" ID="b" RefBaseSystemUnitPath="Units/Belt">
    <Attribute Name="speed" AttributeDataType="xs:float" Unit="{unit}"><Value>2</Value></Attribute>
    <ExternalInterface Name="in" ID="b.in" RefBaseClassPath="Wires/Wire"/>
   </InternalElement>
   <ExternalInterface Name="plug" ID="c.plug" RefBaseClassPath="Wires/Wire"/>
   <InternalLink Name="w" RefPartnerSideA="c.plug" RefPartnerSideB="b.in"/>
  </InternalElement>
 </InstanceHierarchy>
 <InterfaceClassLib Name="Wires"><Version>2.1</Version><InterfaceClass Name="Wire"/>
 </InterfaceClassLib>
 <SystemUnitClassLib Name="Units"><Version>1.0</Version>
  <SystemUnitClass Name="Belt">
   <Attribute Name="speed" AttributeDataType="xs:float" Unit="{unit}"/>
   <ExternalInterface Name="in" ID="belt.in" RefBaseClassPath="Wires/Wire"/>
  </SystemUnitClass>
  <SystemUnitClass Name="Cell">
   <InternalElement Name="belt" ID="cell.belt" RefBaseSystemUnitPath="Units/Belt"/>
   <ExternalInterface Name="plug" ID="cell.plug" RefBaseClassPath="Wires/Wire"/>
  </SystemUnitClass>
 </SystemUnitClassLib>
</CAEXFile>
"""


def read_plant(data, name="plant.aml"):
    graph, sink = Graph(), Sink()
    CAEX.read([Source(name, data)], graph, sink, Coverage())
    pipeline.build_pipeline(("resolve", "inherit", "classify", "ports")).run(graph, sink)
    return graph


def read_back(graph, sink=None):
    text, _ = print_document(graph, Sink())
    again, sink = Graph(), Sink() if sink is None else sink
    FRONTEND.read([Source("model.sysml", text.encode())], again, sink, Coverage())
    pipeline.build_pipeline(("resolve", "inherit", "classify", "ports")).run(again, sink)
    return again


def list_differences(graph):
    return [
        str(difference) for difference in compare(graph, read_back(graph), ("id", "declaration"))
    ]


@pytest.mark.parametrize("unit", ["m/s", "m³/h", "MTS", ""])
def test_data_types_units_versions_and_the_ends_of_links_come_back(unit):
    """``MTS`` is another spelling of m/s, which the text keeps; SI has no m³/h."""
    assert list_differences(read_plant(PLANT.replace("{unit}", unit).encode())) == []


def test_ids_of_interfaces_that_are_read_are_not_reported_as_lost():
    sink = Sink()
    again = read_back(read_plant(PLANT.replace("{unit}", "m/s").encode()), sink)
    assert [element for element in again if element.attrs.get("interface_ids")]
    assert [diagnostic.message for diagnostic in sink if diagnostic.rule.code == "SM481"] == []


def test_values_for_a_part_of_a_class_stay_values():
    """The text alone declares a second part there; AutomationML had one element more then."""
    values = """<SystemUnitClass Name="Line" RefBaseClassPath="Units/Cell">
     <InternalElement Name="belt" ID="line.belt" RefBaseSystemUnitPath="Units/Belt">
      <Attribute Name="speed"><Value>3</Value></Attribute></InternalElement>
    </SystemUnitClass></SystemUnitClassLib>"""
    text = PLANT.replace("{unit}", "m/s").replace("</SystemUnitClassLib>", values)
    assert list_differences(read_plant(text.encode())) == []


def test_roles_of_repeated_parts_come_back():
    roles = """<RoleRequirements RefBaseRoleClassPath="AutomationMLBaseRoleClassLib/\
AutomationMLBaseRole/Resource"/></InternalElement>"""
    text = PLANT.replace("{unit}", "m/s").replace("</InternalElement>", roles, 1)
    graph = read_plant(text.encode())
    assert any(element.kind is Kind.INSTANCE for element in realizing(graph))
    assert [(element.kind, element.name) for element in realizing(graph)] == [
        (element.kind, element.name) for element in realizing(read_back(graph))
    ]


def test_the_role_of_an_element_stays_beside_an_inner_element_of_the_same_name():
    text = """<CAEXFile SchemaVersion="3.0" FileName="p.aml"><InstanceHierarchy Name="Plant">
     <InternalElement Name="cell" ID="c"><InternalElement Name="robot" ID="r">
      <InternalElement Name="robot" ID="arm"/>
      <RoleRequirements RefBaseRoleClassPath="Roles/Mover"/></InternalElement></InternalElement>
    </InstanceHierarchy><RoleClassLib Name="Roles"><RoleClass Name="Mover"/></RoleClassLib>
    </CAEXFile>"""
    graph = read_plant(text.encode())
    assert list_differences(graph) == []


def realizing(graph):
    return [element for element in graph if graph.targets(element, Edge.REALIZES)]


def test_an_id_of_an_interface_is_written_once_beside_other_members():
    """A part of a class has a class of its own then; the port came into it a second time."""
    units = """<SystemUnitClass Name="Motor"/>
    <SystemUnitClass Name="Driven" RefBaseClassPath="Units/Belt">
     <InternalElement Name="motor" ID="dm" RefBaseSystemUnitPath="Units/Motor"/>
    </SystemUnitClass>
    <SystemUnitClass Name="Line">
     <InternalElement Name="belt" ID="l" RefBaseSystemUnitPath="Units/Driven">
      <InternalElement Name="motor" ID="lm" RefBaseSystemUnitPath="Units/Motor"/>
      <InternalElement Name="guard" ID="lg"/>
      <ExternalInterface Name="in" ID="l.in" RefBaseClassPath="Wires/Wire"/>
     </InternalElement></SystemUnitClass></SystemUnitClassLib>"""
    text = PLANT.replace("{unit}", "m/s").replace("</SystemUnitClassLib>", units)
    once = read_back(read_plant(text.encode()))
    assert [
        element.attrs["interface_ids"][0][1]
        for element in once
        if element.attrs.get("interface_ids")
    ]
    assert [
        str(difference) for difference in compare(once, read_back(once), ("id", "declaration"))
    ] == []


def test_a_unit_that_si_does_not_have_comes_back_with_its_quantity():
    again = read_back(read_plant(PLANT.replace("{unit}", "rpm").encode()))
    (speed,) = [
        property_ for property_ in again.of_kind(Kind.PROPERTY) if property_.name == "speed"
    ]
    assert speed.attrs["unit"] == "rpm"
    assert unit_of(again, speed).attrs["symbol"] == "rpm"
    assert quantity_kind_of(again, speed).name == "rotational frequency"


def test_a_name_that_the_text_cannot_have_comes_back():
    """``Quantities`` is a package of the standard library: the text has another name for ours."""
    data = PLANT.replace("Units", "Quantities").replace("{unit}", "m").encode()
    text, _ = print_document(read_plant(data), Sink())
    assert "package Quantities_2 {" in text
    assert list_differences(read_plant(data)) == []


@pytest.mark.corpus
@pytest.mark.parametrize("name", ["BayGate.aml", "BayGate_caex215.aml"])
def test_baygate_comes_back_as_it_was(corpus, name):
    data = (corpus / "aml" / "baygate" / name).read_bytes()
    assert list_differences(read_plant(data, name)) == []


def test_the_example_comes_back_as_it_was():
    assert list_differences(read_plant((ROOT / "examples/baygate/baygate.aml").read_bytes())) == []


WITH_CONSTRAINTS = """\
Package p "Plant"
  Class plug "Plug" role="interface block"
    Property plug.way "way" role="value"
    Constraint plug.c "Allowed" body="way > 1" language="sysmlc"
      -> references plug.way
  DataType level "Level" role="value type"
  Constraint p.c "" body="Level >= 0.0" language="sysmlc"
    -> references level
"""


def test_constraints_of_interfaces_and_of_attribute_types_are_well_formed_in_the_text():
    """A port has no parts, and a type is no value: these were errors of the text."""
    text, _ = print_document(parse_text(WITH_CONSTRAINTS), Sink())
    lines = [line.strip() for line in text.splitlines()]
    assert lines[lines.index("ref assert constraint Allowed {") + 2] == "way > 1"
    assert "constraint {" in lines
    assert "assert constraint {" not in lines


@pytest.mark.corpus
@pytest.mark.parametrize("name", quick_first(REAL_PLANTS))
def test_the_text_of_a_real_plant_has_no_errors(name, corpus, tmp_path):
    data = (corpus / "aml" / "dev" / f"{name}.aml").read_bytes()
    compilation = compile_text(tmp_path, f"{name}.aml", data, "sysml")
    for path, text in outputs(compilation).items():
        (tmp_path / path).parent.mkdir(exist_ok=True)
        (tmp_path / path).write_text(text)
    again = compile_example(tmp_path / "sysml" / f"{name}.sysml", "ir")
    errors = [
        diagnostic for diagnostic in again.diagnostics if diagnostic.severity is Severity.ERROR
    ]
    assert [str(error.message) for error in errors] == []
