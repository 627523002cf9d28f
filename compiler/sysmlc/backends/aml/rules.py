"""Rules for what CAEX cannot express, and the counter of such losses."""

from dataclasses import dataclass, field

from sysmlc.diagnostics import Rule, Severity, Sink, rule
from sysmlc.ir import Element, Graph

UNSUPPORTED_KIND = rule(
    "SM740",
    "caex-without-kind",
    Severity.WARNING,
    "AutomationML cannot express {kind} ({count} omitted from the saved plant)",
    help="--emit +uml, +sysml, +ir or +ecore saves them",
)
UNSUPPORTED_EDGE = rule(
    "SM741",
    "caex-without-relation",
    Severity.WARNING,
    "AutomationML cannot express '{edge}' from {kind} to {target} ({count} omitted "
    "from the saved plant)",
    help="--emit +uml, +sysml, +ir or +ecore saves them",
)
UNSUPPORTED_ATTRIBUTE = rule(
    "SM742",
    "caex-without-attribute",
    Severity.WARNING,
    "AutomationML cannot express '{attribute}' of {kind} ({count} omitted from the saved plant)",
    help="--emit +uml, +sysml, +ir or +ecore saves them",
)
MOVED = rule(
    "SM743",
    "caex-moved",
    Severity.INFO,
    "{kind} in {owner} is saved in a library for its kind ({count})",
)
APPROXIMATED = rule(
    "SM744",
    "caex-approximated",
    Severity.INFO,
    "{said} is saved as {written} ({count})",
)
ILLEGAL_CHARACTERS = rule(
    "SM745",
    "caex-illegal-character",
    Severity.WARNING,
    "{count} characters that XML does not allow were replaced in the saved plant",
)
ADDED = rule(
    "SM746",
    "caex-required",
    Severity.INFO,
    "'{element}' has no {what}, which the schema of CAEX 3.0 requires: '{value}' is written",
)

_Key = tuple[str, tuple[tuple[str, str], ...]]
"""Code of the rule, and the sorted facts of its message."""


@dataclass(slots=True)
class Losses:
    """Counts losses by rule and facts; each combination becomes one diagnostic."""

    graph: Graph
    _counts: dict[_Key, tuple[Rule, Element, int]] = field(default_factory=dict)
    """The rule, the first element and the number of losses."""

    def note(self, loss: Rule, element: Element, /, **facts: str) -> None:
        """Count one more element with this loss."""
        key = (loss.code, tuple(sorted(facts.items())))
        _, first, count = self._counts.get(key, (loss, element, 0))
        self._counts[key] = (loss, first, count + 1)

    def note_approximation(self, element: Element, original: str, replacement: str) -> None:
        """Count an element that is saved in another form."""
        self.note(APPROXIMATED, element, said=original, written=replacement)

    def note_untyped(self, feature: Element, kind: str, type_: Element) -> None:
        """Count a feature whose type CAEX cannot reference."""
        facts = {"edge": "typed-by", "kind": kind, "target": str(type_.kind)}
        self.note(UNSUPPORTED_EDGE, feature, **facts)

    def report(self, sink: Sink) -> None:
        """Report each loss at the first element that has it."""
        for (_, pairs), (loss, first, count) in self._counts.items():
            facts: dict[str, object] = {"count": count, **dict(pairs)}
            sink.report(loss, self.graph.subject(first), notes=(), help="", **facts)
