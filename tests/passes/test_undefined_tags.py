"""Tags that the profile of the unit does not define are reported once for each stereotype."""

import pytest
from pass_runs import list_messages

from sysmlc.diagnostics import Sink
from sysmlc.ir import Graph
from sysmlc.ir.text import parse_text
from sysmlc.passes.classify.tags import UNDEFINED_TAG, check_tags

PROFILE = """\
Profile q "Plant"
  Stereotype g "Station"
    Property o "maker of it"
  Stereotype s "Cell"{external}
    -> specializes g
    Property n "number"
Class a "A"
  Application t "Cell" stereotype="Cell"{tags}
    -> instance-of s
    -> subject a
Class b "B"
  Application u "Cell" stereotype="Cell"{tags}
    -> instance-of s
    -> subject b
"""


def list_undefined_tags(tags: str, external: str = "") -> list[str]:
    sink = Sink()
    check_tags(parse_text(PROFILE.format(tags=tags, external=external)), sink)
    return list_messages(sink, UNDEFINED_TAG.code)


def test_an_undefined_tag_is_reported_once():
    assert list_undefined_tags(' tag.numbr="3"') == [
        "tag 'numbr' of stereotype 'Cell' on 'A' and 1 more is not defined by its profile"
    ]


@pytest.mark.parametrize("tags", ["", ' tag.number="3"', ' tag.Number="3"', ' tag.maker_of_it="x"'])
def test_tags_of_the_stereotype_and_its_generals_are_defined(tags):
    assert list_undefined_tags(tags) == []


def test_tags_of_a_stereotype_outside_the_unit_are_not_checked():
    assert list_undefined_tags(' tag.numbr="3"', external=" external=true") == []


def test_an_empty_model_has_no_undefined_tags():
    sink = Sink()
    check_tags(Graph(), sink)
    assert list(sink) == []
