"""Random changes of XMI: cycles, huge bounds, odd expressions, many copies, deep nesting."""

import copy
from collections.abc import Sequence
from random import Random

from lxml import etree

from dialects.mutations import (
    JUNK,
    Change,
    choose_element,
    choose_id,
    find_references,
    pair_in_cycle,
    xmi_key,
)
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


def _list_ids(root: Element) -> list[str]:
    key = xmi_key(root, "id")
    return [element.get(key) for element in root.iter("*") if key in element.attrib] or ["_"]


def _find_by_type(root: Element, *types: str) -> list[Element]:
    key = xmi_key(root, "type")
    wanted = {f"uml:{name}" for name in types}
    return [element for element in root.iter("*") if element.get(key) in wanted]


def _add_child(
    root: Element, owner: Element, feature: str, metaclass: str, **values: str
) -> Element:
    child = etree.SubElement(owner, feature)
    child.set(xmi_key(root, "type"), f"uml:{metaclass}")
    child.set(xmi_key(root, "id"), f"_new{sum(1 for _ in owner)}_{feature}")
    for name, value in values.items():
        child.set(name, value)
    return child


def _make_cycle_of_generals(root: Element, random: Random) -> None:
    """Make classifiers of any kinds specialise one another in a cycle."""
    classifiers = _find_by_type(
        root, "Class", "Component", "DataType", "Signal", "Activity", "Interface"
    )
    chosen = random.sample(classifiers, min(len(classifiers), random.randint(1, 4)))
    for classifier, general in pair_in_cycle(chosen):
        general_id = general.get(xmi_key(root, "id"), "")
        _add_child(root, classifier, "generalization", "Generalization", general=general_id)


def _make_cycle_of_parts(root: Element, random: Random) -> None:
    """Make a class a part of itself, directly or through other classes."""
    classes = _find_by_type(root, "Class", "Component")
    chosen = random.sample(classes, min(len(classes), random.randint(1, 3)))
    for owner, part_class in pair_in_cycle(chosen):
        part_id = part_class.get(xmi_key(root, "id"), "")
        _add_child(
            root,
            owner,
            "ownedAttribute",
            "Property",
            type=part_id,
            aggregation="composite",
            name="p",
        )


def _make_cycle_of_calls(root: Element, random: Random) -> None:
    """Make activities call one another in a cycle."""
    activities = _find_by_type(root, "Activity")
    chosen = random.sample(activities, min(len(activities), random.randint(1, 3)))
    for caller, callee in pair_in_cycle(chosen):
        callee_id = callee.get(xmi_key(root, "id"), "")
        _add_child(root, caller, "node", "CallBehaviorAction", behavior=callee_id)


def _make_cycle_of_features(root: Element, random: Random) -> None:
    """Make features redefine or subset one another in a cycle."""
    features = _find_by_type(root, "Property", "Port", "Operation")
    chosen = random.sample(features, min(len(features), random.randint(1, 3)))
    name = random.choice(
        ["redefinedProperty", "subsettedProperty", "redefinedOperation", "opposite"]
    )
    for feature, target in pair_in_cycle(chosen):
        feature.set(name, target.get(xmi_key(root, "id"), ""))


def _set_huge_bounds(root: Element, random: Random) -> None:
    owners = _find_by_type(root, "Property", "Port", "Parameter", "InputPin", "OutputPin")
    for owner in random.sample(owners, min(len(owners), 3)):
        for bound in ("lowerValue", "upperValue"):
            kind = random.choice(["LiteralInteger", "LiteralUnlimitedNatural", "LiteralString"])
            _add_child(root, owner, bound, kind, value=random.choice(_BOUNDS))


def _spoil_names(root: Element, random: Random) -> None:
    rename_all(root, random, "name", ("", " ", "\n", "same", "\u202e", "a/b:c*", "con", None))


def rename_all(root: Element, random: Random, attribute: str, names: Sequence[str | None]) -> None:
    """Give all elements of one tag one of *names*, or remove their names for None."""
    tag = choose_element(root, random).tag
    name = random.choice(names)
    for element in root.iter(tag):
        if name is None:
            element.attrib.pop(attribute, None)
        else:
            element.set(attribute, name)


def _change_all_of_one_type(root: Element, random: Random) -> None:
    """Give all elements of one metaclass another metaclass."""
    key = xmi_key(root, "type")
    types = sorted({element.get(key) for element in root.iter("*") if key in element.attrib})
    if types:
        old, new = random.choice(types), random.choice(types)
        for element in root.iter("*"):
            if element.get(key) == old:
                element.set(key, new)


def _misdirect_flows(root: Element, random: Random) -> None:
    """Connect edges and transitions to any elements, also in other behaviours."""
    edges = [element for element in root.iter("*") if "source" in element.attrib]
    for edge in random.sample(edges, min(len(edges), 4)):
        edge.set(random.choice(["source", "target"]), choose_id(root, random))


def _reverse_flows(root: Element, random: Random) -> None:
    edges = [element for element in root.iter("*") if {"source", "target"} <= set(element.attrib)]
    for edge in random.sample(edges, min(len(edges), 6)):
        source, target = edge.get("source", ""), edge.get("target", "")
        edge.set("source", target)
        edge.set("target", source)


