"""Findings about interactions name the interaction, the lifeline and the message."""

import pytest

from sysmlc.diagnostics import Sink
from sysmlc.ir import parse_text
from sysmlc.passes import pipeline

DESTROYED = """
Interaction feed "Feed"
  Lifeline g "{lifeline}"
  Occurrence x subkind="destruction"
    -> covers g
  Occurrence o
    -> covers g
"""
CREATED = """
Interaction feed "Feed"
  Lifeline b "{lifeline}"
  Occurrence o
    -> covers b
  Occurrence r
    -> covers b
  Message m "new" subkind="create-message"
    -> receive-event r
    -> flow-target b
"""


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            DESTROYED,
            "something happens on lifeline '{lifeline}' of 'Feed' after it was destroyed",
        ),
        (
            CREATED,
            "message 'new' of 'Feed' creates lifeline '{lifeline}', on which something has "
            "happened before",
        ),
    ],
)
@pytest.mark.parametrize(("name", "lifeline"), [("gate", "gate"), ("", "without name")])
def test_the_lifeline_is_named(text, message, name, lifeline):
    sink = Sink()
    pipeline.load("interactions").run(parse_text(text.format(lifeline=name)), sink)
    messages = [found.message for found in sink]
    assert message.format(lifeline=lifeline) in messages
