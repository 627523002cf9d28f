"""Pass ``resolve``: references become edges, what lies outside the unit becomes a stand-in."""

from typing import ClassVar

from msgspec import Struct

from sysmlc.diagnostics import Sink
from sysmlc.ir import AttrValue, Edge, Element, Graph, Kind
from sysmlc.passes.resolve.references import Use, attributes, needs, use_of
from sysmlc.passes.resolve.reports import report_libraries, report_lost
from sysmlc.passes.resolve.resolver import Answers, Targets
from sysmlc.passes.resolve.rules import SEVERAL_TARGETS


class Resolve(Struct, frozen=True):
    """Turn every reference into an edge.

    Assumes what a front end leaves: elements, edges it could draw at once, ``graph.pending``.
    Guarantees: nothing is pending; the ids in attributes exist; every edge's target is an
    element, a stand-in (``external``, ``href``) when its file is not part of the unit. A
    reference that leads nowhere is reported, and the holder's attribute ``unresolved`` names
    the relation so that later rules do not complain about what follows from it. The result
    does not depend on the order of the files.
    """

    name: ClassVar[str] = "resolve"
    after: ClassVar[tuple[str, ...]] = ()

    def run(self, graph: Graph, sink: Sink) -> None:
        """Resolve in place; see the class."""
        held = [*attributes(graph)]
        answers = Answers(graph, Targets(graph))
        answers.find(needs(graph, held))
        lost = _connect(graph, answers)
        lost += [use for use in held if answers.get(use.holder.source, use.target) is None]
        report_lost(graph, sink, lost)
        keep_first_ends(graph, sink)
        _rewrite(graph, answers, held)
        missing = {h: of_it for h, of_it in answers.outside.items() if h not in answers.known}
        report_libraries(graph, sink, missing)
        graph.pending.clear()


def _connect(graph: Graph, answers: Answers) -> list[Use]:
    """Turn the pending references into edges. Return those without a target, in order."""
    lost: list[Use] = []
    for reference in graph.pending:
        source = graph.get(reference.source)
        if source is None:
            continue
        target = graph.get(reference.target) or answers.get(source.source, reference.target)
        if target is None:
            lost.append(use_of(source, reference))
        else:
            graph.connect(reference.edge, source, target)
    return lost


def _rewrite(graph: Graph, answers: Answers, held: list[Use]) -> None:
    for holder, name in dict.fromkeys((use.holder, use.attribute) for use in held):
        graph.set(holder, **{name: _renamed(answers, holder, holder.attrs[name])})


def _renamed(answers: Answers, holder: Element, value: AttrValue) -> AttrValue:
    if isinstance(value, str):
        found = answers.get(holder.source, value)
        return found.id if found else None
    if isinstance(value, tuple):
        items = (_renamed(answers, holder, item) for item in value)
        return tuple(item for item in items if item is not None)
    return value


_FLOW_ENDS = (Edge.FLOW_SOURCE, Edge.FLOW_TARGET)


def keep_first_ends(graph: Graph, sink: Sink) -> None:
    """Leave each flow and transition its first source and target; report where others go."""
    for flow in graph.of_kind(Kind.CONTROL_FLOW, Kind.OBJECT_FLOW, Kind.TRANSITION):
        for edge in _FLOW_ENDS:
            ends = graph.targets(flow, edge)
            if len(ends) > 1:
                _keep_first(graph, sink, flow, edge, ends)


def _keep_first(graph: Graph, sink: Sink, flow: Element, edge: Edge, ends: list[Element]) -> None:
    graph.replace_targets(edge, flow, ends[:1])
    sink.report(
        SEVERAL_TARGETS,
        graph.subject(flow),
        relation=edge.value,
        element=graph.qualified_name(flow),
        count=len(ends),
    )
