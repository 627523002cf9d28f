"""What UML cannot say, and how it is counted: one finding for each kind of loss."""

from dataclasses import dataclass, field

from sysmlc.backends.uml.kept import Kept
from sysmlc.diagnostics import Rule, Severity, Sink, rule
from sysmlc.ir import Element, Graph

UNSAID_KIND = rule(
    "SM720",
    "uml-without-kind",
    Severity.WARNING,
    "UML has no place for {kind} ({count} left out of the saved model)",
    help="--emit +ir or +ecore saves the whole graph",
)
UNSAID_EDGE = rule(
    "SM721",
    "uml-without-relation",
    Severity.WARNING,
    "UML has no '{edge}' from {kind} to {target} ({count} left out of the saved model)",
    help="--emit +ir or +ecore saves the whole graph",
)
UNSAID_ATTRIBUTE = rule(
    "SM722",
    "uml-without-attribute",
    Severity.WARNING,
    "UML has no '{attribute}' of {kind} ({count} left out of the saved model)",
    help="--emit +ir or +ecore saves the whole graph",
)
MOVED = rule(
    "SM723",
    "uml-moved",
    Severity.INFO,
    "UML lets no {owner} own {kind}: saved with the nearest owner that may ({count})",
)
APPROXIMATED = rule(
    "SM724",
    "uml-approximated",
    Severity.INFO,
    "{said} is saved as {written} ({count})",
)
ILLEGAL = rule(
    "SM725",
    "uml-illegal-character",
    Severity.WARNING,
    "{count} characters that XML cannot hold were replaced in the saved model",
)
KEPT = rule(
    "SM726",
    "uml-kept",
    Severity.INFO,
    "UML has no words for {count} facts of the plant: a comment keeps them for the way back",
)
RESPELT_ID = rule(
    "SM747",
    "uml-value-names-respelt-id",
    Severity.WARNING,
    "{count} values name elements by IDs that are no names of XML: the saved elements have others",
    help=(
        "let the plant's tool give IDs that start with a letter, or follow these values in the "
        "plant and not in the saved model"
    ),
)
_UNSAID = frozenset({UNSAID_KIND, UNSAID_EDGE, UNSAID_ATTRIBUTE})


@dataclass(slots=True)
class Losses:
    """Counts losses by rule and facts; each is reported once, at the first element."""

    graph: Graph
    kept: Kept | None = None
    """What a plant keeps for the way back; of other models nothing is kept."""
    _found: dict[tuple[str, tuple[tuple[str, str], ...]], tuple[Rule, Element, int]] = field(
        default_factory=dict
    )

    def note(self, loss: Rule, element: Element, **facts: str) -> None:
        """One more element with this loss."""
        if self.kept is not None:
            self._keep(self.kept, loss, element, facts)
        key = (loss.code, tuple(sorted(facts.items())))
        _, first, count = self._found.get(key, (loss, element, 0))
        self._found[key] = (loss, first, count + 1)

    def _keep(self, kept: Kept, loss: Rule, element: Element, facts: dict[str, str]) -> None:
        if loss is UNSAID_ATTRIBUTE:
            kept.attribute(element, facts["attribute"])
        elif loss is UNSAID_KIND:
            kept.whole(element)
        elif loss is MOVED:
            kept.owner(element)
        elif loss is APPROXIMATED:
            kept.attribute(element, "subkind")

    def report(self, sink: Sink) -> None:
        """Report what was counted."""
        found = dict(self._found)
        if self.kept is not None:
            self._report_kept(sink)
            found = {key: one for key, one in found.items() if one[0] not in _UNSAID}
        for (_, facts), (lost, first, count) in found.items():
            told: dict[str, object] = {"count": count, **dict(facts)}
            sink.report(lost, self.graph.subject(first), notes=(), help="", **told)

    def _report_kept(self, sink: Sink) -> None:
        """One finding for all that is kept; its notes say what."""
        kept = [(facts, one) for (_, facts), one in self._found.items() if one[0] in _UNSAID]
        if not kept:
            return
        notes = []
        for facts, (lost, _, count) in kept:
            told: dict[str, object] = {"count": count, **dict(facts)}
            notes.append(lost.phrase.format(**told).replace(" left out of the saved model", ""))
        first = self.graph.subject(kept[0][1][1])
        total = sum(count for _, (_, _, count) in kept)
        sink.report(KEPT, first, notes=tuple(notes), count=total)
