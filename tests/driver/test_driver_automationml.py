"""AutomationML: files that aliases refer to, folders, external data, diagrams."""

import zipfile

import pytest
from driver_helpers import list_inputs

from sysmlc.driver import Request, compile_model, select_backends

HEAD = '<CAEXFile xmlns="http://www.dke.de/CAEX" SchemaVersion="3.0" FileName="{}">'
ROLES = (
    '<RoleClassLib Name="Shared"><RoleClass Name="Base" '
    'RefBaseClassPath="AutomationMLBaseRoleClassLib/AutomationMLBaseRole"/></RoleClassLib>'
)
REFERRING_ROLES = (
    '<ExternalReference Path="libs/roles.aml" Alias="Al"/><RoleClassLib Name="Roles">'
    '<RoleClass Name="Gate" RefBaseClassPath="Al@Shared/Base"/></RoleClassLib>'
)

REFERENCE_TO_DOCUMENT = (
    '<InstanceHierarchy Name="Plant"><InternalElement Name="Robot" ID="1">'
    '<ExternalInterface Name="Manual" ID="2" RefBaseClassPath="AutomationMLInterfaceClassLib/'
    'AutomationMLBaseInterface/ExternalDataConnector/ExternalDataReference"><Attribute '
    'Name="refURI" AttributeDataType="xs:anyURI"><Value>{}</Value></Attribute></ExternalInterface>'
    "</InternalElement></InstanceHierarchy>"
)


def write_file(folder, name, text):
    path = folder / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(f"{HEAD.format(path.name)}{text}</CAEXFile>")
    return path


def compile_paths(*paths, backends=()):
    selected = tuple(select_backends(backends)) if backends else ()
    return compile_model(Request(inputs=paths, backends=selected))


def compile_plant(folder, text, backends=()):
    """Compile a file ``main.aml`` with this content."""
    return compile_paths(write_file(folder, "main.aml", text), backends=backends)


def list_messages(compilation):
    """Return the diagnostics except SM158, because most files here contain libraries only."""
    messages = [
        f"{diagnostic.rule.code}: {diagnostic.message}" for diagnostic in compilation.diagnostics
    ]
    return [message for message in messages if not message.startswith("SM158")]


def test_files_that_aliases_refer_to_join_the_unit(tmp_path):
    write_file(tmp_path, "libs/roles.aml", ROLES)
    compilation = compile_plant(tmp_path, REFERRING_ROLES)
    assert [(file.path, file.language) for file in compilation.inputs] == [
        ("libs/roles.aml", "caex"),
        ("main.aml", "caex"),
    ]
    assert list_messages(compilation) == []


def test_files_outside_of_the_folder_of_the_model_are_not_opened(tmp_path):
    write_file(tmp_path, "roles.aml", ROLES)
    referring = REFERRING_ROLES.replace("libs/roles.aml", "../roles.aml")
    compilation = compile_paths(write_file(tmp_path, "plant/main.aml", referring))
    assert list_inputs(compilation) == ["main.aml"]
    assert list_messages(compilation) == [
        "SM132: the file '../roles.aml' is not part of the compile unit; "
        "1 element refers to classes of it"
    ]


def test_aliases_may_form_a_cycle(tmp_path):
    back_reference = '<ExternalReference Path="../main.aml" Alias="Back"/>'
    write_file(tmp_path, "libs/roles.aml", back_reference + ROLES)
    compilation = compile_plant(tmp_path, REFERRING_ROLES)
    assert list_inputs(compilation) == ["libs/roles.aml", "main.aml"]
    assert list_messages(compilation) == []


def test_a_folder_is_searched_for_automationml(tmp_path):
    write_file(tmp_path, "a.aml", ROLES)
    write_file(tmp_path, "b.caex", REFERRING_ROLES.replace("libs/roles.aml", "a.aml"))
    assert list_inputs(compile_paths(tmp_path)) == ["a.aml", "b.caex"]


EXTERNAL_DATA = (
    '<InstanceHierarchy Name="P"><InternalElement Name="i" ID="1"><ExternalInterface Name="d" '
    'ID="2" RefBaseClassPath="AutomationMLInterfaceClassLib/AutomationMLBaseInterface/'
    'ExternalDataConnector/COLLADAInterface"><Attribute Name="refURI" '
    'AttributeDataType="xs:anyURI"><Value>{}</Value></Attribute></ExternalInterface>'
    "</InternalElement></InstanceHierarchy>"
)


