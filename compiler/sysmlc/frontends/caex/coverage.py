"""Coverage of the files: the verdict of every element, and references that do not resolve."""

from collections import Counter
from collections.abc import Sequence
from itertools import compress
from operator import not_

from sysmlc.diagnostics import Coverage, Place, Subject, Verdict
from sysmlc.diagnostics.coverage import FileCoverage
from sysmlc.diagnostics.locations import Location, locate
from sysmlc.frontends.caex import conformance, rules, standard
from sysmlc.frontends.caex.context import Context
from sysmlc.frontends.caex.data_types import report_values
from sysmlc.frontends.caex.document import Document, Node
from sysmlc.frontends.caex.findings import (
    Findings,
    qualified_name,
    record_unresolved_path,
    report_ids,
)
from sysmlc.frontends.caex.identifiers import LocatedNode
from sysmlc.frontends.caex.types import MissingTarget
from sysmlc.frontends.caex.value_types import report_unknown_units
from sysmlc.frontends.caex.vocabulary import (
    FOLDED_TAGS,
    LIBRARIES,
    ROLE_REFERENCES,
    STANDARD_LIBRARIES,
    TAG_CODES,
)
from sysmlc.ir import Edge, Graph
from sysmlc.sources import Source
from sysmlc.support.counts import count as count_nouns


def report_coverage(context: Context, coverage: Coverage, sources: Sequence[Source]) -> None:
    """Count every element of each file once, and report all findings of the reading."""
    # Unknown attributes change verdicts, so they come before the count.
    conformance.report_unknown_content(context.findings, context.documents, sources)
    for document in context.documents:
        _count_verdicts(document, coverage.file(document.name))
        _report_unread(context.findings, document)
        conformance.report_order(context.findings, document)
        standard.report_interfaces(context, document)
    _report_missing_targets(context.graph, context.findings, sources)
    report_ids(context.findings, context.ids, context.documents)
    standard.report_repeated_across_files(context.findings, context.ids)
    report_unknown_units(context.findings)
    report_values(context.findings)
    conformance.report_repeated_names(context.findings, context.documents)


# -- verdicts --------------------------------------------------------------------------------------


def _count_verdicts(document: Document, counts: FileCoverage) -> None:
    """Count every element once; a folded element shares the verdict of its parent."""
    verdicts = document.verdicts
    text_columns = {tag: document.texts[tag] for tag in FOLDED_TAGS}
    if verdicts.count(Verdict.MAPPED) == len(verdicts):
        numbers = _count_tags(document)
        numbers.update({tag: len(column) for tag, column in text_columns.items()})
        for tag, number in numbers.items():
            if number:
                counts.count(tag, Verdict.MAPPED, number)
        return
    rows = Counter(zip(document.tags, verdicts, strict=True))
    for (tag, verdict), number in rows.items():
        counts.count(tag, verdict or Verdict.UNSUPPORTED, number)
    for tag, column in text_columns.items():
        for verdict, number in Counter(map(verdicts.__getitem__, column)).items():
            counts.count(tag, verdict or Verdict.UNSUPPORTED, number)


def _count_tags(document: Document) -> Counter[str]:
    """Return the number of rows with each tag."""
    codes = document.tag_codes
    numbers = Counter({tag: codes.count(code) for tag, code in TAG_CODES.items()})
    if 0 in codes:
        numbers.update(compress(document.tags, map(not_, codes)))
    return numbers


def _report_unread(findings: Findings, document: Document) -> None:
    """Report elements without a verdict, once for each tag."""
    if None not in document.verdicts:
        return
    nodes_by_tag: dict[str, list[Node]] = {}
    for row, verdict in enumerate(document.verdicts):
        if verdict is None:
            nodes_by_tag.setdefault(document.tags[row], []).append(document.node(row))
    for tag, nodes in nodes_by_tag.items():
        count = count_nouns(len(nodes), "element")
        findings.report(rules.UNSUPPORTED, document, nodes[0], count=count, tag=tag)


# -- references that do not resolve ----------------------------------------------------------------

_EDGES = {
    "InternalElement": Edge.TYPED_BY,
    "ExternalInterface": Edge.TYPED_BY,
    "Attribute": Edge.TYPED_BY,
    "SupportedRoleClass": Edge.REALIZES,
    "RoleRequirements": Edge.REALIZES,
}
"""Edge that a reference would become, by the tag of its element; else a generalization."""

