"""Path fragments of EMF: ``//@packagedElement.0/@ownedAttribute.2`` instead of an id."""

from sysmlc.frontends.xmi import namespaces
from sysmlc.frontends.xmi.document import Document


def is_path(fragment: str) -> bool:
    """Whether the fragment is a path, not an id."""
    return fragment.startswith("/")


def row_at(document: Document, fragment: str) -> int | None:
    """The row that the path leads to, or None.

    The first segment is the number of the root, empty for the first. ``@feature.2`` is the third
    child of that feature, ``@feature`` its only one; a segment without ``@`` is a name.
    """
    first, *steps = fragment.removeprefix("/").split("/")
    roots = _roots(document)
    number = _number(first or "0")
    row = roots[number] if number is not None and number < len(roots) else None
    for step in steps:
        row = None if row is None else _step(document, row, step)
    return row


def _roots(document: Document) -> list[int]:
    """What EMF holds of the file: all below ``xmi:XMI`` that is not XMI's own."""
    if not namespaces.is_xmi(document.namespace(0)):
        return [0]
    return [row for row in document.children(0) if not namespaces.is_xmi(document.namespace(row))]


def _step(document: Document, row: int, step: str) -> int | None:
    if not step.startswith("@"):
        named = (c for c in document.children(row) if document.get(c, "name") == step)
        return next(named, None)
    feature, _, index = step.removeprefix("@").partition(".")
    number = _number(index or "0")
    children = list(document.children(row, feature))
    return children[number] if number is not None and number < len(children) else None


def _number(text: str) -> int | None:
    return int(text) if text.isdecimal() and len(text) < 10 else None
