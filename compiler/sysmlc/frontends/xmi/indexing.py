"""What the columns of a document are looked into for: features, types, ids."""

from sysmlc.frontends.xmi import namespaces
from sysmlc.frontends.xmi.document import Document

XSI = "http://www.w3.org/2001/XMLSchema-instance"
"""Its ``type`` says what ``xmi:type`` says where EMF saves without the options of UML2."""


def index(document: Document, declared: tuple[str, ...]) -> None:
    """Look into columns as the parser fills them; types leave the attributes."""
    document.declared = declared
    document.features = [_local(tag) for tag in document.tags]
    spaces = [uri for uri in declared if namespaces.is_xmi(uri)]
    xmi = spaces[0] if spaces else ""
    for other in spaces[1:]:
        _rename(document, other, xmi)
    _set_keys(document, xmi)
    _index_types(document)
    _index_ids(document)
    _index_referring(document)


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
    return [values.pop(key, "").rpartition(":")[2] for values in document.attributes]


def _index_referring(document: Document) -> None:
    rows = zip(document.features, document.attributes, strict=True)
    key = document.idref_key
    document.referring = frozenset(f for f, values in rows if key in values or "href" in values)


def _index_ids(document: Document) -> None:
    """Of several elements with one id the first has it."""
    key = document.id_key
    for row, values in enumerate(document.attributes):
        id = values.get(key)
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
