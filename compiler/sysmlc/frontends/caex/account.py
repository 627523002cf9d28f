"""What became of every element of a file: coverage, and findings about what leads nowhere."""

import re
from collections import Counter
from collections.abc import Iterator, Sequence
from html import unescape
from itertools import compress
from operator import gt, not_

from sysmlc.diagnostics import Coverage, Place, Subject, Verdict
from sysmlc.diagnostics.coverage import FileCoverage
from sysmlc.diagnostics.locate import Location, locate
from sysmlc.frontends.caex import fitting, measures, repeats, rules, strange
from sysmlc.frontends.caex.context import Context, path_of
from sysmlc.frontends.caex.document import Document, Node
from sysmlc.frontends.caex.types import Missing
from sysmlc.frontends.caex.vocabulary import FOLDED, LIBRARIES, ROLE_REFERENCES, SIGNS, STANDARD
from sysmlc.ir import Edge
from sysmlc.sources import Source
from sysmlc.sources.caex import ORDER
from sysmlc.sources.encoding import codec

_Use = tuple[Document, Node]

_EXTERNAL = re.compile(r"<(?:[\w.-]+:)?ExternalReference\b[^>]*")
_HIERARCHY = re.compile(rb"<(?:[\w.-]+:)?InstanceHierarchy\b")
_PATH = re.compile(r"""\bPath\s*=\s*(?:"([^"]+)|'([^']+))""")


def links(source: Source) -> list[str]:
    """Files that external references name, each once and in order.

    Those of a file in a package lead to other parts of it, which are read with it.
    """
    if "!" in source.name:
        return []
    mark, name = codec(source.data)
    text = source.data[mark:].decode(name, "replace")
    found = (match for tag in _EXTERNAL.findall(text) if (match := _PATH.search(tag)))
    return list(dict.fromkeys(unescape(match[1] or match[2]) for match in found))


def has_hierarchy(source: Source) -> bool:
    """Whether the file has an instance hierarchy; in UTF-16 every other byte is zero."""
    return _HIERARCHY.search(source.data.replace(b"\0", b"")) is not None


def account(context: Context, coverage: Coverage, sources: Sequence[Source]) -> None:
    """Count every element of each file once, and report what is not read or leads nowhere."""
    strange.report(context, sources)
    for document in context.documents:
        _count(document, coverage.file(document.name))
        lost: dict[str, list[Node]] = {}
        unread = None in document.verdicts
        for row, verdict in enumerate(document.verdicts) if unread else ():
            if verdict is None:
                lost.setdefault(document.tags[row], []).append(document.node(row))
        unordered = map(document.node, _unordered(document))
        misplaced = [pair for node in unordered for pair in _misplaced(node)]
        _report_lost(context, document, lost)
        _report_order(context, document, misplaced)
    _report_missing(context, sources)
    context.report_ids()
    measures.report_strange(context)
    fitting.report(context)
    repeats.report(context)


def _count(document: Document, counts: FileCoverage) -> None:
    """Count every element once; what is folded shares the verdict of its parent."""
    verdicts, columns = document.verdicts, [document.texts[tag] for tag in FOLDED]
    if verdicts.count(Verdict.MAPPED) == len(verdicts):
        numbers = _tags(document)
        numbers.update(dict(zip(FOLDED, map(len, columns), strict=True)))
        for tag, number in numbers.items():
            if number:
                counts.count(tag, Verdict.MAPPED, number)
        return
    found = Counter(zip(document.tags, verdicts, strict=True))
    for (tag, verdict), number in found.items():
        counts.count(tag, verdict or Verdict.UNSUPPORTED, number)
    for tag, column in zip(FOLDED, columns, strict=True):
        for verdict, number in Counter(map(verdicts.__getitem__, column)).items():
            counts.count(tag, verdict or Verdict.UNSUPPORTED, number)


def _tags(document: Document) -> Counter[str]:
    """How many rows have which tag."""
    signs = document.signs
    numbers = Counter({tag: signs.count(sign) for tag, sign in SIGNS.items()})
    if 0 in signs:
        numbers.update(compress(document.tags, map(not_, signs)))
    return numbers


def _unordered(document: Document) -> list[int]:
    """Rows with a child that stands after one that the schema has behind it."""
    if 0 not in document.signs:
        return _unordered_neighbours(document)
    ranks = [ORDER.get(tag, -1) for tag in document.tags]
    highest: dict[int, int] = {}
    found: dict[int, None] = {}
    for parent, rank in zip(document.parents, ranks, strict=True):
        if rank < 0:
            continue
        if rank < highest.get(parent, -1):
            found[parent] = None
        else:
            highest[parent] = rank
    return sorted(found)


def _unordered_neighbours(document: Document) -> list[int]:
    """The same where every child has a place in the order: then two neighbours are wrong."""
    signs, parents, ends = document.signs, document.parents, document.ends
    less = compress(range(len(signs) - 1), map(gt, signs, signs[1:]))
    found = {parents[row] for row in less if parents[row] == parents[row + 1]}
    holding = set(parents)
    holding.discard(-1)
    for row in holding:
        after = ends[row]
        if after < len(ends) and signs[row] > signs[after] and parents[row] == parents[after]:
            found.add(parents[row])
    return sorted(found)


