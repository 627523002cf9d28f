"""Spoils documents with knowledge of their structure: what hand edits, merges and bugs leave."""

import copy
from collections.abc import Callable
from random import Random

from lxml import etree

from dialects.papyrus import XMI, Element, id_of

_TYPE = f"{{{XMI}}}type"
_ID = f"{{{XMI}}}id"
_JUNK = (
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


def mutate(document: bytes, random: Random) -> tuple[str, bytes]:
    """One to three changes of the document; what was done, and the result."""
    done: list[str] = []
    root = etree.fromstring(document)
    for _ in range(random.randint(1, 3)):
        change = random.choice(_CHANGES)
        done.append(change.__name__.strip("_"))
        change(root, random)
    spoilt = etree.tostring(root, xml_declaration=True, encoding="UTF-8")
    if random.random() < 0.25:
        damage = random.choice(_DAMAGES)
        done.append(damage.__name__.strip("_"))
        spoilt = damage(spoilt, random)
    return " ".join(done), spoilt


def damage(data: bytes, random: Random) -> tuple[str, bytes]:
    """Damage to the bytes alone, for files that are no XML."""
    chosen = random.choice(_DAMAGES)
    return chosen.__name__.strip("_"), chosen(data, random)


# -- changes of the tree -----------------------------------------------------------------------


def _any(root: Element, random: Random) -> Element:
    return random.choice([element for element in root.iter("*") if element is not root])


def _drop(root: Element, random: Random) -> None:
    victim = _any(root, random)
    victim.getparent().remove(victim)
    _never_empty(root)


def _duplicate(root: Element, random: Random) -> None:
    original = _any(root, random)
    original.addnext(copy.deepcopy(original))


def _swap(root: Element, random: Random) -> None:
    one, other = _any(root, random), _any(root, random)
    if one not in other.iterancestors() and other not in one.iterancestors() and one is not other:
        here, there = etree.Element("here"), etree.Element("there")
        one.addprevious(here)
        other.addprevious(there)
        here.getparent().replace(here, other)
        there.getparent().replace(there, one)


def _move(root: Element, random: Random) -> None:
    moved, owner = _any(root, random), _any(root, random)
    if moved is not owner and moved not in owner.iterancestors():
        owner.append(moved)


def _references(root: Element) -> list[tuple[Element, str]]:
    ids = {id_of(element) for element in root.iter("*")}
    return [
        (element, str(name))
        for element in root.iter("*")
        for name, value in element.attrib.items()
        if name != _ID and value in ids
    ]


def _retarget(root: Element, random: Random) -> None:
    found = _references(root)
    if found:
        element, name = random.choice(found)
        element.set(name, id_of(_any(root, random)))


def _close_a_cycle(root: Element, random: Random) -> None:
    """A reference to its own element or an owner of it: inheritance, types and flows in circles."""
    found = _references(root)
    if found:
        element, name = random.choice(found)
        element.set(name, id_of(random.choice([element, *element.iterancestors()])))


def _dangle(root: Element, random: Random) -> None:
    found = _references(root)
    if found:
        element, name = random.choice(found)
        element.set(name, random.choice(["_nothing", "a b", "", "_"]))


def _change_type(root: Element, random: Random) -> None:
    typed = [element for element in root.iter("*") if _TYPE in element.attrib]
    random.choice(typed or [root]).set(_TYPE, "uml:" + random.choice(_METACLASSES))


def _rename_feature(root: Element, random: Random) -> None:
    element = _any(root, random)
    element.tag = _any(root, random).tag


def _drop_attribute(root: Element, random: Random) -> None:
    element = _any(root, random)
    if element.attrib:
        del element.attrib[random.choice(list(element.attrib))]


def _spoil_attribute(root: Element, random: Random) -> None:
    element = _any(root, random)
    if element.attrib:
        element.set(random.choice(list(element.attrib)), random.choice(_JUNK))


def _spoil_text(root: Element, random: Random) -> None:
    texts = [element for element in root.iter("*") if element.text and element.text.strip()]
    random.choice(texts or [_any(root, random)]).text = random.choice(_JUNK)


def _same_id(root: Element, random: Random) -> None:
    _any(root, random).set(_ID, id_of(_any(root, random)))


def _bury(root: Element, random: Random) -> None:
    """An element under many owners of its own kind."""
    victim = _any(root, random)
    tag, attributes = victim.tag, dict(victim.attrib)
    for depth in range(random.choice([3, 120])):
        outer = etree.Element(tag, attributes)
        outer.set(_ID, f"_deep{depth}")
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


_DAMAGES: tuple[Callable[[bytes, Random], bytes], ...] = (
    _truncate,
    _flip,
    _insert,
    _lie_about_encoding,
    _encode_otherwise,
    _forbidden_prologue,
)
