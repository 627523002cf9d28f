"""``--schema DIR``: inputs against the schemas of the user."""

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
def folder(here):
    here.write("schemas/caex.xsd", XSD)
    here.write("plant.aml", PLANT.format(""))
    here.write("wrong.aml", PLANT.format('<InstanceHierarchy Nam="Other"/>'))
    return here


@pytest.mark.parametrize("command", [("check",), ("build",), ()])
def test_violations_are_warnings_at_their_places(folder, command):
    made = folder.sysmlc(*command, "wrong.aml", "--schema", "schemas", "--format", "concise")
    told = [line for line in made.stderr.splitlines() if "SM186" in line]
    assert told == [
        "wrong.aml:3:3: warning[SM186 schema-violation]: 'InstanceHierarchy' does not conform "
        "to caex.xsd: 'InstanceHierarchy' has no attribute 'Name' (InstanceHierarchy)",
        "wrong.aml:3:3: warning[SM186 schema-violation]: 'InstanceHierarchy' does not conform "
        "to caex.xsd: 'InstanceHierarchy' must not have the attribute 'Nam' (InstanceHierarchy)",
    ]
    assert made.exit_code == 0


def test_a_valid_file_has_no_findings(folder):
    made = folder.sysmlc("check", "plant.aml", "--schema", "schemas")
    assert made.stderr == "no findings\n"


def test_without_the_option_nothing_is_validated(folder):
    made = folder.sysmlc("check", "wrong.aml", "--format", "json")
    codes = [found["code"] for found in json.loads(made.stdout)["diagnostics"]]
    assert "SM186" not in codes


def test_strict_makes_a_violation_an_exit_code(folder):
    assert folder.sysmlc("check", "wrong.aml", "--schema", "schemas", "--strict").exit_code == 1
    assert folder.sysmlc("check", "plant.aml", "--schema", "schemas", "--strict").exit_code == 0


def test_the_cache_does_not_hide_a_changed_schema(folder):
    assert folder.sysmlc("check", "plant.aml", "--schema", "schemas").stderr == "no findings\n"
    folder.write("schemas/caex.xsd", XSD.replace('name="InstanceHierarchy"', 'name="Other"'))
    made = folder.sysmlc("check", "plant.aml", "--schema", "schemas", "--format", "concise")
    assert "'InstanceHierarchy' stands where 'Other' should" in made.stderr


def test_a_file_without_a_schema_is_told(folder):
    made = folder.sysmlc("check", "plant.ir", "--schema", "schemas", "--format", "concise")
    expected = "SM187 no-schema-for-file]: 'plant.ir' was not validated: 'schemas' has no schema"
    assert expected in made.stderr


def test_a_damaged_file_is_told_once(folder):
    folder.write("plant.aml", PLANT.format("<InstanceHierarchy>"))
    made = folder.sysmlc("check", "plant.aml", "--schema", "schemas", "--format", "json")
    codes = [found["code"] for found in json.loads(made.stdout)["diagnostics"]]
    assert codes == ["SM142"]


def test_of_many_violations_the_first_are_told_and_the_others_counted(folder):
    folder.write("plant.aml", PLANT.format("<InstanceHierarchy/>" * 250))
    made = folder.sysmlc("check", "plant.aml", "--schema", "schemas", "--format", "concise")
    assert made.stderr.count("SM186") == 200
    assert "'plant.aml' does not conform to caex.xsd in 50 more places" in made.stderr


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
def test_schemas_that_cannot_be_used_end_the_run(folder, name, text, message):
    if name != "gone":
        (folder.folder / name).mkdir()
    if text is not None:
        folder.write(f"{name}/caex.xsd", text)
    made = folder.sysmlc("check", "plant.aml", "--schema", name)
    assert made.exit_code == 2
    assert message in made.stderr
    assert len(made.stderr.splitlines()) == 1
