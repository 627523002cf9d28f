"""Diagnostics of the pass ``resolve``: missing elements and missing files."""

from sysmlc.diagnostics import Place, Rule, Severity, Sink, Subject, rule
from sysmlc.ir import Graph, Kind
from sysmlc.ir.element import is_generated
from sysmlc.passes.resolve.libraries import PRIMITIVES, has_primitives_only, is_standard, split_href
from sysmlc.passes.resolve.resolver import Use, UseGroup, stub_id
from sysmlc.support.counts import list_first

BROKEN_REFERENCE = rule(
    "SM150",
    "broken-reference",
    Severity.ERROR,
    "'{relation}' of '{element}' leads to '{target}', which does not exist",
    help="restore the element in the modelling tool, or remove what refers to it",
)
BROKEN_ID = rule(
    "SM151",
    "broken-id",
    Severity.ERROR,
    "'{relation}' of '{element}' names '{target}', which does not exist",
    help="restore the element in the modelling tool, or remove what refers to it",
)
MANY_BROKEN = rule(
    "SM166",
    "broken-references",
    Severity.ERROR,
    "'{relation}' of '{element}' leads to '{target}' and {others} more that do not exist",
    help="restore the elements in the modelling tool, or remove what refers to them",
)
SEVERAL_TARGETS = rule(
    "SM167",
    "several-targets",
    Severity.ERROR,
    "'{relation}' of '{element}' leads to {count} elements, but a flow has only "
    "one; the first is used",
    help="draw one flow for each, with a fork or a decision before them",
)
MISSING_LIBRARY = rule(
    "SM152",
    "missing-library",
    Severity.WARNING,
    "'{library}' is not part of the compile unit; the model refers to {count} of its elements",
    help="give the file '{file}' as a further input{origin}",
)
UNKNOWN_IN_LIBRARY = rule(
    "SM153",
    "unknown-in-library",
    Severity.WARNING,
    "the built-in description of '{library}' lacks {count} of the elements that the model uses",
    help="choose the type again in the modelling tool, or give the file as a further input",
)


_MAX_SINGLE_REPORTS = 4
"""Limit of broken references of one element and relation that are reported one by one."""


def report_unresolved(graph: Graph, sink: Sink, unresolved: list[Use]) -> None:
    """Report references without target; many references of one relation share one diagnostic."""
    lists: dict[tuple[str, str], list[Use]] = {}
    for use in unresolved:
        lists.setdefault((use.holder.id, use.relation), []).append(use)
    for uses in lists.values():
        if len(uses) <= _MAX_SINGLE_REPORTS:
            for use in uses:
                _report_broken(graph, sink, use)
        else:
            _report_many(graph, sink, uses)


def _report_many(graph: Graph, sink: Sink, uses: list[Use]) -> None:
    first = uses[0]
    _mark_unresolved(graph, first)
    subject = _subject(graph, first)
    sink.report(
        MANY_BROKEN,
        subject,
        relation=first.relation,
        element=subject.name,
        target=first.target,
        others=len(uses) - 1,
    )


def _mark_unresolved(graph: Graph, use: Use) -> None:
    marked = use.holder.attrs.get("unresolved")
    names = {str(name) for name in marked} if isinstance(marked, tuple) else set()
    graph.set(use.holder, unresolved=tuple(sorted(names | {use.relation})))


def _report_broken(graph: Graph, sink: Sink, use: Use) -> None:
    _mark_unresolved(graph, use)
    subject = _subject(graph, use)
    sink.report(
        BROKEN_REFERENCE if use.edge else BROKEN_ID,
        subject,
        cause=f"missing {use.target}",
        relation=use.relation,
        element=subject.name,
        target=use.target,
    )


def _subject(graph: Graph, use: Use) -> Subject:
    holder = use.holder
    if use.ordinal < 0:
        return graph.subject(holder)
    return Subject(graph.qualified_name(holder), holder.id, Place(holder.source, use.ordinal))


_MAX_LISTED = 10
_INSTALLED = ("pathmap:", "platform:/plugin")
"""Beginnings of the addresses of files that belong to plug-ins of Eclipse."""


def report_libraries(graph: Graph, sink: Sink, external: dict[str, list[UseGroup]]) -> None:
    """Report each missing file once, with its users. *external* is keyed by href."""
    libraries: dict[str, dict[str, list[Use]]] = {}
    for href, groups in external.items():
        library, _ = split_href(href)
        if not is_standard(library) or _is_doubtful(graph, href):
            uses = [use for group in groups for use in group.uses()]
            libraries.setdefault(library, {})[href] = uses
    for library in sorted(libraries):
        rule = UNKNOWN_IN_LIBRARY if is_standard(library) else MISSING_LIBRARY
        _report_library(graph, sink, rule, library, libraries[library])


def _is_doubtful(graph: Graph, href: str) -> bool:
    """Whether to report a missing element of a standard library.

    This is an element without a known name, or in the library of primitive types. Other libraries
    may have new elements in newer versions.
    """
    # Only the application of a nameless profile is lost, which has no effect by itself.
    stub = graph[stub_id(href)]
    is_nameless = is_generated(stub.name) and stub.kind is not Kind.PROFILE
    return is_nameless or (has_primitives_only(split_href(href)[0]) and stub.name not in PRIMITIVES)


def _report_library(
    graph: Graph, sink: Sink, rule: Rule, library: str, missing: dict[str, list[Use]]
) -> None:
    first = min((use for uses in missing.values() for use in uses), key=Use.location)
    file, ordinal, _ = first.location()
    descriptions = (_describe_loss(graph, href, missing[href]) for href in sorted(missing))
    lines = list(dict.fromkeys(descriptions))
    is_installed = library.startswith(_INSTALLED)
    more = [f"and {len(lines) - _MAX_LISTED} more"] if len(lines) > _MAX_LISTED else []
    sink.report(
        rule,
        _subject_of_first(graph, first, Place(file, ordinal) if file else None),
        notes=(*lines[:_MAX_LISTED], *more),
        library=library,
        count=len(missing),
        file=library.rpartition("/")[2],
        origin="; the modelling tool installs it with its plug-ins" if is_installed else "",
    )


def _subject_of_first(graph: Graph, first: Use, place: Place | None) -> Subject:
    """Return the first user of a library as subject, without an id if it is in a library."""
    holder = first.holder
    id = "" if holder.attrs.get("library") else holder.id
    return Subject(graph.qualified_name(holder), id, place)


def _describe_loss(graph: Graph, href: str, uses: list[Use]) -> str:
    stub = graph[stub_id(href)]
    users = sorted({graph.qualified_name(use.holder) for use in uses})
    return f"{stub.kind} '{stub.name}', used by {list_first(users, 2)}"
