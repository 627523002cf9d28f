"""A plant that was saved as UML or SysML v2 is saved as AutomationML again."""

from pathlib import Path

import pytest
from aml_files import parse_file
from lxml import etree

from examples.compiling import compile_text, format_diagnostics, outputs
from sysmlc.driver import Request, compile_model, select_backends

PLANT = """<CAEXFile xmlns="http://www.dke.de/CAEX" SchemaVersion="3.0" FileName="cell.aml">
<SourceDocumentInformation OriginName="us" OriginID="u" OriginVersion="1"
 LastWritingDateTime="2024-01-01T00:00:00Z"/>
<InstanceHierarchy Name="Plant">
  <InternalElement Name="line" ID="1line">
    <Attribute Name="length" AttributeDataType="xs:double" Unit="m"><Value>2.5</Value></Attribute>
    <ExternalInterface Name="in" ID="line-in" RefBaseClassPath="Ports/Port"/>
    <InternalElement Name="belt" ID="belt" RefBaseSystemUnitPath="Lib/Belt">
      <Attribute Name="speed"><Value>1.5</Value></Attribute>
      <ExternalInterface Name="out" ID="belt-out" RefBaseClassPath="Ports/Port"/>
    </InternalElement>
    <InternalLink Name="l" RefPartnerSideA="line-in" RefPartnerSideB="belt-out"/>
    <RoleRequirements RefBaseRoleClassPath="Roles/Mover"/>
  </InternalElement>
</InstanceHierarchy>
<InterfaceClassLib Name="Ports"><InterfaceClass Name="Port"/></InterfaceClassLib>
<RoleClassLib Name="Roles"><RoleClass Name="Mover"
 RefBaseClassPath="AutomationMLBaseRoleClassLib/AutomationMLBaseRole/Resource"/></RoleClassLib>
<SystemUnitClassLib Name="Lib">
  <SystemUnitClass Name="Belt">
    <Attribute Name="speed" AttributeDataType="xs:double" Unit="m/s"/>
    <ExternalInterface Name="out" ID="b-out" RefBaseClassPath="Ports/Port"/>
  </SystemUnitClass>
</SystemUnitClassLib>
</CAEXFile>"""
WAYS = ("uml", "sysml")


def compile_again(folder: Path, language: str, text: str = PLANT):
    """Save a plant in a language in *folder*, and compile the saved files to AutomationML."""
    saved = outputs(compile_text(folder, "cell.aml", text.encode(), language))
    models = []
    for path, content in saved.items():
        if path.startswith(f"{language}/"):
            models.append(folder / path)
            models[-1].parent.mkdir(exist_ok=True)
            models[-1].write_text(content)
    return compile_model(Request(tuple(models), backends=tuple(select_backends(["aml"]))))


def list_texts(compilation):
    return {path: text for path, text in outputs(compilation).items() if path.startswith("aml/")}


@pytest.mark.parametrize("way", WAYS)
def test_the_file_is_named_after_the_model(way, tmp_path):
    """``sysml/`` also has the file of our library, which comes first in the alphabet."""
    assert list(list_texts(compile_again(tmp_path, way))) == ["aml/cell.aml"]


@pytest.mark.parametrize("way", WAYS)
def test_internal_elements_come_back_with_their_content(way, tmp_path):
    (line,) = parse_file(list_texts(compile_again(tmp_path, way))).xpath(
        "InstanceHierarchy[@Name='Plant']/InternalElement"
    )
    (belt,) = line.findall("InternalElement")
    assert [(node.get("Name"), node.get("ID")) for node in (line, belt)] == [
        ("line", "1line"),
        ("belt", "belt"),
    ]
    assert belt.get("RefBaseSystemUnitPath") == "Lib/Belt"
    assert [
        (attribute.get("Name"), attribute.findtext("Value"), attribute.get("Unit"))
        for attribute in (line.find("Attribute"), belt.find("Attribute"))
    ] == [("length", "2.5", "m"), ("speed", "1.5", "m/s")]
    assert line.find("RoleRequirements").get("RefBaseRoleClassPath") == "Roles/Mover"
    link = line.find("InternalLink")
    ends = [link.get("RefPartnerSideA"), link.get("RefPartnerSideB")]
    interfaces = [line.find("ExternalInterface"), belt.find("ExternalInterface")]
    assert [interface.get("ID") for interface in interfaces] == ends == ["line-in", "belt-out"]


def test_a_model_without_structure_gives_an_error_and_no_file(tmp_path):
    text = "package Plan { requirement def Speed { doc /* at least 2 m/s */ } }"
    compilation = compile_text(tmp_path, "plan.sysml", text.encode(), "aml")
    assert list_texts(compilation) == {}
    assert (
        "SM764 error no file is written: the model has no blocks, types or instances "
        "for AutomationML [Plan]\n"
    ) in format_diagnostics(compilation)


def test_libraries_without_a_plant_are_written(tmp_path):
    hierarchy = PLANT.partition("<InterfaceClassLib")[0].partition("<InstanceHierarchy")
    text = hierarchy[0] + "<InterfaceClassLib" + PLANT.partition("<InterfaceClassLib")[2]
    (saved,) = list_texts(compile_again(tmp_path, "uml", text)).values()
    tags = {etree.QName(node).localname for node in etree.fromstring(saved.encode())}
    assert "SystemUnitClassLib" in tags
    assert "InstanceHierarchy" not in tags
