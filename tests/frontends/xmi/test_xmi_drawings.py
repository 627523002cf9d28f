"""Diagrams of authors, as MagicDraw, Papyrus and Enterprise Architect keep them."""

import io
import zipfile
from random import Random

import pytest

from dialects.mutations import mutate
from sysmlc.backends.plantuml import BACKEND
from sysmlc.diagnostics.renderers import make_report
from sysmlc.driver import Request, compile_model
from sysmlc.frontends.xmi.diagrams.common import extend_path
from sysmlc.ir import Edge, Kind

HEAD = (
    '<xmi:XMI xmlns:xmi="http://www.omg.org/spec/XMI/20131001"'
    ' xmlns:uml="http://www.omg.org/spec/UML/20131001">'
)
MAGICDRAW = f"""{HEAD}
<uml:Model xmi:type="uml:Model" xmi:id="m" name="Plant">
 <xmi:Extension extender="MagicDraw UML 19.0"><modelExtension>
  <ownedDiagram xmi:type="uml:Diagram" xmi:id="d" name="Gates" ownerOfDiagram="m" context="gate">
   <xmi:Extension><diagramRepresentation>
    <diagram:DiagramRepresentationObject xmlns:diagram="x" type="SysML Block Definition Diagram"
        umlType="Class Diagram" diagramProperties="3c 3f">
     <diagramContents><binaryObject streamContentID="BINARY-1"/>
      <usedElements>gate</usedElements><usedElements>item</usedElements>
      <usedElements>lift</usedElements><usedElements>up</usedElements>
      <usedElements>gone</usedElements>
     </diagramContents>
    </diagram:DiagramRepresentationObject>
   </diagramRepresentation></xmi:Extension>
  </ownedDiagram>
 </modelExtension></xmi:Extension>
 <packagedElement xmi:type="uml:Class" xmi:id="gate" name="Gate">
  <generalization xmi:type="uml:Generalization" xmi:id="up">
   <general xmi:idref="lift"/></generalization>
  <generalization xmi:type="uml:Generalization" xmi:id="up2" general="other"/>
  <ownedAttribute xmi:type="uml:Property" xmi:id="item" name="item"/>
  <ownedAttribute xmi:type="uml:Port" xmi:id="in" name="in"/>
 </packagedElement>
 <packagedElement xmi:type="uml:Class" xmi:id="lift" name="Lift"/>
 <packagedElement xmi:type="uml:Class" xmi:id="other" name="Other"/>
</uml:Model>
%s</xmi:XMI>
"""
SHAPES = """<?xml version='1.0' encoding='UTF-8'?>
<mdOwnedViews>
 <mdElement elementClass='DiagramFrame'><elementID xmi:idref='d'/></mdElement>
 <mdElement elementClass='Class'><elementID xmi:idref='gate'/><geometry>1, 2, 3, 4</geometry>
  <mdOwnedViews><mdElement elementClass='Port'><elementID href='Plant.mdzip#in'/></mdElement>
  </mdOwnedViews>
 </mdElement>
 <mdElement elementClass='Class'><elementID xmi:idref='lift'/></mdElement>
 <mdElement elementClass='Generalization'><elementID xmi:idref='up'/></mdElement>
</mdOwnedViews>
"""
ENTRY = "com.nomagic.magicdraw.uml_model.model"


def archive(path, shapes, model=MAGICDRAW % ""):
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as entries:
        entries.writestr(ENTRY, model)
        entries.writestr("BINARY-1", shapes)
        entries.writestr("BINARY-2", b"PK\x03\x04 no xml")
    path.write_bytes(packed.getvalue())
    return path


def compile_diagrams(path, diagrams="author"):
    asked = Request(inputs=(path,), diagrams=diagrams, backends=(BACKEND,), verify_each=True)
    compilation = compile_model(asked)
    assert "SM900" not in codes(compilation)
    assert "SM901" not in codes(compilation)
    return compilation


def codes(compilation):
    return [diagnostic.rule.code for diagnostic in compilation.diagnostics]


def view(compilation):
    views = compilation.graph.of_kind(Kind.VIEW)
    (diagram,) = [view for view in views if view.subkind == "diagram"]
    return diagram