_RULES_PER_REFERENCE = {"class": rules.MISSING_CLASS, "alias": rules.UNDECLARED_ALIAS}
"""Rules reported at each reference. A missing file or library is reported once for all of them."""

_PROBLEMS = {
    "class": "which does not exist",
    "alias": "an alias that no ExternalReference declares",
}


def _report_missing_targets(graph: Graph, findings: Findings, sources: Sequence[Source]) -> None:
    grouped: dict[MissingTarget, list[LocatedNode]] = {}
    for target, references in findings.missing_targets.items():
        for document, node in references:
            _mark_unresolved(graph, node)
            if target.kind in _RULES_PER_REFERENCE:
                _report_reference(findings, target, document, node)
            else:
                grouped.setdefault(target, []).append((document, node))
    places = [document.locate(node) for nodes in grouped.values() for document, node in nodes]
    locations = locate(sources, places) if places else {}
    for target, references in grouped.items():
        _report_file_or_library(findings, target, references, locations)


def _mark_unresolved(graph: Graph, node: Node) -> None:
    """Record the missing edge in its element, so that later rules do not report consequences."""
    nodes = (node, *node.iter_ancestors())
    elements = ((graph.get(holder.element_id), holder) for holder in nodes)
    element, holder = next((pair for pair in elements if pair[0] is not None), (None, node))
    # A node that repeats a member of a class has the element of the class, which lacks nothing.
    if element is None or element.ordinal != holder.ordinal:
        return
    stored = element.attrs.get("unresolved")
    edges = {str(edge) for edge in stored} if isinstance(stored, tuple) else set()
    edges.add(_EDGES.get(node.tag, Edge.SPECIALIZES).value)
    graph.set(element, unresolved=tuple(sorted(edges)))
    named_by = node.parent if node.tag in ROLE_REFERENCES else node
    if named_by is not None and element.id == named_by.element_id:
        record_unresolved_path(graph, element, node)


def _report_reference(
    findings: Findings, target: MissingTarget, document: Document, node: Node
) -> None:
    nodes = (node, *node.iter_ancestors())
    library = next((holder.name for holder in nodes if holder.tag in LIBRARIES), "")
    if library in STANDARD_LIBRARIES:
        _report_library_fault(findings, target, document, node, library)
        return
    facts = {"path": target.name, "alias": target.name, "family": "class"}
    rule, cause = _RULES_PER_REFERENCE[target.kind], f"no {target.kind} {target.name}"
    element = f"'{qualified_name(node)}'"
    findings.report(rule, document, node, cause, element=element, **facts)


def _report_library_fault(
    findings: Findings, target: MissingTarget, document: Document, node: Node, library: str
) -> None:
    """Report a fault in a standard library that the file holds as a warning: the plant is read."""
    name = qualified_name(node)
    # Without an element, because diagnostics about elements of libraries are suppressed.
    subject = Subject(name, place=document.locate(node))
    facts = {"element": f"'{name}'", "library": library, "path": target.name}
    facts["problem"] = _PROBLEMS[target.kind]
    cause = f"{library} without {target.name}"
    findings.sink.report(rules.LIBRARY_FAULT, subject, notes=(), help="", cause=cause, **facts)


def _report_file_or_library(
    findings: Findings,
    target: MissingTarget,
    references: list[LocatedNode],
    locations: dict[Place, Location],
) -> None:
    """Report a missing file or library, with a note for each reference to it."""
    document, node = references[0]
    rule = rules.MISSING_CLASS_LIBRARY if target.kind == "library" else rules.MISSING_FILE
    number = len(references)
    count = "1 element refers" if number == 1 else f"{number} elements refer"
    # Without an element, because references from libraries are reported, too.
    subject = Subject(qualified_name(node), place=document.locate(node))
    notes = tuple(_format_note(*reference, locations) for reference in references)
    facts = {"library": target.name, "file": target.name, "count": count}
    findings.sink.report(rule, subject, notes=notes, **facts)


def _format_note(document: Document, node: Node, locations: dict[Place, Location]) -> str:
    location = locations.get(document.locate(node))
    if location is None:
        return qualified_name(node)
    return f"{qualified_name(node)} ({document.name}:{location.line}:{location.column})"
