"""Names that actions assign to although nobody has them (SM545), or another object (SM544)."""

from collections.abc import Iterable, Iterator

from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.ir import Element, Graph, query
from sysmlc.logic.expressions.context import named_values
from sysmlc.logic.writers import Writers, called
from sysmlc.passes.activities.assignments import Written
from sysmlc.passes.activities.refusals import ELSEWHERE, Unfollowed, report_unfollowed
from sysmlc.suggest import did_you_mean


def _filling(body: str) -> str:
    return f"""\
Package p "Plant"
  Class c "Cell" role="block"
    Property n "full"
      -> typed-by bool
    Activity a "work"
      Control i subkind="initial"
      Action w "fill" subkind="opaque" body="{body}"
      Control e subkind="final"
      ControlFlow iw
        -> flow-source i
        -> flow-target w
      ControlFlow we
        -> flow-source w
        -> flow-target e
  DataType bool "Boolean"
"""


UNKNOWN = rule(
    "SM545",
    "assigns-to-nobody",
    Severity.INFO,
    "action '{action}' assigns to '{name}', which is no feature that '{activity}' or what it is in "
    "has; {suggestion}",
    why="An action assigns to features of its activity and of the block that has it. The contract "
    "leaves out what it cannot find, so that the assignment has no effect there.",
    help="correct the name, or give the block or the activity a property of that name",
    wrong=_filling("ful := true"),
    right=_filling("full := true"),
)


def report_unknown(
    graph: Graph,
    activity: Element,
    written: Iterable[list[Written]],
    writers: Writers,
    sink: Sink,
) -> None:
    """Report each name that one of the actions assigns to and that the activity does not know."""
    # What a write action writes is a reference, no name.
    lost = (one.said for found in written for one in found if one.feature is None)
    for one in lost:
        if one.is_bound or one.action.subkind == "write":
            continue
        target = writers.target(one.action, one.name)
        if target is not None:
            if activity in graph.ancestors(target):
                continue
            label = called(graph, one.action)
            unfollowed = Unfollowed(target, ELSEWHERE, (f"action '{label}'",))
            report_unfollowed(graph, activity, [unfollowed], sink)
        elif one.name.partition(".")[0] not in (known := set(_known(graph, activity))):
            sink.report(
                UNKNOWN,
                graph.subject(one.action),
                action=one.action.name,
                activity=activity.name,
                name=one.name,
                suggestion=did_you_mean(one.name, known),
            )


def _known(graph: Graph, activity: Element) -> Iterator[str]:
    """Names of what the activity has, and of features of the classifiers that it is in."""
    around = (activity, *graph.ancestors(activity))
    owners = [one for one in around if one.kind in query.CLASSIFIERS]
    features = (name for owner in owners for name in named_values(graph, owner))
    yield from (name for name in features if name)
    yield from (one.name for one in graph.subtree(activity) if one.name)
