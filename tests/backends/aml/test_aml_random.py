"""Random plants are written as valid CAEX 3.0 and read back as the same graph."""

from random import Random

import pytest
from hypothesis import given
from hypothesis import strategies as st
from lxml import etree
from writing_aml import read, round_trip, saved

from dialects.random_plants import random_plant
from sysmlc.sources import Source

SEEDS = st.integers(0, 2**32)


def graph_of(seed):
    return read(Source("plant.aml", random_plant(Random(seed))))


def has_no_reason(change):
    """Whether nothing that CAEX cannot say explains a difference.

    Of features that are several features of roles the order is that of the roles; a reference
    to nothing is not kept of an element that only repeats a part of its class (SM742), and an
    open link of such an element has lost its end (SM741).
    """
    is_order = change.what == "edge-order" and change.detail == "redefines"
    is_repeated = change.detail.startswith("unresolved: ")
    is_side = change.what == "edge-removed" and change.detail.startswith(("client ", "supplier "))
    return not is_order and not is_repeated and not is_side


@pytest.mark.long
@given(SEEDS)
def test_a_random_plant_comes_back(seed):
    graph = graph_of(seed)
    _, _, changes = round_trip(graph)
    assert [change for change in changes if has_no_reason(change)] == []
    told = {one[:5] for one in saved(graph)[1]}
    assert told <= {"SM741", "SM742"}


def test_random_plants_hold_everything_that_the_schema_knows():
    tags = set()
    for seed in range(40):
        tree = etree.fromstring(random_plant(Random(seed)))
        tags |= {etree.QName(one).localname for one in tree.iter(etree.Element)}
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
def test_what_is_written_of_random_plants_is_valid(corpus):
    """By the published schema, which the random plants themselves satisfy."""
    schema = etree.XMLSchema(etree.parse(corpus / "aml" / "schema" / "CAEX_ClassModel_V.3.0.xsd"))
    for seed in range(100):
        data = random_plant(Random(seed))
        assert schema.validate(etree.fromstring(data)), schema.error_log
        texts, _ = saved(read(Source("plant.aml", data)))
        for text in texts.values():
            assert schema.validate(etree.fromstring(text.encode())), schema.error_log
