"""What an activity writes and its contract does not follow, with the reason (SM544)."""

from collections.abc import Iterable

from msgspec import Struct

from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.ir import Element, Graph

WRITTEN = rule(
    "SM544",
    "guard-reads-what-is-written",
    Severity.INFO,
    "the contract of '{activity}' leaves '{name}' to the environment, although {writers} {verb} "
    "it: {reason}",
    help="{advice}, or say what becomes of it in a requirement",
)


class Refusal(Struct, frozen=True):
    """Why a contract cannot follow a feature, and what can be done about it."""

    reason: str
    advice: str


ENDLESS = Refusal("it has not finitely many values", "give it a type that has")
WIDE = Refusal("it has no range", "give it a range (constraint 0 <= {name} <= 9)")
DECIDED = Refusal("others decide it too", "assign to a feature that is neither given nor constant")
ELSEWHERE = Refusal("it belongs to another object", "let the object itself do it (an operation)")
UNKNOWN = Refusal(
    "the value that it gets is not known", "write the value as an expression over known properties"
)


def shared(writer: str) -> Refusal:
    """Another behaviour writes it."""
    return Refusal(f"'{writer}' writes it too", "let one behaviour alone write it")


class Unfollowed(Struct, frozen=True):
    """A feature that the activity writes, and why its contract does not follow it."""

    feature: Element
    why: Refusal
    writers: tuple[str, ...]


def report_unfollowed(
    graph: Graph, activity: Element, unfollowed: Iterable[Unfollowed], sink: Sink
) -> None:
    """Report each feature whose values are left to the environment although actions write it."""
    for one in unfollowed:
        sink.report(
            WRITTEN,
            graph.subject(one.feature),
            activity=activity.name,
            name=one.feature.name,
            writers=" and ".join(one.writers),
            verb="writes" if len(one.writers) == 1 else "write",
            reason=one.why.reason,
            advice=one.why.advice.format(name=one.feature.name),
        )
