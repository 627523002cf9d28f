"""XPaths of the elements of an XML file, found in the pass that finds their offsets.

A path has the file's own prefixes and the position of each element among its siblings of the
same name: ``/xmi:XMI/uml:Model[1]/packagedElement[3]``. XPath 1.0 cannot name what stands in a
default namespace, nor a prefix that means two things in one file; such a step asks for the
local name and the namespace instead.
"""

from collections.abc import Collection
from contextlib import suppress
from dataclasses import dataclass, field
from typing import NamedTuple

from sysmlc.sources import Source, SourceError
from sysmlc.sources.xml import SEPARATOR, Parser, parse, parser


class Spot(NamedTuple):
    """Where an element is: its first byte, and its XPath."""

    offset: int
    xpath: str


@dataclass(slots=True)
class Spots:
    """What was found: elements by their ordinals, and the elements around offsets."""

    by_ordinal: dict[int, Spot] = field(default_factory=dict)
    around: dict[int, str] = field(default_factory=dict)
    """XPath of the innermost element that is open at an offset; ``/`` outside the root."""


def is_xml(data: bytes) -> bool:
    """Whether the bytes start as XML does, in any encoding that expat reads."""
    return data[:64].lstrip(b"\xef\xbb\xbf\xff\xfe\0 \t\r\n").startswith(b"<")


def find(source: Source, ordinals: Collection[int], offsets: Collection[int]) -> Spots:
    """The elements with these ordinals, and those around these offsets.

    In a damaged file what stands before the damage is found; nothing in one that is not XML.
    """
    if not is_xml(source.data):
        return Spots()
    search = _Search(frozenset(ordinals), sorted(offsets, reverse=True))
    with suppress(SourceError, _DoneError):
        parse(source, search.parser())
    search.pass_offsets(len(source.data) + 1)
    return search.spots


class _DoneError(Exception):
    """Everything that was looked for is found."""


class _Open:
    """An element that is open: its step, and how many children it has of each name so far."""

    __slots__ = ("children", "step")

    def __init__(self, step: str) -> None:
        self.step = step
        self.children: dict[str, int] = {}


class _Search:
    """One pass over a file; ``offsets`` descend, so that the next one is the last."""

    def __init__(self, ordinals: frozenset[int], offsets: list[int]) -> None:
        self.spots = Spots()
        self._ordinals = ordinals
        self._offsets = offsets
        self._open = [_Open("")]
        self._seen = 0
        self._namespaces: dict[str, str] = {}
        self._tests: dict[str, tuple[str, str]] = {}
        self._made: Parser = parser()

    def parser(self) -> Parser:
        """A parser that tells this search what it sees."""
        made = self._made
        made.namespace_prefixes = True
        made.StartNamespaceDeclHandler = self._declare
        made.StartElementHandler = self._start
        made.EndElementHandler = self._end
        return made

    def pass_offsets(self, here: int) -> None:
        """Note the open element for every offset that lies before ``here``."""
        while self._offsets and self._offsets[-1] < here:
            self.spots.around[self._offsets.pop()] = self._path()

    def _declare(self, prefix: str | None, uri: str | None) -> None:
        self._namespaces.setdefault(prefix or "", uri or "")

    def _start(self, name: str, _attributes: dict[str, str]) -> None:
        here = self._made.CurrentByteIndex
        self.pass_offsets(here)
        self._enter(name)
        if self._seen in self._ordinals:
            self.spots.by_ordinal[self._seen] = Spot(here, self._path())
        self._seen += 1
        if len(self.spots.by_ordinal) == len(self._ordinals) and not self._offsets:
            raise _DoneError

    def _enter(self, name: str) -> None:
        test, key = self._tests.get(name) or self._test(name)
        children = self._open[-1].children
        children[key] = number = children.get(key, 0) + 1
        self._open.append(_Open(f"{test}[{number}]" if len(self._open) > 1 else test))

    def _end(self, _name: str) -> None:
        self.pass_offsets(self._made.CurrentByteIndex)
        self._open.pop()

    def _path(self) -> str:
        return "/".join(one.step for one in self._open) or "/"

    def _test(self, name: str) -> tuple[str, str]:
        """The name as a step has it, and the name by which siblings are counted."""
        uri, local, prefix = _split_name(name)
        if not uri:
            test = local
        elif prefix and self._namespaces.get(prefix) == uri:
            test = f"{prefix}:{local}"
        else:
            test = f"*[local-name()='{local}' and namespace-uri()={_literal(uri)}]"
        self._tests[name] = made = (test, f"{uri}{SEPARATOR}{local}")
        return made


def _split_name(name: str) -> tuple[str, str, str]:
    """Split ``namespace}local}prefix``, ``namespace}local`` or ``local``, the names of expat."""
    parts = name.split(SEPARATOR)
    if len(parts) == 1:
        return "", name, ""
    return parts[0], parts[1], parts[2] if len(parts) > 2 else ""


def _literal(text: str) -> str:
    """An XPath string; no URI has both kinds of quotes."""
    return f'"{text}"' if "'" in text else f"'{text}'"
