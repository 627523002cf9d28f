"""Changes of a model that only a fuzzer makes: cycles, giants, strangers and crowds."""

import copy
from random import Random

from lxml import etree

from dialects.mutations import JUNK, Change, choose_element, choose_id, find_references, xmi_key
from dialects.papyrus import Element

_BOUNDS = ("0", "1", "-1", "*", "2147483648", "9" * 400, "1.5", "", "0x10", "٣", "1e9")
_EXPRESSIONS = (
    "a",
    "not a and (b or",
    "x > 10000000000000000000000",
    "x == 'é",
    "((((((((((a))))))))))",
    "- " * 500 + "1",
    "a" + ".b" * 300,
    "1/0",
    "true implies",
    "G(F(a U b))",
    "self.x := self.x + 1",
    "if a then b",
)


def _ids(root: Element) -> list[str]:
    key = xmi_key(root, "id")
    return [element.get(key) for element in root.iter("*") if key in element.attrib] or ["_"]


def _of_type(root: Element, *types: str) -> list[Element]:
    key = xmi_key(root, "type")
    wanted = {f"uml:{name}" for name in types}
    return [element for element in root.iter("*") if element.get(key) in wanted]


def _new(root: Element, owner: Element, feature: str, metaclass: str, **values: str) -> Element:
    made = etree.SubElement(owner, feature)
    made.set(xmi_key(root, "type"), f"uml:{metaclass}")
    made.set(xmi_key(root, "id"), f"_new{sum(1 for _ in owner)}_{feature}")
    for name, value in values.items():
        made.set(name, value)
    return made


def _circle_of_generals(root: Element, random: Random) -> None:
    """Classifiers that specialise one another, of one kind or of several."""
    classifiers = _of_type(
        root, "Class", "Component", "DataType", "Signal", "Activity", "Interface"
    )
    chosen = random.sample(classifiers, min(len(classifiers), random.randint(1, 4)))
    for one, other in zip(chosen, chosen[1:] + chosen[:1], strict=True):
        general = other.get(xmi_key(root, "id"), "")
        _new(root, one, "generalization", "Generalization", general=general)


def _circle_of_parts(root: Element, random: Random) -> None:
    """A class that is made of itself, directly or through another."""
    classes = _of_type(root, "Class", "Component")
    chosen = random.sample(classes, min(len(classes), random.randint(1, 3)))
    for one, other in zip(chosen, chosen[1:] + chosen[:1], strict=True):
        other_id = other.get(xmi_key(root, "id"), "")
        _new(
            root,
            one,
            "ownedAttribute",
            "Property",
            type=other_id,
            aggregation="composite",
            name="p",
        )


def _circle_of_calls(root: Element, random: Random) -> None:
    """Activities that call one another."""
    activities = _of_type(root, "Activity")
    chosen = random.sample(activities, min(len(activities), random.randint(1, 3)))
    for one, other in zip(chosen, chosen[1:] + chosen[:1], strict=True):
        behavior = other.get(xmi_key(root, "id"), "")
        _new(root, one, "node", "CallBehaviorAction", behavior=behavior)


def _circle_of_features(root: Element, random: Random) -> None:
    """Features that redefine or subset one another."""
    features = _of_type(root, "Property", "Port", "Operation")
    chosen = random.sample(features, min(len(features), random.randint(1, 3)))
    name = random.choice(
        ["redefinedProperty", "subsettedProperty", "redefinedOperation", "opposite"]
    )
    for one, other in zip(chosen, chosen[1:] + chosen[:1], strict=True):
        one.set(name, other.get(xmi_key(root, "id"), ""))


def _giant_multiplicity(root: Element, random: Random) -> None:
    owners = _of_type(root, "Property", "Port", "Parameter", "InputPin", "OutputPin")
    for owner in random.sample(owners, min(len(owners), 3)):
        for bound in ("lowerValue", "upperValue"):
            kind = random.choice(["LiteralInteger", "LiteralUnlimitedNatural", "LiteralString"])
            _new(root, owner, bound, kind, value=random.choice(_BOUNDS))


def _no_names(root: Element, random: Random) -> None:
    """Names are empty, blank, equal or gone, all of one feature."""
    feature = choose_element(root, random).tag
    name = random.choice(["", " ", "\n", "same", "\u202e", "a/b:c*", "con", None])
    for element in root.iter(feature):
        if name is None:
            element.attrib.pop("name", None)
        else:
            element.set("name", name)


def _all_of_one_type(root: Element, random: Random) -> None:
    """All elements of one metaclass get another."""
    key = xmi_key(root, "type")
    types = sorted({element.get(key) for element in root.iter("*") if key in element.attrib})
    if types:
        old, new = random.choice(types), random.choice(types)
        for element in root.iter("*"):
            if element.get(key) == old:
                element.set(key, new)


def _crossed_flows(root: Element, random: Random) -> None:
    """Edges and transitions lead from and to anything, also into other behaviours."""
    edges = [element for element in root.iter("*") if "source" in element.attrib]
    for edge in random.sample(edges, min(len(edges), 4)):
        edge.set(random.choice(["source", "target"]), choose_id(root, random))