def list_shown(compilation, edge=Edge.REFERENCES):
    return [target.id for target in compilation.graph.targets(view(compilation), edge)]


# -- MagicDraw ---------------------------------------------------------------------------------


def in_archive(folder):
    return archive(folder / "plant.mdzip", SHAPES)


def in_one_file(folder):
    shapes = SHAPES.partition("\n")[2]
    part = (
        f"<xmi:Extension><filePart name='BINARY-1' type='XML'>{shapes}</filePart></xmi:Extension>"
    )
    path = folder / "plant.xml"
    path.write_text(MAGICDRAW % part)
    return path


@pytest.mark.parametrize("write", [in_archive, in_one_file])
def test_diagrams_of_magicdraw_have_names_types_contents_and_nesting(tmp_path, write):
    compilation = compile_diagrams(write(tmp_path))
    diagram = view(compilation)
    assert (diagram.name, diagram.owner) == ("Gates", "m")
    assert diagram.attrs == {
        "subkind": "diagram",
        "diagram": "bdd",
        "diagram_type": "SysML Block Definition Diagram",
        "nesting": (("gate", "in"),),
        "listed": ("item",),
        "relations": (("specializes", "gate", "lift"),),
    }
    assert list_shown(compilation) == ["gate", "in", "lift", "item"]
    assert list_shown(compilation, Edge.REPRESENTS) == ["gate"]


def test_missing_elements_are_reported_at_the_diagram(tmp_path):
    compilation = compile_diagrams(in_one_file(tmp_path))
    (diagnostic,) = [item for item in compilation.diagnostics if item.rule.code == "SM162"]
    assert diagnostic.message == (
        "diagram 'Gates' shows 5 elements, 1 of them from no file of the unit"
    )
    assert diagnostic.subject.name == "Plant::Gates"
    assert diagnostic.subject.place.ordinal == 4


def test_derived_diagrams_read_no_shapes(tmp_path):
    compilation = compile_diagrams(archive(tmp_path / "plant.mdzip", "<damaged"), "derived")
    assert compilation.graph.of_kind(Kind.VIEW) == []
    assert not any(code.startswith("SM1") for code in codes(compilation))


@pytest.mark.parametrize(
    "shapes",
    [
        "<mdOwnedViews><mdElement>",
        '<!DOCTYPE x [<!ENTITY e SYSTEM "file:///etc/passwd">]><mdOwnedViews>&e;</mdOwnedViews>',
        "<mdOwnedViews>&undefined;</mdOwnedViews>",
    ],
)
def test_damaged_shapes_are_reported_and_the_rest_is_read(tmp_path, shapes):
    compilation = compile_diagrams(archive(tmp_path / "plant.mdzip", shapes))
    (diagnostic,) = [item for item in compilation.diagnostics if item.rule.code == "SM161"]
    assert diagnostic.subject.place.file == "plant.mdzip!BINARY-1"
    assert list_shown(compilation) == ["gate", "item", "lift"]


def test_an_entry_that_is_no_xml_has_no_shapes(tmp_path):
    compilation = compile_diagrams(archive(tmp_path / "plant.mdzip", b"PK\x03\x04 a document"))
    assert "SM161" not in codes(compilation)
    assert "nesting" not in view(compilation).attrs


def test_a_damaged_model_is_reported_once(tmp_path):
    path = tmp_path / "plant.xml"
    path.write_text((MAGICDRAW % "")[:-20])
    assert codes(compile_diagrams(path)) == ["SM100"]


def test_shapes_nested_beyond_the_limit(tmp_path):
    deep = "<mdElement><elementID xmi:idref='gate'/>" * 50_000 + "</mdElement>" * 50_000
    compilation = compile_diagrams(
        archive(tmp_path / "plant.mdzip", f"<mdOwnedViews>{deep}</mdOwnedViews>")
    )
    assert list_shown(compilation) == ["gate", "item", "lift"]


# -- Papyrus -----------------------------------------------------------------------------------

