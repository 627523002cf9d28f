"""Changes of AutomationML that a fuzzer makes: paths, ids and links astray, circles of classes."""

import copy
from random import Random

from lxml import etree

from dialects.mutations import GENERIC, JUNK, Change, choose_element
from dialects.papyrus import Element
from fuzz.changes import GENERIC as CROWDS

_LIBRARIES = {
    "InterfaceClass": ("InterfaceClassLib", "RefBaseClassPath"),
    "RoleClass": ("RoleClassLib", "RefBaseClassPath"),
    "SystemUnitClass": ("SystemUnitClassLib", "RefBaseClassPath"),
    "AttributeType": ("AttributeTypeLib", "RefAttributeType"),
}
_PATHS = (
    "RefBaseClassPath",
    "RefBaseRoleClassPath",
    "RefBaseSystemUnitPath",
    "RefRoleClassPath",
    "RefAttributeType",
)
_SIDES = ("RefPartnerSideA", "RefPartnerSideB")
_TAGS = (
    *_LIBRARIES,
    *(library for library, _ in _LIBRARIES.values()),
    "Attribute",
    "AttributeNameMapping",
    "Constraint",
    "ExternalInterface",
    "ExternalReference",
    "InstanceHierarchy",
    "InternalElement",
    "InternalLink",
    "MappingObject",
    "RefSemantic",
    "RoleRequirements",
    "SupportedRoleClass",
    "Value",
)
_VALUES = (*JUNK, "0", "NaN", "1,5", "2026-13-45", "P1D", "0x1F", "AQID", "true ", "-0", "9" * 400)
_TYPES = ("xs:boolean", "xs:integer", "xs:double", "xs:dateTime", "xs:base64Binary", "xs:none", "")
_UNITS = ("mm", "m/s", "kg·m²/s^2", "°C", "%", "MTS", "^^", "m^" + "9" * 50, "(" * 50, "xs:anyUnit")


def _local(element: Element) -> str:
    return etree.QName(element).localname


def _of_tag(root: Element, *tags: str) -> list[Element]:
    return [element for element in root.iter("*") if _local(element) in tags]


def _some(found: list[Element], random: Random, most: int) -> list[Element]:
    return random.sample(found, min(len(found), random.randint(1, most)))


def _new(owner: Element, tag: str, **values: str) -> Element:
    made = etree.SubElement(owner, etree.QName(etree.QName(owner).namespace, tag))
    for name, value in values.items():
        made.set(name, value)
    return made


def path_of(element: Element) -> str:
    """The class path of an element: names from the library down."""
    around = [element, *element.iterancestors()]
    names = [one.get("Name") or "" for one in around if _local(one) != "CAEXFile"]
    return "/".join(reversed(names))


def _any_path(root: Element, random: Random) -> str:
    known = path_of(random.choice(_of_tag(root, *_LIBRARIES) or [choose_element(root, random)]))
    spelt = "/".join(f"[{part}]" for part in known.split("/"))
    broken = (f"{known}/none", known[:-1], f"A@{known}", f"[{known}", f"{known}]", "/", "@", "@@/")
    return random.choice((known, known, known, spelt, *broken))


def _any_id(root: Element, random: Random) -> str:
    ids = [element.get("ID") for element in root.iter("*") if element.get("ID")]
    id = str(random.choice(ids or ["none"]))
    return random.choice((id, id, id, f"{{{id}}}", id.upper(), f"A@{id}", f" {id}", "none", ""))


# -- classes -------------------------------------------------------------------------------------


def _lead_paths_astray(root: Element, random: Random) -> None:
    found = [(e, name) for e in root.iter("*") for name in _PATHS if name in e.attrib]
    for element, name in random.sample(found, min(len(found), random.randint(1, 4))):
        element.set(name, _any_path(root, random))


def _circle_of_bases(root: Element, random: Random) -> None:
    """Classes of one library that specialise one another, by path or by bare name."""
    tag, (_, feature) = random.choice(list(_LIBRARIES.items()))
    chosen = _some(_of_tag(root, tag), random, 4)
    for one, other in zip(chosen, chosen[1:] + chosen[:1], strict=True):
        one.set(feature, random.choice((path_of(other), other.get("Name") or "")))


def _circle_of_parts(root: Element, random: Random) -> None:
    """A class that is made of itself, directly or through another."""
    chosen = _some(_of_tag(root, "SystemUnitClass", "RoleClass"), random, 3)
    for one, other in zip(chosen, chosen[1:] + chosen[:1], strict=True):
        _new(one, "InternalElement", Name="in", ID=f"in{random.random()}").set(
            "RefBaseSystemUnitPath", path_of(other)
        )


def _circle_of_mirrors(root: Element, random: Random) -> None:
    chosen = _some(_of_tag(root, "InternalElement", "ExternalInterface", "Attribute"), random, 4)
    features = {"InternalElement": "RefBaseSystemUnitPath", "Attribute": "RefAttributeType"}
    for one, other in zip(chosen, chosen[1:] + chosen[:1], strict=True):
        feature = features.get(_local(one), "RefBaseClassPath")
        one.set(feature, other.get("ID") or path_of(other))


def _other_tag(root: Element, random: Random) -> None:
    element = choose_element(root, random)
    element.tag = etree.QName(etree.QName(root).namespace, random.choice(_TAGS))


