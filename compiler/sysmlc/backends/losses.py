"""Counts what an output does not express, and reports each kind of loss once."""

from dataclasses import dataclass, field

from sysmlc.diagnostics import Rule, Sink
from sysmlc.ir import Element, Graph

_Key = tuple[str, tuple[tuple[str, str], ...]]
"""Code of the rule, and the sorted facts of its message."""


# No slots: dataclass(slots=True) replaces the class, so super() in its methods would fail.
@dataclass
class LossCounter:
    """Losses of one output, counted by rule and facts.

    A model may lose the same kind of information in thousands of elements: one diagnostic states
    the number and the first element.
    """

    graph: Graph
    _counts: dict[_Key, tuple[Rule, Element, int]] = field(default_factory=dict, init=False)
    """The rule, the first element and the number of elements."""

    def record(self, loss: Rule, element: Element, /, **facts: str) -> None:
        """Count a loss of *element*; *facts* fill the placeholders of the message."""
        key = (loss.code, tuple(sorted(facts.items())))
        _, first, count = self._counts.get(key, (loss, element, 0))
        self._counts[key] = (loss, first, count + 1)

    def report(self, sink: Sink) -> None:
        """Report one diagnostic for each combination of rule and facts."""
        for loss, first, facts in self.list_losses():
            sink.report(loss, self.graph.subject(first), notes=(), help="", cause="", **facts)

    def list_losses(self) -> list[tuple[Rule, Element, dict[str, object]]]:
        """Return each loss with its first element and the facts of its message."""
        return [
            (loss, first, {"count": count, **dict(pairs)})
            for (_, pairs), (loss, first, count) in self._counts.items()
        ]
