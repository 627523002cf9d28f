"""Queries: stereotypes, generals, conformance, types, features, connector ends, bounds."""

import pytest

from sysmlc.ir import query
from sysmlc.ir.text import parse_text

GATE = parse_text(
    """\
Class device "Device"
  -> specializes gate
  Port device.in "in"
    -> typed-by track
Class gate "Gate"
  -> specializes device
  -> realizes reading
  Port gate.in "in"
    -> redefines device.in
  Application b stereotype="Block" tag.Text="T" tag.n=["1", "2"]
    -> subject gate
  Application c stereotype="Custom" lineage=["Custom", "Block"] tag.text="t"
    -> subject gate
Class track "Track"
  FlowProperty track.p "p" direction="in"
Interface reading "Reading"
Connector c1
  -> end e1 e2
  ConnectorEnd e1
    -> role gate.in
  ConnectorEnd e2
    -> role device.in
    -> path gate
"""
)


def list_ids(elements):
    return [element.id for element in elements]


def test_stereotypes_and_tags_are_those_of_all_applications():
    gate = GATE["gate"]
    assert list_ids(query.applications(GATE, gate)) == ["b", "c"]
    assert query.stereotypes(GATE, gate) == ("Block", "Custom")
    assert query.has_stereotype(GATE, gate, "Nothing", "Block")
    assert not query.has_stereotype(GATE, gate, "Nothing")
    assert query.tag(GATE, gate, "text") == "t"
    assert query.tag(GATE, gate, "Text") == "T"
    assert query.tag(GATE, gate, "TEXT") == "T"
    assert query.tag(GATE, gate, "n") == ("1", "2")
    assert query.tag(GATE, gate, "absent") is None


def test_generals_of_a_cycle_are_finite():
    assert list_ids(query.generals(GATE, GATE["gate"])) == ["device"]


def test_generals_come_nearest_first_each_once():
    graph = parse_text(
        """\
Class robot "Robot"
  -> specializes arm cart
Class arm "Arm"
  -> specializes axis machine
Class cart "Cart"
  -> specializes machine
Class axis "Axis"
Class machine "Machine"
  -> specializes thing
Class thing "Thing"
"""
    )
    generals = query.generals(graph, graph["robot"])
    assert list_ids(generals) == ["arm", "cart", "axis", "machine", "thing"]


def test_a_class_that_specialises_itself_is_not_among_its_generals():
    graph = parse_text('Class a "A"\n  -> specializes a b\nClass b "B"\n  -> specializes a\n')
    assert list_ids(query.generals(graph, graph["a"])) == ["b"]


def test_a_class_conforms_to_its_generals_and_their_realised_interfaces():
    gate, track = GATE["gate"], GATE["track"]
    assert query.conforms(GATE, gate, gate)
    assert query.conforms(GATE, gate, GATE["device"])
    assert query.conforms(GATE, GATE["device"], GATE["reading"])
    assert not query.conforms(GATE, gate, track)


def test_a_redefining_feature_has_the_type_of_the_redefined_feature():
    assert query.type_of(GATE, GATE["gate.in"]).id == "track"
    assert query.type_of(GATE, GATE["track.p"]) is None


def test_features_before_inherit_are_the_owned_features():
    assert list_ids(query.features(GATE, GATE["gate"])) == ["gate.in"]
    assert list_ids(query.ports(GATE, GATE["gate"])) == ["gate.in"]
    assert list_ids(query.flow_properties(GATE, GATE["track"])) == ["track.p"]


def test_a_connector_end_has_a_role_an_opposite_end_and_perhaps_a_path():
    connector, first, second = GATE["c1"], GATE["e1"], GATE["e2"]
    assert query.opposite_end(GATE, connector, first) is second
    assert query.role_of(GATE, first).id == "gate.in"
    assert (query.is_boundary(GATE, first), query.is_boundary(GATE, second)) == (True, False)
    assert list_ids(query.connectors_of(GATE, GATE["gate.in"])) == ["c1"]


@pytest.mark.parametrize(
    ("multiplicity", "expected"),
    [
        (None, (1, 1)),
        ("*", (0, None)),
        ("0..1", (0, 1)),
        ("2..*", (2, None)),
        ("3", (3, 3)),
        (4, (4, 4)),
        ("", None),
        ("a..b", None),
        ("*..1", None),
        ("1..", None),
        ("-1", None),
    ],
)
def test_bounds_of_a_multiplicity(multiplicity, expected):
    assert query.bounds(multiplicity) == expected
