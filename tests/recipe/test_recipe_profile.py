"""The shipped profile is consistent, and it has every tag that the pass reads."""

import re
from collections import Counter
from pathlib import Path

from lxml import etree

import sysmlc.analyses
from sysmlc.support import resources

XMI = "{http://www.omg.org/spec/XMI/20131001}"
PROFILE = etree.parse(resources.path("metamodels", "sysmlc.profile.uml")).getroot()
ANALYSES = Path(sysmlc.analyses.__file__).parent


def list_elements(type_: str) -> dict[str, etree._Element]:
    """Return the elements of an xmi:type by name."""
    elements = (element for element in PROFILE.iter() if element.get(f"{XMI}type") == type_)
    return {element.get("name"): element for element in elements}


def list_features(owner: etree._Element, tag: str) -> set[str]:
    """Return the names of the features of an element."""
    return {feature.get("name") for feature in owner.findall(tag)}


def test_the_profile_has_the_expected_stereotypes():
    names = {
        "Recipe",
        "Task",
        "MachineService",
        "InfrastructureService",
        "MachineFunction",
        "Machine",
        "Material",
        "OpcUaCall",
        "Capability",
        "Loop",
    }
    assert names <= list_elements("uml:Stereotype").keys() <= names | {"Service"}


def test_ids_are_unique_and_references_name_existing_elements():
    ids = Counter(element.get(f"{XMI}id") for element in PROFILE.iter() if element.get(f"{XMI}id"))
    assert max(ids.values()) == 1
    for element in PROFILE.iter():
        for name in ("type", "association", "general", "memberEnd", "references", "eSuperTypes"):
            assert set((element.get(name) or "").split()) <= ids.keys()


def test_each_base_property_of_a_stereotype_has_an_extension():
    bases = {
        (name, feature.removeprefix("base_"))
        for name, stereotype in list_elements("uml:Stereotype").items()
        for feature in list_features(stereotype, "ownedAttribute")
        if feature.startswith("base_")
    }
    assert {f"E_{name}_{metaclass}" for name, metaclass in bases} == list_elements(
        "uml:Extension"
    ).keys()


def test_the_ecore_definition_has_the_same_features():
    classes = list_elements("ecore:EClass")
    for name, stereotype in list_elements("uml:Stereotype").items():
        assert list_features(stereotype, "ownedAttribute") == list_features(
            classes[name], "eStructuralFeatures"
        )


def test_every_tag_that_the_pass_reads_is_in_the_profile():
    code = "".join(path.read_text(encoding="utf-8") for path in ANALYSES.glob("recipe/*.py"))
    read = set(re.findall(r"tags\.\w+\(\"(\w+)\"", code))
    read |= set(re.findall(r"tags\.range\(\"\w+\", \"(\w+)\"", code))
    stereotypes = list_elements("uml:Stereotype").values()
    attributes = set().union(*(list_features(s, "ownedAttribute") for s in stereotypes))
    assert len(read) > 20
    assert read <= attributes
