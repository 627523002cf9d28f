"""Stereotypes: definitions, applications, and what ties one to the other."""

from reading_xmi import PAPYRUS, below_model, magicdraw, papyrus, read, source

PROFILE = PAPYRUS % (
    """<uml:Profile xmi:id="pr" name="Plant">
  <eAnnotations xmi:id="e" source="http://www.eclipse.org/uml2/2.0.0/UML">
    <contents xmi:type="ecore:EPackage" xmi:id="ep" name="Plant" nsURI="http://plant/profile"/>
  </eAnnotations>
  <packagedElement xmi:type="uml:Stereotype" xmi:id="st" name="Service">
    <generalization xmi:id="g"><general xmi:type="uml:Stereotype"
      href="pathmap://P/SysML.profile.uml#SysML.stereotype_packagedElement_FullPort"/>
    </generalization>
    <ownedAttribute xmi:id="b" name="base_Port" association="x"><type xmi:type="uml:Class"
      href="pathmap://UML_METAMODELS/UML.metamodel.uml#Port"/></ownedAttribute>
    <ownedAttribute xmi:id="rate" name="rate"/>
  </packagedElement>
  <packagedElement xmi:type="uml:Extension" xmi:id="x" memberEnd="b y">
    <ownedEnd xmi:type="uml:ExtensionEnd" xmi:id="y" type="st"/></packagedElement>
</uml:Profile>"""
)

PORT = """<packagedElement xmi:type="uml:Class" xmi:id="k" name="K">
  <ownedAttribute xmi:type="uml:Port" xmi:id="p" name="p"/></packagedElement>"""


def test_definitions():
    reading = read(source(PROFILE, "plant.profile.uml"))
    assert (
        below_model(reading)
        == """\
Stereotype st "Service"
  ?> specializes pathmap://P/SysML.profile.uml#SysML.stereotype_packagedElement_FullPort \
Stereotype "FullPort"
  ?> extends pathmap://UML_METAMODELS/UML.metamodel.uml#Port Class "Port"
  Property rate "rate"
"""
    )
    assert reading.totals == {
        "elements": 12,
        "mapped": 8,
        "ignored_notation": 2,
        "external": 2,
    }


def test_an_application_knows_its_stereotype_and_its_tags():
    model = papyrus(
        PORT,
        '<Plant:Service xmi:id="a" base_Port="p" base_Element="p" rate="4" owner="k">'
        "<note>one</note><note>two</note></Plant:Service>",
    )
    for order in ((source(PROFILE, "plant.profile.uml"), model), (model,)):
        application = read(*order).graph["a"]
        assert application.owner == "p"
        assert application.attrs == {
            "stereotype": "Service",
            "namespace": "http://plant/profile",
            "tag.rate": "4",
            "tag.owner": "k",
            "tag.note": ("one", "two"),
        }
    graph = read(source(PROFILE, "plant.profile.uml"), model).graph
    assert [e.id for e in graph.targets(graph["a"], "instance-of")] == ["st"]
    assert [(r.edge, r.target) for r in graph.pending if r.source == "a"] == [("subject", "p")]


def test_an_application_may_name_its_base_by_a_child():
    reading = read(
        magicdraw(PORT, "<sysml:FlowPort xmi:id='a'><base_Port xmi:idref='p'/></sysml:FlowPort>")
    )
    assert reading.graph["a"].owner == "p"


def test_an_application_without_id_gets_a_stable_one():
    model = papyrus(PORT, '<Blocks:Block base_Class="k"/>')
    ids = {read(model).graph.of_kind("Application")[0].id for _ in range(2)}
    assert len(ids) == 1


def test_stereotypes_of_diagrams_are_notation():
    reading = read(
        magicdraw(
            "", "<MagicDraw_Profile:DiagramInfo xmi:id='a' base_Diagram='d' Author='someone'/>"
        )
    )
    assert reading.findings == []
    assert reading.totals == {"elements": 5, "mapped": 2, "ignored_notation": 3}


def test_an_application_to_nothing_is_reported():
    reading = read(papyrus(PORT, '<Blocks:Block xmi:id="a" base_Class="gone"/>'))
    assert reading.findings == [
        "stereotype-without-element: stereotype 'Block' is applied once to elements that are "
        "not in the model"
    ]
    assert read(papyrus(PORT, '<Blocks:Block xmi:id="a" base_Class="k"/>')).findings == []


def test_profiles_that_enterprise_architect_keeps_beside_the_model():
    """In windows-1252, with two versions of XMI, ids with spaces, and ids used once a profile."""
    profile = """<uml:Profile xmlns:xmi="http://www.omg.org/spec/XMI/20161101" xmi:id="{0}"
      name="{0}"><ownedComment xmi:type="uml:Comment" xmi:id="comment01"/>
      <packagedElement xmi:type="uml:Stereotype" xmi:id="{0} Unit" name="{0} Unit"/>
      </uml:Profile>"""
    text = f"""<?xml version="1.0" encoding="windows-1252"?>
<xmi:XMI xmlns:xmi="http://www.omg.org/spec/XMI/20131001"
  xmlns:uml="http://www.omg.org/spec/UML/20161101">
<uml:Model xmi:type="uml:Model" name="Förderer">
  <packagedElement xmi:type="uml:Class" xmi:id="k"><ownedAttribute xmi:type="uml:Property"
    xmi:id="a"><type xmi:idref="EAJava_int"/></ownedAttribute></packagedElement></uml:Model>
<xmi:Extension extender="Enterprise Architect"><elements><element xmi:idref="k"/></elements>
<primitivetypes><packagedElement xmi:type="uml:DataType" xmi:id="EAJava_int" name="int"/>
</primitivetypes><profiles>{profile.format("P")}{profile.format("Q")}</profiles>
</xmi:Extension></xmi:XMI>"""
    reading = read(source(text.encode("windows-1252"), "m.xmi"))
    assert reading.findings == []
    assert [(r.source, r.target) for r in reading.graph.pending] == [("a", "EAJava_int")]
    assert [e.id for e in reading.graph.of_kind("Stereotype")] == ["P Unit", "Q Unit"]
    assert reading.graph.roots()[0].name == "Förderer"
    assert reading.totals == {"elements": 17, "mapped": 12, "ignored_notation": 5}


def test_annotations_of_eclipse_in_a_profile_refer_to_nothing():
    annotation = '<eAnnotations xmi:id="{}" source="http://www.eclipse.org/uml2/2.0.0/UML"/>'
    reading = read(
        papyrus(
            f"""
  <packagedElement xmi:type="uml:Stereotype" xmi:id="s" name="S">
    <ownedAttribute xmi:id="b" name="base_Class" association="e">{annotation.format("n1")}
      <type href="pathmap://UML_METAMODELS/UML.metamodel.uml#Class"/></ownedAttribute>
  </packagedElement>
  <packagedElement xmi:type="uml:Extension" xmi:id="e" memberEnd="x b">{annotation.format("n2")}
    <ownedEnd xmi:type="uml:ExtensionEnd" xmi:id="x" type="s"/></packagedElement>"""
        )
    )
    assert reading.findings == []
