"""The IDs that objects have in their AutomationML files."""

import re
from collections.abc import Collection

from sysmlc.ir.element import Element
from sysmlc.ir.kinds import Kind

CAEX_ID = "caex_id"
"""Attribute with the ID of an object that was read from another language, which has other ids."""
_ADDED_ID = re.compile(r"#(values|class|part|type)(~\d+)?$")
"""Ends of the ids of elements that the front end ``caex`` adds to an object."""

_TYPES = (Kind.CLASS, Kind.DATA_TYPE)
"""Kinds of types that the front end adds; they are no objects of AutomationML."""


def find_caex_id(element: Element, files: Collection[str]) -> str:
    """Return the ID that the object has in its AutomationML file, or the empty string.

    *files* are the names of the sources that are AutomationML.
    """
    if CAEX_ID in element.attrs:
        return str(element.attrs[CAEX_ID])
    if element.source not in files:
        return ""
    id = element.id
    if _ADDED_ID.search(id):
        return "" if element.kind in _TYPES else find_extended_id(element)
    # The front end made such an id: the object has no ID, or not the only one of its kind.
    if id.startswith((f"{element.source}#", f"{element.owner}/")):
        return ""
    return "" if element.owner is None and element.kind is Kind.PACKAGE and "#" in id else id


def find_extended_id(element: Element) -> str:
    """Return the ID of the object to which the front end added an element, or an empty string."""
    id = element.id
    while _ADDED_ID.search(id):
        id = _ADDED_ID.sub("", id)
    return "" if id == element.id or "/" in id or id.startswith(f"{element.source}#") else id
