"""The vocabulary of CAEX agrees with the schemas of versions 2.15 and 3.0."""

from itertools import pairwise

import pytest
from lxml import etree

from sysmlc.sources.caex_vocabulary import ATTRIBUTES, ORDER, TEXTS

XS = "{http://www.w3.org/2001/XMLSchema}"


class Schema:
    """The elements of an XML schema with their children, attributes and types."""

    def __init__(self, path):
        self.root = etree.parse(path).getroot()
        self.types_by_name = {node.get("name"): node for node in self.root.iter(f"{XS}complexType")}
        self.groups = {node.get("name"): node for node in self.root.iter(f"{XS}group")}
        self.elements = [node for node in self.root.iter(f"{XS}element") if node.get("name")]

    def find_type(self, element):
        nested_type = element.find(f"{XS}complexType")
        return (
            self.types_by_name.get(strip_namespace(element.get("type")))
            if nested_type is None
            else nested_type
        )

    def is_free(self, element):
        return strip_namespace(element.get("type")) == "anyType" or element.get("name") in FREE

    def holds_text(self, element):
        """Whether an element has a simple type, possibly extended by attributes."""
        type_ = self.find_type(element)
        nodes = () if type_ is None else self.iter_own_nodes(type_)
        bases = [node.get("base") for node in nodes if node.get("base")]
        names = {strip_namespace(name) for name in [element.get("type"), *bases]}
        return bool(names & SIMPLE) or self.is_free(element)

    def iter_attributes(self, type_):
        for node in self.iter_own_nodes(type_):
            if node.tag == f"{XS}attribute":
                yield node.get("name")
            elif node.get("base") and strip_namespace(node.get("base")) in self.types_by_name:
                yield from self.iter_attributes(
                    self.types_by_name[strip_namespace(node.get("base"))]
                )

    def iter_children(self, type_):
        for node in self.iter_own_nodes(type_):
            if node.get("base") and strip_namespace(node.get("base")) in self.types_by_name:
                yield from self.iter_children(self.types_by_name[strip_namespace(node.get("base"))])
            elif node.tag == f"{XS}group" and node.get("ref"):
                yield from self.iter_children(self.groups[strip_namespace(node.get("ref"))])
            elif node.tag == f"{XS}element":
                yield node.get("name")

    def iter_own_nodes(self, type_):
        """Yield the nodes in a type, except those in the elements that it declares."""
        for node in () if type_ is None else type_.iterchildren(etree.Element):
            yield node
            if node.tag not in (f"{XS}element", f"{XS}attribute"):
                yield from self.iter_own_nodes(node)


FREE = {"AdditionalInformation"}
SIMPLE = {"string", "dateTime"}


def strip_namespace(name):
    return (name or "").rpartition(":")[2]


@pytest.fixture(params=["CAEX_ClassModel_V2.15.xsd", "CAEX_ClassModel_V.3.0.xsd"])
def schema(request, corpus):
    return Schema(corpus / "aml" / "schema" / request.param)


@pytest.mark.corpus
def test_the_order_of_children_is_that_of_every_sequence(schema):
    sequences = [list(schema.iter_children(schema.find_type(node))) for node in schema.elements]
    assert sum(map(len, sequences)) > 200
    for names in sequences:
        is_choice = "NominalScaledType" in names
        ranks = [ORDER[name] for name in names]
        assert is_choice or all(first < second for first, second in pairwise(ranks)), names


@pytest.mark.corpus
def test_attributes_are_those_of_both_schemas(corpus):
    attributes = {}
    for path in (corpus / "aml" / "schema").glob("*.xsd"):
        schema = Schema(path)
        for node in schema.elements:
            names = set(schema.iter_attributes(schema.find_type(node)))
            is_free = schema.is_free(node) or node.get("name") in FREE
            attributes.setdefault(node.get("name"), set()).update({None} if is_free else names)
    assert attributes == {
        tag: {None} if names is None else names for tag, names in ATTRIBUTES.items()
    }


@pytest.mark.corpus
def test_elements_with_text_are_those_of_simple_types(schema):
    texts = {node.get("name") for node in schema.elements if schema.holds_text(node)}
    assert texts == TEXTS & {node.get("name") for node in schema.elements}
