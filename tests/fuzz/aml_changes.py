"""Random changes of AutomationML: wrong paths, ids and links, cycles of classes, odd values."""

from random import Random

from lxml import etree

from dialects.mutations import GENERIC, JUNK, Change, choose_element, pair_in_cycle
from dialects.papyrus import Element
from fuzz.xmi_changes import XML_CHANGES, add_many_copies, rename_all

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


def _local_name(element: Element) -> str:
    return etree.QName(element).localname


def _find_by_tag(root: Element, *tags: str) -> list[Element]:
    return [element for element in root.iter("*") if _local_name(element) in tags]


def _sample(elements: list[Element], random: Random, largest: int) -> list[Element]:
    return random.sample(elements, min(len(elements), random.randint(1, largest)))


def _add_child(owner: Element, tag: str, **values: str) -> Element:
    child = etree.SubElement(owner, etree.QName(etree.QName(owner).namespace, tag))
    for name, value in values.items():
        child.set(name, value)
    return child


def class_path(element: Element) -> str:
    """Return the class path of an element: the names from the library down."""
    elements = [element, *element.iterancestors()]
    names = [owner.get("Name") or "" for owner in elements if _local_name(owner) != "CAEXFile"]
    return "/".join(reversed(names))


def _choose_path(root: Element, random: Random) -> str:
    path = class_path(
        random.choice(_find_by_tag(root, *_LIBRARIES) or [choose_element(root, random)])
    )
    bracketed = "/".join(f"[{part}]" for part in path.split("/"))
    broken = (f"{path}/none", path[:-1], f"A@{path}", f"[{path}", f"{path}]", "/", "@", "@@/")
    return random.choice((path, path, path, bracketed, *broken))


def _choose_id(root: Element, random: Random) -> str:
    ids = [element.get("ID") for element in root.iter("*") if element.get("ID")]
    id = str(random.choice(ids or ["none"]))
    return random.choice((id, id, id, f"{{{id}}}", id.upper(), f"A@{id}", f" {id}", "none", ""))


# -- classes -------------------------------------------------------------------------------------


def _misdirect_paths(root: Element, random: Random) -> None:
    references = [
        (element, name) for element in root.iter("*") for name in _PATHS if name in element.attrib
    ]
    for element, name in random.sample(references, min(len(references), random.randint(1, 4))):
        element.set(name, _choose_path(root, random))


def _make_cycle_of_bases(root: Element, random: Random) -> None:
    """Make classes of one kind specialise one another in a cycle, by path or by bare name."""
    tag, (_, feature) = random.choice(list(_LIBRARIES.items()))
    chosen = _sample(_find_by_tag(root, tag), random, 4)
    for class_, base in pair_in_cycle(chosen):
        class_.set(feature, random.choice((class_path(base), base.get("Name") or "")))


def _make_cycle_of_parts(root: Element, random: Random) -> None:
    """Make a class a part of itself, directly or through other classes."""
    chosen = _sample(_find_by_tag(root, "SystemUnitClass", "RoleClass"), random, 3)
    for owner, part_class in pair_in_cycle(chosen):
        _add_child(owner, "InternalElement", Name="in", ID=f"in{random.random()}").set(
            "RefBaseSystemUnitPath", class_path(part_class)
        )


def _make_cycle_of_mirrors(root: Element, random: Random) -> None:
    chosen = _sample(
        _find_by_tag(root, "InternalElement", "ExternalInterface", "Attribute"), random, 4
    )
    features = {"InternalElement": "RefBaseSystemUnitPath", "Attribute": "RefAttributeType"}
    for mirror, master in pair_in_cycle(chosen):
        feature = features.get(_local_name(mirror), "RefBaseClassPath")
        mirror.set(feature, master.get("ID") or class_path(master))


def _change_tag(root: Element, random: Random) -> None:
    element = choose_element(root, random)
    element.tag = etree.QName(etree.QName(root).namespace, random.choice(_TAGS))


def _change_all_of_one_tag(root: Element, random: Random) -> None:
    old = choose_element(root, random).tag
    new = etree.QName(etree.QName(root).namespace, random.choice(_TAGS))
    for element in list(root.iter(old)):
        element.tag = new


# -- ids and links -------------------------------------------------------------------------------


def _change_ids(root: Element, random: Random) -> None:
    for element in _sample(
        [candidate for candidate in root.iter("*") if "ID" in candidate.attrib], random, 4
    ):
        element.set("ID", _choose_id(root, random))


def _drop_ids(root: Element, random: Random) -> None:
    for element in root.iter("*"):
        if random.random() < 0.8:
            element.attrib.pop("ID", None)


