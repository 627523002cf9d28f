"""Prefixes read as the root declares them give the same columns as namespaces of the parser."""

from random import Random

import pytest
from reading_xmi import magicdraw, papyrus, read, source

from dialects.magicdraw import write_xml
from dialects.random_models import random_model
from sysmlc.frontends.xmi import parsing, pieces
from sysmlc.frontends.xmi.document import Document
from sysmlc.frontends.xmi.prefixes import IrregularError
from sysmlc.sources import SourceError

XMI = 'xmlns:xmi="http://www.omg.org/spec/XMI/20131001"'
UML = 'xmlns:uml="http://www.eclipse.org/uml2/5.0.0/UML"'
CLASS = '<packagedElement xmi:type="uml:Class" xmi:id="c" name="C"/>'


@pytest.fixture(autouse=True)
def _by_the_parser(monkeypatch):
    monkeypatch.setattr(pieces, "fill", lambda *_: None)


def columns(one):
    found = parsing.read(one)
    return {name: getattr(found, name) for name in Document.__slots__}


def namespaces_of_the_parser(monkeypatch, one):
    """The columns when no prefix is taken at its word."""

    def refuse(*_):
        raise IrregularError

    with monkeypatch.context() as patch:
        patch.setattr(parsing, "fill_swiftly", refuse)
        return columns(one)


def is_swift(monkeypatch, one):
    """Whether the parser did not have to look for namespaces."""
    with monkeypatch.context() as patch:
        patch.setattr(parsing, "fill", None)
        try:
            parsing.read(one)
        except TypeError:
            return False
    return True


@pytest.mark.parametrize("seed", range(3))
def test_both_ways_give_the_same_columns_for_random_models(seed, monkeypatch):
    model = random_model(Random(seed))
    for text, name in ((model, "m.uml"), (write_xml(model), "m.xml")):
        one = source(text, name)
        assert is_swift(monkeypatch, one)
        assert columns(one) == namespaces_of_the_parser(monkeypatch, one)


def test_rare_prefixed_attributes_have_their_namespace(monkeypatch):
    one = papyrus(f'{CLASS}<a xml:lang="en" Blocks:b="c" xmi:uuid="d"/>', '<Blocks:b Blocks:b=""/>')
    assert is_swift(monkeypatch, one)
    assert columns(one) == namespaces_of_the_parser(monkeypatch, one)


REGULAR = (
    f"<uml:Model {XMI} {UML} xmi:id='m'>{CLASS}</uml:Model>",
    f"<?xml version='1.0' encoding='windows-1252'?><uml:Model {XMI} {UML}>{CLASS}</uml:Model>",
)
IRREGULAR = (
    f"<xmi:XMI {XMI}><uml:Model {UML} xmi:id='m'>{CLASS}</uml:Model></xmi:XMI>",
    f"<xmi:XMI {XMI} {UML} xmlns='urn:d'><uml:Model>{CLASS}</uml:Model></xmi:XMI>",
    f"<xmi:XMI {XMI} {UML}><uml:Model xmlns='urn:d'>{CLASS}</uml:Model></xmi:XMI>",
    f"<xmi:XMI {XMI} {UML} {UML.replace('uml=', 'u=')}><u:Model>{CLASS}</u:Model></xmi:XMI>",
    f"<xmi:XMI {XMI} {UML}><uml:Model><a {XMI.replace('xmi=', 'uml=')} uml:id='x'/></uml:Model>"
    "</xmi:XMI>",
    f"<xmi:XMI {XMI} {UML}><uml:Model><x:MDExtension xmlns:x='urn:x'/></uml:Model></xmi:XMI>",
)


@pytest.mark.parametrize("text", REGULAR)
def test_a_root_that_declares_all_prefixes_is_read_without_the_parsers_namespaces(
    text, monkeypatch
):
    one = source(text)
    assert is_swift(monkeypatch, one)
    assert columns(one) == namespaces_of_the_parser(monkeypatch, one)


@pytest.mark.parametrize("text", IRREGULAR)
def test_prefixes_of_other_files_are_left_to_the_parser(text, monkeypatch):
    one = source(text)
    assert not is_swift(monkeypatch, one)
    assert columns(one) == namespaces_of_the_parser(monkeypatch, one)


WRONG = (
    f"<xmi:XMI {XMI} {UML}><uml:Model><a b:c=''/></uml:Model></xmi:XMI>",
    f"<xmi:XMI {XMI} {UML}><uml:Model><b:c/></uml:Model></xmi:XMI>",
    f"<xmi:XMI {XMI} {UML}><uml:Model><xmi:b:c/></uml:Model></xmi:XMI>",
    f"<xmi:XMI {XMI} {UML} xmlns:xml='urn:x'><uml:Model/></xmi:XMI>",
    f"<xmi:XMI {XMI} {UML} xmlns:u=''><uml:Model/></xmi:XMI>",
    f"<xmi:XMI {XMI} {UML}><diagramRepresentation><b:c/></diagramRepresentation></xmi:XMI>",
)


@pytest.mark.parametrize("text", WRONG)
def test_a_prefix_that_means_nothing_is_a_fault(text, monkeypatch):
    one = source(text)
    with pytest.raises(SourceError) as swift:
        columns(one)
    with pytest.raises(SourceError) as general:
        namespaces_of_the_parser(monkeypatch, one)
    assert str(swift.value) == str(general.value)
    assert swift.value.offset == general.value.offset


def test_a_drawing_may_declare_its_own_prefixes(monkeypatch):
    drawing = "<diagramRepresentation><d:o xmlns:d='urn:d' a='b'/></diagramRepresentation>"
    one = magicdraw(f"<xmi:Extension>{drawing}</xmi:Extension>")
    assert is_swift(monkeypatch, one)
    assert columns(one) == namespaces_of_the_parser(monkeypatch, one)
    assert read(one).totals["ignored_notation"] == 2 + 3
