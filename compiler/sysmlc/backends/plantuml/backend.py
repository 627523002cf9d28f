"""All diagrams of a graph: views, file names, templates, and what no diagram shows."""

from collections.abc import Callable, Collection, Iterable, Iterator
from itertools import groupby
from typing import NamedTuple

from msgspec import Struct

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
from sysmlc.backends.plantuml.undrawn import report_overtaken_messages
from sysmlc.backends.plantuml.author import diagrams as author_diagrams
from sysmlc.backends.plantuml.views import Diagram
from sysmlc.backends.templates import TemplateError, Templates
from sysmlc.diagnostics import Severity, Sink, Subject, rule
from sysmlc.ir import Graph
from sysmlc.support.file_names import assign_file_names
from sysmlc.support.output import Output
from sysmlc.support.plantuml_text import comment
from sysmlc.support.recursion import allow_recursion

BAD_TEMPLATE = rule(
    "SM700",
    "bad-diagram-template",
    Severity.ERROR,
    "the template for {kind} diagrams cannot be used: {fault}",
    help="compare it with templates/plantuml of sysmlc; docs/diagrams.md lists the names",
)

KINDS: tuple[Callable[[Graph], Iterator[Diagram]], ...] = (
    block_definition.diagrams,
    internal_block.diagrams,
    parametric.diagrams,
    activity.diagrams,
    state_machine.diagrams,
    requirement.diagrams,
    sequence.diagrams,
    use_case.diagrams,
)


class PlantUml(Struct, frozen=True):
    """Diagrams as PlantUML text."""

    name: str = "plantuml"
    summary: str = "block, internal block, activity, state machine, requirement, sequence, use case"
    is_default: bool = True

    def emit(self, graph: Graph, output: Output, sink: Sink, options: EmitOptions) -> None:
        """Write every diagram that shows something; report what none of them shows."""
        with allow_recursion(state_machine.depth(graph)):
            self._emit(graph, output, sink, options)

    def _emit(self, graph: Graph, output: Output, sink: Sink, options: EmitOptions) -> None:
        if options.diagrams != AUTHOR:
            found = [_Traced(one, one.trace()) for kind in KINDS for one in kind(graph)]
            undrawn.report(graph, {id for one in found for id in one.trace}, sink)
            report_overtaken_messages(graph, sink)
            _write(graph, found, "", output, sink, options)
        if options.diagrams != DERIVED:
            drawn = [_Traced(one, one.trace()) for one in diagrams(graph, sink)]
            _write(graph, drawn, author_diagrams.FOLDER, output, sink, options)


class _Traced(NamedTuple):
    """A diagram with the ids of everything that it shows."""

    diagram: Diagram
    trace: tuple[str, ...]


def _write(
    graph: Graph,
    found: list[_Traced],
    folder: str,
    output: Output,
    sink: Sink,
    options: EmitOptions,
) -> None:
    if not found:
        return
    found.sort(key=lambda one: one.diagram.kind)
    with Templates("plantuml", options.templates) as templates:
        for kind, group in groupby(found, lambda one: one.diagram.kind):
            try:
                for (diagram, trace), file in _named(list(group)):
                    text = _render(graph, diagram, templates)
                    output.add(f"diagrams/{folder}{file}.{kind}.puml", text, trace, "plantuml")
            except TemplateError as fault:
                sink.report(BAD_TEMPLATE, Subject(f"{kind}.puml.j2"), kind=kind, fault=fault)


def _named(found: list[_Traced]) -> Iterable[tuple[_Traced, str]]:
    """File name for each diagram of one kind; equal names are numbered in model order."""
    keys: dict[str, _Traced] = {}
    for one in found:
        keys[_free(one.diagram.name, keys)] = one
    files = assign_file_names(keys)
    return [(one, files[key]) for key, one in keys.items()]


def _free(name: str, taken: Collection[str]) -> str:
    number, key = 1, name
    while key in taken:
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
        header=_header(diagram, source),
    )


def _header(diagram: Diagram, source: str) -> tuple[str, ...]:
    kind, name = diagram.heading
    parts = [f"{kind} of {name}", f"from {source}" if source else ""]
    parts.append("made by sysmlc; change the model, not this file")
    return tuple(comment(part) for part in parts if part)
