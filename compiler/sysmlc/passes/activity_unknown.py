"""Names that actions assign to although nobody has them (SM545)."""

from collections.abc import Iterable, Iterator

from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.ir import Element, Graph, query
from sysmlc.passes.activity_written import Assigned
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
    "action '{action}' assigns to '{name}', which '{activity}' does not know; {suggestion}",
    why="An action assigns to features of its activity and of the block that has it. The contract "
    "leaves out what it cannot find, so that the assignment has no effect there.",
    help="correct the name, or give the block or the activity a property of that name",
    wrong=_filling("ful := true"),
    right=_filling("full := true"),
)


def report_unknown(
    graph: Graph, activity: Element, written: Iterable[list[Assigned]], sink: Sink
) -> None:
    """Report each name that one of the actions assigns to and nobody has."""
    # What a write action writes is a reference, no name.
    named = [one for found in written for one in found if one.action.subkind != "write"]
    if not named:
        return
    known = set(_known(graph, activity))
    for action, name in ((one.action, one.name) for one in named):
        if name.partition(".")[0] not in known:
            suggestion = did_you_mean(name, known)
            sink.report(
                UNKNOWN,
                graph.subject(action),
                action=action.name,
                activity=activity.name,
                name=name,
                suggestion=suggestion,
            )


def _known(graph: Graph, activity: Element) -> Iterator[str]:
    """Names of what the activity has, and of features of the classifiers that it is in."""
    owners = (one for one in graph.ancestors(activity) if one.kind in query.CLASSIFIERS)
    features = (one for owner in owners for one in query.features(graph, owner))
    return (one.name for one in (*features, *graph.subtree(activity)) if one.name)
