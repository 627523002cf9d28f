"""An XMI file as columns: one row for each XML element, in document order.

One pass of expat reads the file. Expat calls the handlers for each element of the file, so they
only append to columns; features, types and ids are derived from the columns afterwards. Expat and
not an lxml parser target, because expat tells the byte offset of a fault, and both take the same
time.
"""

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from itertools import pairwise
from typing import NamedTuple
from urllib.parse import unquote

from sysmlc.frontends.xmi import namespaces
from sysmlc.sources import DEFAULT_LIMITS, Source
from sysmlc.sources.xml import make_parser, parse, refuse_depth


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


# -- reading -----------------------------------------------------------------------------------

_SKIPPED = frozenset({"diagramRepresentation", "filePart"})
"""Elements of MagicDraw's extensions whose content is only counted: up to 87 % of a file."""

_XSI = "http://www.w3.org/2001/XMLSchema-instance"


def read_document(source: Source) -> Document:
    """Return the document of an XMI file. Raises SourceError."""
    reader = _ColumnReader(source)
    reader.run()
    document = reader.document
    document.declared_namespaces = tuple(reader.namespaces)
    _derive_columns(document)
    return document


class _ColumnReader:
    """The parser handlers that fill the columns of one document.

    ``namespaces`` holds the namespaces that the file declares outside skipped content, in order.
    """

    def __init__(self, source: Source) -> None:
        self.document = Document(source.name)
        self.namespaces: dict[str, None] = {}
        self._source = source
        self._parser = make_parser()
        self._open_rows = [-1]
        self._breaks: list[tuple[int, int]] = []
        """After a skipped element: the next row, and how many elements were skipped so far."""

    def run(self) -> None:
        """Parse the source. Raises SourceError."""
        self._set_handlers()
        parse(self._source, self._parser)
        if self._breaks:
            self.document.ordinals = _number_elements(len(self.document.tags), self._breaks)

    def _set_handlers(self) -> None:
        document, open_rows = self.document, self._open_rows
        texts, ends = document.texts, document.ends
        following = len(document.tags)

        def start_element(tag: str, attributes: dict[str, str]) -> None:
            nonlocal following
            row = following
            following = row + 1
            document.ordinals.append(row)
            document.tags.append(tag)
            document.attributes.append(attributes)
            document.parents.append(open_rows[-1])
            ends.append(row)
            open_rows.append(row)
            if len(open_rows) > DEFAULT_LIMITS.depth:
                refuse_depth(self._source, self._parser)
            if tag in _SKIPPED:
                self._skip_content(tag)

        def end_element(_tag: str) -> None:
            ends[open_rows.pop()] = following

        def add_text(text: str) -> None:
            if not text.isspace():
                row = open_rows[-1]
                texts[row] = texts.get(row, "") + text

        def declare_namespace(_prefix: str | None, uri: str | None) -> None:
            self.namespaces[uri or ""] = None

        self._parser.StartNamespaceDeclHandler = declare_namespace
        self._parser.StartElementHandler = start_element
        self._parser.EndElementHandler = end_element
        self._parser.CharacterDataHandler = add_text

    def _skip_content(self, outer: str) -> None:
        """Count the elements up to the end of the open element, which is called ``outer``."""
        depth = skipped = 0

        def start_skipped(_tag: str, _attributes: dict[str, str]) -> None:
            nonlocal depth, skipped
            depth += 1
            skipped += 1
            if depth > DEFAULT_LIMITS.depth:
                refuse_depth(self._source, self._parser)

        def end_skipped(_tag: str) -> None:
            nonlocal depth
            depth -= 1
            if depth < 0:
                self._resume(outer, skipped)

        self._parser.StartElementHandler = start_skipped
        self._parser.EndElementHandler = end_skipped
        self._parser.CharacterDataHandler = None
        self._parser.StartNamespaceDeclHandler = None

    def _resume(self, outer: str, skipped: int) -> None:
        document = self.document
        if skipped:
            document.skipped_elements[outer] += skipped
        self._breaks.append((len(document.tags), document.skipped_elements.total()))
        document.ends[self._open_rows.pop()] = len(document.tags)
        self._set_handlers()


def _number_elements(rows: int, breaks: list[tuple[int, int]]) -> list[int]:
    """Return the position of each row's element among all elements of the file."""
    ordinals: list[int] = []
    for (row, skipped), (next_row, _) in pairwise([(0, 0), *breaks, (rows, 0)]):
        ordinals += range(row + skipped, next_row + skipped)
    return ordinals


def _derive_columns(document: Document) -> None:
    """Fill the columns derived from tags and attributes; move types to their own column."""
    versions = [uri for uri in document.declared_namespaces if namespaces.is_xmi(uri)]
    xmi, *other_versions = versions or [""]
    for namespace in other_versions:
        _rename_attributes(document, namespace, xmi)
    document.id_key, document.type_key = f"{xmi}}}id", f"{xmi}}}type"
    document.idref_key = f"{xmi}}}idref"
    local_names = {tag: tag.rpartition("}")[2].rpartition(":")[2] for tag in set(document.tags)}
    document.features = [local_names[tag] for tag in document.tags]
    if _is_from_staruml(document):
        _decode_attributes(document)
    document.types = _extract_types(document, document.type_key)
    if _XSI in document.declared_namespaces and not any(document.types):
        # EMF saves the type in this namespace if the options of UML2 are not set.
        document.types = _extract_types(document, f"{_XSI}}}type")
    _index_ids(document)
    rows = zip(document.features, document.attributes, strict=True)
    document.referring_features = frozenset(
        feature for feature, names in rows if document.idref_key in names or "href" in names
    )


def _rename_attributes(document: Document, namespace: str, new_namespace: str) -> None:
    """Move the attributes of XMI to one namespace.

    Enterprise Architect mixes versions of XMI in one file.
    """
    for values in document.attributes:
        for name in ("id", "type", "idref"):
            value = values.pop(f"{namespace}}}{name}", None)
            if value is not None:
                values[f"{new_namespace}}}{name}"] = value


def _is_from_staruml(document: Document) -> bool:
    return any(
        document.attributes[row].get("exporter") == "StarUML"
        for row in document.children(0, "Documentation")
    )


def _decode_attributes(document: Document) -> None:
    """Decode the attributes of StarUML, which writes them percent-encoded, as in a URI.

    An href is decoded where it is resolved, as those of the other tools are.
    """
    for values in document.attributes:
        for name, value in values.items():
            if "%" in value and name != "href":
                values[name] = unquote(value)


def _extract_types(document: Document, key: str) -> list[str]:
    return [values.pop(key, "").rpartition(":")[2] for values in document.attributes]


def _index_ids(document: Document) -> None:
    for row, values in enumerate(document.attributes):
        id = values.get(document.id_key)
        if id is not None:
            first = document.ids.setdefault(id, row)
            if first != row:
                document.repeated_ids.setdefault(id, [first]).append(row)