PAPYRUS = """<?xml version="1.0" encoding="UTF-8"?>
<xmi:XMI xmlns:xmi="http://www.omg.org/spec/XMI/20131001" xmlns:uml="http://www.eclipse.org/uml2/5.0.0/UML">
 <uml:Model xmi:id="m" name="Plant">
  <packagedElement xmi:type="uml:Class" xmi:id="gate" name="Gate">
   <generalization xmi:id="up" general="lift"/>
   <ownedAttribute xmi:type="uml:Port" xmi:id="in" name="in"/>
   <ownedAttribute xmi:id="item" name="item"/>
  </packagedElement>
  <packagedElement xmi:type="uml:Class" xmi:id="lift" name="Lift"/>
 </uml:Model>
</xmi:XMI>
"""
NOTATION = """<?xml version="1.0" encoding="UTF-8"?>
<xmi:XMI xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI"
  xmlns:notation="http://www.eclipse.org/gmf/runtime/1.0.3/notation"
  xmlns:uml="http://www.eclipse.org/uml2/5.0.0/UML" xmlns:style="http://style">
 <notation:Diagram xmi:id="_d" type="PapyrusUMLClassDiagram" name="Gates">
  <children xmi:type="notation:Shape" type="Class_Shape">
   <children xmi:type="notation:DecorationNode" type="StereotypeLabel">
    <element xmi:type="uml:Stereotype" href="pathmap://X/SysML.profile.uml#Block"/>
   </children>
   <children xmi:type="notation:BasicCompartment" visible="false" type="Class_AttributeCompartment">
    <children type="Property_ClassAttributeLabel"><element href="plant.uml#item"/></children>
   </children>
   <children xmi:type="notation:Shape" type="Class_Port"><element href="plant.uml#in"/></children>
   <element xmi:type="uml:Class" href="plant.uml#gate"/>
  </children>
  <children xmi:type="notation:Shape" type="Class_Shape"><element href="plant.uml#lift"/></children>
  <styles xmi:type="style:PapyrusDiagramStyle"
    diagramKindId="org.eclipse.papyrus.sysml16.diagram.blockdefinition">
   <owner xmi:type="uml:Model" href="plant.uml#m"/>
  </styles>
  <element xmi:type="uml:Class" href="plant.uml#gate"/>
  <edges xmi:type="notation:Connector" type="Generalization_Edge">
   <element href="plant.uml#up"/></edges>
 </notation:Diagram>
</xmi:XMI>
"""


def papyrus(folder, notation=NOTATION):
    (folder / "plant.uml").write_text(PAPYRUS)
    (folder / "plant.notation").write_text(notation)
    return folder / "plant.uml"


def test_diagrams_of_papyrus_show_the_visible_nodes_of_the_notation_file(tmp_path):
    compilation = compile_diagrams(papyrus(tmp_path))
    diagram = view(compilation)
    assert (diagram.name, diagram.owner, diagram.source) == ("Gates", "m", "plant.notation")
    assert diagram.attrs["diagram"] == "bdd"
    assert diagram.attrs["relations"] == (("specializes", "gate", "lift"),)
    assert diagram.attrs["nesting"] == (("gate", "in"),)
    assert sorted(list_shown(compilation)) == ["gate", "in", "lift"]
    assert list_shown(compilation, Edge.REPRESENTS) == ["gate"]
    assert "SM162" not in codes(compilation)


def test_the_notation_file_is_an_input_only_when_it_is_read(tmp_path):
    compilation = compile_diagrams(papyrus(tmp_path))
    assert [item.path for item in compilation.inputs] == ["plant.uml", "plant.notation"]
    assert [item.path for item in compile_diagrams(papyrus(tmp_path), "derived").inputs] == [
        "plant.uml"
    ]


def test_a_damaged_notation_file_is_reported_where_it_is_damaged(tmp_path):
    compilation = compile_diagrams(papyrus(tmp_path, NOTATION.replace("</styles>", "</style>")))
    (diagnostic,) = [
        item
        for item in make_report(compilation.diagnostics, compilation.sources).findings
        if item.diagnostic.rule.code == "SM161"
    ]
    assert diagnostic.where.startswith("plant.notation:20:5")
    assert diagnostic.xpath.startswith("/xmi:XMI/notation:Diagram[1]/styles[1]")


