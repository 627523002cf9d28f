"""Losses: what of the graph SysML v2 text cannot express, or expresses in other words."""

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
    """Losses of one text, counted by rule and facts.

    A model may lose the same kind of information in thousands of elements: a diagnostic states
    the number and the first element.
    """

    graph: Graph
    _counts: dict[tuple[str, tuple[tuple[str, str], ...]], tuple[Rule, Element, int]] = field(
        default_factory=dict
    )
    """Rule, first element and number of elements by code and facts."""
    by_element: dict[str, list[tuple[str, dict[str, str]]]] = field(default_factory=dict)
    """Code and facts of each loss by the id of the element."""

    def record(self, loss: Rule, element: Element, **facts: str) -> None:
        """Count a loss of *element*; *facts* fill the placeholders of the message."""
        self.by_element.setdefault(element.id, []).append((loss.code, facts))
        key = (loss.code, tuple(sorted(facts.items())))
        _, first, count = self._counts.get(key, (loss, element, 0))
        self._counts[key] = (loss, first, count + 1)

    def report(self, sink: Sink) -> None:
        """Report one diagnostic for each combination of rule and facts."""
        for (_, facts), (loss, first, count) in self._counts.items():
            values: dict[str, object] = {"count": count, **dict(facts)}
            sink.report(loss, self.graph.subject(first), notes=(), help="", **values)
