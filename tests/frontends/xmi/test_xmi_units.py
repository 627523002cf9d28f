"""Units of value types in every version of SysML and every tool's way of writing them."""

import pytest
from reading_xmi import Read, magicdraw, papyrus

from sysmlc.diagnostics import Sink
from sysmlc.ir import Kind
from sysmlc.ir.query.classifiers import quantity_kind_of, unit_of
from sysmlc.ir.text import print_text
from sysmlc.passes import pipeline

MASS = (
    '<packagedElement xmi:type="uml:DataType" xmi:id="mass" name="Mass"/>'
    '<packagedElement xmi:type="uml:Class" xmi:id="gate" name="Gate">'
    '<ownedAttribute xmi:type="uml:Property" xmi:id="load" name="load" type="mass"/>'
    "</packagedElement>"
)
KG = '<packagedElement xmi:type="uml:InstanceSpecification" xmi:id="kg" name="kilogram">'
SYMBOL = (
    '<slot xmi:type="uml:Slot" xmi:id="s1"><definingFeature href="%s#x_ownedAttribute_symbol"/>'
    '<value xmi:type="uml:LiteralString" xmi:id="v1" value="kg"/></slot>'
)
LIBRARY = "pathmap://SysML16_LIBRARIES/SysML-Standard-Library.uml"
UNIT_CLASS = (
    f'<classifier xmi:type="uml:Class" href="{LIBRARY}#SysML.package_packagedElement_Libraries'
    '.package_packagedElement_UnitAndQuantityKind.class_packagedElement_Unit"/>'
)


def measured(source, sink=None):
    """Unit and quantity kind of the property ``load`` (names), and the refined graph."""
    graph = Read([source]).graph
    pipeline.build_pipeline(("resolve", "inherit", "classify", "ports")).run(
        graph, sink or Sink(), verify_each=True
    )
    load = graph["load"]
    measures = unit_of(graph, load), quantity_kind_of(graph, load)
    return [element.name if element else None for element in measures], graph


def test_an_instance_of_the_librarys_unit():
    unit = KG + UNIT_CLASS + SYMBOL % LIBRARY + "</packagedElement>"
    value_type = '<Blocks:ValueType xmi:id="a" base_DataType="mass" unit="kg"/>'
    names, graph = measured(papyrus(MASS + unit, value_type))
    assert names == ["kilogram", None]
    assert graph["kg"].role == "unit"
    assert graph["kg"].attrs["symbol"] == "kg"


def test_a_stereotyped_instance_as_sysml_1_2_has_it():
    unit = KG + "</packagedElement>"
    kind = '<packagedElement xmi:type="uml:InstanceSpecification" xmi:id="k" name="mass"/>'
    applications = (
        '<Blocks:ValueType xmi:id="a" base_DataType="mass" unit="b"/>'
        '<Blocks:Unit xmi:id="b" base_InstanceSpecification="kg" quantityKind="c" symbol="kg"/>'
        '<Blocks:QuantityKind xmi:id="c" base_InstanceSpecification="k"/>'
    )
    names, graph = measured(papyrus(MASS + unit + kind, applications))
    assert names == ["kilogram", "mass"]
    assert (graph["kg"].role, graph["k"].role) == ("unit", "quantity kind")
    assert graph["kg"].attrs["symbol"] == "kg"


def test_a_data_type_as_sysml_1_0_has_it():
    unit = '<packagedElement xmi:type="uml:DataType" xmi:id="kg" name="kilogram"/>'
    kind = '<packagedElement xmi:type="uml:DataType" xmi:id="k" name="mass"/>'
    applications = (
        '<Blocks:ValueType xmi:id="a" base_DataType="mass" unit="b" dimension="c"/>'
        '<Blocks:Unit xmi:id="b" base_DataType="kg" dimension="c"/>'
        '<Blocks:Dimension xmi:id="c" base_DataType="k"/>'
    )
    names, _ = measured(papyrus(MASS + unit + kind, applications))
    assert names == ["kilogram", "mass"]


