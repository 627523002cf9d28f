"""Enterprise Architect: what it keeps in its extension, mangled stereotypes, windows-1252."""

import pytest
from reading_xmi import below_model, read, source

FILE = """<?xml version='1.0' encoding='windows-1252'?>
<xmi:XMI xmlns:xmi="http://www.omg.org/spec/XMI/20131001"
 xmlns:uml="http://www.omg.org/spec/UML/20161101"
 xmlns:thecustomprofile="http://www.sparxsystems.com/profiles/thecustomprofile/1.0"
 xmlns:Plant="http://www.sparxsystems.com/profiles/Plant/1.0"
 xmlns:SysML1.4="http://www.sparxsystems.com/profiles/SysML1.4/1.4">
<xmi:Documentation exporter="Enterprise Architect" exporterVersion="6.5" exporterID="1704"/>
<uml:Model xmi:type="uml:Model" xmi:id="m" name="EA_Model">{model}</uml:Model>
<xmi:Extension extender="Enterprise Architect" extenderID="6.5">{extension}</xmi:Extension>
{applications}</xmi:XMI>"""
GATE = '<packagedElement xmi:type="uml:Class" xmi:id="EAID_G" name="Gate">{}</packagedElement>'
XREFS = "$XREFPROP=$NAM=Stereotypes$NAM;$DES={}$DES;$ENDXREF;"


def ea(model=GATE, extension="", applications=""):
    text = FILE.format(
        model=model.replace("{}", ""), extension=extension, applications=applications
    )
    return read(source(text.encode("cp1252"), "m.xmi"))


def about(id, content, kind="element"):
    return f'<{kind}s><{kind} xmi:idref="{id}">{content}</{kind}></{kind}s>'


def lines(reading):
    return [line.strip() for line in below_model(reading).splitlines()]


def test_windows_1252_is_read_as_the_file_says():
    reading = ea(GATE.replace("Gate", "T\xfcr \u2013 5 \u20ac"))
    assert reading.graph["EAID_G"].name == "Tür – 5 €"


def test_notes_are_comments():
    reading = ea(extension=about("EAID_G", '<properties documentation="Opens &#xA;slowly"/>'))
    (comment,) = [e for e in reading.graph if e.kind == "Comment"]
    assert comment.attrs["body"] == "Opens \nslowly"
    assert [e.id for e in reading.graph.owned(reading.graph["EAID_G"])] == [comment.id]
    assert reading.findings == []


def test_a_note_that_repeats_a_comment_is_not_added():
    comment = '<ownedComment xmi:type="uml:Comment" xmi:id="n" body="Opens"/>'
    note = about("EAID_G", '<properties documentation="Opens"/>')
    reading = ea(GATE.replace("{}", comment), note)
    assert [e.id for e in reading.graph if e.kind == "Comment"] == ["n"]


def test_notes_of_features_parameters_connectors_and_ends():
    model = GATE.replace(
        "{}",
        '<ownedAttribute xmi:type="uml:Property" xmi:id="EAID_A" name="a"/>'
        '<ownedAttribute xmi:type="uml:Property" xmi:id="EAID_src345_6" name="end"/>'
        '<ownedOperation xmi:id="EAID_O"><ownedParameter xmi:id="EAID_P"/></ownedOperation>',
    )
    model += '<packagedElement xmi:type="uml:Association" xmi:id="EAID_12345_6"/>'
    elements = about(
        "EAID_G",
        '<attributes><attribute xmi:idref="EAID_A"><documentation value="attribute"/></attribute>'
        '</attributes><operations><operation xmi:idref="EAID_O"><documentation value="operation"/>'
        '<parameters><parameter xmi:idref="EAID_P"><documentation value="parameter"/></parameter>'
        "</parameters></operation></operations>",
    )
    connectors = about(
        "EAID_12345_6",
        '<source xmi:idref="EAID_G"><documentation value="end"/></source>'
        '<target xmi:idref="EAID_G"/><documentation value="connector"/>',
        "connector",
    )
    graph = ea(model, elements + connectors).graph
    owners = {e.attrs["body"]: e.owner for e in graph if e.kind == "Comment"}
    assert owners == {
        "attribute": "EAID_A",
        "operation": "EAID_O",
        "parameter": "EAID_P",
        "connector": "EAID_12345_6",
        "end": "EAID_src345_6",
    }


