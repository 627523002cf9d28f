"""Which artefacts are withheld: those that come from an element with an error."""

from collections.abc import Iterable, Mapping, Sequence

from sysmlc.diagnostics import Diagnostic
from sysmlc.ir import Graph
from sysmlc.output import Artefact

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
    clean: set[str] = set()
    # Several files of one element often have one trace, and it can be long.
    traces = {artefact.path: artefact.trace for artefact in artefacts}
    found = {
        trace: _reasons(trace, graph, by_id, by_file, clean)
        for trace in dict.fromkeys(traces.values())
    }
    return {path: found[trace] for path, trace in traces.items() if found[trace]}


def _indexed(errors: Iterable[Diagnostic]) -> tuple[_Errors, _Errors]:
    by_id: dict[str, list[Diagnostic]] = {}
    by_file: dict[str, list[Diagnostic]] = {}
    for error in errors:
        if error.subject.id:
            by_id.setdefault(error.subject.id, []).append(error)
        elif error.subject.place is not None:
            by_file.setdefault(error.subject.place.file, []).append(error)
    return by_id, by_file


def _reasons(
    trace: Sequence[str], graph: Graph, by_id: _Errors, by_file: _Errors, clean: set[str]
) -> tuple[Diagnostic, ...]:
    """The errors that concern what is traced; of ``clean`` ids it is known that none does."""
    reached = _closure(trace, graph, clean)
    elements = (graph.get(id) for id in reached) if by_file else ()
    files = dict.fromkeys(one.source for one in elements if one is not None)
    found = [error for id in reached for error in by_id.get(id, ())]
    found += [error for file in files for error in by_file.get(file, ())]
    if not found:
        clean.update(reached)
    return tuple(found)


def _closure(trace: Iterable[str], graph: Graph, clean: set[str]) -> list[str]:
    """The traced ids with their owners and origins, without those that are clean."""
    reached: dict[str, None] = {}
    waiting = list(trace)
    while waiting:
        id = waiting.pop()
        if id in reached or id in clean:
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
