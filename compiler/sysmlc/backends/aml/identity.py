"""The ``ID`` of every object: that of an AutomationML file as it is, else one made of it."""

import re

from msgspec import Struct

from sysmlc.ir import Element, Kind
from sysmlc.ir.identity import derived_id

_MADE = re.compile(r"#(values|class|part|type)(~\d+)?$")
"""Ends of the ids of what the front end ``caex`` adds beside an object."""


class Identity(Struct, frozen=True):
    """Which ids are those of the objects of AutomationML files."""

    files: frozenset[str]
    """Names of the sources that are AutomationML."""

    def is_ours(self, element: Element) -> bool:
        """Whether the element comes from an AutomationML file."""
        return element.source in self.files

    def literal(self, element: Element) -> str:
        """The ID that the object has in its AutomationML file, or the empty string."""
        id = element.id
        if not self.is_ours(element) or _MADE.search(id):
            return ""
        if id.startswith((f"{element.source}#", f"{element.owner}/")):
            return ""
        return "" if element.owner is None and element.kind is Kind.PACKAGE and "#" in id else id

    def of(self, *alike: Element | None) -> str:
        """The ID of an object that several elements stand for: a literal one, else derived."""
        known = [one for one in alike if one is not None]
        found = (id for one in known if (id := self.literal(one) or self._of_class(one)))
        return next(found, "") or derived_id(known[0].id, "caex")

    def _of_class(self, element: Element) -> str:
        """The ID in the id of the class that was made for what an object adds to its own."""
        id = element.id.removesuffix("#part")
        if not id.endswith("#class") or not self.is_ours(element):
            return ""
        id = id.removesuffix("#class")
        return "" if "/" in id else id