def constraint(values):
    return about("EAID_G", f"<constraints><constraint {values}/></constraints>")


def test_a_note_on_an_event_belongs_to_its_package():
    """An event is no element of the graph; the note of the package itself goes first."""
    model = (
        '<packagedElement xmi:type="uml:Package" xmi:id="EAPK_P" name="Signals"><packagedElement'
        ' xmi:type="uml:TimeEvent" xmi:id="EAID_T" name="tick"/></packagedElement>'
    )
    element = '<element xmi:idref="{}"><properties documentation="{}"/></element>'
    notes = element.format("EAPK_P", "Ours") + element.format("EAID_T", "In seconds")
    graph = ea(model, f"<elements>{notes}</elements>").graph
    comments = graph.owned(graph["EAPK_P"])
    assert [comment.attrs["body"] for comment in comments] == ["Ours", "In seconds"]


@pytest.mark.parametrize(
    ("values", "expected"),
    [
        ('name="speed &lt; 3" type="OCL"', 'body="speed < 3" language="OCL"'),
        (
            'name="slow" type="Invariant" notes="speed is low"',
            'body="speed is low" subkind="invariant"',
        ),
        ('name="open" type="Pre-condition"', 'body="open" subkind="precondition"'),
        (
            'name="open" type="Post-condition" status="Approved"',
            'body="open" subkind="postcondition"',
        ),
        ('name="by hand" type="Process"', 'body="by hand" tag.type="Process"'),
    ],
)
def test_constraints_of_the_extension_are_constraints(values, expected):
    reading = ea(extension=constraint(values))
    (element,) = [e for e in reading.graph if e.kind == "Constraint"]
    assert element.owner == "EAID_G"
    attributes = " ".join(f'{key}="{value}"' for key, value in sorted(element.attrs.items()))
    assert attributes == expected
    assert element.name == ("slow" if "notes" in values else "")
    assert (reading.findings, reading.totals["mapped"]) == ([], 5)


@pytest.mark.parametrize("attribute", ['name="slow"', 'name="other"', ""])
def test_a_constraint_that_the_model_has_is_not_added(attribute):
    model = GATE.replace(
        "{}",
        f'<ownedRule xmi:type="uml:Constraint" xmi:id="r" {attribute}><specification'
        ' xmi:type="uml:OpaqueExpression" body="v &lt; 3"/></ownedRule>',
    )
    extension = constraint('name="slow" type="Invariant" notes="v &lt; 3"')
    assert [e.id for e in ea(model, extension).graph if e.kind == "Constraint"] == ["r"]


def test_a_constraint_without_a_word_or_an_element_is_notation():
    for extension in (constraint('type="OCL"'), constraint('name="x"').replace("EAID_G", "none")):
        reading = ea(extension=extension)
        assert [e for e in reading.graph if e.kind == "Constraint"] == []
        assert reading.totals["mapped"] == 3


def test_tagged_values_without_a_stereotype_belong_to_the_element():
    tags = '<tags><tag xmi:id="t" name="Mass" value="12 kg"/><tag xmi:id="u" name="Empty"/></tags>'
    assert ea(extension=about("EAID_G", tags)).graph["EAID_G"].attrs == {"tag.Mass": "12 kg"}


def test_tagged_values_of_a_stereotype_are_not_repeated():
    tags = '<tags><tag xmi:id="t" name="Plant::maker" value="ACME"/></tags>'
    applied = '<Plant:Robot base_Class="EAID_G" maker="ACME"/>'
    graph = ea(extension=about("EAID_G", tags), applications=applied).graph
    assert graph["EAID_G"].attrs == {}
    (application,) = [e for e in graph if e.kind == "Application"]
    assert application.attrs["tag.maker"] == "ACME"