def _all_of_one_tag(root: Element, random: Random) -> None:
    old = choose_element(root, random).tag
    new = etree.QName(etree.QName(root).namespace, random.choice(_TAGS))
    for element in list(root.iter(old)):
        element.tag = new


# -- ids and links -------------------------------------------------------------------------------


def _other_ids(root: Element, random: Random) -> None:
    for element in _some([e for e in root.iter("*") if "ID" in e.attrib], random, 4):
        element.set("ID", _any_id(root, random))


def _no_ids(root: Element, random: Random) -> None:
    for element in root.iter("*"):
        if random.random() < 0.8:
            element.attrib.pop("ID", None)


def _cross_links(root: Element, random: Random) -> None:
    for link in _some(_of_tag(root, "InternalLink"), random, 5):
        side = random.choice(_SIDES)
        name = random.choice(list(root.iter("*"))).get("Name") or ""
        id = _any_id(root, random)
        link.set(side, random.choice((id, f"{id}:{name}", f"{id}:", f":{name}", name, "a/b:c")))


def _more_links(root: Element, random: Random) -> None:
    owners = _of_tag(root, "InternalElement", "SystemUnitClass", "InstanceHierarchy")
    for owner in _some(owners, random, 3):
        link = _new(owner, "InternalLink", Name=random.choice(("l", "")))
        for side in _SIDES:
            link.set(side, _any_id(root, random))


def _references_to_files(root: Element, random: Random) -> None:
    path = random.choice(("m.aml", "../../x.aml", "/etc/passwd", "http://127.0.0.1:1/x", ".", ""))
    known = _of_tag(root, "ExternalReference")
    for one in known[:1] or [_new(root, "ExternalReference")]:
        one.set("Path", path)
        one.set("Alias", random.choice(("A", "", "a@b", "A")))


# -- values --------------------------------------------------------------------------------------


def _odd_values(root: Element, random: Random) -> None:
    for attribute in _some(_of_tag(root, "Attribute", "AttributeType"), random, 4):
        attribute.set("AttributeDataType", random.choice(_TYPES))
        attribute.set("Unit", random.choice(_UNITS))
        _new(attribute, random.choice(("Value", "DefaultValue"))).text = random.choice(_VALUES)


def _odd_constraints(root: Element, random: Random) -> None:
    for attribute in _some(_of_tag(root, "Attribute"), random, 2):
        constraint = _new(attribute, "Constraint", Name="c")
        scaled = _new(constraint, random.choice(("OrdinalScaledType", "NominalScaledType", "X")))
        for tag in ("RequiredMaxValue", "RequiredValue", "RequiredMinValue"):
            _new(scaled, tag).text = random.choice(_VALUES)


def _odd_ports(root: Element, random: Random) -> None:
    for port in _some(_of_tag(root, "ExternalInterface"), random, 4):
        name = random.choice(("Direction", "Cardinality", "Category", "refURI"))
        attribute = _new(port, "Attribute", Name=name)
        _new(attribute, "Value").text = random.choice(("In", "InOut", "sideways", *_VALUES))
        for part in ("MinOccur", "MaxOccur"):
            inner = _new(attribute, "Attribute", Name=part)
            _new(inner, "Value").text = random.choice(("5", "0", "many", *_VALUES))


def _no_names(root: Element, random: Random) -> None:
    tag = choose_element(root, random).tag
    name = random.choice(("", " ", "same", "a/b", "a@b", "[a]", "a:b", "\u202e", "con", None))
    for element in root.iter(tag):
        if name is None:
            element.attrib.pop("Name", None)
        else:
            element.set("Name", name)


def _schema_version(root: Element, random: Random) -> None:
    root.set("SchemaVersion", random.choice(("2.15", "3.0", "1.0", "", "9" * 50)))


def _crowd(root: Element, random: Random) -> None:
    victim = choose_element(root, random)
    if sum(1 for _ in victim.iter("*")) > 50:
        return
    for number in range(random.choice((5, 60))):
        double = copy.deepcopy(victim)
        for element in double.iter("*"):
            if "ID" in element.attrib:
                element.set("ID", f"{element.get('ID')}.{number}")
        victim.addnext(double)


def _dig(root: Element, random: Random) -> None:
    """Nested so deep that recursion would end: under or over the limit."""
    here = choose_element(root, random)
    tag, attributes = here.tag, dict(here.attrib)
    for depth in range(random.choice((100, 400, 600))):
        here = etree.SubElement(here, tag, attributes)
        if "ID" in attributes:
            here.set("ID", f"dug{depth}")


def _other_part(root: Element, random: Random) -> None:
    """The table of a package leads elsewhere."""
    for one in _some([e for e in root.iter("*") if "Target" in e.attrib], random, 2):
        one.set(
            "Target", random.choice(("/", "", "../x", "/gone.aml", "http://x/y", "/_rels/.rels"))
        )


AML_CHANGES: tuple[Change, ...] = (
    *GENERIC,
    *CROWDS,
    _lead_paths_astray,
    _lead_paths_astray,
    _circle_of_bases,
    _circle_of_parts,
    _circle_of_mirrors,
    _other_tag,
    _all_of_one_tag,
    _other_ids,
    _no_ids,
    _cross_links,
    _more_links,
    _references_to_files,
    _odd_values,
    _odd_constraints,
    _odd_ports,
    _no_names,
    _schema_version,
    _crowd,
    _dig,
    _other_part,
)
"""What is done to AutomationML."""
