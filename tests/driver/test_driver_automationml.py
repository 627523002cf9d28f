"""AutomationML through the driver: files that aliases lead to, folders, external data, diagrams."""

from sysmlc.driver import Request, compile_model, select_backends

HEAD = '<CAEXFile xmlns="http://www.dke.de/CAEX" SchemaVersion="3.0" FileName="{}">'
ROLES = '<RoleClassLib Name="Shared"><RoleClass Name="Base"/></RoleClassLib>'
USER = (
    '<ExternalReference Path="libs/roles.aml" Alias="Al"/><RoleClassLib Name="Roles">'
    '<RoleClass Name="Gate" RefBaseClassPath="Al@Shared/Base"/></RoleClassLib>'
)


def write(folder, name, body):
    path = folder / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(f"{HEAD.format(path.name)}{body}</CAEXFile>")
    return path


def build(*paths, backends=()):
    chosen = tuple(select_backends(backends)) if backends else ()
    return compile_model(Request(inputs=paths, backends=chosen))


def told(made):
    """The diagnostics, without the one that these files have no plant (SM158)."""
    rows = [f"{diagnostic.rule.code}: {diagnostic.message}" for diagnostic in made.diagnostics]
    return [row for row in rows if not row.startswith("SM158")]


def test_files_that_aliases_lead_to_are_part_of_the_unit(tmp_path):
    write(tmp_path, "libs/roles.aml", ROLES)
    made = build(write(tmp_path, "main.aml", USER))
    assert [(file.path, file.language) for file in made.inputs] == [
        ("libs/roles.aml", "caex"),
        ("main.aml", "caex"),
    ]
    assert told(made) == []


def test_files_outside_of_the_folder_of_the_model_are_not_opened(tmp_path):
    write(tmp_path, "roles.aml", ROLES)
    user = USER.replace("libs/roles.aml", "../roles.aml")
    made = build(write(tmp_path, "plant/main.aml", user))
    assert [file.path for file in made.inputs] == ["main.aml"]
    assert told(made) == [
        "SM132: the file '../roles.aml' is not part of the compile unit; "
        "1 element refers to classes of it"
    ]


def test_aliases_that_lead_round_in_a_circle_end(tmp_path):
    back = '<ExternalReference Path="../main.aml" Alias="Back"/>'
    write(tmp_path, "libs/roles.aml", back + ROLES)
    made = build(write(tmp_path, "main.aml", USER))
    assert [file.path for file in made.inputs] == ["libs/roles.aml", "main.aml"]
    assert told(made) == []


def test_a_folder_is_searched_for_automationml(tmp_path):
    write(tmp_path, "a.aml", ROLES)
    write(tmp_path, "b.caex", USER.replace("libs/roles.aml", "a.aml"))
    assert [file.path for file in build(tmp_path).inputs] == ["a.aml", "b.caex"]


DATA = (
    '<InstanceHierarchy Name="P"><InternalElement Name="i" ID="1"><ExternalInterface Name="d" '
    'ID="2" RefBaseClassPath="AutomationMLInterfaceClassLib/AutomationMLBaseInterface/'
    'ExternalDataConnector/COLLADAInterface"><Attribute Name="refURI" '
    'AttributeDataType="xs:anyURI"><Value>{}</Value></Attribute></ExternalInterface>'
    "</InternalElement></InstanceHierarchy>"
)


def test_external_data_that_is_not_there_is_told_at_its_place(tmp_path):
    made = build(write(tmp_path, "main.aml", DATA.format("file:///geo/gate.dae#n1")))
    assert told(made) == ["SM148: the model refers to a file that does not exist: 'geo/gate.dae'"]
    (found,) = made.diagnostics
    data = made.sources[0].data
    assert data[found.subject.place.offset :].startswith(b'<Attribute Name="refURI"')


