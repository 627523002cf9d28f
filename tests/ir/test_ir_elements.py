"""Elements: their text, and derived ids, which are UUIDs of version 5."""

from uuid import UUID, uuid5

from hypothesis import given
from hypothesis import strategies as st

from sysmlc.ir import Element, Kind, derived_id

NAMESPACE = UUID("6f1d7a54-3f0c-5d3a-9a52-0c2f6f2d7b11")
TEXTS = st.text(st.characters(exclude_categories=["Cs"]))


def test_the_text_of_an_element_shows_kind_and_name():
    assert repr(Element("x", Kind.PORT, "infeed")) == "<Port infeed>"


@given(TEXTS, TEXTS)
def test_a_derived_id_is_the_uuid_that_the_standard_library_computes(origin, role):
    assert derived_id(origin, role) == str(uuid5(NAMESPACE, f"{origin}\x1f{role}"))


def test_derived_ids_depend_on_origin_and_role_only():
    assert derived_id("gate", "token") == derived_id("gate", "token")
    assert len({derived_id("a", "b"), derived_id("ab", ""), derived_id("", "ab")}) == 3
