"""The elements of snapshots that a model needs: the transitive closure of its references."""

from collections.abc import Iterable, Iterator

from sysmlc.frontends.xmi.snapshots.entries import Entry, Snapshots

APPLICATION = "appliedStereotypeInstance"

_PRIMITIVE_TYPES = "http://www.omg.org/spec/UML/20161101/PrimitiveTypes.xmi#"
_METACLASSES = "http://www.omg.org/spec/UML/20161101/UML.xmi#"
_PRIMITIVES = frozenset({"Boolean", "Integer", "Real", "String", "UnlimitedNatural"})
_METAMODEL = "UML2 Metamodel"
_PRIMITIVE_VALUES = "PrimitiveValueTypes"

_NEEDED_CONTENT = frozenset(
    {
        APPLICATION,
        *("ownedAttribute", "ownedPort", "ownedEnd", "ownedLiteral", "qualifier", "end"),
        *("ownedOperation", "ownedReception", "ownedParameter"),
        *("generalization", "interfaceRealization", "slot", "value"),
    }
)
"""Features whose content is needed with its owner. Other content (members of a package, connectors,
behaviour) is needed only if something refers to it."""

_NEEDED_REFERENCES = frozenset(
    {
        *("type", "general", "contract", "classifier", "definingFeature", "instance", "element"),
        *("subsettedProperty", "redefinedProperty", "redefinedPort", "memberEnd", "role"),
    }
)
"""References whose targets are needed, too."""


def canonical_href(snapshots: Snapshots, entry: Entry) -> str:
    """Return the href of a primitive type or metaclass that all dialects share, else empty.

    MagicDraw has copies of both in its own standard profile, and SysML's profile has one of the
    primitive types.
    """
    if entry.name in _PRIMITIVES and entry.written_type in ("PrimitiveType", "DataType"):
        is_primitive = entry.written_type == "PrimitiveType"
        is_standard = is_primitive or _is_in(snapshots, entry, _PRIMITIVE_VALUES)
        return _PRIMITIVE_TYPES + entry.name if is_standard else ""
    if entry.written_type == "Class" and _is_in(snapshots, entry, _METAMODEL):
        return _METACLASSES + entry.name
    return ""


def _is_in(snapshots: Snapshots, entry: Entry, package: str) -> bool:
    return any(owner.name == package for owner in snapshots.iter_owners(entry))


def compute_closure(snapshots: Snapshots, ids: Iterable[str]) -> list[Entry]:
    """Return the elements with these ids and all that they need, in the order of their position.

    A container such as a package is needed without its content; a classifier with its features,
    generalizations and stereotypes, and with the types of these.
    """
    closure: dict[str, Entry] = {}
    worklist = list(ids)
    while worklist:
        entry = snapshots.entries.get(worklist.pop())
        if entry is None or entry.id in closure:
            continue
        closure[entry.id] = entry
        if not canonical_href(snapshots, entry):
            worklist.extend(_list_needs(snapshots, entry))
    return sorted(closure.values(), key=lambda entry: entry.position)


def _list_needs(snapshots: Snapshots, entry: Entry) -> Iterator[str]:
    if entry.owner:
        yield entry.owner
    for feature, targets in entry.references.items():
        if feature in _NEEDED_REFERENCES:
            yield from targets
    for feature in _NEEDED_REFERENCES & entry.values.keys():
        yield from entry.values[feature].split()
    for owned in snapshots.owned(entry.id):
        # Snapshots retain slots whose values they omit.
        is_empty_slot = owned.feature == "slot" and not snapshots.owned(owned.id)
        if owned.feature in _NEEDED_CONTENT and not is_empty_slot:
            yield owned.id
