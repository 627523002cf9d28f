"""Random changes of SysML v2 interchange files: metaclasses, ids, references, names."""

from random import Random

from lxml import etree

from dialects.mutations import GENERIC, Change, choose_element
from dialects.papyrus import Element
from fuzz.xmi_changes import XML_CHANGES

_XMI = "http://www.omg.org/spec/XMI/20131001"
_TYPE = "{http://www.w3.org/2001/XMLSchema-instance}type"
_KINDS = """
    PartUsage PartDefinition Membership OwningMembership FeatureMembership FeatureValue Subsetting
    Redefinition FeatureTyping Package NamespaceImport MembershipImport Conjugation ActionUsage
    StateUsage TransitionUsage OperatorExpression LiteralInteger MetadataUsage Comment
    ConnectionUsage EndFeatureMembership MultiplicityRange Feature ReturnParameterMembership
    NoSuchMetaclass Annotation Dependency ConjugatedPortTyping PortConjugation
"""


def _list_ids(root: Element) -> list[str]:
    ids = [
        value
        for element in root.iter("*")
        for name, value in element.attrib.items()
        if _is_id(name)
    ]
    return [str(value) for value in ids] or ["none"]


def _is_id(name: object) -> bool:
    return str(name) in ("elementId", "id") or str(name).endswith("}id")


def _find_references(root: Element) -> list[tuple[Element, str]]:
    ids = set(_list_ids(root))
    return [
        (element, str(name))
        for element in root.iter("*")
        for name, value in element.attrib.items()
        if not _is_id(name) and (value in ids or name == "href")
    ]


def _change_metaclass(root: Element, random: Random) -> None:
    typed_elements = [element for element in root.iter("*") if _TYPE in element.attrib]
    metaclasses = sorted({element.get(_TYPE) for element in typed_elements})
    for element in random.sample(
        typed_elements, min(len(typed_elements), random.choice((1, 1, 4)))
    ):
        new = f"sysml:{random.choice(_KINDS.split())}"
        element.set(_TYPE, random.choice((new, random.choice(metaclasses))))


def _change_all_of_one_metaclass(root: Element, random: Random) -> None:
    typed_elements = [element for element in root.iter("*") if _TYPE in element.attrib]
    old = random.choice(typed_elements).get(_TYPE) if typed_elements else None
    new = f"sysml:{random.choice(_KINDS.split())}"
    for element in typed_elements:
        if element.get(_TYPE) == old:
            element.set(_TYPE, new)


def _misdirect_references(root: Element, random: Random) -> None:
    references = _find_references(root)
    for element, name in random.sample(references, min(len(references), random.choice((1, 2, 8)))):
        id = random.choice(_list_ids(root))
        odd_targets = (
            "none",
            "",
            f"#{id}",
            f"../x.sysmlx#{id}",
            "http://127.0.0.1:1/x#y",
            f"{id} {id}",
        )
        element.set(name, id if random.random() < 0.7 else random.choice(odd_targets))


def _close_cycles(root: Element, random: Random) -> None:
    """Make references name their own element or one of its owners."""
    references = _find_references(root)
    for element, name in random.sample(references, min(len(references), random.choice((1, 3)))):
        elements = [element, *element.iterancestors()]
        ids = [
            str(value)
            for owner in elements
            for attribute, value in owner.attrib.items()
            if _is_id(attribute)
        ]
        element.set(name, random.choice(ids or ["none"]))


def _duplicate_ids(root: Element, random: Random) -> None:
    for _ in range(random.choice((1, 5))):
        element = choose_element(root, random)
        for name in list(element.attrib):
            if _is_id(name):
                element.set(name, random.choice(_list_ids(root)))


def _drop_names(root: Element, random: Random) -> None:
    for element in root.iter("*"):
        if random.random() < 0.5:
            element.attrib.pop("declaredName", None)


def _duplicate_names(root: Element, random: Random) -> None:
    named_elements = [e for e in root.iter("*") if "declaredName" in e.attrib]
    name = random.choice(
        ("A", "", "a::b", "'", *(e.get("declaredName") or "" for e in named_elements[:9]))
    )
    for element in random.sample(
        named_elements, min(len(named_elements), random.choice((1, 3, 9)))
    ):
        element.set("declaredName", name)


def _nest_deeply(root: Element, random: Random) -> None:
    """Nest members deeply: below or above the limit on depth."""
    element = choose_element(root, random)
    for depth in range(random.choice((40, 300, 700))):
        relation = etree.SubElement(element, "ownedRelationship")
        relation.set(_TYPE, "sysml:OwningMembership")
        element = etree.SubElement(relation, "ownedRelatedElement")
        element.set(_TYPE, "sysml:PartUsage")
        element.set(f"{{{_XMI}}}id", f"dug{depth}")


INTERCHANGE_CHANGES: tuple[Change, ...] = (
    *GENERIC,
    *XML_CHANGES,
    _change_metaclass,
    _change_metaclass,
    _change_all_of_one_metaclass,
    _misdirect_references,
    _misdirect_references,
    _close_cycles,
    _duplicate_ids,
    _drop_names,
    _duplicate_names,
    _nest_deeply,
)
"""All changes of interchange files; frequent ones are listed twice."""
