"""An XMI file as columns: one row an element, in document order, made in one pass."""

from collections import Counter
from collections.abc import Iterator
from typing import cast

from sysmlc.frontends.xmi import namespaces
from sysmlc.frontends.xmi.columns import fill, fill_swiftly
from sysmlc.frontends.xmi.prefixes import IrregularError, Prefixes
from sysmlc.sources import Source, SourceError

_XSI = "http://www.w3.org/2001/XMLSchema-instance"
"""Its ``type`` says what ``xmi:type`` says where EMF saves without the options of UML2."""

Shape = tuple[str, str, tuple[str, ...]]
"""What decides what becomes of a row: feature, type, and names of the attributes in order."""


class Document:
    """Columns of one file; a row stands for one XML element.

    ``tags`` are ``namespace}local`` as expat gives them, ``attributes`` have such keys where
    the attribute has a namespace. ``features`` are local names of the tags, ``types`` of
    ``xmi:type`` (or empty), which is no longer in ``attributes``; ``ends[row]`` is the first
    row after the row's content; ``shapes[shape_numbers[row]]`` is the row's shape;
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
        "shape_numbers",
        "shapes",
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
        self.shapes: list[Shape] = []
        self.referring: frozenset[str] = frozenset()
        self.shape_numbers: list[int] = []
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
        """Give the row another type; what its shape said no longer counts."""
        self.types[row] = type_name
        self.shape_numbers[row] = -1

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


def read(source: Source) -> Document:
    """The columns of the file. Raises SourceError."""
    try:
        prefixes = Prefixes()
        document = Document(source.name)
        _index(document, fill_swiftly(document, source, prefixes))
        if prefixes.expand(document):
            _index_shapes(document)
        prefixes.check_hidden(source.data)
    except (IrregularError, SourceError):
        document = Document(source.name)
        _index(document, fill(document, source))
    return document


def _index(document: Document, declared: tuple[str, ...]) -> None:
    document.declared = declared
    local = {tag: _local(tag) for tag in dict.fromkeys(document.tags)}
    document.features = list(map(local.__getitem__, document.tags))
    spaces = [uri for uri in declared if namespaces.is_xmi(uri)]
    xmi = spaces[0] if spaces else ""
    for other in spaces[1:]:
        _rename(document, other, xmi)
    document.id_key, document.type_key = f"{xmi}}}id", f"{xmi}}}type"
    document.idref_key = f"{xmi}}}idref"
    _index_types(document)
    _index_ids(document)
    _index_shapes(document)


def _local(tag: str) -> str:
    """The name without namespace or prefix."""
    return tag.rpartition("}")[2].rpartition(":")[2]


def _index_types(document: Document) -> None:
    document.types = _types(document, document.type_key)
    if _XSI in document.declared and not any(document.types):
        document.types = _types(document, f"{_XSI}}}type")


def _types(document: Document, key: str) -> list[str]:
    short = _Short()
    return [short[values.pop(key, "")] for values in document.attributes]


class _Short(dict[str, str]):
    """Names of types without prefix, one string for each name."""

    def __missing__(self, name: str) -> str:
        short = self[name] = name.rpartition(":")[2]
        return short


def _index_shapes(document: Document) -> None:
    numbers = _Numbers()
    shapes = zip(document.features, document.types, map(tuple, document.attributes), strict=True)
    document.shape_numbers = list(map(numbers.__getitem__, shapes))
    document.shapes = list(numbers)
    references = {document.idref_key, "href"}
    referring = (feature for feature, _, names in numbers if not references.isdisjoint(names))
    document.referring = frozenset(referring)


class _Numbers(dict[Shape, int]):
    """Shapes, numbered as they are met."""

    def __missing__(self, shape: Shape) -> int:
        self[shape] = number = len(self)
        return number


def _index_ids(document: Document) -> None:
    key = document.id_key
    written = [values.get(key) for values in document.attributes]
    # The numbers of the ordinals are shared where they are those of the rows.
    numbers = range(len(written)) if document.drawn else document.ordinals
    rows = dict(zip(written, numbers, strict=True))
    rows.pop(None, None)
    document.ids = cast("dict[str, int]", rows)
    if len(rows) < len(written) - written.count(None):
        _index_repeated(document, written)


def _index_repeated(document: Document, written: list[str | None]) -> None:
    """Of several elements with one id the first has it."""
    document.ids = {}
    for row, id in enumerate(written):
        if id is not None:
            first = document.ids.setdefault(id, row)
            if first != row:
                document.repeated.setdefault(id, [first]).append(row)


def _rename(document: Document, namespace: str, to: str) -> None:
    """Enterprise Architect mixes versions of XMI in one file."""
    for values in document.attributes:
        for name in ("id", "type", "idref"):
            value = values.pop(f"{namespace}}}{name}", None)
            if value is not None:
                values[f"{to}}}{name}"] = value
