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
    found = {a.path: _reasons(a, graph, by_id, by_file, clean) for a in artefacts}
    return {path: reasons for path, reasons in found.items() if reasons}


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
    artefact: Artefact, graph: Graph, by_id: _Errors, by_file: _Errors, clean: set[str]
) -> tuple[Diagnostic, ...]:
    """The errors that concern an artefact; of ``clean`` ids it is known that none does."""
    reached = _closure(artefact.trace, graph, clean)
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
        element = graph.get(id)
        if id in reached or id in clean:
            continue
        reached[id] = None
        if element is not None:
            above = (element.owner, element.attrs.get("origin"))
            waiting.extend(str(next_id) for next_id in above if next_id)
    return list(reached)