def _refer_to_many(root: Element, random: Random) -> None:
    """Give a reference many targets: duplicate, empty or unknown ones, separated by tabs."""
    references = find_references(root)
    if references:
        element, name = random.choice(references)
        ids = random.choices([*_list_ids(root), "_unknown", ""], k=random.choice([2, 3, 40]))
        element.set(name, random.choice([" ", "  ", "\t", ","]).join(ids))


def _write_reference_as_child(root: Element, random: Random) -> None:
    """Write a reference as a child element, as MagicDraw does, or as an href."""
    references = find_references(root)
    if references:
        element, name = random.choice(references)
        value = element.attrib.pop(name)
        child = etree.SubElement(element, name)
        if random.random() < 0.5:
            child.set(xmi_key(root, "idref"), value)
        else:
            child.set("href", random.choice([f"#{value}", f"m.uml#{value}", "#", "", "../x.uml"]))


def _add_odd_expressions(root: Element, random: Random) -> None:
    owners = _find_by_type(
        root, "ControlFlow", "ObjectFlow", "Transition", "Constraint", "OpaqueAction"
    )
    for owner in random.sample(owners, min(len(owners), 3)):
        feature = random.choice(["guard", "specification", "weight"])
        expression = _add_child(root, owner, feature, "OpaqueExpression")
        for _ in range(random.choice([1, 1, 2])):
            etree.SubElement(expression, "body").text = random.choice((*_EXPRESSIONS, *JUNK))
        if random.random() < 0.3:
            etree.SubElement(expression, "language").text = random.choice(
                ["", "OCL", "LTL", "English"]
            )


def _duplicate_application(root: Element, random: Random) -> None:
    """Duplicate a stereotype application and give the copy another base."""
    applications = [
        element
        for element in root.iter("*")
        if any("base_" in str(name) for name in element.attrib)
    ]
    if applications:
        original = random.choice(applications)
        copied = copy.deepcopy(original)
        for name in copied.attrib:
            if "base_" in str(name):
                copied.set(name, choose_id(root, random))
        copied.set(xmi_key(root, "id"), "_applied_again")
        original.addnext(copied)


def _add_many_copies(root: Element, random: Random) -> None:
    add_many_copies(root, random, xmi_key(root, "id"))


def add_many_copies(root: Element, random: Random, id_attribute: str) -> None:
    """Add 5 or 60 copies of one element, each with unique ids."""
    original = choose_element(root, random)
    if sum(1 for _ in original.iter("*")) > 50:
        return
    for number in range(random.choice((5, 60))):
        copied = copy.deepcopy(original)
        for element in copied.iter("*"):
            if id_attribute in element.attrib:
                element.set(id_attribute, f"{element.get(id_attribute)}.{number}")
        original.addnext(copied)


def _copy_into_itself(root: Element, random: Random) -> None:
    """Insert a copy of a subtree into that subtree."""
    victim = choose_element(root, random)
    if sum(1 for _ in victim.iter("*")) < 300:
        random.choice(list(victim.iter("*"))).append(copy.deepcopy(victim))


def _drop_many(root: Element, random: Random) -> None:
    """Remove most elements of one feature, with their content."""
    feature = choose_element(root, random).tag
    for element in [candidate for candidate in root.iter(feature) if candidate is not root]:
        owner = element.getparent()
        if owner is not None and random.random() < 0.7:
            owner.remove(element)


def _rename_attribute(root: Element, random: Random) -> None:
    element, donor = choose_element(root, random), choose_element(root, random)
    if element.attrib and donor.attrib:
        name = random.choice(list(donor.attrib))
        element.set(name, element.attrib.pop(random.choice(list(element.attrib))))


def _move_to_root(root: Element, random: Random) -> None:
    root.insert(random.randrange(len(root) + 1), choose_element(root, random))


def _nest_deeply(root: Element, random: Random) -> None:
    """Nest copies of an element deeply: below or above the limit on depth."""
    element = choose_element(root, random)
    tag, attributes = element.tag, dict(element.attrib)
    for depth in range(random.choice([100, 400, 600])):
        element = etree.SubElement(element, tag, attributes)
        element.set(xmi_key(root, "id"), f"_dug{depth}")


XML_CHANGES: tuple[Change, ...] = (_copy_into_itself, _drop_many, _rename_attribute, _move_to_root)
"""Changes that apply to any XML document."""

XMI_CHANGES: tuple[Change, ...] = (
    _make_cycle_of_generals,
    _make_cycle_of_parts,
    _make_cycle_of_calls,
    _make_cycle_of_features,
    _set_huge_bounds,
    _spoil_names,
    _change_all_of_one_type,
    _misdirect_flows,
    _misdirect_flows,
    _reverse_flows,
    _refer_to_many,
    _write_reference_as_child,
    _add_odd_expressions,
    _duplicate_application,
    _add_many_copies,
    _copy_into_itself,
    _drop_many,
    _rename_attribute,
    _move_to_root,
    _nest_deeply,
)
