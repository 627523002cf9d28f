"""The XML in metadata quotes attributes as the standard library of Python does."""

from xml.sax.saxutils import quoteattr

from hypothesis import example, given
from hypothesis import strategies as st

from sysmlc.frontends.caex.metadata import quote_attribute


@example('it\'s "both"\n\t\r & <that>')
@given(st.text(alphabet=st.sampled_from("a'\"&<>\n\t\r é")))
def test_attributes_are_quoted_as_by_the_standard_library(value):
    assert quote_attribute(value) == quoteattr(value)
