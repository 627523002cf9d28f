"""Elements of the snapshots of used projects in a MagicDraw archive: parts of libraries, by id.

Snapshots are a dialect of their own: XMI 2.0 with ``xsi:type``, an ``ID`` for each element, and
applications of stereotypes inside the elements to which they are applied. A model needs the
transitive closure of its references.
"""

import re
from collections import Counter
from collections.abc import Iterable, Iterator

from sysmlc.frontends.xmi.metaclasses import DEFAULT_TYPES
from sysmlc.sources import DEFAULT_LIMITS, Fault, Source, SourceError
from sysmlc.sources.xml import make_parser, parse, refuse_depth

_HEAD = 4096
_NAMESPACE = re.compile(rb"""["']https?://www\.nomagic\.com/magicdraw/UML/""")
_ENTRY = re.compile(r"[!/][^!/]*snapshot$")
_TYPE = "http://www.w3.org/2001/XMLSchema-instance}type"


def is_snapshot(source: Source) -> bool:
    """Whether the source is a snapshot: its name and its namespace occur nowhere else."""
    is_entry = _ENTRY.search(source.name) is not None
    return is_entry and _NAMESPACE.search(source.data, 0, _HEAD) is not None


class Entry:
    """One element of a snapshot.

    ``references`` are ids by feature, ``values`` the attributes as written. ``size`` is the number
    of elements inside.
    """

    __slots__ = ("feature", "id", "ordinal", "owner", "references", "size", "source", "values")

    def __init__(
        self, id: str, feature: str, ordinal: int, source: str, owner: str, values: dict[str, str]
    ) -> None:
        self.id = id
        self.feature = feature
        self.ordinal = ordinal
        self.source = source
        self.owner = owner
        self.values = values
        self.size = 0
        self.references: dict[str, list[str]] = {}

    @property
    def name(self) -> str:
        """The name, or the empty string."""
        return self.values.get("name", "")

    @property
    def written_type(self) -> str:
        """The metaclass as written (a root's is its tag), or the empty string."""
        written = self.values.get(_TYPE)
        if written is None:
            return "" if self.feature[0].islower() else self.feature
        return written.rpartition(":")[2]

    @property
    def metaclass(self) -> str:
        """The metaclass as written, else the declared type of the feature."""
        return self.written_type or DEFAULT_TYPES.get(self.feature, "")

    @property
    def coverage_type(self) -> str:
        """The type as coverage reports it."""
        written = self.written_type
        return self.feature if written in ("", self.feature) else f"uml:{written}"

    @property
    def position(self) -> tuple[str, int]:
        """File and ordinal of the element."""
        return self.source, self.ordinal

    def targets(self, feature: str) -> list[str]:
        """Return the ids that the feature refers to, as attribute or as children."""
        return self.references.get(feature) or self.values.get(feature, "").split()

    def add_reference(self, feature: str, href: str) -> None:
        """Add the target of a child without ID; a root refers to its owner in this way."""
        target = href.rpartition("#")[2]
        if feature == "owningPackage":
            self.owner = self.owner or target
        elif feature != "packagedElement":
            self.references.setdefault(feature, []).append(target)


class Snapshots:
    """The elements of all snapshots of a unit, each once.

    Snapshots overlap: each holds what one used project needs of the others. Of several copies the
    one with the largest content counts, with the references that only the others have. A damaged
    snapshot is skipped and added to *problems*; one that exceeds the limits raises SourceError.
    """

    def __init__(self, sources: Iterable[Source], problems: list[SourceError]) -> None:
        self.entries: dict[str, Entry] = {}
        self.counts: dict[str, Counter[str]] = {}
        """Number of elements of each type, by snapshot."""
        self.attribute_names: dict[str, frozenset[str]] = {}
        """Names of the attributes in each snapshot, and some that are no attributes."""
        self._owned: dict[str, list[Entry]] = {}
        for source in sorted(sources, key=lambda source: source.name):
            self._read(source, problems)
        for entry in sorted(self.entries.values(), key=lambda entry: entry.position):
            if entry.owner:
                self._owned.setdefault(entry.owner, []).append(entry)

    def owned(self, id: str) -> list[Entry]:
        """Return the elements that the element owns, in document order."""
        return self._owned.get(id, [])

    def iter_owners(self, entry: Entry) -> Iterator[Entry]:
        """Yield the element and its owners, nearest first."""
        visited: set[str] = set()
        ancestor: Entry | None = entry
        while ancestor is not None and ancestor.id not in visited:
            visited.add(ancestor.id)
            yield ancestor
            ancestor = self.entries.get(ancestor.owner)

    def _read(self, source: Source, problems: list[SourceError]) -> None:
        try:
            entries, counts, names = _read_entries(source)
        except SourceError as problem:
            if problem.fault is Fault.LIMIT:
                raise
            problems.append(problem)
            return
        self.counts[source.name], self.attribute_names[source.name] = counts, names
        for entry in entries:
            self._add(entry)

    def _add(self, entry: Entry) -> None:
        copy = self.entries.get(entry.id)
        if copy is None:
            self.entries[entry.id] = entry
            return
        best, other = (entry, copy) if entry.size > copy.size else (copy, entry)
        best.references = other.references | best.references
        best.values = other.values | best.values
        best.owner = best.owner or other.owner
        self.entries[entry.id] = best


def _read_entries(source: Source) -> tuple[list[Entry], Counter[str], frozenset[str]]:
    """Return the elements with an ID, the number of elements by type, and names of attributes.

    Owned elements precede their owners. Attribute names are all names that the parser has met,
    except tags. Raises SourceError.
    """
    xml_parser = make_parser()
    name, limit = source.name, DEFAULT_LIMITS.depth
    entries: list[Entry] = []
    features: list[str] = []
    types: list[str | None] = []
    local_names: dict[str, str] = {}
    stack: list[Entry | None] = [None]

    def start(tag: str, values: dict[str, str]) -> None:
        parent = stack[-1]
        feature = local_names.setdefault(tag, tag.rpartition("}")[2])
        id = values.get("ID")
        if id:
            owner = parent.id if parent is not None else ""
            stack.append(Entry(id, feature, len(features), name, owner, values))
        else:
            if parent is not None and "href" in values:
                parent.add_reference(feature, values["href"])
            stack.append(parent)
        features.append(feature)
        types.append(values.get(_TYPE))
        if len(stack) > limit:
            refuse_depth(source, xml_parser)

    def end(_tag: str) -> None:
        entry = stack.pop()
        parent = stack[-1]
        if entry is not None and entry is not parent:
            if parent is not None:
                parent.size += entry.size + 1
            entries.append(entry)

    xml_parser.StartElementHandler = start
    xml_parser.EndElementHandler = end
    parse(source, xml_parser)
    counts = Counter(type or feature for type, feature in zip(types, features, strict=True))
    return entries, counts, frozenset(xml_parser.intern.keys() - local_names.keys())


# -- needed elements ---------------------------------------------------------------------------

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
