"""Tags that the profile of the unit does not define are told, once for each stereotype."""

import pytest

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


def told(tags: str, external: str = "") -> list[str]:
    sink = Sink()
    check_tags(parse_text(PROFILE.format(tags=tags, external=external)), sink)
    return [finding.message for finding in sink if finding.rule is UNDEFINED_TAG]


def test_a_tag_is_told_once():
    assert told(' tag.numbr="3"') == [
        "tag 'numbr' of stereotype 'Cell' on 'A' and 1 more is not defined by its profile"
    ]


@pytest.mark.parametrize("tags", ["", ' tag.number="3"', ' tag.Number="3"', ' tag.maker_of_it="x"'])
def test_tags_of_the_stereotype_and_of_general_ones_are_not(tags):
    assert told(tags) == []


def test_of_a_stereotype_that_another_file_has_nothing_is_known():
    assert told(' tag.numbr="3"', external=" external=true") == []


def test_without_a_stereotype_nothing_is_known():
    sink = Sink()
    check_tags(Graph(), sink)
    assert list(sink) == []
