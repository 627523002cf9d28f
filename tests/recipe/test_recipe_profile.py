"""The shipped profile: complete in itself, and the one that the pass reads."""

import re
from collections import Counter
from pathlib import Path

from lxml import etree

import sysmlc.passes
from sysmlc.support import resources

XMI = "{http://www.omg.org/spec/XMI/20131001}"
PROFILE = etree.parse(resources.path("metamodels", "sysmlc.profile.uml")).getroot()
PASSES = Path(sysmlc.passes.__file__).parent


def elements(type_: str) -> dict[str, etree._Element]:
    """Elements of an xmi:type by name."""
    found = (one for one in PROFILE.iter() if one.get(f"{XMI}type") == type_)
    return {one.get("name"): one for one in found}


def features(owner: etree._Element, tag: str) -> set[str]:
    """Names of its features."""
    return {one.get("name") for one in owner.findall(tag)}


def test_the_profile_has_the_stereotypes_of_the_design():
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
    assert names <= elements("uml:Stereotype").keys() <= names | {"Service"}


def test_ids_are_unique_and_references_lead_somewhere():
    ids = Counter(one.get(f"{XMI}id") for one in PROFILE.iter() if one.get(f"{XMI}id"))
    assert max(ids.values()) == 1
    for one in PROFILE.iter():
        for name in ("type", "association", "general", "memberEnd", "references", "eSuperTypes"):
            assert set((one.get(name) or "").split()) <= ids.keys()


def test_each_extension_is_there_from_both_sides():
    bases = {
        (name, feature.removeprefix("base_"))
        for name, one in elements("uml:Stereotype").items()
        for feature in features(one, "ownedAttribute")
        if feature.startswith("base_")
    }
    assert {f"E_{name}_{metaclass}" for name, metaclass in bases} == elements(
        "uml:Extension"
    ).keys()


def test_the_ecore_definition_has_the_same_features():
    classes = elements("ecore:EClass")
    for name, stereotype in elements("uml:Stereotype").items():
        assert features(stereotype, "ownedAttribute") == features(
            classes[name], "eStructuralFeatures"
        )


def test_every_tag_that_the_pass_reads_is_in_the_profile():
    code = "".join(path.read_text(encoding="utf-8") for path in PASSES.glob("recipe/*.py"))
    read = set(re.findall(r"tags\.\w+\(\"(\w+)\"", code))
    read |= set(re.findall(r"tags\.range\(\"\w+\", \"(\w+)\"", code))
    known = set().union(
        *(features(one, "ownedAttribute") for one in elements("uml:Stereotype").values())
    )
    assert len(read) > 20
    assert read <= known
