"""What the textual notation cannot say, or not yet says: each loss once, with its number."""

from dataclasses import dataclass, field

from sysmlc.diagnostics import Rule, Severity, Sink, rule
from sysmlc.ir import Element, Graph

UNSAID_KIND = rule(
    "SM730",
    "sysml-unsaid-kind",
    Severity.WARNING,
    "SysML v2 text cannot express {kind} ({count} omitted)",
)
UNSAID_EDGE = rule(
    "SM731",
    "sysml-unsaid-relation",
    Severity.WARNING,
    "SysML v2 text cannot express '{edge}' from {kind} to {target} ({count} omitted)",
)
UNSAID_ATTRIBUTE = rule(
    "SM732",
    "sysml-unsaid-attribute",
    Severity.WARNING,
    "SysML v2 text cannot express '{attribute}' of {kind} ({count} omitted)",
)
RENAMED = rule(
    "SM733",
    "sysml-renamed",
    Severity.INFO,
    "the name '{name}' is already used in its namespace; it is written '{written}'",
)
APPROXIMATED = rule(
    "SM734",
    "sysml-approximated",
    Severity.INFO,
    "{said} is written as {written} ({count} in the text)",
)
TEXT_AS_NAME = rule(
    "SM735",
    "sysml-text-as-name",
    Severity.INFO,
    "'{text}' is not an expression over the model; it is written as a feature of that name",
)
UNREACHABLE = rule(
    "SM736",
    "sysml-unreachable",
    Severity.WARNING,
    "'{edge}' of {kind} leads to an element without a name in the text ({count} omitted)",
)
NAME_LEFT_OUT = rule(
    "SM737",
    "sysml-name-left-out",
    Severity.INFO,
    "{said} has no name in SysML v2 ({count} names omitted)",
)


@dataclass(slots=True)
class Losses:
    """Counts losses by rule and facts; each is reported once, at the first element."""

    graph: Graph
    _found: dict[tuple[str, tuple[tuple[str, str], ...]], tuple[Rule, Element, int]] = field(
        default_factory=dict
    )

    told: dict[str, list[tuple[str, dict[str, str]]]] = field(default_factory=dict)
    """Code and facts of each loss by the id of the element."""

    def note(self, loss: Rule, element: Element, **facts: str) -> None:
        """One more element with this loss."""
        self.told.setdefault(element.id, []).append((loss.code, facts))
        key = (loss.code, tuple(sorted(facts.items())))
        _, first, count = self._found.get(key, (loss, element, 0))
        self._found[key] = (loss, first, count + 1)

    def report(self, sink: Sink) -> None:
        """Report what was counted."""
        for (_, facts), (lost, first, count) in self._found.items():
            told: dict[str, object] = {"count": count, **dict(facts)}
            sink.report(lost, self.graph.subject(first), notes=(), help="", **told)
