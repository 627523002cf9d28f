"""Every element has one verdict; unread elements are reported, and hostile files are refused."""

import pytest
from reading_xmi import MAGICDRAW, PAPYRUS, Read, papyrus, read, source

from sysmlc.diagnostics.locations import locate
from sysmlc.frontends.xmi import FRONTEND
from sysmlc.sources import Fault, Source, SourceError


def test_the_five_verdicts():
    reading = read(
        papyrus(
            """
  <eAnnotations xmi:id="e" source="tool"><details xmi:id="d" key="k"/></eAnnotations>
  <packagedElement xmi:type="uml:Class" xmi:id="k" name="K">
    <ownedAttribute xmi:id="a"><type href="x.uml#_1"/></ownedAttribute>
    <ownedAttribute xmi:id="r"><upperValue xmi:type="uml:OpaqueExpression" xmi:id="s">
      <body>a</body><body>b</body></upperValue></ownedAttribute></packagedElement>
  <packagedElement xmi:type="uml:State" xmi:id="o"/>
  <packagedElement xmi:type="uml:State" xmi:id="o2"/>"""
        )
    )
    assert reading.totals == {
        "elements": 13,
        "mapped": 7,
        "approximated": 1,
        "ignored_notation": 2,
        "unsupported": 2,
        "external": 1,
    }
    (file,) = reading.coverage.as_json()["files"]
    assert file["by_type"]["uml:State"] == {"unsupported": 2}
    assert file["by_type"]["uml:Property"] == {"mapped": 2}
    assert reading.findings == [
        "unsupported-element: 2 elements of type 'uml:State' not read (2 with all that they "
        "contain)",
        "approximated-element: 1 element of type 'uml:OpaqueExpression' read without its "
        "alternative bodies",
    ]


def test_a_diagnostic_has_the_first_location():
    model = papyrus('<packagedElement xmi:type="uml:State" xmi:id="o"/>')
    (finding,) = read(model).sink
    (location,) = locate([model], [finding.subject.place]).values()
    assert location.text[location.column - 1 :].startswith("<packagedElement")


def test_an_element_below_an_owner_that_cannot_own_it_is_not_read():
    reading = read(papyrus('<packagedElement xmi:type="uml:State" xmi:id="s"/>'))
    assert reading.totals["unsupported"] == 1
    assert [element.id for element in reading.graph] == ["m"]


def test_a_file_without_known_content_is_an_error():
    reading = read(source(PAPYRUS % "<settings/>"))
    assert reading.findings[-1].startswith("no-known-content: 'm.uml' looks like UML in XMI")
    assert [f for f in read(papyrus("")).findings if "no-known" in f] == []


BILLION = '<!DOCTYPE a [<!ENTITY x "xx"><!ENTITY y "&x;&x;">]>'
OUTSIDE = '<!DOCTYPE a [<!ENTITY x SYSTEM "file:///etc/passwd">]>'
REFERRED = '<!DOCTYPE a SYSTEM "http://localhost/a.dtd">'


@pytest.mark.parametrize("doctype", ["<!DOCTYPE a>", BILLION, OUTSIDE, REFERRED])
def test_every_doctype_is_refused(doctype):
    text = (PAPYRUS % '<uml:Model xmi:id="m"/>').replace("?>", f"?>{doctype}", 1)
    hostile = source(text)
    assert FRONTEND.detect(hostile) > 0
    reading = read(hostile)
    assert len(reading.graph) == 0
    assert len(reading.findings) == 1
    assert "it has a DOCTYPE, which is refused" in reading.findings[0]


def test_an_undeclared_entity_is_an_error():
    assert "not well-formed XML: undefined entity" in read(papyrus("&x;")).findings[0]


def test_truncation_is_an_error_with_its_location():
    whole = papyrus('<packagedElement xmi:type="uml:Class" xmi:id="k"/>')
    cut = Source("m.uml", whole.data[:-30])
    (finding,) = read(cut).sink
    (location,) = locate([cut], [finding.subject.place]).values()
    assert location.line == 8
    assert finding.message.startswith("'m.uml' cannot be read: not well-formed XML")


def test_a_damaged_file_does_not_take_the_others_with_it():
    good = papyrus('<packagedElement xmi:type="uml:Class" xmi:id="k"/>', name="good.uml")
    reading = read(source("<uml:Model", "bad.uml"), good)
    assert "k" in reading.graph
    assert len(reading.findings) == 1


def test_wrong_encodings_are_errors():
    latin = (MAGICDRAW % "<uml:Model name='é'/>").encode("latin-1")
    assert "not encoded in UTF-8" in read(source(latin)).findings[0]
    unknown = (MAGICDRAW % "").replace("UTF-8", "klingon").encode()
    assert "its encoding 'klingon' is unknown" in read(source(unknown)).findings[0]


def test_declared_encodings_are_believed():
    text = MAGICDRAW % "<uml:Model xmi:id='m' name='Förderband'/>"
    for encoding in ("windows-1252", "utf-16", "iso-8859-1"):
        data = text.replace("UTF-8", encoding).encode(encoding)
        assert FRONTEND.detect(source(data)) == 1.0
        assert read(source(data)).graph["m"].name == "Förderband"


