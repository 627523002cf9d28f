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
        self.named = {one.get("name"): one for one in self.root.iter(f"{XS}complexType")}
        self.groups = {one.get("name"): one for one in self.root.iter(f"{XS}group")}
        self.elements = [one for one in self.root.iter(f"{XS}element") if one.get("name")]

    def type_of(self, element):
        inside = element.find(f"{XS}complexType")
        return self.named.get(local(element.get("type"))) if inside is None else inside

    def is_free(self, element):
        return local(element.get("type")) == "anyType" or element.get("name") in FREE

    def holds_text(self, element):
        """Whether it is of a simple type, or of one that only adds attributes to such a type."""
        type_ = self.type_of(element)
        inside = () if type_ is None else self.own(type_)
        bases = [one.get("base") for one in inside if one.get("base")]
        names = {local(name) for name in [element.get("type"), *bases]}
        return bool(names & SIMPLE) or self.is_free(element)

    def attributes(self, type_):
        for one in self.own(type_):
            if one.tag == f"{XS}attribute":
                yield one.get("name")
            elif one.get("base") and local(one.get("base")) in self.named:
                yield from self.attributes(self.named[local(one.get("base"))])

    def children(self, type_):
        for one in self.own(type_):
            if one.get("base") and local(one.get("base")) in self.named:
                yield from self.children(self.named[local(one.get("base"))])
            elif one.tag == f"{XS}group" and one.get("ref"):
                yield from self.children(self.groups[local(one.get("ref"))])
            elif one.tag == f"{XS}element":
                yield one.get("name")

    def own(self, type_):
        """What stands in a type, but not in the elements that are declared in it."""
        for one in () if type_ is None else type_.iterchildren(etree.Element):
            yield one
            if one.tag not in (f"{XS}element", f"{XS}attribute"):
                yield from self.own(one)


FREE = {"AdditionalInformation"}
SIMPLE = {"string", "dateTime"}


def local(name):
    return (name or "").rpartition(":")[2]


@pytest.fixture(params=["CAEX_ClassModel_V2.15.xsd", "CAEX_ClassModel_V.3.0.xsd"])
def schema(request, corpus):
    return Schema(corpus / "aml" / "schema" / request.param)


@pytest.mark.corpus
def test_the_order_is_that_of_every_sequence(schema):
    sequences = [list(schema.children(schema.type_of(one))) for one in schema.elements]
    assert sum(map(len, sequences)) > 200
    for names in sequences:
        is_choice = "NominalScaledType" in names
        ranks = [ORDER[name] for name in names]
        assert is_choice or all(one < two for one, two in pairwise(ranks)), names


@pytest.mark.corpus
def test_an_element_has_the_attributes_that_one_of_the_schemas_gives_it(corpus):
    found = {}
    for path in (corpus / "aml" / "schema").glob("*.xsd"):
        schema = Schema(path)
        for one in schema.elements:
            names = set(schema.attributes(schema.type_of(one)))
            is_free = schema.is_free(one) or one.get("name") in FREE
            found.setdefault(one.get("name"), set()).update({None} if is_free else names)
    assert found == {tag: {None} if k is None else k for tag, k in ATTRIBUTES.items()}


@pytest.mark.corpus
def test_texts_stand_in_elements_of_simple_types(schema):
    found = {one.get("name") for one in schema.elements if schema.holds_text(one)}
    assert found == TEXTS & {one.get("name") for one in schema.elements}
