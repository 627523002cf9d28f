"""Withhold the artefacts that come from an element with an error."""

from collections.abc import Iterable, Mapping, Sequence

from sysmlc.diagnostics import Diagnostic
from sysmlc.ir import Graph
from sysmlc.support.output import Artefact

_Errors = Mapping[str, Sequence[Diagnostic]]


def find_withheld_artefacts(
    artefacts: Iterable[Artefact], graph: Graph, diagnostics: Iterable[Diagnostic]
) -> dict[str, tuple[Diagnostic, ...]]:
    """Return the path of each withheld artefact, with the errors that are the reason.

    An error concerns an artefact if its subject is a traced element, an owner or the origin of a
    traced element, or the whole file of a traced element. Artefacts that mark elements with errors
    are not withheld.
    """
    by_id, by_file = _index_errors(d for d in diagnostics if d.is_error)
    if not by_id and not by_file:
        return {}
    affected = _find_affected(graph, by_id, by_file)
    # Several files of one element often have one trace, and it can be long.
    traces = {a.path: a.trace for a in artefacts if not a.marks_faults}
    reasons = {
        trace: _list_reasons(trace, graph, by_id, by_file)
        for trace in dict.fromkeys(traces.values())
        if not affected.isdisjoint(trace)
    }
    return {path: reasons[trace] for path, trace in traces.items() if trace in reasons}


def _index_errors(errors: Iterable[Diagnostic]) -> tuple[_Errors, _Errors]:
    by_id: dict[str, list[Diagnostic]] = {}
    by_file: dict[str, list[Diagnostic]] = {}
    for error in errors:
        if error.subject.id:
            by_id.setdefault(error.subject.id, []).append(error)
        elif error.subject.place is not None:
            by_file.setdefault(error.subject.place.file, []).append(error)
    return by_id, by_file


def _find_affected(graph: Graph, by_id: _Errors, by_file: _Errors) -> set[str]:
    """Return the ids of elements with errors, of all below and of all derived from them."""
    worklist = list(by_id)
    derived: dict[str, list[str]] = {}
    for element in graph:
        origin = element.attrs.get("origin")
        if origin:
            derived.setdefault(str(origin), []).append(element.id)
        if element.source in by_file:
            worklist.append(element.id)
    affected: set[str] = set()
    while worklist:
        id = worklist.pop()
        if id not in affected:
            affected.add(id)
            worklist += derived.get(id, ())
            owner = graph.get(id)
            worklist += [element.id for element in graph.owned(owner)] if owner else ()
    return affected


def _list_reasons(
    trace: Sequence[str], graph: Graph, by_id: _Errors, by_file: _Errors
) -> tuple[Diagnostic, ...]:
    """Return the errors that concern the elements of a trace."""
    ids = _add_owners_and_origins(trace, graph)
    elements = (graph.get(id) for id in ids) if by_file else ()
    files = dict.fromkeys(element.source for element in elements if element is not None)
    errors = [error for id in ids for error in by_id.get(id, ())]
    errors += [error for file in files for error in by_file.get(file, ())]
    return tuple(errors)


def _add_owners_and_origins(trace: Iterable[str], graph: Graph) -> list[str]:
    """Return the traced ids with those of all their owners and origins."""
    visited: dict[str, None] = {}
    worklist = list(trace)
    while worklist:
        id = worklist.pop()
        if id in visited:
            continue
        visited[id] = None
        element = graph.get(id)
        if element is not None:
            origin = element.attrs.get("origin")
            if element.owner:
                worklist.append(element.owner)
            if origin:
                worklist.append(str(origin))
    return list(visited)
