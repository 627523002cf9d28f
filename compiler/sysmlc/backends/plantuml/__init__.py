"""The PlantUML back end: diagrams of structure, behaviour and requirements in ``out/diagrams``."""

from collections.abc import Callable, Collection, Iterable, Iterator
from itertools import groupby
from typing import Any, NamedTuple

from msgspec import Struct
from msgspec.structs import fields, replace

from sysmlc.backends.base import AUTHOR, DERIVED, EmitOptions
from sysmlc.backends.plantuml import (
    activity,
    block_definition,
    internal_block,
    parametric,
    requirement,
    sequence,
    state_machine,
    undrawn,
    use_case,
)
from sysmlc.backends.plantuml.author_diagrams import FOLDER, draw_author_diagrams
from sysmlc.backends.plantuml.undrawn import report_overtaken_messages
from sysmlc.backends.plantuml.views import Diagram
from sysmlc.backends.templates import TemplateError, Templates
from sysmlc.diagnostics import Severity, Sink, Subject, rule
from sysmlc.ir import Graph
from sysmlc.support.interpreter import allow_recursion
from sysmlc.support.output import Output, assign_file_names
from sysmlc.support.plantuml_text import format_comment

BAD_TEMPLATE = rule(
    "SM700",
    "bad-diagram-template",
    Severity.ERROR,
    "the template for {kind} diagrams cannot be used: {fault}",
    help="compare it with templates/plantuml of sysmlc; docs/diagrams.md lists the names",
)

KINDS: tuple[Callable[[Graph], Iterator[Diagram]], ...] = (
    block_definition.draw_block_definitions,
    internal_block.draw_internal_blocks,
    parametric.draw_parametric_diagrams,
    activity.draw_activities,
    state_machine.draw_state_machines,
    requirement.draw_requirements,
    sequence.draw_sequences,
    use_case.draw_use_cases,
)


class PlantUml(Struct, frozen=True):
    """Diagrams as PlantUML text."""

    name: str = "plantuml"
    summary: str = "block, internal block, activity, state machine, requirement, sequence, use case"
    is_default: bool = True
    needs: tuple[str, ...] = ()

    def emit(self, graph: Graph, output: Output, sink: Sink, options: EmitOptions) -> None:
        """Write every diagram that is not empty; report the elements that no diagram shows."""
        # The views of nested states are built by recursion; 200 levels of nesting exceeded the
        # limit of the interpreter.
        with allow_recursion(state_machine.find_depth(graph)):
            self._emit(graph, output, sink, options)

    def _emit(self, graph: Graph, output: Output, sink: Sink, options: EmitOptions) -> None:
        if options.diagrams != AUTHOR:
            traced = [
                _Traced(diagram, diagram.list_trace()) for kind in KINDS for diagram in kind(graph)
            ]
            # Author diagrams do not count: an element in none of the derived diagrams is reported.
            undrawn.report_undrawn(graph, {id for item in traced for id in item.trace}, sink)
            report_overtaken_messages(graph, sink)
            _write(graph, traced, "", output, sink, options)
        if options.diagrams != DERIVED:
            author_traced = [
                _Traced(diagram, diagram.list_trace())
                for diagram in draw_author_diagrams(graph, sink)
            ]
            _write(graph, author_traced, FOLDER, output, sink, options)


class _Traced(NamedTuple):
    """A diagram with the ids of all elements that it shows."""

    diagram: Diagram
    trace: tuple[str, ...]


def _write(
    graph: Graph,
    traced: list[_Traced],
    folder: str,
    output: Output,
    sink: Sink,
    options: EmitOptions,
) -> None:
    if not traced:
        return
    # groupby needs adjacent kinds; the sort is stable, so that numbers follow the model order.
    traced.sort(key=lambda item: item.diagram.kind)
    with Templates("plantuml", options.templates) as templates:
        for kind, group in groupby(traced, lambda item: item.diagram.kind):
            try:
                for (diagram, trace), file in _assign_files(list(group)):
                    marked = _mark_faults(graph, diagram, trace, options.faulty)
                    text = _render(graph, marked, templates)
                    path = f"diagrams/{folder}{file}.{kind}.puml"
                    name = diagram.name
                    output.add(path, text, trace, "plantuml", marks_faults=True, name=name)
            except TemplateError as fault:
                sink.report(BAD_TEMPLATE, Subject(f"{kind}.puml.j2"), kind=kind, fault=fault)


def _assign_files(traced: list[_Traced]) -> Iterable[tuple[_Traced, str]]:
    """Return the file name of each diagram of one kind; equal names are numbered in model order."""
    keys: dict[str, _Traced] = {}
    for item in traced:
        keys[_make_unique(item.diagram.name, keys)] = item
    files = assign_file_names(keys)
    return [(item, files[key]) for key, item in keys.items()]


def _make_unique(name: str, names: Collection[str]) -> str:
    number, key = 1, name
    while key in names:
        number += 1
        key = f"{name}-{number}"
    return key


def _render(graph: Graph, diagram: Diagram, templates: Templates) -> str:
    about = graph.get(diagram.about)
    source = "" if about is None else about.source
    return templates.render(
        f"{diagram.kind}.puml.j2",
        diagram=diagram,
        view=diagram.view,
        header=_list_header_comments(diagram, source),
    )


def _list_header_comments(diagram: Diagram, source: str) -> tuple[str, ...]:
    kind, name = diagram.heading
    parts = [f"{kind} of {name}", f"from {source}" if source else ""]
    parts.append("made by sysmlc; change the model, not this file")
    return tuple(format_comment(part) for part in parts if part)


# -- marks of faults -------------------------------------------------------------------------------

_MARK = "<color:#C53030>⚠</color> "
_TEXT_FIELDS = ("label", "text")


def _mark_faults(
    graph: Graph, diagram: Diagram, trace: Collection[str], faulty: frozenset[str]
) -> Diagram:
    """Return the diagram with a mark on each shape and line that shows an element in *faulty*.

    *trace* has the ids of all elements of the diagram. If one of them has an error but no label, or
    if an owner of the diagram's subject has an error, the mark is on the frame.
    """
    if not faulty:
        return diagram
    view = diagram.view if faulty.isdisjoint(trace) else _mark(diagram.view, faulty)
    subject = graph.get(diagram.about)
    owners = [] if subject is None else [subject, *graph.ancestors(subject)]
    concerned = {*trace, *(owner.id for owner in owners)}
    if view != diagram.view or faulty.isdisjoint(concerned):
        return replace(diagram, view=view)
    return replace(diagram, frame=f"{_MARK}{diagram.frame}")


def _mark(view: Any, faulty: frozenset[str]) -> Any:  # noqa: ANN401 - any struct of a view
    """Return the view or a part of it with the marks."""
    if isinstance(view, tuple):
        return tuple(_mark(item, faulty) for item in view)
    if not isinstance(view, Struct):
        return view
    marked = {field.name: _mark(getattr(view, field.name), faulty) for field in fields(view)}
    label = next((name for name in _TEXT_FIELDS if marked.get(name)), None)
    if label is not None and not faulty.isdisjoint(marked.get("shows", ())):
        marked[label] = f"{_MARK}{marked[label]}"
    return replace(view, **marked)


BACKEND = PlantUml()