def test_external_data_that_is_there_or_elsewhere_is_nothing_to_tell(tmp_path):
    (tmp_path / "geo").mkdir()
    (tmp_path / "geo" / "gate.dae").write_text("<COLLADA/>")
    for href in ("file:///geo/gate.dae#n1", "geo/gate.dae", "https://a.b/gate.dae", "Skill 1"):
        assert told(build(write(tmp_path, "main.aml", DATA.format(href)))) == []


GATE = (
    '<InstanceHierarchy Name="Site"><InternalElement Name="line" ID="1" '
    'RefBaseSystemUnitPath="Lib/Line"><ExternalInterface Name="way" ID="2"/>'
    '<InternalElement Name="gate" ID="3"><ExternalInterface Name="p" ID="4"/></InternalElement>'
    '<InternalLink Name="l" RefPartnerSideA="2" RefPartnerSideB="4"/>'
    "</InternalElement></InstanceHierarchy>"
    '<InterfaceClassLib Name="I"><InterfaceClass Name="P"/></InterfaceClassLib>'
    '<SystemUnitClassLib Name="Lib"><SystemUnitClass Name="Line">'
    '<ExternalInterface Name="way" ID="5" RefBaseClassPath="I/P"/>'
    '<InternalElement Name="gate" ID="6">'
    '<ExternalInterface Name="p" ID="7" RefBaseClassPath="I/P"/>'
    "</InternalElement></SystemUnitClass></SystemUnitClassLib>"
)


def test_an_instance_with_links_frames_an_internal_block_diagram(tmp_path):
    made = build(write(tmp_path, "main.aml", GATE), backends=("plantuml",))
    (ibd,) = [a for a in made.artefacts if a.path.endswith(".ibd.puml")]
    lines = ibd.text[ibd.text.index("mainframe ibd") :].splitlines()
    assert lines[0] == "mainframe ibd [block] line : Line"
    assert [line for line in lines if line.startswith(("port", "rectangle"))] == [
        'rectangle " " as line_1 <<frame>> {',
        'portin "<back:#FFFFFF>way</back>" as way_1',
        'rectangle "**gate : gate**" as gate_1 <<part>> {',
        'portin "<back:#FFFFFF>p</back>" as p_1',
    ]
    assert "way_1 -- p_1 : l" in lines
    assert told(made) == []


def test_values_of_an_instance_and_its_parts_stand_in_its_diagram(tmp_path):
    length = '<Attribute Name="length" AttributeDataType="xs:double">{}</Attribute>'
    value = length.format("<Value>1.2</Value>")
    body = GATE
    for id, text in (
        ("5", length.format("")),
        ("7", length.format("")),
        ("2", value),
        ("4", value),
    ):
        name = "way" if id in "52" else "p"
        port = f'<ExternalInterface Name="{name}" ID="{id}"'
        body = body.replace(port, text + port)
    made = build(write(tmp_path, "main.aml", body), backends=("plantuml",))
    (ibd,) = [a for a in made.artefacts if a.path.endswith(".ibd.puml")]
    boxes = [line for line in ibd.text.splitlines() if line.startswith("rectangle")]
    assert ["length = 1.2" in box for box in boxes] == [True, True]
    assert not [a for a in made.artefacts if "Site.bdd" in a.path]
    assert told(made) == []


def test_an_instance_without_links_frames_none(tmp_path):
    body = GATE.replace('<InternalLink Name="l" RefPartnerSideA="2" RefPartnerSideB="4"/>', "")
    made = build(write(tmp_path, "main.aml", body), backends=("plantuml",))
    assert not [a for a in made.artefacts if a.path.endswith(".ibd.puml")]


def test_standard_libraries_that_a_plant_holds_are_not_drawn(tmp_path):
    libraries = (
        '<RoleClassLib Name="AutomationMLBaseRoleClassLib"><RoleClass Name="AutomationMLBaseRole"/>'
        "</RoleClassLib>" + ROLES
    )
    made = build(write(tmp_path, "main.aml", libraries), backends=("plantuml",))
    assert [a.path for a in made.artefacts] == ["diagrams/Shared.bdd.puml"]
    assert told(made) == []
