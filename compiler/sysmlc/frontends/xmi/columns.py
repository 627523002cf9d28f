"""From the bytes of a file to the columns of a document, in one pass of the XML parser.

The handlers here are called for every element of a file: they do the least that they can.
"""

from collections.abc import Callable
from itertools import pairwise

from sysmlc.frontends.xmi.document import Document
from sysmlc.frontends.xmi.makers import NOTHING
from sysmlc.frontends.xmi.prefixes import IrregularError, Prefixes
from sysmlc.sources import DEFAULT_LIMITS, Source
from sysmlc.sources.xml import parse, parser, plain_parser, too_deep

_DRAWINGS = frozenset({"diagramRepresentation", "filePart"})
"""Elements of MagicDraw's extensions whose content is only counted: up to 87 % of a file."""

_IRREGULAR = "MDFoundation:MDExtension"
"""What MagicDraw attaches is another document of XMI, whose prefixes mean something else."""

SPECIAL = _DRAWINGS | {_IRREGULAR}
"""Elements whose content is no part of the columns as other content is."""

_TOP = [-1]

_Start = Callable[[str, dict[str, str]], None]
"""Handler of an element's start; takes its name and its attributes."""


def fill(document: Document, source: Source) -> tuple[str, ...]:
    """Fill the columns; return the namespaces that the file declares outside drawings.

    Raises SourceError.
    """
    filling = _Filling(document, source)
    filling.run()
    return tuple(filling.declared)


def fill_swiftly(document: Document, source: Source, prefixes: Prefixes) -> tuple[str, ...]:
    """The same for files as nearly all are; some attributes keep their prefixes.

    Raises SourceError or IrregularError for any other: faults, namespaces declared below the
    root, drawings inside drawings.
    """
    filling = _Filling(document, source, prefixes)
    filling.run()
    if filling.stack != _TOP:
        raise IrregularError
    return tuple(prefixes.declared.values())


class _Filling:
    """One run of the parser over a file; the swift one knows what prefixes mean."""

    def __init__(
        self, document: Document, source: Source, prefixes: Prefixes | None = None
    ) -> None:
        self.breaks: list[tuple[int, int]] = []
        """Rows after which content is hidden, and the number of elements hidden so far."""
        self.stack = [*_TOP]
        self.declared: dict[str, None] = {}
        self._document = document
        self._source = source
        self._prefixes = prefixes
        self._made = parser() if prefixes is None else plain_parser(prefixes.names)

    def run(self) -> None:
        start = self._handle_elements()
        if self._prefixes is not None:
            self._handle_root(self._prefixes, start)
        try:
            parse(self._source, self._made)
        finally:
            self._let_go()
        if self.breaks:
            self._document.ordinals = _ordinals(len(self._document.tags), self.breaks)

    def _let_go(self) -> None:
        """End the circle of parser and handlers: the frozen graph would keep it for good."""
        made = self._made
        made.StartElementHandler = made.EndElementHandler = made.CharacterDataHandler = None
        made.StartNamespaceDeclHandler = None

    def _handle_root(self, prefixes: Prefixes, start: _Start) -> None:
        def root(tag: str, values: dict[str, str]) -> None:
            self._made.StartElementHandler = start
            start(prefixes.begin(tag, values), values)

        self._made.StartElementHandler = root

    def _handle_elements(self) -> _Start:
        tags, stack, texts = self._document.tags, self.stack, self._document.texts
        ends = self._document.ends
        add_tag, add_attributes = tags.append, self._document.attributes.append
        add_parent, add_end = self._document.parents.append, ends.append
        add_ordinal = self._document.ordinals.append
        push, pop = stack.append, stack.pop
        deepest = DEFAULT_LIMITS.depth
        following = len(tags)

        def start(tag: str, values: dict[str, str]) -> None:
            # Columns share their numbers: a number of its own is four times its place in a list.
            nonlocal following
            row = following
            following = row + 1
            add_ordinal(row)
            add_tag(tag)
            add_attributes(values or NOTHING)
            add_parent(stack[-1])
            add_end(row)
            push(row)
            if tag in SPECIAL or len(stack) > deepest:
                self._special(tag)

        def end(_tag: str) -> None:
            ends[pop()] = following

        def text(data: str) -> None:
            if not data.isspace():
                row = stack[-1]
                texts[row] = texts[row] + data if row in texts else data

        def namespace(_: str | None, uri: str | None) -> None:
            self.declared[uri or ""] = None

        self._made.StartNamespaceDeclHandler = namespace
        self._made.StartElementHandler = start
        self._made.EndElementHandler = end
        self._made.CharacterDataHandler = text
        return start

    def _special(self, tag: str) -> None:
        if len(self.stack) > DEFAULT_LIMITS.depth:
            too_deep(self._source, self._made)
        if tag == _IRREGULAR:
            raise IrregularError
        if self._prefixes is None:
            self._hide_nested(tag)
        else:
            self._hide(tag)

    def _hide(self, outer: str) -> None:
        """Only count what ends before ``outer`` does; starts are not even looked at."""
        hidden = 0

        def end_hidden(tag: str) -> None:
            nonlocal hidden
            if tag == outer:
                self._show(tag, hidden)
            else:
                hidden += 1

        self._made.StartElementHandler = None
        self._made.EndElementHandler = end_hidden
        self._made.CharacterDataHandler = None
        self._made.StartNamespaceDeclHandler = None

    def _hide_nested(self, outer: str) -> None:
        depth = hidden = 0

        def start_hidden(_tag: str, _values: dict[str, str]) -> None:
            nonlocal depth, hidden
            depth += 1
            hidden += 1
            if depth > DEFAULT_LIMITS.depth:
                too_deep(self._source, self._made)

        def end_hidden(_tag: str) -> None:
            nonlocal depth
            depth -= 1
            if depth < 0:
                self._show(outer, hidden)

        self._made.StartElementHandler = start_hidden
        self._made.EndElementHandler = end_hidden
        self._made.CharacterDataHandler = None
        self._made.StartNamespaceDeclHandler = None

    def _show(self, tag: str, hidden: int) -> None:
        document = self._document
        if hidden:
            document.drawn[tag] += hidden
        self.breaks.append((len(document.tags), document.drawn.total()))
        document.ends[self.stack.pop()] = len(document.tags)
        self._handle_elements()


def _ordinals(rows: int, breaks: list[tuple[int, int]]) -> list[int]:
    """Place of each row's element among all elements of the file."""
    found: list[int] = []
    for (row, hidden), (following, _) in pairwise([(0, 0), *breaks, (rows, 0)]):
        found += range(row + hidden, following + hidden)
    return found