def test_missing_external_data_is_reported_at_its_attribute(tmp_path):
    compilation = compile_plant(tmp_path, EXTERNAL_DATA.format("file:///geo/gate.dae#n1"))
    assert list_messages(compilation) == [
        "SM148: the model refers to a file that does not exist: 'geo/gate.dae'"
    ]
    (diagnostic,) = compilation.diagnostics
    data = compilation.sources[0].data
    assert data[diagnostic.subject.place.offset :].startswith(b'<Attribute Name="refURI"')


def test_existing_or_remote_external_data_is_not_reported(tmp_path):
    (tmp_path / "geo").mkdir()
    (tmp_path / "geo" / "gate.dae").write_text("<COLLADA/>")
    for href in ("file:///geo/gate.dae#n1", "geo/gate.dae", "https://a.b/gate.dae", "Skill 1"):
        assert list_messages(compile_plant(tmp_path, EXTERNAL_DATA.format(href))) == []


LINE = (
    '<InstanceHierarchy Name="Site"><InternalElement Name="line" ID="1" '
    'RefBaseSystemUnitPath="Lib/Line"><ExternalInterface Name="way" ID="2"/>'
    '<InternalElement Name="gate" ID="3"><ExternalInterface Name="p" ID="4"/></InternalElement>'
    '<InternalLink Name="l" RefPartnerSideA="2" RefPartnerSideB="4"/>'
    "</InternalElement></InstanceHierarchy>"
    '<InterfaceClassLib Name="I"><InterfaceClass Name="P" RefBaseClassPath='
    '"AutomationMLInterfaceClassLib/AutomationMLBaseInterface"/></InterfaceClassLib>'
    '<SystemUnitClassLib Name="Lib"><SystemUnitClass Name="Line">'
    '<ExternalInterface Name="way" ID="5" RefBaseClassPath="I/P"/>'
    '<InternalElement Name="gate" ID="6">'
    '<ExternalInterface Name="p" ID="7" RefBaseClassPath="I/P"/>'
    "</InternalElement></SystemUnitClass></SystemUnitClassLib>"
)


def test_an_instance_with_links_is_the_frame_of_an_internal_block_diagram(tmp_path):
    compilation = compile_plant(tmp_path, LINE, backends=("plantuml",))
    (ibd,) = [artefact for artefact in compilation.artefacts if artefact.path.endswith(".ibd.puml")]
    lines = ibd.text[ibd.text.index("mainframe ibd") :].splitlines()
    assert lines[0] == "mainframe ibd [block] line : Line"
    assert [line for line in lines if line.startswith(("port", "rectangle"))] == [
        'rectangle " " as line_1 <<frame>> {',
        'portin "<back:#FFFFFF>way</back>" as way_1',
        'rectangle "**gate : gate**" as gate_1 <<part>> {',
        'portin "<back:#FFFFFF>p</back>" as p_1',
    ]
    assert "way_1 -- p_1 : l" in lines
    assert list_messages(compilation) == []


def test_the_diagram_of_an_instance_shows_its_values_and_those_of_its_parts(tmp_path):
    length = '<Attribute Name="length" AttributeDataType="xs:double">{}</Attribute>'
    value = length.format("<Value>1.2</Value>")
    plant = LINE
    for interface_id, attribute in (
        ("5", length.format("")),
        ("7", length.format("")),
        ("2", value),
        ("4", value),
    ):
        name = "way" if interface_id in "52" else "p"
        port = f'<ExternalInterface Name="{name}" ID="{interface_id}"'
        plant = plant.replace(port, attribute + port)
    compilation = compile_plant(tmp_path, plant, backends=("plantuml",))
    (ibd,) = [artefact for artefact in compilation.artefacts if artefact.path.endswith(".ibd.puml")]
    frames = [line for line in ibd.text.splitlines() if line.startswith("rectangle")]
    assert ["length = 1.2" in frame for frame in frames] == [True, True]
    assert not [artefact for artefact in compilation.artefacts if "Site.bdd" in artefact.path]
    assert list_messages(compilation) == []


