"""XML that CAEX does not know: attributes of elements, and text between elements."""

from collections.abc import Collection, Iterable, Iterator, Sequence
from itertools import compress

from sysmlc.diagnostics import Severity, Verdict, rule
from sysmlc.frontends.caex.context import Context, path_of
from sysmlc.frontends.caex.document import Document, Node
from sysmlc.sources import Source
from sysmlc.sources.caex import ATTRIBUTES, TEXTS
from sysmlc.sources.xml import SEPARATOR, parse, parser
from sysmlc.support.suggestions import did_you_mean

UNKNOWN_ATTRIBUTE = rule(
    "SM633",
    "unknown-caex-attribute",
    Severity.WARNING,
    "{element} has an attribute '{attribute}', which CAEX does not have at '{tag}'{more}; {hint}",
)
STRAY_TEXT = rule(
    "SM634",
    "stray-caex-text",
    Severity.WARNING,
    "{element} holds the text '{text}'{more}; CAEX has none at '{tag}'",
    help="remove it, or put it into a Description",
)

_Shape = tuple[str, tuple[str, ...]]
"""Tag and names of attributes."""


def report(context: Context, sources: Sequence[Source]) -> None:
    """Tell of what no schema of CAEX has: each attribute once a file and tag, text once a tag."""
    known = {source.name: source for source in sources}
    for document in context.documents:
        if not document.is_built_in:
            _attributes(context, document)
            _texts(context, document, known[document.name])


# -- attributes --------------------------------------------------------------------------------


def _attributes(context: Context, document: Document) -> None:
    unknown = _unknown_by_shape(set(_shape_of_each_row(document)))
    found: dict[tuple[str, str], list[int]] = {}
    for row in _rows(document, unknown) if unknown else ():
        tag = document.tags[row]
        for name in unknown[tag, tuple(document.attributes[row])]:
            if not is_free(document, row):
                found.setdefault((tag, name), []).append(row)
    for (tag, name), rows in found.items():
        for row in rows:
            if document.verdicts[row] is Verdict.MAPPED:
                document.verdicts[row] = Verdict.APPROXIMATED
        facts = {"tag": tag, "attribute": name, "more": _more(len(rows))}
        facts["hint"] = did_you_mean(name, ATTRIBUTES[tag] or ())
        _tell(context, document, rows[0], facts)


def _shape_of_each_row(document: Document) -> Iterator[_Shape]:
    return zip(document.tags, map(tuple, document.attributes), strict=True)


def _rows(document: Document, shapes: Collection[_Shape]) -> Iterator[int]:
    """The rows that have one of the shapes."""
    are_such = map(shapes.__contains__, _shape_of_each_row(document))
    return compress(range(len(document.tags)), are_such)


def _unknown_by_shape(shapes: Iterable[_Shape]) -> dict[_Shape, list[str]]:
    """Unknown attributes of each shape that has some; its rows do not keep namespaces."""
    found = {}
    for tag, names in shapes:
        kept = tuple(name for name in names if name != "xmlns")
        found[tag, kept] = list(_unknown((tag, kept)))
    return {shape: names for shape, names in found.items() if names}


def _unknown(shape: _Shape) -> Iterator[str]:
    """Attributes that an element of CAEX has not; those of other namespaces do not count."""
    tag, names = shape
    known = ATTRIBUTES.get(tag)
    if known is not None:
        yield from (name for name in names if name not in known and _is_own(name))


def _is_own(name: str) -> bool:
    return SEPARATOR not in name and not name.startswith("xmlns")


def is_free(document: Document, row: int) -> bool:
    """Whether a row lies in what may hold any XML, or in what CAEX does not know."""
    above = document.parents[row]
    while above >= 0:
        if ATTRIBUTES.get(document.tags[above]) is None:
            return True
        above = document.parents[above]
    return False


def _tell(context: Context, document: Document, row: int, facts: dict[str, str]) -> None:
    node = document.node(row)
    context.report(UNKNOWN_ATTRIBUTE, document, node, element=_name(node, document), **facts)


def _name(node: Node, document: Document) -> str:
    return f"'{path_of(node) or document.name}'"


def _more(count: int) -> str:
    return f" ({count} elements)" if count > 1 else ""


# -- texts -------------------------------------------------------------------------------------


def _texts(context: Context, document: Document, source: Source) -> None:
    if not (document.has_stray or _has_stray_of_rows(document)):
        return
    rows = {ordinal: row for row, ordinal in enumerate(document.ordinals)}
    found: dict[str, list[tuple[int, str]]] = {}
    for tag, ordinal, text in _stray(source):
        found.setdefault(tag, []).append((ordinal, text))
    for tag, places in found.items():
        ordinal, text = places[0]
        more = f" and {len(places) - 1} more like it" if len(places) > 1 else ""
        node = document.node(rows[ordinal])
        facts = {"element": _name(node, document), "tag": tag, "text": text, "more": more}
        context.report(STRAY_TEXT, document, node, **facts)


def _has_stray_of_rows(document: Document) -> bool:
    """Whether a row has text of its own and is neither free nor an element that holds text."""
    own, tags = document.texts[""].items(), document.tags
    heard = (row for row, text in own if tags[row] in _SILENT and text.strip())
    return any(not is_free(document, row) for row in heard)


_SILENT = frozenset(ATTRIBUTES) - TEXTS
"""Elements that hold no text; in what CAEX does not know any may stand."""


def _stray(source: Source) -> list[tuple[str, int, str]]:
    """Texts in elements that have none: tag, place among all elements, text."""
    made, found, above = parser(), [], [("", -1)]
    free, ordinal = 0, -1

    def start(tag: str, _values: dict[str, str]) -> None:
        nonlocal free, ordinal
        ordinal += 1
        name = tag.rpartition(SEPARATOR)[2]
        above.append((name, ordinal))
        free += ATTRIBUTES.get(name) is None or name in TEXTS

    def end(_tag: str) -> None:
        nonlocal free
        name = above.pop()[0]
        free -= ATTRIBUTES.get(name) is None or name in TEXTS

    def text(data: str) -> None:
        if not free and data.strip():
            found.append((*above[-1], " ".join(data.split())))

    made.StartElementHandler, made.EndElementHandler = start, end
    made.CharacterDataHandler = text
    try:
        parse(source, made)
    finally:
        made.StartElementHandler = made.EndElementHandler = made.CharacterDataHandler = None
    return found
