"""Reports libraries that are not at hand, with what depends on them."""

from sysmlc.diagnostics import Place, Rule, Sink, Subject
from sysmlc.ir import Graph, Kind
from sysmlc.ir.identity import is_made_by_tools
from sysmlc.passes.resolve.hrefs import PRIMITIVES, has_primitives_only, is_standard, split
from sysmlc.passes.resolve.references import Need, Use
from sysmlc.passes.resolve.resolver import stand_in_id
from sysmlc.passes.resolve.rules import MISSING_LIBRARY, UNKNOWN_IN_LIBRARY

_LISTED = 10


def report_libraries(graph: Graph, sink: Sink, outside: dict[str, list[Need]]) -> None:
    """Report each library once, with what its elements are used by; ``outside`` is by href."""
    libraries: dict[str, dict[str, list[Use]]] = {}
    for href, needs in outside.items():
        library, _ = split(href)
        if not is_standard(library) or _is_doubtful(graph, href):
            uses = [use for need in needs for use in need.uses()]
            libraries.setdefault(library, {})[href] = uses
    for library in sorted(libraries):
        rule = UNKNOWN_IN_LIBRARY if is_standard(library) else MISSING_LIBRARY
        _report_library(graph, sink, rule, library, libraries[library])


def _is_doubtful(graph: Graph, href: str) -> bool:
    """Whether a standard library surely has no such element, or only its id is known.

    Newer versions may have new elements; profiles that are applied say nothing by themselves.
    """
    stub = graph[stand_in_id(href)]
    is_nameless = is_made_by_tools(stub.name) and stub.kind is not Kind.PROFILE
    return is_nameless or (has_primitives_only(split(href)[0]) and stub.name not in PRIMITIVES)


def _report_library(
    graph: Graph, sink: Sink, rule: Rule, library: str, missing: dict[str, list[Use]]
) -> None:
    first = min((use for uses in missing.values() for use in uses), key=Use.place)
    file, ordinal, _ = first.place()
    lines = [_takes_down(graph, href, missing[href]) for href in sorted(missing)]
    more = [f"and {len(lines) - _LISTED} more"] if len(lines) > _LISTED else []
    sink.report(
        rule,
        _user(graph, first, Place(file, ordinal) if file else None),
        notes=(*lines[:_LISTED], *more),
        library=library,
        count=len(missing),
    )


def _user(graph: Graph, first: Use, place: Place | None) -> Subject:
    """The first element that uses a library; what another library uses is told all the same."""
    holder = first.holder
    id = "" if holder.attrs.get("library") else holder.id
    return Subject(graph.qualified_name(holder), id, place)


def _takes_down(graph: Graph, href: str, uses: list[Use]) -> str:
    stand_in = graph[stand_in_id(href)]
    users = sorted({graph.qualified_name(use.holder) for use in uses})
    more = f" and {len(users) - 2} more" if len(users) > 2 else ""
    return f"{stand_in.kind} '{stand_in.name}', used by {', '.join(users[:2])}{more}"
