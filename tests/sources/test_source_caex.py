"""The table of CAEX is what both of its schemas say, read from these anew."""

from itertools import pairwise

import pytest
from lxml import etree

from sysmlc.sources.caex_vocabulary import ATTRIBUTES, ORDER, TEXTS

XS = "{http://www.w3.org/2001/XMLSchema}"


class Schema:
    """Sequences of children, attributes and content of the elements of one schema."""

    def __init__(self, path):
        self.root = etree.parse(path).getroot()
        self.named = {node.get("name"): node for node in self.root.iter(f"{XS}complexType")}
        self.groups = {node.get("name"): node for node in self.root.iter(f"{XS}group")}
        self.elements = [node for node in self.root.iter(f"{XS}element") if node.get("name")]

    def type_of(self, element):
        inside = element.find(f"{XS}complexType")
        return self.named.get(local(element.get("type"))) if inside is None else inside

    def is_free(self, element):
        return local(element.get("type")) == "anyType" or element.get("name") in FREE

    def holds_text(self, element):
        """Whether it is of a simple type, or of one that only adds attributes to such a type."""
        type_ = self.type_of(element)
        inside = () if type_ is None else self.iter_own_nodes(type_)
        bases = [node.get("base") for node in inside if node.get("base")]
        names = {local(name) for name in [element.get("type"), *bases]}
        return bool(names & SIMPLE) or self.is_free(element)

    def attributes(self, type_):
        for node in self.iter_own_nodes(type_):
            if node.tag == f"{XS}attribute":
                yield node.get("name")
            elif node.get("base") and local(node.get("base")) in self.named:
                yield from self.attributes(self.named[local(node.get("base"))])

    def children(self, type_):
        for node in self.iter_own_nodes(type_):
            if node.get("base") and local(node.get("base")) in self.named:
                yield from self.children(self.named[local(node.get("base"))])
            elif node.tag == f"{XS}group" and node.get("ref"):
                yield from self.children(self.groups[local(node.get("ref"))])
            elif node.tag == f"{XS}element":
                yield node.get("name")

    def iter_own_nodes(self, type_):
        """What stands in a type, but not in the elements that are declared in it."""
        for node in () if type_ is None else type_.iterchildren(etree.Element):
            yield node
            if node.tag not in (f"{XS}element", f"{XS}attribute"):
                yield from self.iter_own_nodes(node)


FREE = {"AdditionalInformation"}
SIMPLE = {"string", "dateTime"}


def local(name):
    return (name or "").rpartition(":")[2]


@pytest.fixture(params=["CAEX_ClassModel_V2.15.xsd", "CAEX_ClassModel_V.3.0.xsd"])
def schema(request, corpus):
    return Schema(corpus / "aml" / "schema" / request.param)


@pytest.mark.corpus
def test_the_order_is_that_of_every_sequence(schema):
    sequences = [list(schema.children(schema.type_of(node))) for node in schema.elements]
    assert sum(map(len, sequences)) > 200
    for names in sequences:
        is_choice = "NominalScaledType" in names
        ranks = [ORDER[name] for name in names]
        assert is_choice or all(first < second for first, second in pairwise(ranks)), names


@pytest.mark.corpus
def test_an_element_has_the_attributes_that_one_of_the_schemas_gives_it(corpus):
    attributes = {}
    for path in (corpus / "aml" / "schema").glob("*.xsd"):
        schema = Schema(path)
        for node in schema.elements:
            names = set(schema.attributes(schema.type_of(node)))
            is_free = schema.is_free(node) or node.get("name") in FREE
            attributes.setdefault(node.get("name"), set()).update({None} if is_free else names)
    assert attributes == {tag: {None} if k is None else k for tag, k in ATTRIBUTES.items()}


@pytest.mark.corpus
def test_texts_stand_in_elements_of_simple_types(schema):
    texts = {node.get("name") for node in schema.elements if schema.holds_text(node)}
    assert texts == TEXTS & {node.get("name") for node in schema.elements}