GUID = "{A059C88E-4BDF-46ec-9651-03CBB56A4410}"


def test_a_tagged_value_may_refer_to_an_element_by_its_guid():
    id = "EAPK_" + GUID[1:-1].replace("-", "_")
    package = f'<packagedElement xmi:type="uml:Package" xmi:id="{id}" name="P"/>'
    applied = f'<Plant:Robot base_Class="EAID_G" cell="{GUID}"/>'
    tags = about("EAID_G", f'<tags><tag xmi:id="t" name="Other" value="{GUID}"/></tags>')
    for model, expected in ((GATE + package, id), (GATE, GUID)):
        graph = ea(model, tags, applied).graph
        (application,) = [e for e in graph if e.kind == "Application"]
        assert application.attrs["tag.cell"] == expected
        assert graph["EAID_G"].attrs == {"tag.Other": expected}


def test_a_mangled_stereotype_has_its_own_name_and_profile():
    graph = ea(
        applications='<thecustomprofile:Plant__Robot_arm base_Class="EAID_G"'
        ' __EAStereoName="Plant::Robot arm" axes="6"/>'
    ).graph
    (application,) = [e for e in graph if e.kind == "Application"]
    assert application.name == "Robot arm"
    assert application.attrs == {
        "stereotype": "Robot arm",
        "namespace": "http://www.sparxsystems.com/profiles/Plant/1.0",
        "tag.axes": "6",
    }


def test_a_stereotype_that_only_the_extension_applies():
    xrefs = XREFS.format("@STEREO;Name=Robot;FQName=Plant::Robot;@ENDSTEREO;")
    graph = ea(extension=about("EAID_G", f'<xrefs value="{xrefs}"/>')).graph
    (application,) = [e for e in graph if e.kind == "Application"]
    assert application.owner == "EAID_G"
    assert application.attrs == {
        "stereotype": "Robot",
        "namespace": "http://www.sparxsystems.com/profiles/Plant/1.0",
    }


def test_a_stereotype_that_the_extension_repeats_is_applied_once():
    xrefs = XREFS.format(
        "@STEREO;Name=Robot;GUID={1};FQName=Plant::Robot;@ENDSTEREO;"
        "@STEREO;Name=Robot arm;FQName=Plant::Robot arm;@ENDSTEREO;"
    )
    applied = (
        '<Plant:Robot base_Class="EAID_G"/>'
        '<Plant:Robot_arm base_Class="EAID_G" __EAStereoName="Robot arm"/>'
    )
    graph = ea(extension=about("EAID_G", f'<xrefs value="{xrefs}"/>'), applications=applied).graph
    assert sorted(e.name for e in graph if e.kind == "Application") == ["Robot", "Robot arm"]


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("block", "Block"),
        ("proxyPort", "ProxyPort"),
        ("flowProperty", "FlowProperty"),
        ("Block", "Block"),
        ("extendedRequirement", "extendedRequirement"),
    ],
)
def test_names_of_sysml_begin_as_the_standard_writes_them(name, expected):
    """Untested with a real file: none was there."""
    graph = ea(applications=f'<SysML1.4:{name} base_Class="EAID_G"/>').graph
    (application,) = [e for e in graph if e.kind == "Application"]
    assert application.attrs == {
        "stereotype": expected,
        "namespace": "http://www.sparxsystems.com/profiles/SysML1.4/1.4",
    }


PROFILE = """<profiles><uml:Profile xmi:id="P1" nsPrefix="Plant" name="Plant">
  <packagedElement xmi:type="uml:Stereotype" xmi:id="Robot" name="Robot"/></uml:Profile>
</profiles>"""
APPLIED = """<profileApplication xmi:type="uml:ProfileApplication" xmi:id="a">
  <appliedProfile xmi:type="uml:Profile"
    href="http://www.sparxsystems.com/profiles/Plant/1.0#P1"/></profileApplication>"""


