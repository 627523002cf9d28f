"""Changes of SysML v2 interchange files that a fuzzer makes: metaclasses, ids, references."""

from random import Random

from lxml import etree

from dialects.mutations import GENERIC, Change, choose_element
from dialects.papyrus import Element
from fuzz.changes import GENERIC as CROWDS

_XMI = "http://www.omg.org/spec/XMI/20131001"
_TYPE = "{http://www.w3.org/2001/XMLSchema-instance}type"
_KINDS = """
    PartUsage PartDefinition Membership OwningMembership FeatureMembership FeatureValue Subsetting
    Redefinition FeatureTyping Package NamespaceImport MembershipImport Conjugation ActionUsage
    StateUsage TransitionUsage OperatorExpression LiteralInteger MetadataUsage Comment
    ConnectionUsage EndFeatureMembership MultiplicityRange Feature ReturnParameterMembership
    NoSuchMetaclass Annotation Dependency ConjugatedPortTyping PortConjugation
"""


def _ids(root: Element) -> list[str]:
    found = [value for e in root.iter("*") for name, value in e.attrib.items() if _is_id(name)]
    return [str(value) for value in found] or ["none"]


def _is_id(name: object) -> bool:
    return str(name) in ("elementId", "id") or str(name).endswith("}id")


def _references(root: Element) -> list[tuple[Element, str]]:
    ids = set(_ids(root))
    return [
        (element, str(name))
        for element in root.iter("*")
        for name, value in element.attrib.items()
        if not _is_id(name) and (value in ids or name == "href")
    ]


def _other_metaclass(root: Element, random: Random) -> None:
    typed = [element for element in root.iter("*") if _TYPE in element.attrib]
    known = sorted({element.get(_TYPE) for element in typed})
    for element in random.sample(typed, min(len(typed), random.choice((1, 1, 4)))):
        new = f"sysml:{random.choice(_KINDS.split())}"
        element.set(_TYPE, random.choice((new, random.choice(known))))


def _all_of_one_metaclass(root: Element, random: Random) -> None:
    typed = [element for element in root.iter("*") if _TYPE in element.attrib]
    old = random.choice(typed).get(_TYPE) if typed else None
    new = f"sysml:{random.choice(_KINDS.split())}"
    for element in typed:
        if element.get(_TYPE) == old:
            element.set(_TYPE, new)


def _retarget(root: Element, random: Random) -> None:
    found = _references(root)
    for element, name in random.sample(found, min(len(found), random.choice((1, 2, 8)))):
        id = random.choice(_ids(root))
        odd = ("none", "", f"#{id}", f"../x.sysmlx#{id}", "http://127.0.0.1:1/x#y", f"{id} {id}")
        element.set(name, id if random.random() < 0.7 else random.choice(odd))


def _circle(root: Element, random: Random) -> None:
    """References to their own element or an owner of it."""
    found = _references(root)
    for element, name in random.sample(found, min(len(found), random.choice((1, 3)))):
        around = [element, *element.iterancestors()]
        ids = [str(v) for one in around for n, v in one.attrib.items() if _is_id(n)]
        element.set(name, random.choice(ids or ["none"]))


def _same_ids(root: Element, random: Random) -> None:
    for _ in range(random.choice((1, 5))):
        element = choose_element(root, random)
        for name in list(element.attrib):
            if _is_id(name):
                element.set(name, random.choice(_ids(root)))


def _no_names(root: Element, random: Random) -> None:
    for element in root.iter("*"):
        if random.random() < 0.5:
            element.attrib.pop("declaredName", None)


def _same_names(root: Element, random: Random) -> None:
    named = [e for e in root.iter("*") if "declaredName" in e.attrib]
    name = random.choice(("A", "", "a::b", "'", *(e.get("declaredName") or "" for e in named[:9])))
    for element in random.sample(named, min(len(named), random.choice((1, 3, 9)))):
        element.set("declaredName", name)


def _dig(root: Element, random: Random) -> None:
    """Members within members, under or over the limit."""
    here = choose_element(root, random)
    for depth in range(random.choice((40, 300, 700))):
        relation = etree.SubElement(here, "ownedRelationship")
        relation.set(_TYPE, "sysml:OwningMembership")
        here = etree.SubElement(relation, "ownedRelatedElement")
        here.set(_TYPE, "sysml:PartUsage")
        here.set(f"{{{_XMI}}}id", f"dug{depth}")


EXCHANGE_CHANGES: tuple[Change, ...] = (
    *GENERIC,
    *CROWDS,
    _other_metaclass,
    _other_metaclass,
    _all_of_one_metaclass,
    _retarget,
    _retarget,
    _circle,
    _same_ids,
    _no_names,
    _same_names,
    _dig,
)
"""What is done to interchange files."""
