"""Random plants are written as valid CAEX 3.0 and read back as the same graph."""

from random import Random

import pytest
from aml_files import read, round_trip, save
from hypothesis import given
from hypothesis import strategies as st
from lxml import etree

from dialects.random_plants import random_plant
from sysmlc.sources import Source

SEEDS = st.integers(0, 2**32)


def read_random_plant(seed):
    return read(Source("plant.aml", random_plant(Random(seed))))


def is_unexplained(change):
    """Whether CAEX could have avoided a difference.

    A feature that redefines features of several roles redefines them in the order of the roles.
    An element that only repeats a part of its class loses unresolved references (SM742) and the
    ends of open links (SM741).
    """
    is_order = change.what == "edge-order" and change.detail == "redefines"
    is_repeated = change.detail.startswith("unresolved: ")
    is_side = change.what == "edge-removed" and change.detail.startswith(("client ", "supplier "))
    return not is_order and not is_repeated and not is_side


@pytest.mark.long
@given(SEEDS)
def test_a_random_plant_is_read_back(seed):
    graph = read_random_plant(seed)
    _, _, changes = round_trip(graph)
    assert [change for change in changes if is_unexplained(change)] == []
    codes = {message[:5] for message in save(graph)[1]}
    assert codes <= {"SM741", "SM742"}


def test_random_plants_contain_all_elements_of_the_schema():
    tags = set()
    for seed in range(40):
        tree = etree.fromstring(random_plant(Random(seed)))
        tags |= {etree.QName(element).localname for element in tree.iter(etree.Element)}
    assert tags >= TAGS


NAMES = """AdditionalInformation Attribute AttributeNameMapping AttributeType AttributeTypeLib
    CAEXFile Constraint Copyright DefaultValue Description ExternalInterface InstanceHierarchy
    InterfaceClass InterfaceClassLib InternalElement InternalLink MappingObject NominalScaledType
    OrdinalScaledType RefSemantic RequiredMaxValue RequiredMinValue RequiredValue Revision
    RoleClass RoleClassLib RoleRequirements SourceDocumentInformation SourceObjectInformation
    SupportedRoleClass SystemUnitClass SystemUnitClassLib UnknownType Value Version"""
TAGS = set(NAMES.split())


@pytest.mark.long
@pytest.mark.corpus
def test_saved_random_plants_are_valid(corpus):
    """By the published schema, which the random plants themselves satisfy."""
    schema = etree.XMLSchema(etree.parse(corpus / "aml" / "schema" / "CAEX_ClassModel_V.3.0.xsd"))
    for seed in range(100):
        data = random_plant(Random(seed))
        assert schema.validate(etree.fromstring(data)), schema.error_log
        texts, _ = save(read(Source("plant.aml", data)))
        for text in texts.values():
            assert schema.validate(etree.fromstring(text.encode())), schema.error_log
