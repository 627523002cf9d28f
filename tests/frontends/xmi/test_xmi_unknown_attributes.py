"""Attributes that neither UML nor XMI has, or UML elsewhere, are reported once for each file."""

import pytest
from lxml import etree
from reading_xmi import magicdraw, papyrus, read, source

from sysmlc.frontends.xmi import uml_features
from sysmlc.frontends.xmi.uml_features import is_misplaced

CLASS = '<packagedElement xmi:type="uml:Class" xmi:id="{}" name="{}" {}/>'


def list_findings(reading):
    return [finding.message for finding in reading.sink if finding.rule.code == "SM124"]


def test_an_unknown_name_is_reported_once_at_its_first_element():
    classes = [CLASS.format(x, x.upper(), 'isAbstrct="true"') for x in "abc"]
    reading = read(papyrus("".join(classes)))
    assert list_findings(reading) == [
        "attribute 'isAbstrct' of 'M::A' and 2 more is defined neither by UML nor by XMI"
    ]
    (finding,) = reading.sink
    assert finding.help == "did you mean 'isAbstract'?"
    assert (finding.subject.id, finding.subject.place.ordinal) == ("a", 2)
    assert reading.totals == {"elements": 5, "mapped": 2, "approximated": 3}


def test_each_file_reports_its_own_names():
    files = [papyrus(CLASS.format(x, x, 'colour="red"'), name=f"{x}.uml") for x in "ab"]
    reading = read(*files)
    assert [finding.subject.place.file for finding in reading.sink] == ["a.uml", "b.uml"]


def test_names_beyond_fifty_are_counted():
    names = " ".join(f'colour{number}="red"' for number in range(60))
    reading = read(papyrus(CLASS.format("a", "A", names)))
    assert len(list_findings(reading)) == 50
    assert [finding.notes for finding in reading.sink][-1] == (
        "10 more such names are in the file",
    )


@pytest.mark.parametrize(
    ("model", "name"),
    [
        ('<ownedRule xmi:id="r"><specification xmi:type="uml:LiteralNull" valeu="3"/></ownedRule>',
         "valeu"),
        ('<packagedElement xmi:type="uml:Class" xmi:id="k"><generalization xmi:id="g" to="k"/>'
         "</packagedElement>", "to"),
        ('<packagedElement xmi:type="uml:Class" xmi:id="k"><ownedAttribute xmi:id="p">'
         '<type href="x.uml#_1" named="y"/></ownedAttribute></packagedElement>', "named"),
        ('<packagedElement xmi:type="uml:Class" xmi:idd="k"/>', "xmi:idd"),
    ],
)  # fmt: skip
def test_rows_that_are_no_elements_and_the_namespace_of_xmi_are_checked(model, name):
    (message,) = list_findings(read(papyrus(model)))
    assert message.startswith(f"attribute '{name}' of ")


@pytest.mark.parametrize(
    ("model", "applications"),
    [
        (CLASS.format("a", "A", 'xmi:uuid="1" isAbstract="true" visibility="private"'), ""),
        (CLASS.format("a", "A", 'xmlns:draw="http://vendor/draw" draw:colour="red"'), ""),
        (CLASS.format("a", "A", ""), '<Plant:Cell xmi:id="s" base_Class="a" colour="red"/>'),
        ('<eAnnotations xmi:id="e" source="tool" colour="red"/>', ""),
    ],
)
def test_tags_notation_and_namespaces_of_tools_are_not_checked(model, applications):
    assert list_findings(read(papyrus(model, applications))) == []


def test_magicdraws_own_values_name_an_element_by_an_attribute():
    value = "<defaultValue xmi:type='uml:ElementValue' xmi:id='v' element='c'/>"
    owned = f"<ownedAttribute xmi:type='uml:Property' xmi:id='p'>{value}</ownedAttribute>"
    model = f"<packagedElement xmi:type='uml:Class' xmi:id='c' name='C'>{owned}</packagedElement>"
    assert read(magicdraw(model)).findings == []