def test_an_instance_without_links_has_no_diagram(tmp_path):
    plant = LINE.replace('<InternalLink Name="l" RefPartnerSideA="2" RefPartnerSideB="4"/>', "")
    compilation = compile_plant(tmp_path, plant, backends=("plantuml",))
    assert not [
        artefact for artefact in compilation.artefacts if artefact.path.endswith(".ibd.puml")
    ]


def test_standard_libraries_in_a_plant_are_not_drawn(tmp_path):
    libraries = (
        '<RoleClassLib Name="AutomationMLBaseRoleClassLib"><RoleClass Name="AutomationMLBaseRole"/>'
        "</RoleClassLib>" + ROLES
    )
    compilation = compile_plant(tmp_path, libraries, backends=("plantuml",))
    assert [artefact.path for artefact in compilation.artefacts] == ["diagrams/Shared.bdd.puml"]
    assert list_messages(compilation) == []


# -- packages --------------------------------------------------------------------------------------

RELATIONSHIPS = (
    '<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">'
    '<Relationship Id="R0" Target="/model/plant.aml" '
    'Type="http://schemas.automationml.org/container/relationship/RootDocument"/>'
    '<Relationship Id="R1" Target="/docs/manual.txt" '
    'Type="http://schemas.automationml.org/container/relationship/AnyContent"/></Relationships>'
)


def write_package(folder, text, **foreign):
    path = folder / "plant.amlx"
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("_rels/.rels", RELATIONSHIPS)
        archive.writestr("model/plant.aml", f"{HEAD.format('plant.aml')}{text}</CAEXFile>")
        archive.writestr("docs/manual.txt", "text")
        for name, content in foreign.items():
            archive.writestr(name, content)
    return path


def test_files_of_the_operating_system_in_a_package_are_a_warning(tmp_path):
    foreign = {".DS_Store": "x", "__MACOSX/._plant.aml": "x"}
    compilation = compile_paths(write_package(tmp_path, ROLES, **foreign))
    assert list_messages(compilation) == [
        "SM102: the package 'plant.amlx' contains files of the operating system, which are not "
        "read: '.DS_Store', '__MACOSX/._plant.aml'"
    ]


@pytest.mark.parametrize("uri", ["/docs/manual.txt", "../docs/manual.txt", "docs/manual.txt#p1"])
def test_a_document_in_a_package_is_found(tmp_path, uri):
    package = write_package(tmp_path, REFERENCE_TO_DOCUMENT.format(uri))
    assert list_messages(compile_paths(package)) == []


def test_a_document_that_a_package_lacks_is_reported(tmp_path):
    package = write_package(tmp_path, REFERENCE_TO_DOCUMENT.format("/docs/missing.txt"))
    (finding,) = compile_paths(package).diagnostics
    assert finding.message == "the model refers to a file that does not exist: 'docs/missing.txt'"
    assert finding.subject.place.file == "plant.amlx!model/plant.aml"


# -- folders ---------------------------------------------------------------------------------------


def test_a_folder_is_searched_for_module_type_packages(tmp_path):
    with zipfile.ZipFile(tmp_path / "pump.mtp", "w") as archive:
        archive.writestr("manifest.aml", f"{HEAD.format('manifest.aml')}{ROLES}</CAEXFile>")
    assert list_inputs(compile_paths(tmp_path)) == ["pump.mtp!manifest.aml"]


def test_an_archive_in_a_folder_is_named_if_it_holds_models(tmp_path):
    write_file(tmp_path, "main.aml", ROLES)
    with zipfile.ZipFile(tmp_path / "copy.zip", "w") as archive:
        archive.writestr("plant.aml", f"{HEAD.format('plant.aml')}{ROLES}</CAEXFile>")
        archive.writestr("readme.txt", "text")
    with zipfile.ZipFile(tmp_path / "photos.zip", "w") as archive:
        archive.writestr("pump.jpg", "x")
    (tmp_path / "damaged.zip").write_bytes(b"PK\x03\x04")
    compilation = compile_paths(tmp_path)
    assert list_inputs(compilation) == ["main.aml"]
    assert list_messages(compilation) == [
        "SM103: 'copy.zip' holds models, which are not read: 'plant.aml'"
    ]