def test_a_unit_of_a_missing_library_is_a_named_stub():
    application = (
        "<sysml:ValueType xmi:id='a' base_DataType='mass'>"
        "<unit href='ISO-80000.mdzip#_18_0beta_903028d_1388650199539_575789_174162'>"
        "<xmi:Extension extender='MagicDraw UML 19.0'><referenceExtension "
        "referentPath='ISO-80000::Units::kilogram' referentType='InstanceSpecification'/>"
        "</xmi:Extension></unit>"
        "<quantityKind href='pathmap://QUDV/lib.uml#_mass'/></sysml:ValueType>"
    )
    names, graph = measured(magicdraw(MASS, application))
    assert names[0] == "kilogram"
    (unit,) = [item for item in graph.of_kind(Kind.INSTANCE) if item.attrs.get("external")]
    assert unit.role == "unit"
    (kind,) = graph.of_kind(Kind.QUANTITY_KIND)
    assert kind.attrs["external"] is True


def test_plain_text_is_a_unit_of_its_own():
    application = '<Blocks:ValueType xmi:id="a" base_DataType="mass" unit="kg"/>'
    names, graph = measured(papyrus(MASS, application))
    assert names == ["kg", None]
    (unit,) = graph.of_kind(Kind.UNIT)
    assert (unit.owner, unit.attrs) == ("mass", {"origin": "a"})


def test_a_broken_reference_is_no_unit():
    application = '<Blocks:ValueType xmi:id="a" base_DataType="mass" unit="_0GvqcJtHEe22gNlMu9xm"/>'
    names, _ = measured(papyrus(MASS, application))
    assert names == [None, None]


@pytest.mark.parametrize("used", [True, False])
def test_names_of_the_iso_80000_library_tell_unit_and_quantity_kind(used):
    type_ = (
        "<type xmi:type='uml:DataType' href='ISO-80000.mdzip#_18_0beta_length_metre_of_iso'>"
        "<xmi:Extension><referenceExtension referentType='DataType' "
        "referentPath='ISO-80000::Space::Quantities::length[metre per second]'/>"
        "</xmi:Extension></type>"
    )
    gate = (
        "<packagedElement xmi:type='uml:Class' xmi:id='gate' name='Gate'>"
        f"<ownedAttribute xmi:type='uml:Property' xmi:id='load' name='load'>{type_ * used}"
        "</ownedAttribute></packagedElement>"
    )
    names, _ = measured(magicdraw(gate))
    assert names == (["metre per second", "length"] if used else [None, None])


def test_a_value_type_inherits_its_unit_unless_it_has_one():
    special = (
        '<packagedElement xmi:type="uml:DataType" xmi:id="mass" name="Load">'
        '<generalization xmi:type="uml:Generalization" xmi:id="g" general="all"/></packagedElement>'
        '<packagedElement xmi:type="uml:DataType" xmi:id="all" name="Mass"/>'
        '<packagedElement xmi:type="uml:Class" xmi:id="gate" name="Gate">'
        '<ownedAttribute xmi:type="uml:Property" xmi:id="load" name="load" type="mass"/>'
        "</packagedElement>"
    )
    general = '<Blocks:ValueType xmi:id="a" base_DataType="all" unit="kg" quantityKind="weight"/>'
    own = '<Blocks:ValueType xmi:id="b" base_DataType="mass" unit="gram"/>'
    assert measured(papyrus(special, general))[0] == ["kg", "weight"]
    assert measured(papyrus(special, general + own))[0] == ["gram", "weight"]


def test_martes_unit_is_not_sysmls():
    unit = KG + "</packagedElement>"
    application = (
        '<N:Unit xmlns:N="http://www.eclipse.org/papyrus/NFPs/1" xmi:id="b" '
        'base_InstanceSpecification="kg"/>'
    )
    _, graph = measured(papyrus(MASS + unit, application))
    assert graph["kg"].role == ""