def test_a_notation_file_that_links_out_of_the_folder_is_skipped(tmp_path):
    (tmp_path / "models").mkdir()
    path = papyrus(tmp_path / "models")
    (tmp_path / "models" / "plant.notation").rename(tmp_path / "secret.notation")
    (tmp_path / "models" / "plant.notation").symlink_to(tmp_path / "secret.notation")
    assert compile_diagrams(path).graph.of_kind(Kind.VIEW) == []


def test_a_folder_instead_of_the_notation_file_is_skipped(tmp_path):
    (tmp_path / "plant.uml").write_text(PAPYRUS)
    (tmp_path / "plant.notation").mkdir()
    assert compile_diagrams(tmp_path / "plant.uml").graph.of_kind(Kind.VIEW) == []


# -- Enterprise Architect ----------------------------------------------------------------------

EA = f"""{HEAD}
<uml:Model xmi:type="uml:Model" xmi:id="m" name="EA_Model">
 <packagedElement xmi:type="uml:Package" xmi:id="EAPK_1" name="Plant">
  <packagedElement xmi:type="uml:Class" xmi:id="EAID_1" name="Gate">
   <generalization xmi:type="uml:Generalization" xmi:id="EAID_3" general="EAID_2"/>
  </packagedElement>
  <packagedElement xmi:type="uml:Class" xmi:id="EAID_2" name="Lift"/>
 </packagedElement>
</uml:Model>
<xmi:Extension extender="Enterprise Architect" extenderID="6.5">
 <diagrams><diagram xmi:id="EAID_D">
  <model package="EAPK_1" localID="1" owner="EAPK_1"/>
  <properties name="Gates" type="Logical"/>
  <style2 value="MDGDgm=SysML1.4::BlockDefinition;HideQuals=0"/>
  <elements><element geometry="Left=1;" subject="EAID_1" seqno="1"/>
   <element geometry="Left=2;" subject="EAID_2" seqno="2"/>
   <element geometry="SX=0;" subject="EAID_3"/></elements>
 </diagram></diagrams>
</xmi:Extension></xmi:XMI>
"""


def test_enterprise_architect_lists_what_is_shown_and_no_features(tmp_path):
    (tmp_path / "plant.xmi").write_text(EA)
    compilation = compile_diagrams(tmp_path / "plant.xmi")
    diagram = view(compilation)
    assert (diagram.name, diagram.owner, diagram.attrs["diagram"]) == ("Gates", "EAPK_1", "bdd")
    assert list_shown(compilation) == ["EAID_1", "EAID_2"]
    assert diagram.attrs["relations"] == (("specializes", "EAID_1", "EAID_2"),)
    assert "SM162" not in codes(compilation)


# -- damage ------------------------------------------------------------------------------------


@pytest.mark.parametrize("seed", range(40))
def test_damaged_diagrams_cause_no_internal_error(tmp_path, seed):
    random = Random(seed)

    def spoilt(text):
        return mutate(text.encode(), random)[1]

    compile_diagrams(
        archive(tmp_path / "a.mdzip", spoilt(SHAPES.replace("xmi:", "")), MAGICDRAW % "")
    )
    compile_diagrams(archive(tmp_path / "b.mdzip", SHAPES, spoilt(MAGICDRAW % "")))
    (tmp_path / "plant.uml").write_bytes(spoilt(PAPYRUS))
    (tmp_path / "plant.notation").write_bytes(spoilt(NOTATION))
    compile_diagrams(tmp_path / "plant.uml")
    (tmp_path / "plant.xmi").write_bytes(spoilt(EA))
    compile_diagrams(tmp_path / "plant.xmi")


@pytest.mark.parametrize(
    ("path", "id", "extended"),
    [
        ((), "a", ("a",)),
        (("a",), "b", ("a", "b")),
        (("a",), "a", ("a",)),
        (("a", "b"), "a", ("a", "b", "a")),
    ],
)
def test_two_shapes_of_one_element_are_one_step_of_a_path(path, id, extended):
    assert extend_path(path, id) == extended
