"""What CAEX cannot say, and how it is counted: one finding for each kind of loss."""

from dataclasses import dataclass, field

from sysmlc.diagnostics import Rule, Severity, Sink, rule
from sysmlc.ir import Element, Graph

UNSAID_KIND = rule(
    "SM740",
    "caex-without-kind",
    Severity.WARNING,
    "AutomationML has no place for {kind} ({count} left out of the saved plant)",
    help="--emit +uml, +sysml, +ir or +ecore saves them",
)
UNSAID_EDGE = rule(
    "SM741",
    "caex-without-relation",
    Severity.WARNING,
    "AutomationML has no '{edge}' from {kind} to {target} ({count} left out of the saved plant)",
    help="--emit +uml, +sysml, +ir or +ecore saves them",
)
UNSAID_ATTRIBUTE = rule(
    "SM742",
    "caex-without-attribute",
    Severity.WARNING,
    "AutomationML has no '{attribute}' of {kind} ({count} left out of the saved plant)",
    help="--emit +uml, +sysml, +ir or +ecore saves them",
)
MOVED = rule(
    "SM743",
    "caex-moved",
    Severity.INFO,
    "{kind} in {owner} is saved in a library of its own sort ({count})",
)
APPROXIMATED = rule(
    "SM744",
    "caex-approximated",
    Severity.INFO,
    "{said} is saved as {written} ({count})",
)
ILLEGAL = rule(
    "SM745",
    "caex-illegal-character",
    Severity.WARNING,
    "{count} characters that XML cannot hold were replaced in the saved plant",
)
ADDED = rule(
    "SM746",
    "caex-required",
    Severity.INFO,
    "'{element}' has no {what}, which the schema of CAEX 3.0 wants: '{value}' is written",
)


@dataclass(slots=True)
class Losses:
    """Counts losses by rule and facts; each is reported once, at the first element."""

    graph: Graph
    _found: dict[tuple[str, tuple[tuple[str, str], ...]], tuple[Rule, Element, int]] = field(
        default_factory=dict
    )

    def note(self, loss: Rule, element: Element, /, **facts: str) -> None:
        """One more element with this loss."""
        key = (loss.code, tuple(sorted(facts.items())))
        _, first, count = self._found.get(key, (loss, element, 0))
        self._found[key] = (loss, first, count + 1)

    def report(self, sink: Sink) -> None:
        """Report what was counted."""
        for (_, facts), (lost, first, count) in self._found.items():
            told: dict[str, object] = {"count": count, **dict(facts)}
            sink.report(lost, self.graph.subject(first), notes=(), help="", **told)
