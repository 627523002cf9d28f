"""Reports violations of the CAEX schemas: attributes, texts, repeated names, order of elements.

None of them prevents reading: 35 of 1,606 public files do not validate against the schemas.
"""

from collections.abc import Collection, Iterable, Iterator, Sequence
from itertools import compress
from operator import gt

from sysmlc.diagnostics import Severity, Verdict, rule
from sysmlc.frontends.caex import rules
from sysmlc.frontends.caex.document import Document, Node
from sysmlc.frontends.caex.findings import Findings, qualified_name
from sysmlc.frontends.caex.vocabulary import CLASS_TAGS, LIBRARIES
from sysmlc.sources import Source
from sysmlc.sources.caex_vocabulary import ATTRIBUTES, ORDER, TEXTS
from sysmlc.sources.xml import SEPARATOR, make_parser, parse
from sysmlc.support.counts import count as count_nouns
from sysmlc.support.suggestions import did_you_mean

UNKNOWN_ATTRIBUTE = rule(
    "SM633",
    "unknown-caex-attribute",
    Severity.WARNING,
    "{element} has an attribute '{attribute}', which CAEX does not define for "
    "'{tag}'{more}; {hint}",
)
STRAY_TEXT = rule(
    "SM634",
    "stray-caex-text",
    Severity.WARNING,
    "{element} contains the text '{text}'{more}; CAEX allows no text in '{tag}'",
    help="remove it, or move it into a Description",
)
REPEATED_NAME = rule(
    "SM635",
    "repeated-caex-name",
    Severity.WARNING,
    "{owner} has two '{tag}' elements named '{name}'",
    help="rename or remove one of them",
)

_MISPLACED_CLASS = ("ExternalInterface", "RefBaseSystemUnitPath")
"""An attribute for internal elements that some tools write for interfaces (``document.py``)."""
_Shape = tuple[str, tuple[str, ...]]
"""Tag and names of the XML attributes of an element."""


def report_unknown_content(
    findings: Findings, documents: list[Document], sources: Sequence[Source]
) -> None:
    """Report unknown attributes once a file and tag, and stray texts once a tag."""
    sources_by_name = {source.name: source for source in sources}
    for document in documents:
        if not document.is_built_in:
            _report_unknown_attributes(findings, document)
            _report_stray_texts(findings, document, sources_by_name[document.name])


def _is_unchecked(document: Document, row: int) -> bool:
    """Whether a row is below an element that may hold any XML, or that CAEX does not have."""
    ancestor = document.parents[row]
    while ancestor >= 0:
        if ATTRIBUTES.get(document.tags[ancestor]) is None:
            return True
        ancestor = document.parents[ancestor]
    return False


def _quote_name(node: Node, document: Document) -> str:
    return f"'{qualified_name(node) or document.name}'"


# -- attributes ------------------------------------------------------------------------------------


def _report_unknown_attributes(findings: Findings, document: Document) -> None:
    unknown = _find_unknown_attributes(set(_iter_shapes(document)))
    rows_by_attribute: dict[tuple[str, str], list[int]] = {}
    if unknown:
        for row in _find_rows(document, unknown):
            tag = document.tags[row]
            for name in unknown[tag, tuple(document.attributes[row])]:
                if not _is_unchecked(document, row):
                    rows_by_attribute.setdefault((tag, name), []).append(row)
    for row in document.misplaced_classes:
        if not _is_unchecked(document, row):
            rows_by_attribute.setdefault(_MISPLACED_CLASS, []).append(row)
    for (tag, name), rows in rows_by_attribute.items():
        for row in rows:
            if document.verdicts[row] is Verdict.MAPPED:
                document.verdicts[row] = Verdict.APPROXIMATED
        node = document.node(rows[0])
        count = f" ({len(rows)} elements)" if len(rows) > 1 else ""
        facts = {"tag": tag, "attribute": name, "more": count}
        facts["hint"] = did_you_mean(name, ATTRIBUTES[tag] or ())
        if (tag, name) == _MISPLACED_CLASS and rows[0] in document.misplaced_classes:
            facts["hint"] = "it is read as 'RefBaseClassPath'"
        element = _quote_name(node, document)
        findings.report(UNKNOWN_ATTRIBUTE, document, node, element=element, **facts)


def _iter_shapes(document: Document) -> Iterator[_Shape]:
    """Yield the shape of each row: a file has few different ones, which are checked once."""
    return zip(document.tags, map(tuple, document.attributes), strict=True)


def _find_rows(document: Document, shapes: Collection[_Shape]) -> Iterator[int]:
    """Return the rows that have one of the shapes."""
    selectors = map(shapes.__contains__, _iter_shapes(document))
    return compress(range(len(document.tags)), selectors)


def _find_unknown_attributes(shapes: Iterable[_Shape]) -> dict[_Shape, list[str]]:
    """Return the attributes that CAEX does not have, for each shape that has any.

    Attributes in other namespaces are allowed.
    """
    unknown = {}
    for tag, names in shapes:
        allowed = ATTRIBUTES.get(tag)
        if allowed is not None:
            extra = [name for name in names if name not in allowed and _has_no_namespace(name)]
            if extra:
                unknown[tag, names] = extra
    return unknown


def _has_no_namespace(name: str) -> bool:
    return SEPARATOR not in name and not name.startswith("xmlns")


# -- texts -----------------------------------------------------------------------------------------

_TEXTLESS_TAGS = frozenset(ATTRIBUTES) - TEXTS
"""Elements that hold no text; elements that CAEX does not have may hold any."""


