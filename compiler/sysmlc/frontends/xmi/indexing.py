"""What the columns of a document are looked into for: features, types, shapes, ids."""

from typing import cast

from sysmlc.frontends.xmi import namespaces
from sysmlc.frontends.xmi.document import Document, Shape

XSI = "http://www.w3.org/2001/XMLSchema-instance"
"""Its ``type`` says what ``xmi:type`` says where EMF saves without the options of UML2."""


def index(document: Document, declared: tuple[str, ...]) -> None:
    """Look into columns as the parser fills them; types leave the attributes."""
    document.declared = declared
    local = {tag: _local(tag) for tag in dict.fromkeys(document.tags)}
    document.features = list(map(local.__getitem__, document.tags))
    spaces = [uri for uri in declared if namespaces.is_xmi(uri)]
    xmi = spaces[0] if spaces else ""
    for other in spaces[1:]:
        _rename(document, other, xmi)
    _set_keys(document, xmi)
    _index_types(document)
    _index_ids(document)
    _index_shapes(document)


def _set_keys(document: Document, xmi: str) -> None:
    document.id_key, document.type_key = f"{xmi}}}id", f"{xmi}}}type"
    document.idref_key = f"{xmi}}}idref"


def _local(tag: str) -> str:
    """The name without namespace or prefix."""
    return tag.rpartition("}")[2].rpartition(":")[2]


def _index_types(document: Document) -> None:
    document.types = _types(document, document.type_key)
    if XSI in document.declared and not any(document.types):
        document.types = _types(document, f"{XSI}}}type")


def _types(document: Document, key: str) -> list[str]:
    short = _Short()
    return [short[values.pop(key, "")] for values in document.attributes]


class _Short(dict[str, str]):
    """Names of types without prefix, one string for each name."""

    def __missing__(self, name: str) -> str:
        short = self[name] = name.rpartition(":")[2]
        return short


def _index_shapes(document: Document) -> None:
    """Number the shapes of the rows, in the order in which they are met."""
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
