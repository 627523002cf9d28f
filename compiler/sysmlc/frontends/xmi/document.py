"""An XMI file as columns: one row an element, in document order."""

from collections import Counter
from collections.abc import Iterator


class Document:
    """Columns of one file; a row stands for one XML element.

    ``tags`` are ``namespace}local`` as expat gives them, ``attributes`` have such keys where
    the attribute has a namespace. ``features`` are local names of the tags, ``types`` of
    ``xmi:type`` (or empty), which is no longer in ``attributes``; ``ends[row]`` is the first
    row after the row's content; ``retyped`` are rows whose type the file does not write;
    ``referring`` are the features of the rows that refer to others;
    ``declared`` are the namespaces that the file declares outside drawings.
    """

    __slots__ = (
        "attributes",
        "declared",
        "drawn",
        "ends",
        "features",
        "id_key",
        "idref_key",
        "ids",
        "name",
        "ordinals",
        "parents",
        "referring",
        "repeated",
        "retyped",
        "tags",
        "texts",
        "type_key",
        "types",
    )

    def __init__(self, name: str) -> None:
        self.name = name
        self.tags: list[str] = []
        self.attributes: list[dict[str, str]] = []
        self.parents: list[int] = []
        self.ends: list[int] = []
        self.ordinals: list[int] = []
        self.texts: dict[int, str] = {}
        self.drawn: Counter[str] = Counter()
        self.features: list[str] = []
        self.types: list[str] = []
        self.referring: frozenset[str] = frozenset()
        self.retyped: set[int] = set()
        self.ids: dict[str, int] = {}
        self.repeated: dict[str, list[int]] = {}
        self.declared: tuple[str, ...] = ()
        self.id_key = self.type_key = self.idref_key = ""

    def __len__(self) -> int:
        return len(self.tags)

    def id(self, row: int) -> str:
        """The row's ``xmi:id``, or the empty string."""
        return self.attributes[row].get(self.id_key, "")

    def idref(self, row: int) -> str:
        """The row's ``xmi:idref``, or the empty string."""
        return self.attributes[row].get(self.idref_key, "")

    def get(self, row: int, name: str) -> str:
        """An attribute without namespace, or the text of a child of that name."""
        value = self.attributes[row].get(name)
        if value is not None:
            return value
        return next((self.texts.get(c, "") for c in self.children(row, name)), "")

    def children(self, row: int, feature: str = "") -> Iterator[int]:
        """Rows of the children, all or those of one feature."""
        end = self.ends[row]
        if end == row + 1:
            return iter(())
        ends, features = self.ends, self.features
        found = []
        child = row + 1
        while child < end:
            if not feature or features[child] == feature:
                found.append(child)
            child = ends[child]
        return iter(found)

    def targets(self, row: int, feature: str) -> list[str]:
        """Local ids that the row's feature refers to, as attribute list or as children."""
        written = self.attributes[row].get(feature)
        ids = self.tokens(written) if written else []
        if feature not in self.referring:
            return ids
        return ids + [ref for c in self.children(row, feature) if (ref := self.idref(c))]

    def retype(self, row: int, type_name: str) -> None:
        """Give the row a type that the file omits."""
        self.types[row] = type_name
        self.retyped.add(row)

    def tokens(self, value: str) -> list[str]:
        """Ids in an attribute; Enterprise Architect's ids may hold spaces."""
        return [value] if value in self.ids else value.split()

    def is_in_extension(self, row: int) -> bool:
        """Whether the row is what a tool keeps beside the model, and numbers as it likes."""
        while row > 0 and self.features[row] != "Extension":
            row = self.parents[row]
        return row > 0

    def namespace(self, row: int) -> str:
        """Namespace of the row's element name."""
        return self.tags[row].rpartition("}")[0]
