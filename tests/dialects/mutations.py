"""Random damage to XML documents, like that of hand edits, merges and faulty tools."""

import copy
from collections.abc import Callable, Iterator, Sequence
from random import Random
from typing import TypeVar

from lxml import etree

from dialects.papyrus import XMI, Element

JUNK = (
    "",
    " ",
    "-1",
    "*",
    "true",
    "99999999999999999999",
    "1e400",
    "::",
    "a::b::c",
    "not (",
    "(" * 400,
    "x" * 5000,
    "é€\U0001f600",
    "{0}{name}%s",
    "../../../etc/passwd#_1",
    "http://localhost:1/x#y",
    "pathmap://NOWHERE/x.uml#_0",
)
_METACLASSES = (
    "Activity",
    "Class",
    "ConditionalNode",
    "Enumeration",
    "FinalState",
    "ForkNode",
    "InputPin",
    "LoopNode",
    "Model",
    "NoSuchMetaclass",
    "OpaqueAction",
    "Port",
    "Property",
    "Pseudostate",
    "Region",
    "State",
    "StateMachine",
    "Transition",
)

T = TypeVar("T")
Change = Callable[[Element, Random], object]
Damage = Callable[[bytes, Random], bytes]


def mutate(
    document: bytes,
    random: Random,
    more_changes: Sequence[Change] = (),
    more_damages: Sequence[Damage] = (),
    changes: Sequence[Change] | None = None,
) -> tuple[str, bytes]:
    """Apply one to three random changes; return their names and the result.

    *changes* replaces all changes of the tree, for documents that are not XMI.
    """
    names: list[str] = []
    root = etree.fromstring(document)
    _ensure_child(root)
    for _ in range(random.randint(1, 3)):
        change = random.choice(changes or (*_CHANGES, *more_changes))
        names.append(change.__name__.strip("_"))
        change(root, random)
        _ensure_child(root)
    mutated = etree.tostring(root, xml_declaration=True, encoding="UTF-8")
    if random.random() < 0.25:
        name, mutated = damage(mutated, random, more_damages)
        names.append(name)
    return " ".join(names), mutated


def damage(data: bytes, random: Random, more_damages: Sequence[Damage] = ()) -> tuple[str, bytes]:
    """Damage the bytes of a file that is not XML; return the name of the damage and the result."""
    chosen = random.choice((*_DAMAGES, *more_damages))
    return chosen.__name__.strip("_"), chosen(data, random)


# -- changes of the tree -----------------------------------------------------------------------


def xmi_key(root: Element, name: str) -> str:
    """Return the name of an XMI attribute in the version of XMI that the document uses."""
    spaces = [uri for uri in root.nsmap.values() if "omg.org" in uri and "XMI" in uri]
    return f"{{{spaces[0] if spaces else XMI}}}{name}"


def choose_element(root: Element, random: Random) -> Element:
    """Return a random element other than the root."""
    return random.choice([element for element in root.iter("*") if element is not root])


def choose_id(root: Element, random: Random) -> str:
    """Return the id of a random element, or the empty string."""
    return choose_element(root, random).get(xmi_key(root, "id"), "")


def _drop_element(root: Element, random: Random) -> None:
    victim = choose_element(root, random)
    victim.getparent().remove(victim)


def _duplicate_element(root: Element, random: Random) -> None:
    original = choose_element(root, random)
    original.addnext(copy.deepcopy(original))


def _swap_elements(root: Element, random: Random) -> None:
    first, second = choose_element(root, random), choose_element(root, random)
    if (
        first not in second.iterancestors()
        and second not in first.iterancestors()
        and first is not second
    ):
        first_place, second_place = etree.Element("here"), etree.Element("there")
        first.addprevious(first_place)
        second.addprevious(second_place)
        first_place.getparent().replace(first_place, second)
        second_place.getparent().replace(second_place, first)


def _move_element(root: Element, random: Random) -> None:
    element, owner = choose_element(root, random), choose_element(root, random)
    if element is not owner and element not in owner.iterancestors():
        owner.append(element)


def pair_in_cycle(items: list[T]) -> Iterator[tuple[T, T]]:
    """Yield each item with the next one; the last item is followed by the first."""
    yield from zip(items, items[1:] + items[:1], strict=True)


def find_references(root: Element) -> list[tuple[Element, str]]:
    """Return elements with the names of their attributes that contain an id of the document."""
    key = xmi_key(root, "id")
    ids = {element.get(key) for element in root.iter("*")}
    return [
        (element, str(name))
        for element in root.iter("*")
        for name, value in element.attrib.items()
        if name != key and value in ids
    ]


