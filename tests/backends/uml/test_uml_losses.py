"""Losses: what UML cannot express, or expresses in another form than the graph."""

import pytest
from lxml import etree
from uml_files import read, refine, round_trip, save

from dialects.papyrus import XMI
from rule_examples import read_graphs
from sysmlc.backends.uml import rules
from sysmlc.ir import Edge, Kind

RULES = (
    rules.UNSUPPORTED_KIND,
    rules.UNSUPPORTED_EDGE,
    rules.UNSUPPORTED_ATTRIBUTE,
    rules.MOVED,
    rules.APPROXIMATED,
    rules.ILLEGAL_CHARACTERS,
    rules.RESPELT_ID,
)


@pytest.mark.parametrize("rule", RULES, ids=lambda rule: rule.name)
def test_the_wrong_example_breaks_the_rule_and_the_right_one_does_not(rule):
    assert rule.code in [message[:5] for message in save(refine(read_graphs(rule).wrong))[1]]
    assert save(refine(read_graphs(rule).right))[1] == []


def test_a_loss_is_counted_and_reported_once():
    facets = "".join(f'  Facet f{number} "F{number}"\n' for number in range(3))
    assert save(refine('Package p "Plant"\n' + facets))[1] == [
        "SM720 UML cannot express facet (3 omitted from the saved model)"
    ]


ROLES = """
Package p "Plant"
  Class gate "Gate" role="block"
    Port gate.in "in" role="proxy port"
      -> typed-by pallets
  Class plain "Plain" role="block"
  Class pallets "Pallets" role="interface block"
    Property pallets.p "p" role="flow property" direction="in"
  Class r1 "No jam" role="requirement" req_id="R1" text="It never jams."
  DataType length "Length" role="value type"
  Dependency d "" subkind="abstraction" role="satisfy"
    -> client gate
    -> supplier r1
"""


def test_roles_without_stereotypes_become_stereotypes_of_sysml():
    graph = refine(ROLES)
    text, back, _ = round_trip(graph)
    for element in graph:
        copy = next(e for e in back if e.name == element.name and e.kind is element.kind)
        for key in ("role", "direction", "req_id", "text"):
            assert copy.attrs.get(key) == element.attrs.get(key), (element, key)
    assert 'SysML.package_packagedElement_Ports_u0026Flows"' in text
    assert '<Requirements:Requirement xmi:id="_' in text


def test_only_ids_that_xml_does_not_allow_are_derived():
    text, _, changes = round_trip(
        refine(
            'Package "a#p" "Plant"\n  Class "2" "Two"\n  Class "b#p" "Three"\n  Class kept "Kept"\n'
        )
    )
    model = etree.fromstring(text.encode())[0]
    ids = [element.get(f"{{{XMI}}}id", "") for element in model.iter("*")]
    assert (ids[0], ids[1], ids[3]) == ("p", "_2", "kept")
    assert ids[2].startswith("_")
    assert "#" not in ids[2]
    assert changes == []


def test_text_is_escaped():
    name = 'a <b> & "c"\n\té'
    graph = refine('Package p "Plant"\n  Comment c ""\n')
    graph.rename(graph["p"], name)
    graph.set(graph["c"], body=f"{name}\r\n]]>")
    _, back, changes = round_trip(graph)
    assert changes == []
    assert back["p"].name == name


def test_a_reference_to_another_model_is_an_href():
    text = """
Package p "Plant"
  Class gate "Gate"
    -> specializes arm
Class arm "Arm" external=true href="robots.uml#_arm" qualified_name="Robots::Arm"
"""
    saved_text, back, _ = round_trip(refine(text))
    assert '<general xmi:type="uml:Class" href="robots.uml#_arm">' in saved_text
    (stub,) = [element for element in back if element.attrs.get("external")]
    assert (stub.name, stub.attrs["qualified_name"]) == ("Arm", "Robots::Arm")


def test_an_empty_graph_is_an_empty_document():
    text, messages = save(refine(""))
    assert len(read(text.encode())) == 0
    assert messages == []


LIBRARY = """
Package p "Plant"
  Class gate "Gate" role="block"
    Application a "Cell" stereotype="Cell" namespace="urn:cells"
      -> subject gate
      -> instance-of cell
Stereotype cell "Cell" external=true library=true href="cells.mdzip#_cell" source="cells.mdzip"
  -> specializes block
Stereotype block "Block" external=true library=true href="SysML Profile.mdzip#_block"
"""


def test_a_role_from_an_external_library_gets_a_stereotype_of_sysml():
    text, back, _ = round_trip(refine(LIBRARY))
    assert 'Blocks:Block xmi:id="_' in text
    (gate,) = [element for element in back if element.name == "Gate"]
    assert gate.role == "block"


PLANT = """
Package lib "Classes"
  Class motor "Motor" role="block"
    Port motor.p "p"
    -> realizes drive
  Class line "Line" role="block"
    Property line.m "m" aggregation="composite"
      -> typed-by motor
Package h "Plant"
  Instance one "Line 1"
    -> instance-of line
    Connector one.c "wire"
      -> end one.c.1
      -> end one.c.2
      ConnectorEnd one.c.1 ""
        -> role motor.p
        -> path line.m
      ConnectorEnd one.c.2 ""
        -> role motor.p
        -> path line.m
Package roles "Roles" external=true library=true
  Class drive "Drive" external=true library=true
"""


def test_connectors_of_an_instance_are_saved_with_its_class():
    graph = refine(PLANT)
    _, messages = save(graph)
    assert (
        "SM723 UML lets no instance own connector: saved with the nearest possible owner (1)"
        in messages
    )
    _, back, _ = round_trip(graph)
    (wire,) = [element for element in back if element.name == "wire"]
    assert back.owner(wire).name == "Line"
    path = back.targets(back.owned(wire)[0], Edge.PATH)
    assert [step.name for step in path] == ["m"]


def test_a_relation_without_dependency_gets_one():
    graph = refine(PLANT)
    text, messages = save(graph)
    assert "SM724 'realizes' from class is saved as Realization (1)" in messages
    assert "pathmap://SYSMLC_LIBRARIES/Roles#Drive" in text
    (motor,) = [element for element in read(text.encode()) if element.name == "Motor"]
    assert motor.role == "block"


@pytest.mark.parametrize(
    ("edge", "role"), [("satisfies", "satisfy"), ("allocated-to", "allocate"), ("depends", None)]
)
def test_an_edge_that_nothing_implies_is_saved_as_a_dependency(edge, role):
    graph = refine(f"""
Package p "Plant"
  Class a "A"
    -> {edge} b
  Class b "B"
""")
    _, back, _ = round_trip(graph)
    a, b = (next(element for element in back if element.name == name) for name in "AB")
    assert back.targets(a, Edge(edge)) == [b]
    (dependency,) = back.of_kind(Kind.DEPENDENCY)
    assert dependency.attrs.get("role") == role
