"""Features that an activity assigns but its contract does not track, with the reason (SM544)."""

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
    """The reason why a contract cannot track a feature, and the advice for the author."""

    reason: str
    advice: str


ENDLESS = Refusal("it has not finitely many values", "give it a type that has")
WIDE = Refusal("it has no range", "give it a range (constraint 0 <= {name} <= 9)")
DECIDED = Refusal("others decide it too", "assign to a feature that is neither given nor constant")
ELSEWHERE = Refusal("it belongs to another object", "let the object itself do it (an operation)")
UNKNOWN = Refusal(
    "the value that it gets is not known", "write the value as an expression over known properties"
)


def refuse_shared(writer: str) -> Refusal:
    """Return the refusal of a feature that another behaviour writes."""
    return Refusal(f"'{writer}' writes it too", "let one behaviour alone write it")


class UntrackedFeature(Struct, frozen=True):
    """An assigned feature, the reason why it is not tracked, and the assigning actions."""

    feature: Element
    why: Refusal
    writers: tuple[str, ...]


def report_untracked(
    graph: Graph, activity: Element, untracked: Iterable[UntrackedFeature], sink: Sink
) -> None:
    """Report each feature whose values are left to the environment although actions assign it."""
    for feature in untracked:
        sink.report(
            WRITTEN,
            graph.subject(feature.feature),
            activity=activity.name,
            name=feature.feature.name,
            writers=" and ".join(feature.writers),
            verb="writes" if len(feature.writers) == 1 else "write",
            reason=feature.why.reason,
            advice=feature.why.advice.format(name=feature.feature.name),
        )
