"""Ids that are made are UUIDs of version 5, as the standard library makes them."""

from uuid import UUID, uuid5

from hypothesis import given
from hypothesis import strategies as st

from sysmlc.ir.element import derived_id

_NAMESPACE = UUID("6f1d7a54-3f0c-5d3a-9a52-0c2f6f2d7b11")
_TEXTS = st.text(st.characters(exclude_categories=["Cs"]))


@given(_TEXTS, _TEXTS)
def test_a_made_id_is_that_of_the_standard_library(origin, role):
    assert derived_id(origin, role) == str(uuid5(_NAMESPACE, f"{origin}\x1f{role}"))
