"""Directions of the features at the ends of flows (SM242)."""

import pytest
from small_models import list_messages

MODEL = """
    item def Signal;
    port def Serial {{ in item rx : Signal; out item tx : Signal; }}
    part def Device {{ port s : Serial; in item order : Signal; out item report : Signal; }}
    part def Host {{ port s : ~Serial; }}
    part def Rack {{ port s : Serial; part inner : Device; {inside} }}
    part line {{ part a : Device; part b : Host; part c : Device; {outside} }}
    interface def Cable {{ end left : Serial; end right : ~Serial; {between} }}
"""


def list_directions(inside="", outside="", between=""):
    """Return the findings about flows inside a part, between parts and in an interface."""
    return list_messages(MODEL.format(inside=inside, outside=outside, between=between))


@pytest.mark.parametrize(
    "flow",
    [
        {"outside": "flow from a.s.tx to b.s.tx;"},
        {"outside": "flow from b.s.rx to a.s.rx;"},
        {"outside": "flow from a.report to c.order;"},
        {"inside": "flow from s.rx to inner.s.rx;"},
        {"inside": "flow from inner.s.tx to s.tx;"},
        {"between": "flow from left.tx to right.tx;"},
    ],
)
def test_flows_run_from_outputs_to_inputs(flow):
    assert list_directions(**flow) == []


@pytest.mark.parametrize(
    ("flow", "messages"),
    [
        (
            {"outside": "flow from a.s.rx to b.s.rx;"},
            [
                "the flow leaves 'a.s.rx', whose direction is in there",
                "the flow enters 'b.s.rx', whose direction is out there",
            ],
        ),
        (
            {"outside": "flow from a.s.tx to c.s.tx;"},
            ["the flow enters 'c.s.tx', whose direction is out there"],
        ),
        (
            {"outside": "flow from a.order to c.order;"},
            ["the flow leaves 'a.order', whose direction is in there"],
        ),
        (
            {"inside": "flow from s.tx to inner.s.rx;"},
            ["the flow leaves 's.tx', whose direction is out there"],
        ),
        (
            {"between": "flow from left.rx to right.tx;"},
            ["the flow leaves 'left.rx', whose direction is in there"],
        ),
    ],
)
def test_a_flow_against_a_direction_is_reported(flow, messages):
    assert list_directions(**flow) == messages