def test_extensions_of_tools_are_not_checked():
    extension = "<xmi:Extension extender='T'><modelExtension colour='red'/></xmi:Extension>"
    held = "<packagedElement xmi:type='uml:Class' xmi:id='a'>{}</packagedElement>"
    assert list_findings(read(magicdraw(held.format(extension)))) == []
    assert (
        len(list_findings(read(magicdraw(held.format("<ownedComment xmi:id='c' colour='red'/>")))))
        == 1
    )


def test_a_template_parameter_is_checked():
    model = """<packagedElement xmi:type="uml:Class" xmi:id="c"><ownedTemplateSignature xmi:id="s">
 <ownedParameter xmi:id="t" colour="red"/></ownedTemplateSignature></packagedElement>"""
    assert len(list_findings(read(papyrus(model)))) == 1


def test_a_model_without_envelope_is_checked():
    bare = (
        '<uml:Model xmlns:xmi="http://schema.omg.org/spec/XMI/2.1" xmi:version="2.1" colour="red"'
        ' xmlns:uml="http://www.eclipse.org/uml2/3.0.0/UML" xmi:id="m" name="M"/>'
    )
    assert list_findings(read(source(bare))) == [
        "attribute 'colour' of 'M' is defined neither by UML nor by XMI"
    ]


@pytest.mark.corpus
def test_every_feature_of_the_metamodel_is_known(corpus):
    tree = etree.parse(corpus / "xmi" / "metamodel" / "uml.ecore")
    features = {feature.get("name") for feature in tree.iter("eStructuralFeatures")}
    assert len(features) > 400
    assert features - uml_features.FEATURES == set()
    assert {
        name for name in features if name[:2] == "is" and name[2].isupper()
    } == uml_features.FLAGS


def misplaced(reading):
    return [finding.message for finding in reading.sink if finding.rule.code == "SM154"]


def test_an_attribute_of_another_metaclass_is_reported_once():
    properties = "".join(
        f'<ownedAttribute xmi:type="uml:Property" xmi:id="{x}" name="{x}" isAbstract="true"/>'
        for x in "pq"
    )
    reading = read(
        papyrus(CLASS.format("a", "A", "").replace("/>", f">{properties}</packagedElement>"))
    )
    assert misplaced(reading) == [
        "attribute 'isAbstract' of 'M::A::p' and 1 more is not an attribute of Property in UML"
    ]
    assert reading.totals == {"elements": 5, "mapped": 3, "approximated": 2}


@pytest.mark.parametrize(
    "model",
    [
        CLASS.format("a", "A", 'isAbstract="true" isLeaf="true" visibility="private"'),
        '<packagedElement xmi:type="uml:AssociationClass" xmi:id="a" isActive="true"/>',
        '<packagedElement xmi:type="uml:Thing" xmi:id="a" memberEnd=""/>',
    ],
)
def test_own_and_inherited_attributes_of_the_metaclass_are_not_reported(model):
    assert misplaced(read(papyrus(model))) == []


def test_a_generalization_has_no_name_in_uml():
    model = (
        '<packagedElement xmi:type="uml:Class" xmi:id="a"><generalization '
        'xmi:type="uml:Generalization" xmi:id="g" general="a" name="is"/></packagedElement>'
    )
    (message,) = misplaced(read(papyrus(model)))
    assert message.endswith(" is not an attribute of Generalization in UML")


@pytest.mark.corpus
def test_the_table_of_features_has_those_of_the_metamodel(corpus):
    tree = etree.parse(corpus / "xmi" / "metamodel" / "uml.ecore")
    for metaclass in tree.iter("eClassifiers"):
        for feature in metaclass.iter("eStructuralFeatures"):
            if feature.get("containment") != "true":
                assert not is_misplaced(metaclass.get("name"), feature.get("name"))
