"""``--schema DIR``: inputs are validated against XML schemas of the user."""

import json

import pytest

XSD = """<xs:schema xmlns:xs="http://www.w3.org/2001/XMLSchema"
 targetNamespace="http://www.dke.de/CAEX"
 xmlns="http://www.dke.de/CAEX" elementFormDefault="qualified">
<xs:element name="CAEXFile"><xs:complexType><xs:sequence>
<xs:element name="InstanceHierarchy" minOccurs="0" maxOccurs="unbounded"><xs:complexType>
<xs:attribute name="Name" type="xs:string" use="required"/></xs:complexType></xs:element>
</xs:sequence><xs:attribute name="SchemaVersion" fixed="3.0" type="xs:string"/>
<xs:attribute name="FileName" type="xs:string" use="required"/></xs:complexType></xs:element>
</xs:schema>"""
PLANT = """<CAEXFile xmlns="http://www.dke.de/CAEX" SchemaVersion="3.0" FileName="plant.aml">
  <InstanceHierarchy Name="Plant"/>
  {}
</CAEXFile>"""


@pytest.fixture
def folder(workspace):
    workspace.write("schemas/caex.xsd", XSD)
    workspace.write("plant.aml", PLANT.format(""))
    workspace.write("wrong.aml", PLANT.format('<InstanceHierarchy Nam="Other"/>'))
    return workspace


@pytest.mark.parametrize("command", [("check",), ("build",), ()])
def test_violations_are_warnings_at_their_locations(folder, command):
    result = folder.sysmlc(*command, "wrong.aml", "--schema", "schemas", "--format", "concise")
    violations = [line for line in result.stderr.splitlines() if "SM186" in line]
    assert violations == [
        "wrong.aml:3:3: warning[SM186 schema-violation]: 'InstanceHierarchy' does not conform "
        "to caex.xsd: 'InstanceHierarchy' has no attribute 'Name' (InstanceHierarchy)",
        "wrong.aml:3:3: warning[SM186 schema-violation]: 'InstanceHierarchy' does not conform "
        "to caex.xsd: 'InstanceHierarchy' must not have the attribute 'Nam' (InstanceHierarchy)",
    ]
    assert result.exit_code == 0


def test_a_valid_file_has_no_diagnostics(folder):
    result = folder.sysmlc("check", "plant.aml", "--schema", "schemas")
    assert result.stderr == "no findings\n"


def test_files_are_not_validated_without_the_option(folder):
    result = folder.sysmlc("check", "wrong.aml", "--format", "json")
    codes = [diagnostic["code"] for diagnostic in json.loads(result.stdout)["diagnostics"]]
    assert "SM186" not in codes


def test_a_violation_is_exit_code_1_with_strict(folder):
    assert folder.sysmlc("check", "wrong.aml", "--schema", "schemas", "--strict").exit_code == 1
    assert folder.sysmlc("check", "plant.aml", "--schema", "schemas", "--strict").exit_code == 0


def test_the_cache_does_not_hide_a_changed_schema(folder):
    assert folder.sysmlc("check", "plant.aml", "--schema", "schemas").stderr == "no findings\n"
    folder.write("schemas/caex.xsd", XSD.replace('name="InstanceHierarchy"', 'name="Other"'))
    result = folder.sysmlc("check", "plant.aml", "--schema", "schemas", "--format", "concise")
    assert "unexpected element 'InstanceHierarchy'; expected 'Other'" in result.stderr


def test_a_file_without_a_schema_is_reported(folder):
    result = folder.sysmlc("check", "plant.ir", "--schema", "schemas", "--format", "concise")
    expected = "SM187 no-schema-for-file]: 'plant.ir' was not validated: 'schemas' has no schema"
    assert expected in result.stderr


def test_a_damaged_file_is_reported_once(folder):
    folder.write("plant.aml", PLANT.format("<InstanceHierarchy>"))
    result = folder.sysmlc("check", "plant.aml", "--schema", "schemas", "--format", "json")
    codes = [diagnostic["code"] for diagnostic in json.loads(result.stdout)["diagnostics"]]
    assert codes == ["SM142"]


def test_the_first_200_violations_are_reported_and_the_rest_is_counted(folder):
    folder.write("plant.aml", PLANT.format("<InstanceHierarchy/>" * 250))
    result = folder.sysmlc("check", "plant.aml", "--schema", "schemas", "--format", "concise")
    assert "'InstanceHierarchy' has no attribute 'Name' (200 places)" in result.stderr
    assert "'plant.aml' does not conform to caex.xsd in 50 more places" in result.stderr


@pytest.mark.parametrize(
    ("name", "text", "message"),
    [
        ("gone", None, "there is no folder 'gone' for schemas"),
        ("empty", None, "there is no schema (*.xsd) in 'empty'"),
        ("bad", "<xs:schema", "the schema 'caex.xsd' cannot be read"),
        ("out", XSD.replace("<xs:element", '<xs:import schemaLocation="../x.xsd"/><xs:element', 1),
         "the schema 'caex.xsd' asks for '../x.xsd', which is not inside 'out'"),
    ],
)  # fmt: skip
def test_an_unusable_schema_is_one_sentence_and_exit_code_2(folder, name, text, message):
    if name != "gone":
        (folder.folder / name).mkdir()
    if text is not None:
        folder.write(f"{name}/caex.xsd", text)
    result = folder.sysmlc("check", "plant.aml", "--schema", name)
    assert result.exit_code == 2
    assert message in result.stderr
    assert len(result.stderr.splitlines()) == 1