def _report_stray_texts(findings: Findings, document: Document, source: Source) -> None:
    if not (document.has_stray_text or _has_stray_text_of_rows(document)):
        return
    # Texts between elements have no row, so a second pass over the file locates them.
    rows = {ordinal: row for row, ordinal in enumerate(document.ordinals)}
    texts_by_tag: dict[str, list[tuple[int, str]]] = {}
    for tag, ordinal, text in _find_stray_texts(source):
        texts_by_tag.setdefault(tag, []).append((ordinal, text))
    for tag, texts in texts_by_tag.items():
        ordinal, text = texts[0]
        count = f" and {len(texts) - 1} more like it" if len(texts) > 1 else ""
        node = document.node(rows[ordinal])
        element = _quote_name(node, document)
        facts = {"element": element, "tag": tag, "text": text, "more": count}
        findings.report(STRAY_TEXT, document, node, **facts)


def _has_stray_text_of_rows(document: Document) -> bool:
    """Whether a checked row has text although its tag allows none."""
    texts, tags = document.texts[""].items(), document.tags
    rows = (row for row, text in texts if tags[row] in _TEXTLESS_TAGS and text.strip())
    return any(not _is_unchecked(document, row) for row in rows)


def _find_stray_texts(source: Source) -> list[tuple[str, int, str]]:
    """Return the texts in elements that hold none: tag, position of the element, text."""
    expat = make_parser()
    texts: list[tuple[str, int, str]] = []
    open_elements = [("", -1)]
    unchecked_depth, ordinal = 0, -1

    def is_unchecked_tag(name: str) -> bool:
        return ATTRIBUTES.get(name) is None or name in TEXTS

    def start_element(tag: str, _attributes: dict[str, str]) -> None:
        nonlocal unchecked_depth, ordinal
        ordinal += 1
        name = tag.rpartition(SEPARATOR)[2]
        open_elements.append((name, ordinal))
        unchecked_depth += is_unchecked_tag(name)

    def end_element(_tag: str) -> None:
        nonlocal unchecked_depth
        unchecked_depth -= is_unchecked_tag(open_elements.pop()[0])

    def add_text(text: str) -> None:
        if not unchecked_depth and text.strip():
            texts.append((*open_elements[-1], " ".join(text.split())))

    expat.StartElementHandler, expat.EndElementHandler = start_element, end_element
    expat.CharacterDataHandler = add_text
    parse(source, expat)
    return texts


# -- names -----------------------------------------------------------------------------------------

_NAMED_TAGS = frozenset({*CLASS_TAGS, *LIBRARIES, "Attribute"})
"""Elements that references find by name; internal elements, interfaces and links have IDs."""


def report_repeated_names(findings: Findings, documents: list[Document]) -> None:
    """Report each row that has the parent, tag and name of an earlier row."""
    for document in documents:
        if document.is_built_in:
            continue
        for row in _find_repeated_rows(document):
            node = document.node(row)
            facts = {"owner": _quote_name(node.parent or node, document), "tag": node.tag}
            findings.report(REPEATED_NAME, document, node, name=node.name, **facts)


def _find_repeated_rows(document: Document) -> Iterator[int]:
    keys: set[tuple[int, str, str]] = set()
    columns = zip(document.tags, document.parents, document.attributes, strict=True)
    for row, (tag, parent, attributes) in enumerate(columns):
        if tag in _NAMED_TAGS:
            key = parent, tag, attributes.get("Name", "")
            if key in keys and not _is_unchecked(document, row):
                yield row
            keys.add(key)


# -- order -----------------------------------------------------------------------------------------


def report_order(findings: Findings, document: Document) -> None:
    """Report the first element in a wrong place.

    One report per file is enough: a tool misplaces all elements of the same kind.
    """
    misplaced = [
        pair
        for node in map(document.node, _find_unordered_rows(document))
        for pair in _find_misplaced(node)
    ]
    if misplaced:
        node, before = misplaced[0]
        count = count_nouns(len(misplaced), "place")
        name = qualified_name(node.parent or node) or document.name
        facts = {"tag": node.tag, "element": name, "before": before.tag, "count": count}
        findings.report(rules.ELEMENT_ORDER, document, node, **facts)


def _find_unordered_rows(document: Document) -> list[int]:
    """Return the rows with a child that the schema puts before a preceding sibling."""
    if 0 not in document.tag_codes:
        return _find_unordered_neighbours(document)
    ranks = [ORDER.get(tag, -1) for tag in document.tags]
    highest: dict[int, int] = {}
    unordered: set[int] = set()
    for parent, rank in zip(document.parents, ranks, strict=True):
        if rank < 0:
            continue
        if rank < highest.get(parent, -1):
            unordered.add(parent)
        else:
            highest[parent] = rank
    return sorted(unordered)


def _find_unordered_neighbours(document: Document) -> list[int]:
    """Return the rows with children in a wrong order, for a file without unknown tags.

    Every child then has a rank, so two adjacent siblings are in the wrong order if any are.
    """
    codes, parents, ends = document.tag_codes, document.parents, document.ends
    # Neighbours without content have consecutive rows.
    decreasing = compress(range(len(codes) - 1), map(gt, codes, codes[1:]))
    unordered = {parents[row] for row in decreasing if parents[row] == parents[row + 1]}
    rows_with_content = set(parents)
    rows_with_content.discard(-1)
    for row in rows_with_content:
        following = ends[row]
        is_last = following == len(ends) or parents[row] != parents[following]
        if not is_last and codes[row] > codes[following]:
            unordered.add(parents[row])
    return sorted(unordered)


def _find_misplaced(parent: Node) -> Iterator[tuple[Node, Node]]:
    """Yield the children in a wrong place, each with the sibling that should come after it."""
    highest, before = -1, parent
    for child in parent.children:
        rank = ORDER.get(child.tag, highest)
        if rank < highest:
            yield child, before
        else:
            highest, before = rank, child