def test_depth_is_limited():
    deep = papyrus("<a>" * 3000 + "</a>" * 3000)
    with pytest.raises(SourceError) as raised:
        Read([deep])
    assert raised.value.fault is Fault.LIMIT
    hidden = source(MAGICDRAW % f"<diagramRepresentation>{'<a>' * 3000}")
    with pytest.raises(SourceError):
        Read([hidden])
    assert read(papyrus("<a>" * 400 + "</a>" * 400)).totals["unsupported"] == 400


EMF = '<xmi:XMI xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI" {}</xmi:XMI>'
EMF_MODEL = EMF.format(
    'xmlns:uml="http://www.eclipse.org/uml2/5.0.0/UML"><uml:Model xmi:id="m" name="M">'
    '<packagedElement xmi:type="uml:Class" xmi:id="c" name="C"/></uml:Model>'
)
EMF_NOTATION = EMF.format(
    'xmlns:n="http://www.eclipse.org/gmf/runtime/1.0.2/notation" '
    'xmlns:uml="http://www.eclipse.org/uml2/5.0.0/UML"><n:Diagram xmi:id="d"/>'
)
ECORE = '<ecore:EPackage xmlns:ecore="http://www.eclipse.org/emf/2002/Ecore" name="p"/>'
NOTATION = (
    '<notation:Diagram xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI"'
    ' xmlns:notation="http://www.eclipse.org/gmf/runtime/1.0.2/notation"/>'
)


@pytest.mark.parametrize(
    ("text", "score"),
    [
        (PAPYRUS % "", 1.0),
        (MAGICDRAW % "", 1.0),
        ('<uml:Model xmlns:uml="http://www.eclipse.org/uml2/3.0.0/UML"/>', 1.0),
        ('<uml:Model xmlns:uml="uml_namespace"/>', 1.0),
        ('<uml:Model xmlns:uml="uml_namespaces"/>', 0.0),
        ('<xmi:XMI xmlns:xmi="https://www.omg.org/spec/XMI/20131001"/>', 0.5),
        (EMF_MODEL, 1.0),
        (EMF_NOTATION, 0.0),
        (ECORE, 0.0),
        (NOTATION, 0.0),
        ("<html/>", 0.0),
        ("", 0.0),
        ("package P;", 0.0),
        ("PK\x03\x04", 0.0),
        ("<CAEXFile/>", 0.0),
        ("<broken", 0.0),
    ],
)
def test_files_are_recognised_by_content(text, score):
    assert FRONTEND.detect(source(text, "any.thing")) == score


def test_a_text_that_is_no_feature_of_uml_is_stored_and_reported_at_its_location():
    owned = '<ownedAttribute xmi:id="p" name="speed">{}</ownedAttribute>'
    model = f'<packagedElement xmi:type="uml:Class" xmi:id="c" name="C">{owned}</packagedElement>'
    reading = read(papyrus(model.format("<unit>mm/s</unit>")))
    assert reading.findings == [
        "stray-text: 'M::C::speed' has a text 'unit', which is not a feature of UML"
    ]
    assert [(f.subject.id, f.subject.place.ordinal) for f in reading.sink] == [("p", 4)]
    assert reading.graph["p"].attrs["unit"] == "mm/s"
    assert reading.totals == {"elements": 5, "mapped": 4, "approximated": 1}
    for known in ("<isReadOnly>true</isReadOnly>", "<visibility>private</visibility>"):
        assert read(papyrus(model.format(known))).findings == []


def test_an_empty_element_that_is_no_feature_of_uml_is_reported():
    reading = read(
        papyrus('<packagedElement xmi:type="uml:Class" xmi:id="c"><unit/></packagedElement>')
    )
    assert [finding.rule.name for finding in reading.sink] == ["stray-text"]
    assert reading.totals["approximated"] == 1


def test_a_text_beside_the_model_belongs_to_nothing():
    reading = read(papyrus("", "<settings>left</settings>"))
    assert [finding.rule.name for finding in reading.sink] == ["unsupported-element"]
    assert reading.totals["unsupported"] == 1


def test_drawings_are_counted_but_not_stored():
    reading = read(
        source(
            MAGICDRAW
            % """<uml:Model xmi:id='m'><xmi:Extension extender='MagicDraw UML 19.0'><modelExtension>
  <ownedDiagram xmi:type='uml:Diagram' xmi:id='d'><xmi:Extension><diagramRepresentation>
    <x><y/></x><z/></diagramRepresentation></xmi:Extension></ownedDiagram>
</modelExtension></xmi:Extension>
<packagedElement xmi:type='uml:Class' xmi:id='k'/></uml:Model>"""
        )
    )
    assert reading.totals == {"elements": 13, "mapped": 3, "ignored_notation": 10}
    assert reading.graph["k"].ordinal == 12


def test_a_model_in_the_namespace_of_emf_is_read():
    reading = read(source(EMF_MODEL))
    assert [(element.id, element.name) for element in reading.graph] == [("m", "M"), ("c", "C")]
    assert reading.findings == []
