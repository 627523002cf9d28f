"""An XMI file as columns: one row for each XML element, in document order."""

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import NamedTuple


class WrittenReference(NamedTuple):
    """A reference as a file writes it; *row* is the row of the attribute or child."""

    target: str
    """A local id, or an href."""
    row: int
    is_href: bool = False


@dataclass(slots=True, eq=False)
class Document:
    """The columns of one file. A row is the index of an XML element in each list."""

    name: str
    tags: list[str] = field(default_factory=list)
    """Element names as expat gives them, ``namespace}local``."""
    attributes: list[dict[str, str]] = field(default_factory=list)
    """Attributes without ``xmi:type``; a name in a namespace is written ``namespace}local``."""
    parents: list[int] = field(default_factory=list)
    ends: list[int] = field(default_factory=list)
    """For each row the first row after its content."""
    ordinals: list[int] = field(default_factory=list)
    """Position of each element in the file; skipped elements have positions but no rows."""
    texts: dict[int, str] = field(default_factory=dict)
    features: list[str] = field(default_factory=list)
    """Local names of the tags."""
    types: list[str] = field(default_factory=list)
    """Local names of ``xmi:type``, or empty."""
    retyped: set[int] = field(default_factory=set)
    """Rows whose type the file omits, and that ``retype`` has set."""
    ids: dict[str, int] = field(default_factory=dict)
    """Row of each id; the first row if an id is repeated."""
    repeated_ids: dict[str, list[int]] = field(default_factory=dict)
    referring_features: frozenset[str] = frozenset()
    """Features of the rows that have ``xmi:idref`` or ``href``."""
    skipped_elements: Counter[str] = field(default_factory=Counter)
    """Number of elements without rows, by the tag of the row that contains them."""
    declared_namespaces: tuple[str, ...] = ()
    """Namespaces that the file declares outside skipped elements."""
    id_key: str = ""
    type_key: str = ""
    idref_key: str = ""

    def __len__(self) -> int:
        return len(self.tags)

    def id(self, row: int) -> str:
        """Return the ``xmi:id`` of the row, or the empty string."""
        return self.attributes[row].get(self.id_key, "")

    def idref(self, row: int) -> str:
        """Return the ``xmi:idref`` of the row, or the empty string."""
        return self.attributes[row].get(self.idref_key, "")

    def href(self, row: int) -> str:
        """Return the ``href`` of the row, or the empty string."""
        return self.attributes[row].get("href", "")

    def get(self, row: int, name: str) -> str:
        """Return an attribute without namespace, or the text of a child of that name."""
        value = self.attributes[row].get(name)
        if value is not None:
            return value
        return next((self.texts.get(child, "") for child in self.children(row, name)), "")

    def children(self, row: int, feature: str = "") -> Iterator[int]:
        """Return the rows of the children, or of the children with *feature*."""
        end = self.ends[row]
        if end == row + 1:
            return iter(())
        ends, features = self.ends, self.features
        children = []
        child = row + 1
        while child < end:
            if not feature or features[child] == feature:
                children.append(child)
            child = ends[child]
        return iter(children)

    def targets(self, row: int, feature: str) -> list[str]:
        """Return the local ids that *feature* refers to, as an attribute or as children."""
        written = self.attributes[row].get(feature)
        ids = self.split_ids(written) if written else []
        if feature not in self.referring_features:
            return ids
        return ids + [id for child in self.children(row, feature) if (id := self.idref(child))]

    def references(self, row: int, feature: str) -> list[WrittenReference]:
        """Return the references of *feature*, local ids and hrefs."""
        written = self.attributes[row].get(feature)
        ids = self.split_ids(written) if written else []
        references = [WrittenReference(id, row) for id in ids]
        if feature not in self.referring_features:
            return references
        for child in self.children(row, feature):
            href = self.href(child)
            target = href or self.idref(child)
            if target:
                references.append(WrittenReference(target, child, bool(href)))
        return references

    def retype(self, row: int, type_name: str) -> None:
        """Set the type of a row whose type the file omits."""
        self.types[row] = type_name
        self.retyped.add(row)

    def split_ids(self, value: str) -> list[str]:
        """Return the ids in an attribute.

        Ids of Enterprise Architect may contain spaces.
        """
        return [value] if value in self.ids else value.split()

    def is_in_extension(self, row: int) -> bool:
        """Whether the row is in ``xmi:Extension``, where tools repeat ids and invent references."""
        while row > 0 and self.features[row] != "Extension":
            row = self.parents[row]
        return row > 0

    def namespace(self, row: int) -> str:
        """Return the namespace of the row's element name."""
        return self.tags[row].rpartition("}")[0]
