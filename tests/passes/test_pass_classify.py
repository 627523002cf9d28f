"""The pass ``classify``: roles by the stereotypes of all dialects, and levels."""

import pytest
from pass_runs import list_codes, run_until

from sysmlc.ir import Edge

PAPYRUS = "http://www.eclipse.org/papyrus/sysml/1.6/SysML"
OLD_PAPYRUS = "http://www.eclipse.org/papyrus/0.7.0/SysML"
OMG = "http://www.omg.org/spec/SysML/20150709/SysML"
MAGICDRAW = "http://www.magicdraw.com/spec/Customization/180/SysML"
SPARX = "http://www.sparxsystems.com/profiles/SysML1.3/1.3"
SHIPPED = "urn:sysmlc:profile:1"


def apply_stereotype(line: str, stereotype: str, namespace: str, id: str = "x") -> str:
    return (
        f'{line}\n  Application a{id} stereotype="{stereotype}" namespace="{namespace}"\n'
        f"    -> subject {id}\n"
    )


@pytest.mark.parametrize(
    ("line", "stereotype", "namespace", "role"),
    [
        ('Class x "X"', "Block", f"{PAPYRUS}/Blocks", "block"),
        ('Class x "X"', "Block", f"{OLD_PAPYRUS}/Blocks", "block"),
        ('Class x "X"', "Block", "http://www.eclipse.org/papyrus/sysml/1.4/SysML/Blocks", "block"),
        ('Class x "X"', "Block", OMG, "block"),
        ('Class x "X"', "Block", "https://www.omg.org/spec/SysML/20240101", "block"),
        ('Class x "X"', "Block", SPARX, "block"),
        ('Class x "X"', "Subsystem", OMG, "block"),
        ('Class x "X"', "ConstraintBlock", f"{OLD_PAPYRUS}/Constraints", "constraint block"),
        ('Class x "X"', "InterfaceBlock", f"{PAPYRUS}/PortsAndFlows", "interface block"),
        ('Interface x "X"', "FlowSpecification", f"{OLD_PAPYRUS}/PortAndFlows", "interface block"),
        ('Class x "X"', "performanceRequirement", OMG, "requirement"),
        ('DataType x "X"', "ValueType", OMG, "value type"),
        ('Port x "X"', "FlowPort", f"{OLD_PAPYRUS}/PortAndFlows", "flow port"),
        ('Port x "X"', "FullPort", OMG, "full port"),
        ('Port x "X"', "FlowPort", "http://www.eclipse.org/papyrus/GCM/1", "port"),
        ('Port x "X"', "FlowPort", "http://www.eclipse.org/papyrus/MARTE/1", "port"),
        ('Property x "X"', "PartProperty", MAGICDRAW, "part"),
        ('Property x "X"', "ValueProperty", MAGICDRAW, "value"),
        (
            'Property x "X"',
            "ConstraintProperty",
            "http://www.magicdraw.com/schemas/additional_stereotypes.xmi",
            "constraint property",
        ),
        ('Activity x "X"', "TestCase", f"{PAPYRUS}/Requirements", "test case"),
        ('Package x "X"', "View", f"{OLD_PAPYRUS}/ModelElements", "view"),
        ('Connector x "X"', "BindingConnector", OMG, "binding connector"),
        ('ItemFlow x "X"', "ItemFlow", OMG, "item flow"),
        ('Class x "X"', "FullPort", OMG, ""),
    ],
)
def test_the_stereotypes_of_each_dialect_give_the_role(line, stereotype, namespace, role):
    graph, sink = run_until(apply_stereotype(line, stereotype, namespace), "classify")
    assert graph["x"].role == role
    assert "SM210" not in list_codes(sink)


def test_a_stereotype_whose_name_xml_cannot_write_is_recognised():
    profile = 'Profile p "Arrowhead"\n  Stereotype p.s "SD-DD"\n    -> specializes i\n'
    text = apply_stereotype(
        'Class x "X"', "SD_DD", "http://www.magicdraw.com/schemas/Arrowhead.xmi"
    )
    stub = 'Stereotype i "InterfaceBlock" external=true href="SysML Profile.mdzip#_1"\n'
    graph, _ = run_until(text + profile + stub, "classify")
    assert graph["x"].role == "interface block"
    assert graph["ax"].attrs["lineage"] == ("SD-DD", "InterfaceBlock", "Block")
    assert graph.target(graph["ax"], Edge.INSTANCE_OF).id == "p.s"