def _misplaced(parent: Node) -> Iterator[tuple[Node, Node]]:
    """Children that stand after one that the schema has behind them, each with that one."""
    highest, before = -1, parent
    for child in parent.children:
        rank = ORDER.get(child.tag, highest)
        if rank < highest:
            yield child, before
        else:
            highest, before = rank, child


def _report_order(context: Context, document: Document, misplaced: list[tuple[Node, Node]]) -> None:
    """Once a file: what writes one element in the wrong place writes all like it there."""
    if misplaced:
        node, before = misplaced[0]
        above = node.parent or node
        count = "1 place" if len(misplaced) == 1 else f"{len(misplaced)} places"
        name = path_of(above) or document.name
        facts = {"tag": node.tag, "element": name, "before": before.tag, "count": count}
        context.report(rules.ELEMENT_ORDER, document, node, **facts)


def _report_lost(context: Context, document: Document, lost: dict[str, list[Node]]) -> None:
    for tag, nodes in lost.items():
        count = "1 element" if len(nodes) == 1 else f"{len(nodes)} elements"
        context.report(rules.UNSUPPORTED, document, nodes[0], count=count, tag=tag)


_EDGES = {
    "InternalElement": Edge.TYPED_BY,
    "ExternalInterface": Edge.TYPED_BY,
    "Attribute": Edge.TYPED_BY,
    "SupportedRoleClass": Edge.REALIZES,
    "RoleRequirements": Edge.REALIZES,
}
"""The edge that is missing when the reference of an element leads nowhere; else a general."""


def _report_missing(context: Context, sources: Sequence[Source]) -> None:
    together: dict[Missing, list[_Use]] = {}
    for missing, uses in context.missing.items():
        for document, node in uses:
            _mark(context, node)
            if missing.what in _SINGLE:
                _report_single(context, missing, document, node)
            else:
                together.setdefault(missing, []).append((document, node))
    places = [document.place(node) for uses in together.values() for document, node in uses]
    locations = locate(sources, places) if places else {}
    for missing, uses in together.items():
        _report_outside(context, missing, uses, locations)


def _mark(context: Context, node: Node) -> None:
    """Name the edge that is missing, so that later rules do not complain of what follows."""
    holders = ((context.graph.get(one.element), one) for one in (node, *node.above()))
    holder, place = next((pair for pair in holders if pair[0] is not None), (None, node))
    # What an instance repeats is the element of its class, to which nothing is missing.
    if holder is not None and holder.ordinal == place.ordinal:
        known = holder.attrs.get("unresolved")
        names = {str(name) for name in known} if isinstance(known, tuple) else set()
        names.add(_EDGES.get(node.tag, Edge.SPECIALIZES).value)
        context.graph.set(holder, unresolved=tuple(sorted(names)))
        says = node.parent if node.tag in ROLE_REFERENCES else node
        if says is not None and holder.id == says.element:
            context.keep_path(holder, node)


_SINGLE = {"class": rules.MISSING_CLASS, "alias": rules.UNDECLARED_ALIAS}
"""What is told at each reference; a file or library that is missing takes down many."""


_PROBLEMS = {
    "class": "which does not exist",
    "alias": "an alias that no ExternalReference declares",
}


def _report_single(context: Context, missing: Missing, document: Document, node: Node) -> None:
    name = missing.name
    library = [one.name for one in (node, *node.above()) if one.tag in LIBRARIES]
    if library and library[0] in STANDARD:
        _report_library(context, missing, document, node, library[0])
        return
    facts = {"element": f"'{path_of(node)}'", "family": "class", "path": name, "alias": name}
    context.report(_SINGLE[missing.what], document, node, **facts)


def _report_library(
    context: Context, missing: Missing, document: Document, node: Node, library: str
) -> None:
    """The plant is not at fault, and it is read: what is wrong is told all the same."""
    name = path_of(node)
    # Without an element: a finding about library content would be left out.
    subject = Subject(name, place=document.place(node))
    facts = {"element": f"'{name}'", "library": library, "path": missing.name}
    problem = _PROBLEMS[missing.what]
    context.sink.report(rules.LIBRARY_FAULT, subject, notes=(), help="", problem=problem, **facts)


def _report_outside(
    context: Context, missing: Missing, uses: list[_Use], locations: dict[Place, Location]
) -> None:
    document, node = uses[0]
    rule = rules.MISSING_CLASS_LIBRARY if missing.what == "library" else rules.MISSING_FILE
    count = "1 element refers" if len(uses) == 1 else f"{len(uses)} elements refer"
    # Without an element: what a library refers to is told all the same.
    subject = Subject(path_of(node), place=document.place(node))
    notes = tuple(_note(*use, locations) for use in uses)
    context.sink.report(
        rule, subject, notes=notes, library=missing.name, file=missing.name, count=count
    )


def _note(document: Document, node: Node, locations: dict[Place, Location]) -> str:
    found = locations.get(document.place(node))
    where = "" if found is None else f" ({document.name}:{found.line}:{found.column})"
    return path_of(node) + where