def test_an_applied_profile_is_the_one_in_the_extension():
    reading = ea(GATE + APPLIED, PROFILE, '<Plant:Robot base_Class="EAID_G"/>')
    graph = reading.graph
    assert [(r.source, r.target) for r in graph.pending if r.edge == "applies"] == [("m", "P1")]
    (application,) = [e for e in graph if e.kind == "Application"]
    assert [e.id for e in graph.targets(application, "instance-of")] == ["Robot"]


def test_primitive_types_of_a_language_are_those_of_uml():
    types = """<primitivetypes><packagedElement xmi:type="uml:Package" xmi:id="EAJavaTypesPackage">
      <packagedElement xmi:type="uml:PrimitiveType" xmi:id="EAJava_int" name="int"/>
      </packagedElement></primitivetypes>"""
    attribute = (
        '<ownedAttribute xmi:type="uml:Property" xmi:id="EAID_A" name="a">'
        '<type xmi:idref="EAJava_int"/></ownedAttribute>'
    )
    graph = ea(GATE.replace("{}", attribute), types).graph
    (reference,) = [r for r in graph.pending if r.edge == "typed-by"]
    assert reference.target == "http://www.omg.org/spec/UML/20161101/PrimitiveTypes.xmi#int"


def test_the_rest_of_the_extension_is_counted_as_notation():
    style = '<project author="me"/><style appearance="BackColor=-1"/><code gentype="Java"/>'
    reading = ea(extension=about("EAID_G", style))
    assert reading.totals == {"elements": 10, "mapped": 3, "ignored_notation": 7}
    assert lines(reading) == ['Class EAID_G "Gate"']


def test_extensions_of_other_tools_are_not_read():
    text = FILE.format(
        model=GATE.replace("{}", ""),
        extension=about("EAID_G", '<properties documentation="not for us"/>'),
        applications="",
    ).replace('extender="Enterprise Architect"', 'extender="Another"')
    assert [e.kind for e in read(source(text.encode("cp1252"))).graph] == ["Package", "Class"]


def test_an_export_in_xmi_2_1_is_read_the_same():
    """UML 2.1 in XMI 2.1, with the applications before the extension."""
    note = about("EAID_G", '<properties documentation="Opens"/>')
    applied = '<Plant:Robot base_Class="EAID_G" axes="6"/>'
    new = ea(extension=note, applications=applied)
    text = FILE.format(model=GATE.replace("{}", ""), extension=note, applications="")
    for old, other in (
        ("http://www.omg.org/spec/XMI/20131001", "http://schema.omg.org/spec/XMI/2.1"),
        ("http://www.omg.org/spec/UML/20161101", "http://schema.omg.org/spec/UML/2.1"),
        ("<xmi:XMI ", '<xmi:XMI xmi:version="2.1" '),
        ("<xmi:Extension ", f"{applied}<xmi:Extension "),
    ):
        assert old in text
        text = text.replace(old, other)
    legacy = read(source(text.encode("cp1252"), "m.xmi"))
    assert legacy.findings == []
    assert content(legacy.graph) == content(new.graph)


@pytest.mark.parametrize("name", ["id", "type", "idref"])
def test_a_file_may_mix_two_versions_of_xmi(name):
    """Attributes of the older one count as those of the newer, whichever prefix they have."""
    tank = '<packagedElement xmi:type="uml:Class" xmi:id="EAID_T" name="Tank"/>'
    owned = '<ownedAttribute xmi:type="uml:Property" xmi:id="EAID_P"><type xmi:idref="EAID_T"/>'
    model = GATE.format(f"{owned}</ownedAttribute>") + tank
    text = FILE.format(model=model, extension="", applications="")
    mixed = text.replace(model, model.replace(f"xmi:{name}=", f"old:{name}=")).replace(
        "<xmi:XMI ", '<xmi:XMI xmlns:old="http://schema.omg.org/spec/XMI/2.1" ', 1
    )
    readings = [read(source(xmi.encode("cp1252"), "m.xmi")) for xmi in (text, mixed)]
    assert readings[1].findings == []
    assert readings[0].text == readings[1].text


def content(graph):
    return sorted((e.kind, e.name, e.owner or "", str(sorted(e.attrs.items()))) for e in graph)
