"""What an activity writes itself and reads in its guards: its contract does not follow it."""

from collections.abc import Iterator

from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.logic.activities.tokens import TokenGraph
from sysmlc.logic.expressions.expression import (
    Assignment,
    ExpressionError,
    name_of,
    parse_effect,
)
from sysmlc.passes.activity_expressions import Scope


def _counting(body: str) -> str:
    return f"""\
Package p "Plant"
  Class c "Cell" role="block"
    Property n "full"
      -> typed-by bool
    Activity a "work"
      Control i subkind="initial"
      Control m subkind="merge"
      Action w "fill" subkind="opaque" body="{body}"
      Control d "enough" subkind="decision"
      Control e subkind="final"
      ControlFlow im
        -> flow-source i
        -> flow-target m
      ControlFlow mw
        -> flow-source m
        -> flow-target w
      ControlFlow wd
        -> flow-source w
        -> flow-target d
      ControlFlow dm guard="not full"
        -> flow-source d
        -> flow-target m
      ControlFlow de guard="full"
        -> flow-source d
        -> flow-target e
  DataType bool "Boolean"
"""


WRITTEN = rule(
    "SM544",
    "guard-reads-what-is-written",
    Severity.INFO,
    "a guard of '{activity}' reads '{name}', which {writers} {verb}: the contract leaves its value "
    "to the environment",
    why="The contract of an activity says where its tokens go, not what its actions compute. It "
    "holds for every value, so that some ways are in it that are never taken.",
    help="say what becomes of it in a requirement, or draw the behaviour as a state machine, whose "
    "effects are in its contract",
    wrong=_counting("full := true"),
    right=_counting("measure()"),
)


def report_written(
    graph: Graph, activity: Element, tokens: TokenGraph, scope: Scope, sink: Sink
) -> None:
    """Report each property that guards of the activity read and actions of it write."""
    read = {one.origin for one in tokens.inputs if graph[one.origin].kind is Kind.PROPERTY}
    if not read:
        return
    writers: dict[str, list[str]] = {}
    for action in graph.subtree(activity):
        if action.kind is Kind.ACTION:
            for feature in _written(graph, action, scope):
                writers.setdefault(feature, []).append(f"'{action.name}'")
    for feature in (one.origin for one in tokens.inputs if one.origin in read & writers.keys()):
        found = writers[feature]
        sink.report(
            WRITTEN,
            graph.subject(graph[feature]),
            activity=activity.name,
            name=graph[feature].name,
            writers=" and ".join(found),
            verb="writes" if len(found) == 1 else "write",
        )


def _written(graph: Graph, action: Element, scope: Scope) -> Iterator[str]:
    """The features that an action writes, by their ids."""
    if action.subkind == "write":
        feature = graph.target(action, Edge.CALLS)
        yield from [feature.id] if feature is not None else []
    body = action.attrs.get("body")
    if action.subkind != "opaque" or not isinstance(body, str):
        return
    try:
        statements = parse_effect(body)
    except ExpressionError:
        return
    for one in statements:
        name = name_of(one.target) if isinstance(one, Assignment) else None
        feature = scope.feature(name) if name else None
        if feature is not None:
            yield feature.id