def test_the_namespace_selects_among_stereotypes_of_the_same_name():
    profiles = (
        'Profile p "one" uri="http://a"\n  Stereotype p.s "Gate"\n'
        'Profile q "two" uri="http://b"\n  Stereotype q.s "Gate"\n    -> specializes b\n'
        f'Stereotype b "Block" external=true href="{OMG}.xmi#Block"\n'
    )
    for namespace, role in (("http://a", ""), ("http://b", "block"), ("http://c", "")):
        graph, _ = run_until(
            apply_stereotype('Class x "X"', "Gate", namespace) + profiles, "classify"
        )
        assert graph["x"].role == role


def test_a_stereotype_that_specialises_itself_has_a_finite_lineage():
    profile = (
        'Profile p "p" uri="http://a"\n  Stereotype s "S"\n    -> specializes t\n'
        '  Stereotype t "T"\n    -> specializes s\n'
    )
    graph, _ = run_until(apply_stereotype('Class x "X"', "S", "http://a") + profile, "classify")
    assert graph["ax"].attrs["lineage"] == ("S", "T")


def test_a_class_with_sysml_ports_is_a_block_whatever_its_stereotype():
    text = (
        apply_stereotype('Class g "Gate"', "Station", "http://a", "g")
        + '  Port x "in"\n    -> typed-by t\n'
        + f'    Application ax stereotype="ProxyPort" namespace="{OMG}"\n      -> subject x\n'
        + 'Class t "Track"\n'
    )
    graph, _ = run_until(text, "classify")
    assert (graph["g"].role, graph["t"].role) == ("block", "interface block")


def test_a_plain_uml_class_with_plain_ports_is_no_block():
    graph, _ = run_until('Class g "Gate"\n  Port p "in"\n', "classify")
    assert graph["g"].role == ""


def test_only_the_shipped_profile_gives_levels():
    for namespace, level in ((SHIPPED, "task"), ("http://a", None)):
        graph, _ = run_until(apply_stereotype('Activity x "X"', "Task", namespace), "classify")
        assert graph["x"].attrs.get("level") == level


def test_a_stereotype_that_specialises_a_shipped_one_gives_its_level():
    profile = (
        'Profile p "plant" uri="http://a"\n  Stereotype s "Screwing"\n    -> specializes t\n'
        'Stereotype t "Task" external=true href="pathmap://SYSMLC_PROFILES/sysmlc.profile.uml#Task"\n'
    )
    graph, _ = run_until(
        apply_stereotype('Activity x "X"', "Screwing", "http://a") + profile, "classify"
    )
    assert graph["x"].attrs["level"] == "task"


def test_an_opc_ua_call_does_not_hide_the_level_of_its_service():
    text = apply_stereotype('Activity x "X"', "OpcUaCall", SHIPPED) + (
        f'  Application b stereotype="MachineService" namespace="{SHIPPED}"\n    -> subject x\n'
    )
    assert run_until(text, "classify")[0]["x"].attrs["level"] == "machine service"


def test_the_level_of_a_general_classifier_is_inherited():
    text = (
        apply_stereotype('Class x "Machine"', "Machine", SHIPPED)
        + 'Class y "Robot"\n  -> specializes x\nClass z "Arm"\n  -> specializes y\n'
    )
    graph, _ = run_until(text, "classify")
    assert [graph[id].attrs.get("level") for id in "xyz"] == ["machine"] * 3


def test_a_role_from_the_front_end_needs_no_stereotype():
    assert run_until('Class x "X" role="block"', "classify")[0]["x"].role == "block"


def test_a_requirement_takes_its_text_from_tags_of_the_element():
    """Enterprise Architect may write a stereotype in one place and its tags in another."""
    graph, _ = run_until(
        apply_stereotype('Class x "X" tag.id="R1" tag.text="shall hold"', "Requirement", SPARX),
        "classify",
    )
    assert (graph["x"].attrs["req_id"], graph["x"].attrs["text"]) == ("R1", "shall hold")