def test_a_second_run_adds_no_unit():
    application = '<Blocks:ValueType xmi:id="a" base_DataType="mass" unit="kg"/>'
    _, graph = measured(papyrus(MASS, application))
    once = print_text(graph)
    pipeline.load("classify").run(graph, Sink())
    assert print_text(graph) == once


# -- stereotypes on what is no element of its own ----------------------------------------------


def test_a_generalization_that_conforms_realises_the_viewpoint():
    model = (
        '<packagedElement xmi:type="uml:Class" xmi:id="load" name="Costs">'
        '<generalization xmi:type="uml:Generalization" xmi:id="g" general="point"/>'
        "</packagedElement>"
        '<packagedElement xmi:type="uml:Class" xmi:id="point" name="Buyer"/>'
    )
    applications = (
        '<ModelElements:Conform xmlns:ModelElements="http://www.eclipse.org/papyrus/sysml/1.6/'
        'SysML/ModelElements" xmi:id="c" base_Generalization="g"/>'
        '<ModelElements:View xmlns:ModelElements="http://www.eclipse.org/papyrus/sysml/1.6/'
        'SysML/ModelElements" xmi:id="v" base_Class="load"/>'
        '<ModelElements:Viewpoint xmlns:ModelElements="http://www.eclipse.org/papyrus/sysml/1.6/'
        'SysML/ModelElements" xmi:id="w" base_Class="point"/>'
    )
    sink = Sink()
    _, graph = measured(papyrus(model, applications), sink)
    text = print_text(graph)
    assert "-> realizes point" in text
    assert '"Conform" lineage=["Conform"]' in text
    assert 'on="generalization"' in text
    assert list(sink) == []


def test_a_changed_feature_is_stored_at_the_trigger():
    model = (
        '<packagedElement xmi:type="uml:Class" xmi:id="gate" name="Gate">'
        '<ownedAttribute xmi:type="uml:Property" xmi:id="load" name="load"/></packagedElement>'
        '<packagedElement xmi:type="uml:Activity" xmi:id="run" name="Run">'
        '<node xmi:type="uml:AcceptEventAction" xmi:id="n" name="wait">'
        '<trigger xmi:type="uml:Trigger" xmi:id="t" event="e"/></node></packagedElement>'
        '<packagedElement xmi:type="uml:ChangeEvent" xmi:id="e" name="changed"/>'
    )
    application = (
        "<PortsAndFlows:ChangeStructuralFeatureEvent "
        'xmi:id="c" base_ChangeEvent="e" structuralFeature="load"/>'
    )
    _, graph = measured(papyrus(model, application))
    assert "-> references load" in print_text(graph).partition("Trigger t")[2]


def test_a_probability_is_the_value_that_the_tag_leads_to():
    model = (
        '<packagedElement xmi:type="uml:Class" xmi:id="gate" name="Gate">'
        '<ownedAttribute xmi:type="uml:Property" xmi:id="load" name="load"/></packagedElement>'
        '<packagedElement xmi:type="uml:Activity" xmi:id="run" name="Run">'
        '<node xmi:type="uml:InitialNode" xmi:id="i"/>'
        '<node xmi:type="uml:ActivityFinalNode" xmi:id="f"/>'
        '<edge xmi:type="uml:ControlFlow" xmi:id="x" source="i" target="f">'
        '<weight xmi:type="uml:LiteralReal" xmi:id="p" value="0.3"/></edge></packagedElement>'
    )
    application = (
        '<A:Probability xmlns:A="http://www.eclipse.org/papyrus/sysml/1.6/SysML/Activities" '
        'xmi:id="q" base_ActivityEdge="x" probability="p"/>'
    )
    _, graph = measured(papyrus(model, application))
    assert graph["x"].attrs["probability"] == 0.3
