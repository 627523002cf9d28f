"""An XMI file as columns: one row an element, in document order, made in one pass."""

from collections import Counter
from collections.abc import Iterator

from sysmlc.frontends.xmi import namespaces
from sysmlc.sources import DEFAULT_LIMITS, Source
from sysmlc.sources.xml import Parser, parse, parser, too_deep

_DRAWINGS = frozenset({"diagramRepresentation", "filePart"})
"""Elements of MagicDraw's extensions whose content is only counted: up to 87 % of a file."""


class Document:
    """Columns of one file; a row stands for one XML element.

    ``tags`` are ``namespace}local`` as expat gives them, ``attributes`` have such keys where
    the attribute has a namespace. ``features`` are local names of the tags, ``types`` of
    ``xmi:type`` (or empty); ``ends[row]`` is the first row after the row's content;
    ``declared`` are the namespaces that the file declares.
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
        "repeated",
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
        child, end = row + 1, self.ends[row]
        while child < end:
            if not feature or self.features[child] == feature:
                yield child
            child = self.ends[child]

    def targets(self, row: int, feature: str) -> list[str]:
        """Local ids that the row's feature refers to, as attribute list or as children."""
        ids = self.tokens(self.attributes[row].get(feature, ""))
        return ids + [ref for c in self.children(row, feature) if (ref := self.idref(c))]

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
    document = Document(source.name)
    made = parser()
    declared: dict[str, None] = {}
    made.StartNamespaceDeclHandler = lambda _prefix, uri: declared.setdefault(uri or "")
    _fill(document, made, source)
    parse(source, made)
    document.declared = tuple(declared)
    _index(document, [uri for uri in declared if namespaces.is_xmi(uri)])
    return document


def _fill(document: Document, made: Parser, source: Source) -> None:
    """Set the handlers that fill the columns; they are called for every element."""
    tags, attributes, parents = document.tags, document.attributes, document.parents
    ends, ordinals, texts, drawn = document.ends, document.ordinals, document.texts, document.drawn
    stack = [-1]
    limit = DEFAULT_LIMITS.depth
    skipped = 0
    hidden: list[str] = []

    def start(tag: str, values: dict[str, str]) -> None:
        row = len(tags)
        tags.append(tag)
        attributes.append(values)
        parents.append(stack[-1])
        ends.append(0)
        ordinals.append(row + skipped)
        stack.append(row)
        if len(stack) > limit:
            too_deep(source, made)
        if tag in _DRAWINGS:
            hide(tag)

    def end(_tag: str) -> None:
        ends[stack.pop()] = len(tags)

    def text(data: str) -> None:
        if not data.isspace():
            row = stack[-1]
            texts[row] = texts[row] + data if row in texts else data

    def hide(tag: str) -> None:
        hidden.append(tag)
        made.StartElementHandler = start_hidden
        made.EndElementHandler = end_hidden
        made.CharacterDataHandler = None

    def start_hidden(tag: str, _values: dict[str, str]) -> None:
        nonlocal skipped
        skipped += 1
        hidden.append(tag)
        if len(hidden) > limit:
            too_deep(source, made)

    def end_hidden(tag: str) -> None:
        hidden.pop()
        if hidden:
            drawn[hidden[0]] += 1
            return
        made.StartElementHandler = start
        made.EndElementHandler = end
        made.CharacterDataHandler = text
        end(tag)

    made.StartElementHandler = start
    made.EndElementHandler = end
    made.CharacterDataHandler = text


def _index(document: Document, spaces: list[str]) -> None:
    local = {tag: tag.rpartition("}")[2] for tag in dict.fromkeys(document.tags)}
    document.features = [local[tag] for tag in document.tags]
    xmi = spaces[0] if spaces else ""
    for other in spaces[1:]:
        _rename(document, other, xmi)
    document.id_key, document.type_key = f"{xmi}}}id", f"{xmi}}}type"
    document.idref_key = f"{xmi}}}idref"
    _index_types(document)
    key, ids = document.id_key, document.ids
    for row, values in enumerate(document.attributes):
        if key in values:
            first = ids.setdefault(values[key], row)
            if first != row:
                document.repeated.setdefault(values[key], [first]).append(row)


def _index_types(document: Document) -> None:
    key = document.type_key
    written = [values.get(key, "") for values in document.attributes]
    short = {name: name.rpartition(":")[2] for name in dict.fromkeys(written)}
    document.types = [short[name] for name in written]


def _rename(document: Document, namespace: str, to: str) -> None:
    """Enterprise Architect mixes versions of XMI in one file."""
    for values in document.attributes:
        for name in ("id", "type", "idref"):
            value = values.pop(f"{namespace}}}{name}", None)
            if value is not None:
                values[f"{to}}}{name}"] = value
