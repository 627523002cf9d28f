"""What of the snapshots is needed: what a model refers to, and what that needs, transitively."""

from collections.abc import Iterable, Iterator

from sysmlc.frontends.xmi.metaclasses import DEFAULT_TYPES
from sysmlc.frontends.xmi.snapshots.entries import Entry, Snapshots, place

PRIMITIVE_TYPES = "http://www.omg.org/spec/UML/20161101/PrimitiveTypes.xmi#"
METACLASSES = "http://www.omg.org/spec/UML/20161101/UML.xmi#"

APPLICATION = "appliedStereotypeInstance"

_PRIMITIVES = frozenset({"Boolean", "Integer", "Real", "String", "UnlimitedNatural"})
_METAMODEL = "UML2 Metamodel"
_PRIMITIVE_VALUES = "PrimitiveValueTypes"

_OWNED = frozenset(
    {
        APPLICATION,
        *("ownedAttribute", "ownedPort", "ownedEnd", "ownedLiteral", "qualifier", "end"),
        *("ownedOperation", "ownedReception", "ownedParameter"),
        *("generalization", "interfaceRealization", "slot", "value"),
    }
)
"""Features whose content is needed to know an element: what else it owns (members of a package,
connectors, behaviour) is read only when something refers to it."""

_NEEDED = frozenset(
    {
        *("type", "general", "contract", "classifier", "definingFeature", "instance", "element"),
        *("subsettedProperty", "redefinedProperty", "redefinedPort", "memberEnd", "role"),
    }
)
"""References whose targets are needed too."""


def canonical(snapshots: Snapshots, entry: Entry) -> str:
    """Href of a primitive type or metaclass, the same in all dialects; else empty.

    MagicDraw keeps copies of both in its own standard profile, SysML's profile one of the
    primitives.
    """
    if entry.name in _PRIMITIVES and entry.type in ("PrimitiveType", "DataType"):
        is_standard = entry.type == "PrimitiveType" or _is_in(snapshots, entry, _PRIMITIVE_VALUES)
        return PRIMITIVE_TYPES + entry.name if is_standard else ""
    if entry.type == "Class" and _is_in(snapshots, entry, _METAMODEL):
        return METACLASSES + entry.name
    return ""


def _is_in(snapshots: Snapshots, entry: Entry, package: str) -> bool:
    return any(one.name == package for one in snapshots.path(entry))


def needed(snapshots: Snapshots, ids: Iterable[str]) -> list[Entry]:
    """The elements with these ids and what they need, by their place.

    A container (a package) is needed without its content; a classifier with its features,
    generalizations and stereotypes, and with what those are typed by.
    """
    found: dict[str, Entry] = {}
    waiting = list(ids)
    while waiting:
        entry = snapshots.entries.get(waiting.pop())
        if entry is None or entry.id in found:
            continue
        found[entry.id] = entry
        if not canonical(snapshots, entry):
            waiting.extend(_needs(snapshots, entry))
    return sorted(found.values(), key=place)


def _needs(snapshots: Snapshots, entry: Entry) -> Iterator[str]:
    if entry.owner:
        yield entry.owner
    for feature, targets in entry.references.items():
        if feature in _NEEDED:
            yield from targets
    for feature in _NEEDED & entry.values.keys():
        yield from entry.values[feature].split()
    for inside in snapshots.owned(entry.id):
        if inside.feature in _OWNED and not _is_empty(snapshots, inside):
            yield inside.id


def _is_empty(snapshots: Snapshots, entry: Entry) -> bool:
    """Snapshots keep slots whose values they leave out."""
    return entry.feature == "slot" and not snapshots.owned(entry.id)


def type_of(entry: Entry) -> str:
    """Metaclass of the element: as written, else what its feature is declared with."""
    return entry.type or DEFAULT_TYPES.get(entry.feature, "")
