"""From the bytes of a file to the columns of a document, in one pass of the XML parser.

The handlers here are called for every element of a file: they do the least that they can.
"""

from itertools import pairwise
from typing import TYPE_CHECKING

from sysmlc.sources import DEFAULT_LIMITS, Source, SourceError
from sysmlc.sources.xml import parse, parser, too_deep

if TYPE_CHECKING:
    from sysmlc.frontends.xmi.document import Document

_DRAWINGS = frozenset({"diagramRepresentation", "filePart"})
"""Elements of MagicDraw's extensions whose content is only counted: up to 87 % of a file."""

_TOP = [-1]


def fill(document: "Document", source: Source) -> list[str]:
    """Fill the columns; return the namespaces that the file declares. Raises SourceError."""
    filling = _Filling(document, source)
    try:
        filling.run()
    except SourceError:
        if not filling.has_hidden:
            raise
    if filling.stack != _TOP:
        # A fault inside a drawing, or a drawing inside it: its end was taken for that of the outer.
        filling = _Filling(document, source, has_nested_drawings=True)
        filling.run()
    document.ordinals = _ordinals(len(document.tags), filling.breaks)
    return list(filling.declared)


class _Filling:
    """One run of the parser over a file."""

    def __init__(
        self, document: "Document", source: Source, has_nested_drawings: bool = False
    ) -> None:
        self.has_hidden = False
        self.breaks: list[tuple[int, int]] = []
        """Rows after which content is hidden, and the number of elements hidden so far."""
        self.stack = [*_TOP]
        self.declared: dict[str, None] = {}
        self._document = document
        self._source = source
        self._has_nested_drawings = has_nested_drawings
        self._made = parser()
        for column in (document.tags, document.attributes, document.parents, document.ends):
            column.clear()
        document.texts.clear()
        document.drawn.clear()

    def run(self) -> None:
        made = self._made
        made.StartNamespaceDeclHandler = lambda _, uri: self.declared.setdefault(uri or "")
        self._handle_elements()
        parse(self._source, made)

    def _handle_elements(self) -> None:
        tags, stack, texts = self._document.tags, self.stack, self._document.texts
        ends = self._document.ends
        add_tag, add_attributes = tags.append, self._document.attributes.append
        add_parent, add_end = self._document.parents.append, ends.append
        push, pop = stack.append, stack.pop
        deepest = DEFAULT_LIMITS.depth

        def start(tag: str, values: dict[str, str]) -> None:
            row = len(tags)
            add_tag(tag)
            add_attributes(values)
            add_parent(stack[-1])
            add_end(0)
            push(row)
            if tag in _DRAWINGS or len(stack) > deepest:
                self._special(tag)

        def end(_tag: str) -> None:
            ends[pop()] = len(tags)

        def text(data: str) -> None:
            if not data.isspace():
                row = stack[-1]
                texts[row] = texts[row] + data if row in texts else data

        self._made.StartElementHandler = start
        self._made.EndElementHandler = end
        self._made.CharacterDataHandler = text

    def _special(self, tag: str) -> None:
        if len(self.stack) > DEFAULT_LIMITS.depth:
            too_deep(self._source, self._made)
        self.has_hidden = True
        if self._has_nested_drawings:
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
