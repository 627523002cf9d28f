"""Spoils documents with knowledge of their structure: what hand edits, merges and bugs leave."""

import copy
from collections.abc import Callable, Sequence
from random import Random

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

Change = Callable[[Element, Random], object]
Damage = Callable[[bytes, Random], bytes]


def mutate(
    document: bytes,
    random: Random,
    more_changes: Sequence[Change] = (),
    more_damages: Sequence[Damage] = (),
    changes: Sequence[Change] | None = None,
) -> tuple[str, bytes]:
    """One to three changes of the document; what was done, and the result.

    ``changes`` are all there are, for documents that are no XMI.
    """
    done: list[str] = []
    root = etree.fromstring(document)
    _never_empty(root)
    for _ in range(random.randint(1, 3)):
        change = random.choice(changes or (*_CHANGES, *more_changes))
        done.append(change.__name__.strip("_"))
        change(root, random)
        _never_empty(root)
    spoilt = etree.tostring(root, xml_declaration=True, encoding="UTF-8")
    if random.random() < 0.25:
        name, spoilt = damage(spoilt, random, more_damages)
        done.append(name)
    return " ".join(done), spoilt


def damage(data: bytes, random: Random, more_damages: Sequence[Damage] = ()) -> tuple[str, bytes]:
    """Damage to the bytes alone, for files that are no XML."""
    chosen = random.choice((*_DAMAGES, *more_damages))
    return chosen.__name__.strip("_"), chosen(data, random)


# -- changes of the tree -----------------------------------------------------------------------


def xmi_key(root: Element, name: str) -> str:
    """An attribute of XMI, in the version of XMI that the document is written in."""
    spaces = [uri for uri in root.nsmap.values() if "omg.org" in uri and "XMI" in uri]
    return f"{{{spaces[0] if spaces else XMI}}}{name}"


def any_element(root: Element, random: Random) -> Element:
    """Some element, not the root."""
    return random.choice([element for element in root.iter("*") if element is not root])


def any_id(root: Element, random: Random) -> str:
    """Id of some element, or the empty string."""
    return any_element(root, random).get(xmi_key(root, "id"), "")


def _drop(root: Element, random: Random) -> None:
    victim = any_element(root, random)
    victim.getparent().remove(victim)


def _duplicate(root: Element, random: Random) -> None:
    original = any_element(root, random)
    original.addnext(copy.deepcopy(original))


def _swap(root: Element, random: Random) -> None:
    one, other = any_element(root, random), any_element(root, random)
    if one not in other.iterancestors() and other not in one.iterancestors() and one is not other:
        here, there = etree.Element("here"), etree.Element("there")
        one.addprevious(here)
        other.addprevious(there)
        here.getparent().replace(here, other)
        there.getparent().replace(there, one)


def _move(root: Element, random: Random) -> None:
    moved, owner = any_element(root, random), any_element(root, random)
    if moved is not owner and moved not in owner.iterancestors():
        owner.append(moved)


def references(root: Element) -> list[tuple[Element, str]]:
    """Elements and the names of their attributes that hold an id of the document."""
    key = xmi_key(root, "id")
    ids = {element.get(key) for element in root.iter("*")}
    return [
        (element, str(name))
        for element in root.iter("*")
        for name, value in element.attrib.items()
        if name != key and value in ids
    ]


def _retarget(root: Element, random: Random) -> None:
    found = references(root)
    if found:
        element, name = random.choice(found)
        element.set(name, any_id(root, random))


def _close_a_cycle(root: Element, random: Random) -> None:
    """A reference to its own element or an owner of it: inheritance, types and flows in circles."""
    found = references(root)
    if found:
        element, name = random.choice(found)
        circle = [element, *element.iterancestors()]
        element.set(name, random.choice(circle).get(xmi_key(root, "id"), ""))


def _dangle(root: Element, random: Random) -> None:
    found = references(root)
    if found:
        element, name = random.choice(found)
        element.set(name, random.choice(["_nothing", "a b", "", "_"]))


def _change_type(root: Element, random: Random) -> None:
    key = xmi_key(root, "type")
    typed = [element for element in root.iter("*") if key in element.attrib]
    random.choice(typed or [root]).set(key, "uml:" + random.choice(_METACLASSES))


def _rename_feature(root: Element, random: Random) -> None:
    element = any_element(root, random)
    element.tag = any_element(root, random).tag


def _drop_attribute(root: Element, random: Random) -> None:
    element = any_element(root, random)
    if element.attrib:
        del element.attrib[random.choice(list(element.attrib))]


def _spoil_attribute(root: Element, random: Random) -> None:
    element = any_element(root, random)
    if element.attrib:
        element.set(random.choice(list(element.attrib)), random.choice(JUNK))


def _spoil_text(root: Element, random: Random) -> None:
    texts = [element for element in root.iter("*") if element.text and element.text.strip()]
    random.choice(texts or [any_element(root, random)]).text = random.choice(JUNK)


def _same_id(root: Element, random: Random) -> None:
    any_element(root, random).set(xmi_key(root, "id"), any_id(root, random))


def _bury(root: Element, random: Random) -> None:
    """An element under many owners of its own kind."""
    victim = any_element(root, random)
    tag, attributes = victim.tag, dict(victim.attrib)
    for depth in range(random.choice([3, 120])):
        outer = etree.Element(tag, attributes)
        outer.set(xmi_key(root, "id"), f"_deep{depth}")
        victim.addprevious(outer)
        outer.append(victim)
        victim = outer


def _never_empty(root: Element) -> None:
    if len(root) == 0:
        etree.SubElement(root, "packagedElement")


_CHANGES: tuple[Change, ...] = (
    _drop,
    _duplicate,
    _swap,
    _move,
    _retarget,
    _retarget,
    _close_a_cycle,
    _dangle,
    _change_type,
    _change_type,
    _rename_feature,
    _drop_attribute,
    _spoil_attribute,
    _spoil_text,
    _same_id,
    _bury,
)

GENERIC: tuple[Change, ...] = (
    _drop,
    _duplicate,
    _swap,
    _move,
    _rename_feature,
    _drop_attribute,
    _spoil_attribute,
    _spoil_text,
)
"""Changes that know nothing of XMI."""


# -- damage to the bytes -----------------------------------------------------------------------


def _truncate(data: bytes, random: Random) -> bytes:
    return data[: random.randrange(len(data))]


def _flip(data: bytes, random: Random) -> bytes:
    at = random.randrange(len(data))
    return data[:at] + bytes([random.randrange(256)]) + data[at + 1 :]


def _insert(data: bytes, random: Random) -> bytes:
    at = random.randrange(len(data))
    return data[:at] + random.choice([b"\x00", b"\xff", b"<", b"&", b"]]>", b"<!--"]) + data[at:]


def _lie_about_encoding(data: bytes, random: Random) -> bytes:
    other = random.choice([b"UTF-16", b"windows-1252", b"US-ASCII", b"no-such-encoding"])
    return data.replace(b"UTF-8", other, 1)


def _encode_otherwise(data: bytes, random: Random) -> bytes:
    other = random.choice(["utf-16", "utf-8-sig", "utf-32"])
    return data.decode("utf-8", "replace").encode(other)


def _forbidden_prologue(data: bytes, random: Random) -> bytes:
    head, _, rest = data.partition(b"?>")
    return head + b'?><!DOCTYPE x [<!ENTITY e SYSTEM "file:///etc/hostname">]>' + rest


_DAMAGES: tuple[Damage, ...] = (
    _truncate,
    _flip,
    _insert,
    _lie_about_encoding,
    _encode_otherwise,
    _forbidden_prologue,
)