def _turned_flows(root: Element, random: Random) -> None:
    edges = [element for element in root.iter("*") if {"source", "target"} <= set(element.attrib)]
    for edge in random.sample(edges, min(len(edges), 6)):
        source, target = edge.get("source", ""), edge.get("target", "")
        edge.set("source", target)
        edge.set("target", source)


def _lists_of_ids(root: Element, random: Random) -> None:
    """A reference gets many targets: doubled, blank, unknown, tabs between."""
    found = find_references(root)
    if found:
        element, name = random.choice(found)
        some = random.choices([*_ids(root), "_unknown", ""], k=random.choice([2, 3, 40]))
        element.set(name, random.choice([" ", "  ", "\t", ","]).join(some))


def _as_child(root: Element, random: Random) -> None:
    """A reference as MagicDraw writes it, or as an href."""
    found = find_references(root)
    if found:
        element, name = random.choice(found)
        value = element.attrib.pop(name)
        child = etree.SubElement(element, name)
        if random.random() < 0.5:
            child.set(xmi_key(root, "idref"), value)
        else:
            child.set("href", random.choice([f"#{value}", f"m.uml#{value}", "#", "", "../x.uml"]))


def _expressions(root: Element, random: Random) -> None:
    owners = _of_type(root, "ControlFlow", "ObjectFlow", "Transition", "Constraint", "OpaqueAction")
    for owner in random.sample(owners, min(len(owners), 3)):
        feature = random.choice(["guard", "specification", "weight"])
        made = _new(root, owner, feature, "OpaqueExpression")
        for _ in range(random.choice([1, 1, 2])):
            etree.SubElement(made, "body").text = random.choice((*_EXPRESSIONS, *JUNK))
        if random.random() < 0.3:
            etree.SubElement(made, "language").text = random.choice(["", "OCL", "LTL", "English"])


def _applied_elsewhere(root: Element, random: Random) -> None:
    """A stereotype application is doubled and given another base."""
    found = [e for e in root.iter("*") if any("base_" in str(name) for name in e.attrib)]
    if found:
        original = random.choice(found)
        double = copy.deepcopy(original)
        for name in double.attrib:
            if "base_" in str(name):
                double.set(name, choose_id(root, random))
        double.set(xmi_key(root, "id"), "_applied_again")
        original.addnext(double)


def _crowd(root: Element, random: Random) -> None:
    """Many copies of one element, each with ids of its own."""
    victim = choose_element(root, random)
    if sum(1 for _ in victim.iter("*")) > 50:
        return
    key = xmi_key(root, "id")
    for number in range(random.choice([5, 60])):
        double = copy.deepcopy(victim)
        for element in double.iter("*"):
            if key in element.attrib:
                element.set(key, f"{element.get(key)}.{number}")
        victim.addnext(double)


def _into_itself(root: Element, random: Random) -> None:
    """A copy of a subtree inside that subtree."""
    victim = choose_element(root, random)
    if sum(1 for _ in victim.iter("*")) < 300:
        random.choice(list(victim.iter("*"))).append(copy.deepcopy(victim))


def _many_drops(root: Element, random: Random) -> None:
    """Every element of a kind is gone, with what it holds."""
    feature = choose_element(root, random).tag
    for element in [e for e in root.iter(feature) if e is not root]:
        owner = element.getparent()
        if owner is not None and random.random() < 0.7:
            owner.remove(element)


def _rename_attribute(root: Element, random: Random) -> None:
    element, other = choose_element(root, random), choose_element(root, random)
    if element.attrib and other.attrib:
        name = random.choice(list(other.attrib))
        element.set(name, element.attrib.pop(random.choice(list(element.attrib))))


def _move_to_root(root: Element, random: Random) -> None:
    root.insert(random.randrange(len(root) + 1), choose_element(root, random))


def _dig(root: Element, random: Random) -> None:
    """Nested so deep that recursion would end: under or over the limit."""
    here = choose_element(root, random)
    tag, attributes = here.tag, dict(here.attrib)
    for depth in range(random.choice([100, 400, 600])):
        here = etree.SubElement(here, tag, attributes)
        here.set(xmi_key(root, "id"), f"_dug{depth}")


GENERIC: tuple[Change, ...] = (_into_itself, _many_drops, _rename_attribute, _move_to_root)
"""Changes that know nothing of XMI."""

CHANGES: tuple[Change, ...] = (
    _circle_of_generals,
    _circle_of_parts,
    _circle_of_calls,
    _circle_of_features,
    _giant_multiplicity,
    _no_names,
    _all_of_one_type,
    _crossed_flows,
    _crossed_flows,
    _turned_flows,
    _lists_of_ids,
    _as_child,
    _expressions,
    _applied_elsewhere,
    _crowd,
    _into_itself,
    _many_drops,
    _rename_attribute,
    _move_to_root,
    _dig,
)
