"""From the bytes of any file to the columns of a document, in one pass of the XML parser.

The handlers here are called for every element of a file: they do the least that they can.
"""

from sysmlc.frontends.caex.document import Document
from sysmlc.frontends.caex.vocabulary import STRUCTURE
from sysmlc.sources import DEFAULT_LIMITS, Source
from sysmlc.sources.xml import SEPARATOR, Parser, parse, parser, too_deep

_Texts = dict[int, str]


class _Kinds(dict[str, _Texts | None]):
    """What text each tag has: none, one that is folded, or (the column of) its own."""

    def __init__(self, texts: dict[str, _Texts]) -> None:
        super().__init__()
        self._texts = texts

    def __missing__(self, tag: str) -> _Texts | None:
        name = tag.rpartition(SEPARATOR)[2]
        own = None if name in STRUCTURE else self._texts[""]
        self[tag] = kind = self._texts.get(name, own) if name else own
        return kind


def fill(document: Document, source: Source) -> None:
    """Fill the columns. Raises SourceError."""
    made = parser()
    try:
        stray = _handle(document, source, made)
        parse(source, made)
        document.has_stray = any(map(str.strip, stray))
        document.has_changes = "ChangeMode" in made.intern
        local = {tag: tag.rpartition(SEPARATOR)[2] for tag in set(document.tags)}
        document.tags = [local[tag] for tag in document.tags]
        document.ids = [values.get("ID", "") for values in document.attributes]
        document.alike = list(range(len(document.tags)))
    finally:
        # The handlers know the parser and the columns: nothing else ends this circle.
        made.StartElementHandler = made.EndElementHandler = made.CharacterDataHandler = None


def _handle(document: Document, source: Source, made: Parser) -> set[str]:
    """Set the handlers; the set that they return will hold what stands where CAEX has no text.

    Text is kept only where CAEX has some: between the other elements stand line ends.
    The text of what is inside a folded element is its parent's, too.
    """
    stray: set[str] = set()
    hear = stray.add
    tags, ends, texts = document.tags, document.ends, document.texts
    stack = [-1]
    kinds = _Kinds(texts)
    deepest = DEFAULT_LIMITS.depth
    own = texts[""]
    ordinal = -1
    following = 0
    folding: _Texts | None = None
    depth = 0
    add_tag, add_attributes = tags.append, document.attributes.append
    add_parent, add_ordinal = document.parents.append, document.ordinals.append
    add_end, push, pop = ends.append, stack.append, stack.pop

    def start(tag: str, values: dict[str, str]) -> None:
        # Columns share their numbers: a number of its own is four times its place in a list.
        nonlocal ordinal, following, folding, depth
        ordinal += 1
        above = stack[-1]
        kind = kinds[tag]
        if kind is not None:
            made.CharacterDataHandler = text
            made.EndElementHandler = end_of_text
            is_folded = not values and kind is not own and folding is None
            if is_folded and above >= 0 and above not in kind:
                folding, depth = kind, len(stack)
                kind[above] = ""
                return
        row = following
        following = row + 1
        push(row)
        add_tag(tag)
        add_attributes(values)
        add_parent(above)
        add_ordinal(ordinal)
        add_end(0)
        if len(stack) > deepest:
            too_deep(source, made)

    def end(_tag: str) -> None:
        ends[pop()] = following

    def end_of_text(_tag: str) -> None:
        nonlocal folding
        made.CharacterDataHandler = hear
        if folding is None:
            made.EndElementHandler = end
        elif len(stack) == depth:
            folding = None
            made.EndElementHandler = end
            return
        ends[pop()] = following

    def text(data: str) -> None:
        row = stack[-1]
        column = folding if folding is not None and len(stack) == depth else own
        column[row] = column[row] + data if column.get(row) else data

    made.StartElementHandler = start
    made.EndElementHandler = end
    made.CharacterDataHandler = hear
    return stray
