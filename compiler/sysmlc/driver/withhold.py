"""Which artefacts are withheld: those that come from an element with an error."""

from collections.abc import Iterable, Mapping, Sequence

from sysmlc.diagnostics import Diagnostic
from sysmlc.ir import Graph
from sysmlc.support.output import Artefact

_Errors = Mapping[str, Sequence[Diagnostic]]


def withheld_artefacts(
    artefacts: Iterable[Artefact], graph: Graph, diagnostics: Iterable[Diagnostic]
) -> dict[str, tuple[Diagnostic, ...]]:
    """Path -> the errors because of which the artefact is withheld.

    An error counts when it is about a traced element, about one that it lies in or that it
    was derived from, or about the file of one as a whole.
    """
    by_id, by_file = _indexed(found for found in diagnostics if found.is_error)
    if not by_id and not by_file:
        return {}
    concerned = _concerned(graph, by_id, by_file)
    # Several files of one element often have one trace, and it can be long.
    traces = {artefact.path: artefact.trace for artefact in artefacts}
    found = {
        trace: _reasons(trace, graph, by_id, by_file)
        for trace in dict.fromkeys(traces.values())
        if not concerned.isdisjoint(trace)
    }
    return {path: found[trace] for path, trace in traces.items() if trace in found}


def _indexed(errors: Iterable[Diagnostic]) -> tuple[_Errors, _Errors]:
    by_id: dict[str, list[Diagnostic]] = {}
    by_file: dict[str, list[Diagnostic]] = {}
    for error in errors:
        if error.subject.id:
            by_id.setdefault(error.subject.id, []).append(error)
        elif error.subject.place is not None:
            by_file.setdefault(error.subject.place.file, []).append(error)
    return by_id, by_file


def _concerned(graph: Graph, by_id: _Errors, by_file: _Errors) -> set[str]:
    """Ids of all that errors are about, of what lies in it, and of what was derived from it."""
    waiting = list(by_id)
    derived: dict[str, list[str]] = {}
    for one in graph:
        origin = one.attrs.get("origin")
        if origin:
            derived.setdefault(str(origin), []).append(one.id)
        if one.source in by_file:
            waiting.append(one.id)
    found: set[str] = set()
    while waiting:
        id = waiting.pop()
        if id not in found:
            found.add(id)
            waiting += derived.get(id, ())
            element = graph.get(id)
            waiting += [one.id for one in graph.owned(element)] if element is not None else ()
    return found


def _reasons(
    trace: Sequence[str], graph: Graph, by_id: _Errors, by_file: _Errors
) -> tuple[Diagnostic, ...]:
    """The errors that concern what is traced."""
    reached = _closure(trace, graph)
    elements = (graph.get(id) for id in reached) if by_file else ()
    files = dict.fromkeys(one.source for one in elements if one is not None)
    found = [error for id in reached for error in by_id.get(id, ())]
    found += [error for file in files for error in by_file.get(file, ())]
    return tuple(found)


def _closure(trace: Iterable[str], graph: Graph) -> list[str]:
    """The traced ids with their owners and origins."""
    reached: dict[str, None] = {}
    waiting = list(trace)
    while waiting:
        id = waiting.pop()
        if id in reached:
            continue
        reached[id] = None
        element = graph.get(id)
        if element is not None:
            origin = element.attrs.get("origin")
            if element.owner:
                waiting.append(element.owner)
            if origin:
                waiting.append(str(origin))
    return list(reached)
