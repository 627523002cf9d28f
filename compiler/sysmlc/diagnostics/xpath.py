"""XPaths and offsets of elements of an XML file, computed in one pass over the file.

A path has the file's own prefixes and the position of each element among its siblings of the
same name: ``/xmi:XMI/uml:Model[1]/packagedElement[3]``. XPath 1.0 can name neither an element in a
default namespace nor a prefix with two meanings in one file; such a step compares the local name
and the namespace instead.
"""

from collections.abc import Collection
from contextlib import suppress
from dataclasses import dataclass, field
from typing import NamedTuple

from sysmlc.sources import Source, SourceError
from sysmlc.sources.xml import SEPARATOR, make_parser, parse


class ElementPosition(NamedTuple):
    """The first byte of an element, and its XPath."""

    offset: int
    xpath: str


@dataclass(slots=True)
class XPaths:
    """The XPaths that ``find_xpaths`` found."""

    by_ordinal: dict[int, ElementPosition] = field(default_factory=dict)
    by_offset: dict[int, str] = field(default_factory=dict)
    """XPath of the innermost element that is open at an offset; ``/`` outside the root."""


def is_xml(data: bytes) -> bool:
    """Whether the bytes start as XML does, in any encoding that expat reads."""
    return data[:64].lstrip(b"\xef\xbb\xbf\xff\xfe\0 \t\r\n").startswith(b"<")


def find_xpaths(source: Source, ordinals: Collection[int], offsets: Collection[int]) -> XPaths:
    """Return the XPaths of the elements with these ordinals, and of those around these offsets.

    In a damaged file, only elements before the damage have XPaths. A file that is not XML has none.
    """
    if not is_xml(source.data):
        return XPaths()
    search = _Search(frozenset(ordinals), sorted(offsets, reverse=True))
    with suppress(SourceError, _DoneError):
        search.run(source)
    search.resolve_offsets(len(source.data) + 1)
    return search.xpaths


class _DoneError(Exception):
    """The search has found everything and can stop."""


@dataclass(slots=True)
class _OpenElement:
    """An open element: its step in the path, and the number of its children by name so far."""

    step: str
    children: dict[str, int] = field(default_factory=dict)


class _Search:
    """Handlers of a parser that find the XPaths in one pass over a file.

    ``offsets`` are in descending order, so that the next one is taken from the end of the list.
    """

    def __init__(self, ordinals: frozenset[int], offsets: list[int]) -> None:
        self.xpaths = XPaths()
        self._ordinals = ordinals
        self._offsets = offsets
        self._open = [_OpenElement("")]
        self._ordinal = 0
        self._namespaces: dict[str, str] = {}
        self._steps: dict[str, tuple[str, str]] = {}
        self._parser = make_parser()
        self._parser.namespace_prefixes = True
        self._parser.StartNamespaceDeclHandler = self._declare_namespace
        self._parser.StartElementHandler = self._start_element
        self._parser.EndElementHandler = self._end_element

    def run(self, source: Source) -> None:
        """Search a file; raise ``_DoneError`` as soon as everything is found."""
        parse(source, self._parser)

    def resolve_offsets(self, limit: int) -> None:
        """Set the XPath of every offset below *limit* to the path of the open element."""
        while self._offsets and self._offsets[-1] < limit:
            self.xpaths.by_offset[self._offsets.pop()] = self._join_steps()

    def _declare_namespace(self, prefix: str | None, uri: str | None) -> None:
        self._namespaces.setdefault(prefix or "", uri or "")

    def _start_element(self, name: str, _attributes: dict[str, str]) -> None:
        offset = self._parser.CurrentByteIndex
        self.resolve_offsets(offset)
        self._open_element(name)
        if self._ordinal in self._ordinals:
            position = ElementPosition(offset, self._join_steps())
            self.xpaths.by_ordinal[self._ordinal] = position
        self._ordinal += 1
        if len(self.xpaths.by_ordinal) == len(self._ordinals) and not self._offsets:
            raise _DoneError

    def _open_element(self, name: str) -> None:
        step, key = self._steps.get(name) or self._make_step(name)
        children = self._open[-1].children
        children[key] = number = children.get(key, 0) + 1
        self._open.append(_OpenElement(f"{step}[{number}]" if len(self._open) > 1 else step))

    def _end_element(self, _name: str) -> None:
        self.resolve_offsets(self._parser.CurrentByteIndex)
        self._open.pop()

    def _join_steps(self) -> str:
        return "/".join(element.step for element in self._open) or "/"

    def _make_step(self, name: str) -> tuple[str, str]:
        """Return the step for a name, and the key by which siblings are counted."""
        uri, local, prefix = _split_name(name)
        if not uri:
            step = local
        elif prefix and self._namespaces.get(prefix) == uri:
            step = f"{prefix}:{local}"
        else:
            step = f"*[local-name()='{local}' and namespace-uri()={_quote(uri)}]"
        self._steps[name] = step, f"{uri}{SEPARATOR}{local}"
        return self._steps[name]


def _split_name(name: str) -> tuple[str, str, str]:
    """Return namespace, local name and prefix of a name as expat writes it.

    Expat writes ``namespace}local}prefix``, ``namespace}local`` or ``local``.
    """
    parts = name.split(SEPARATOR)
    if len(parts) == 1:
        return "", name, ""
    return parts[0], parts[1], parts[2] if len(parts) > 2 else ""


def _quote(text: str) -> str:
    """Return an XPath string; no URI has both kinds of quotes."""
    return f'"{text}"' if "'" in text else f"'{text}'"