def _retarget_reference(root: Element, random: Random) -> None:
    references = find_references(root)
    if references:
        element, name = random.choice(references)
        element.set(name, choose_id(root, random))


def _close_cycle(root: Element, random: Random) -> None:
    """Make a reference name its own element or one of its owners: a cycle of types or flows."""
    references = find_references(root)
    if references:
        element, name = random.choice(references)
        circle = [element, *element.iterancestors()]
        element.set(name, random.choice(circle).get(xmi_key(root, "id"), ""))


def _break_reference(root: Element, random: Random) -> None:
    references = find_references(root)
    if references:
        element, name = random.choice(references)
        element.set(name, random.choice(["_nothing", "a b", "", "_"]))


def _change_type(root: Element, random: Random) -> None:
    key = xmi_key(root, "type")
    typed_elements = [element for element in root.iter("*") if key in element.attrib]
    random.choice(typed_elements or [root]).set(key, "uml:" + random.choice(_METACLASSES))


def _rename_feature(root: Element, random: Random) -> None:
    element = choose_element(root, random)
    element.tag = choose_element(root, random).tag


def _drop_attribute(root: Element, random: Random) -> None:
    element = choose_element(root, random)
    if element.attrib:
        del element.attrib[random.choice(list(element.attrib))]


def _spoil_attribute(root: Element, random: Random) -> None:
    element = choose_element(root, random)
    if element.attrib:
        element.set(random.choice(list(element.attrib)), random.choice(JUNK))


def _spoil_text(root: Element, random: Random) -> None:
    texts = [element for element in root.iter("*") if element.text and element.text.strip()]
    random.choice(texts or [choose_element(root, random)]).text = random.choice(JUNK)


def _duplicate_id(root: Element, random: Random) -> None:
    choose_element(root, random).set(xmi_key(root, "id"), choose_id(root, random))


def _nest_deeply(root: Element, random: Random) -> None:
    """Nest an element in many owners of its own kind."""
    victim = choose_element(root, random)
    tag, attributes = victim.tag, dict(victim.attrib)
    for depth in range(random.choice([3, 120])):
        outer = etree.Element(tag, attributes)
        outer.set(xmi_key(root, "id"), f"_deep{depth}")
        victim.addprevious(outer)
        outer.append(victim)
        victim = outer


def _ensure_child(root: Element) -> None:
    if len(root) == 0:
        etree.SubElement(root, "packagedElement")


_CHANGES: tuple[Change, ...] = (
    _drop_element,
    _duplicate_element,
    _swap_elements,
    _move_element,
    _retarget_reference,
    _retarget_reference,
    _close_cycle,
    _break_reference,
    _change_type,
    _change_type,
    _rename_feature,
    _drop_attribute,
    _spoil_attribute,
    _spoil_text,
    _duplicate_id,
    _nest_deeply,
)

GENERIC: tuple[Change, ...] = (
    _drop_element,
    _duplicate_element,
    _swap_elements,
    _move_element,
    _rename_feature,
    _drop_attribute,
    _spoil_attribute,
    _spoil_text,
)
"""Changes that apply to any XML document."""


# -- damage to the bytes -----------------------------------------------------------------------


def _truncate_bytes(data: bytes, random: Random) -> bytes:
    return data[: random.randrange(len(data))]


def _replace_byte(data: bytes, random: Random) -> bytes:
    index = random.randrange(len(data))
    return data[:index] + bytes([random.randrange(256)]) + data[index + 1 :]


def _insert_bytes(data: bytes, random: Random) -> bytes:
    index = random.randrange(len(data))
    return (
        data[:index] + random.choice([b"\x00", b"\xff", b"<", b"&", b"]]>", b"<!--"]) + data[index:]
    )


def _declare_wrong_encoding(data: bytes, random: Random) -> bytes:
    encoding = random.choice([b"UTF-16", b"windows-1252", b"US-ASCII", b"no-such-encoding"])
    return data.replace(b"UTF-8", encoding, 1)


def _change_encoding(data: bytes, random: Random) -> bytes:
    encoding = random.choice(["utf-16", "utf-8-sig", "utf-32"])
    return data.decode("utf-8", "replace").encode(encoding)


def _add_doctype(data: bytes, random: Random) -> bytes:
    head, _, rest = data.partition(b"?>")
    return head + b'?><!DOCTYPE x [<!ENTITY e SYSTEM "file:///etc/hostname">]>' + rest


_DAMAGES: tuple[Damage, ...] = (
    _truncate_bytes,
    _replace_byte,
    _insert_bytes,
    _declare_wrong_encoding,
    _change_encoding,
    _add_doctype,
)
