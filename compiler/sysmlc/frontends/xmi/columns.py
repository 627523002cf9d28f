"""Reads the bytes of an XMI file into the columns of a document with one pass of expat.

Expat calls the handlers for each element of the file, so they only append to columns; features,
types and ids are derived from the columns afterwards. Expat and not an lxml parser target, because
expat tells the byte offset of a fault, and both take the same time.
"""

from itertools import pairwise

from sysmlc.frontends.xmi import namespaces
from sysmlc.frontends.xmi.document import Document
from sysmlc.sources import DEFAULT_LIMITS, Source
from sysmlc.sources.xml import parse, parser, too_deep

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
        self._parser = parser()
        self._open_rows = [-1]
        self._breaks: list[tuple[int, int]] = []
        """After a skipped element: the next row, and how many elements were skipped so far."""

    def run(self) -> None:
        """Parse the source. Raises SourceError."""
        self._set_handlers()
        try:
            parse(self._source, self._parser)
        finally:
            # The parser and its handlers refer to one another; the garbage collector is off.
            self._parser.StartElementHandler = None
            self._parser.EndElementHandler = None
            self._parser.CharacterDataHandler = None
            self._parser.StartNamespaceDeclHandler = None
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
                too_deep(self._source, self._parser)
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
                too_deep(self._source, self._parser)

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
    """Fill the columns that are derived from tags and attributes, and move types out of these."""
    versions = [uri for uri in document.declared_namespaces if namespaces.is_xmi(uri)]
    xmi, *other_versions = versions or [""]
    for namespace in other_versions:
        _rename_attributes(document, namespace, xmi)
    document.id_key, document.type_key = f"{xmi}}}id", f"{xmi}}}type"
    document.idref_key = f"{xmi}}}idref"
    local_names = {tag: tag.rpartition("}")[2].rpartition(":")[2] for tag in set(document.tags)}
    document.features = [local_names[tag] for tag in document.tags]
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


def _extract_types(document: Document, key: str) -> list[str]:
    return [values.pop(key, "").rpartition(":")[2] for values in document.attributes]


def _index_ids(document: Document) -> None:
    for row, values in enumerate(document.attributes):
        id = values.get(document.id_key)
        if id is not None:
            first = document.ids.setdefault(id, row)
            if first != row:
                document.repeated_ids.setdefault(id, [first]).append(row)
