"""Tags that SysML does not have on its stereotypes: reported once for each file."""

import pytest
from lxml import etree
from reading_xmi import magicdraw, papyrus, read

from sysmlc.frontends.xmi.unknown_names import is_sysml_tag

PROPERTY = """<packagedElement xmi:type="uml:Class" xmi:id="c" name="C">
 <ownedAttribute xmi:id="p" name="p"/><ownedAttribute xmi:id="q" name="q"/></packagedElement>"""
FLOW = '<PortsAndFlows:FlowProperty xmi:id="s{0}" base_Property="{0}" {1}/>'


def test_a_misspelt_tag_is_reported_once():
    applied = FLOW.format("p", 'directon="in"') + FLOW.format("q", 'directon="out"')
    reading = read(papyrus(PROPERTY, applied))
    assert reading.findings == [
        "unknown-tag: tag 'directon' of stereotype 'FlowProperty' on 'M::C::p' and 1 more is "
        "not defined by SysML"
    ]
    (finding,) = reading.sink
    assert (finding.help, finding.subject.id) == ("did you mean 'direction'?", "sp")
    assert reading.totals == {"elements": 7, "mapped": 5, "approximated": 2}
    assert reading.graph["sp"].attrs["tag.directon"] == "in"


def test_tags_beyond_fifty_are_counted():
    tags = " ".join(f'colour{number}="red"' for number in range(5000))
    findings = list(read(papyrus(PROPERTY, FLOW.format("p", tags))).sink)
    assert len(findings) == 50
    assert findings[-1].notes == ("4950 more such tags are in the file",)


def test_tags_of_an_application_without_base_are_not_reported():
    reading = read(papyrus(PROPERTY, FLOW.format("gone", 'directon="in"')))
    assert [finding.rule.code for finding in reading.sink] == ["SM113"]


@pytest.mark.parametrize("tag", ["Txt='shall'", "><Txt>shall</Txt></sysml:Requirement"])
def test_tags_of_magicdraw_as_attributes_and_as_children(tag):
    model = "<packagedElement xmi:type='uml:Class' xmi:id='r' name='R'/>"
    end = "" if tag.startswith(">") else "/"
    applied = f"<sysml:Requirement xmi:id='s' base_Class='r' Id='1' {tag}{end}>"
    assert [f.rule.code for f in read(magicdraw(model, applied)).sink] == ["SM125"]


@pytest.mark.parametrize(
    "applied",
    [
        FLOW.format("p", 'direction="in"'),
        FLOW.format("p", 'Direction="in"'),
        '<Plant:FlowProperty xmi:id="s" base_Property="p" directon="in"/>',
        '<Blocks:Block xmi:id="s" xmi:uuid="1" isEncapsulated="true"><base_Class xmi:idref="c"/>'
        "</Blocks:Block>",
    ],
)
def test_tags_of_sysml_and_of_other_profiles_are_no_findings(applied):
    assert read(papyrus(PROPERTY, applied)).findings == []


@pytest.mark.corpus
@pytest.mark.parametrize(
    "name",
    [
        "profile/papyrus-SysML-1.6.profile.uml",
        "md-eclipse-export/SysML.profile.uml",
        "omg/SysML-1.7-ptc-24-01-02.xmi",
    ],
)
def test_every_tag_of_the_profiles_is_known(corpus, name):
    tree = etree.parse(corpus / "xmi" / name)
    owned = tree.xpath("//*[@*[.='uml:Stereotype']]/ownedAttribute/@name")
    tags = {tag for tag in owned if not tag.startswith("base_")}
    assert len(tags) > 20
    known = {tag for tag in tags if is_sysml_tag(tag)}
    assert tags - known <= {"Completion status", "Version"}