def _misdirect_links(root: Element, random: Random) -> None:
    for link in _sample(_find_by_tag(root, "InternalLink"), random, 5):
        side = random.choice(_SIDES)
        name = random.choice(list(root.iter("*"))).get("Name") or ""
        id = _choose_id(root, random)
        link.set(side, random.choice((id, f"{id}:{name}", f"{id}:", f":{name}", name, "a/b:c")))


def _add_links(root: Element, random: Random) -> None:
    owners = _find_by_tag(root, "InternalElement", "SystemUnitClass", "InstanceHierarchy")
    for owner in _sample(owners, random, 3):
        link = _add_child(owner, "InternalLink", Name=random.choice(("l", "")))
        for side in _SIDES:
            link.set(side, _choose_id(root, random))


def _set_file_references(root: Element, random: Random) -> None:
    path = random.choice(("m.aml", "../../x.aml", "/etc/passwd", "http://127.0.0.1:1/x", ".", ""))
    references = _find_by_tag(root, "ExternalReference")
    for reference in references[:1] or [_add_child(root, "ExternalReference")]:
        reference.set("Path", path)
        reference.set("Alias", random.choice(("A", "", "a@b", "A")))


# -- values --------------------------------------------------------------------------------------


def _add_odd_values(root: Element, random: Random) -> None:
    for attribute in _sample(_find_by_tag(root, "Attribute", "AttributeType"), random, 4):
        attribute.set("AttributeDataType", random.choice(_TYPES))
        attribute.set("Unit", random.choice(_UNITS))
        _add_child(attribute, random.choice(("Value", "DefaultValue"))).text = random.choice(
            _VALUES
        )


def _add_odd_constraints(root: Element, random: Random) -> None:
    for attribute in _sample(_find_by_tag(root, "Attribute"), random, 2):
        constraint = _add_child(attribute, "Constraint", Name="c")
        scaled = _add_child(
            constraint, random.choice(("OrdinalScaledType", "NominalScaledType", "X"))
        )
        for tag in ("RequiredMaxValue", "RequiredValue", "RequiredMinValue"):
            _add_child(scaled, tag).text = random.choice(_VALUES)


def _add_odd_port_attributes(root: Element, random: Random) -> None:
    for port in _sample(_find_by_tag(root, "ExternalInterface"), random, 4):
        name = random.choice(("Direction", "Cardinality", "Category", "refURI"))
        attribute = _add_child(port, "Attribute", Name=name)
        _add_child(attribute, "Value").text = random.choice(("In", "InOut", "sideways", *_VALUES))
        for part in ("MinOccur", "MaxOccur"):
            inner = _add_child(attribute, "Attribute", Name=part)
            _add_child(inner, "Value").text = random.choice(("5", "0", "many", *_VALUES))


def _spoil_names(root: Element, random: Random) -> None:
    names = ("", " ", "same", "a/b", "a@b", "[a]", "a:b", "\u202e", "con", None)
    rename_all(root, random, "Name", names)


def _change_schema_version(root: Element, random: Random) -> None:
    root.set("SchemaVersion", random.choice(("2.15", "3.0", "1.0", "", "9" * 50)))


def _add_many_copies(root: Element, random: Random) -> None:
    add_many_copies(root, random, "ID")


def _nest_deeply(root: Element, random: Random) -> None:
    """Nest copies of an element deeply: below or above the limit on depth."""
    element = choose_element(root, random)
    tag, attributes = element.tag, dict(element.attrib)
    for depth in range(random.choice((100, 400, 600))):
        element = etree.SubElement(element, tag, attributes)
        if "ID" in attributes:
            element.set("ID", f"dug{depth}")


def _misdirect_relationships(root: Element, random: Random) -> None:
    """Make a relationship of a package name another target."""
    for relationship in _sample([e for e in root.iter("*") if "Target" in e.attrib], random, 2):
        relationship.set(
            "Target", random.choice(("/", "", "../x", "/gone.aml", "http://x/y", "/_rels/.rels"))
        )


AML_CHANGES: tuple[Change, ...] = (
    *GENERIC,
    *XML_CHANGES,
    _misdirect_paths,
    _misdirect_paths,
    _make_cycle_of_bases,
    _make_cycle_of_parts,
    _make_cycle_of_mirrors,
    _change_tag,
    _change_all_of_one_tag,
    _change_ids,
    _drop_ids,
    _misdirect_links,
    _add_links,
    _set_file_references,
    _add_odd_values,
    _add_odd_constraints,
    _add_odd_port_attributes,
    _spoil_names,
    _change_schema_version,
    _add_many_copies,
    _nest_deeply,
    _misdirect_relationships,
)
"""All changes of AutomationML; frequent ones are listed twice."""
