"""Names with prefixes instead of namespaces: expat need not expand each of them again.

Nearly every file declares all its namespaces in its root, one prefix for each. Then what a
prefix means is known from there, and expat, which otherwise looks up and copies the namespace
for every name that it comes by, saves a fifth of its time. Its table of names gives the keys of
the columns at once: ``namespace}local``.
"""

from collections.abc import Iterable

from sysmlc.frontends.xmi.document import Document
from sysmlc.sources.xml import SEPARATOR

_XML = {"xml": "http://www.w3.org/XML/1998/namespace"}
_OFTEN = ("id", "type", "idref", "uuid", "label", "version")
"""Attributes that have a prefix in many rows; others are renamed afterwards."""
_DECLARATION = "xmlns"


class IrregularError(Exception):
    """The file does not give each prefix one namespace, and each namespace one prefix."""


class Prefixes:
    """What the prefixes of one file mean.

    ``names`` is the table from names as they are written to what handlers are given for them:
    expat's own table of names, which it looks into anyway.
    """

    def __init__(self) -> None:
        self.names: dict[str, str] = {}
        self.declared: dict[str, str] = {}

    def begin(self, tag: str, values: dict[str, str]) -> str:
        """Learn from the root, whose declarations are taken out of ``values``; its full name.

        Raises IrregularError where only the parser can tell what names mean.
        """
        for name in [name for name in values if name.startswith(_DECLARATION)]:
            self._declare(name, values.pop(name))
        for prefix, namespace in self.declared.items():
            self.names |= {f"{prefix}:{name}": f"{namespace}}}{name}" for name in _OFTEN}
        written = dict(values)
        values.clear()
        values |= {self.full(name): value for name, value in written.items()}
        return self.full(tag)

    def full(self, name: str) -> str:
        """The name with its namespace. Raises IrregularError for a prefix that is not known."""
        prefix, colon, local = name.partition(":")
        if SEPARATOR in name or (not colon and name != _DECLARATION):
            return name
        namespace = self.declared.get(prefix) or _XML.get(prefix)
        if namespace is None or not local or ":" in local:
            raise IrregularError
        return f"{namespace}{SEPARATOR}{local}"

    def expand(self, document: Document) -> bool:
        """Give what has kept its prefix its namespace; whether attributes have changed.

        Raises IrregularError.
        """
        tags = document.tags
        full = self._full_names(dict.fromkeys(tags))
        document.tags = list(map(full.get, tags, tags))
        full = self._full_names({name for _, _, names in document.shapes for name in names})
        if full:
            rows = document.attributes
            document.attributes = [{full.get(n, n): v for n, v in one.items()} for one in rows]
        return bool(full)

    def check_hidden(self, data: bytes) -> None:
        """Of drawings, which declare prefixes of their own, only that they do it at all."""
        known = {_DECLARATION, *_XML, *self.declared}
        for prefix in {name.partition(":")[0] for name in self.names if ":" in name}:
            if prefix not in known and f"{_DECLARATION}:{prefix}".encode() not in data:
                raise IrregularError

    def _full_names(self, names: Iterable[str]) -> dict[str, str]:
        """Full names of those that were not given in full."""
        return {name: full for name in names if (full := self.full(name)) != name}

    def _declare(self, name: str, namespace: str) -> None:
        _, colon, prefix = name.partition(":")
        is_known = namespace in self.declared.values()
        if not colon or not namespace or is_known or prefix in ("xml", _DECLARATION):
            raise IrregularError
        self.declared[prefix] = namespace
