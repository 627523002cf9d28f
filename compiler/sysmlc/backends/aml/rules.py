"""What CAEX cannot say, and how it is counted: one finding for each kind of loss."""

from dataclasses import dataclass, field

from sysmlc.diagnostics import Rule, Severity, Sink, rule
from sysmlc.ir import Element, Graph

_GATE = 'Package p "Plant"\n  Class gate "Gate" role="block"\n'

UNSAID_KIND = rule(
    "SM740",
    "caex-without-kind",
    Severity.WARNING,
    "AutomationML has no place for {kind} ({count} left out of the saved plant)",
    why="CAEX says structure: classes, attributes, interfaces, parts and links. Behaviour, "
    "requirements and flows it cannot say.",
    help="--emit +uml, +sysml, +ir or +ecore saves them",
    wrong=_GATE + '    StateMachine m "Control"\n',
    right=_GATE,
)
UNSAID_EDGE = rule(
    "SM741",
    "caex-without-relation",
    Severity.WARNING,
    "AutomationML has no '{edge}' from {kind} to {target} ({count} left out of the saved plant)",
    why="The saved plant holds what CAEX 3.0 can say; this relation it cannot.",
    help="--emit +uml, +sysml, +ir or +ecore saves them",
    wrong=_GATE + '    -> depends other\n  Class other "Other" role="block"\n',
    right=_GATE + '    -> specializes other\n  Class other "Other" role="block"\n',
)
UNSAID_ATTRIBUTE = rule(
    "SM742",
    "caex-without-attribute",
    Severity.WARNING,
    "AutomationML has no '{attribute}' of {kind} ({count} left out of the saved plant)",
    why="The saved plant holds what CAEX 3.0 can say; this attribute it cannot.",
    help="--emit +uml, +sysml, +ir or +ecore saves them",
    wrong='Package p "Plant"\n  Class gate "Gate" role="block" active=true\n',
    right='Package p "Plant"\n  Class gate "Gate" role="block" copyright="us"\n',
)
MOVED = rule(
    "SM743",
    "caex-moved",
    Severity.INFO,
    "{kind} in {owner} is saved in a library of its own sort ({count})",
    why="A library holds classes of one sort; CAEX has neither libraries in libraries nor "
    "interface classes in system unit classes.",
    wrong=_GATE + '    Class plug "Plug" role="interface block"\n',
    right=_GATE + '  Class plug "Plug" role="interface block"\n',
)
APPROXIMATED = rule(
    "SM744",
    "caex-approximated",
    Severity.INFO,
    "{said} is saved as {written} ({count})",
    why="CAEX says it in another way; who reads the saved plant sees that.",
    wrong='Package p "Plant"\n  Enumeration e "Mode"\n    EnumerationLiteral a "auto"\n',
    right='Package p "Plant"\n  DataType e "Mode" role="value type"\n',
)
ILLEGAL = rule(
    "SM745",
    "caex-illegal-character",
    Severity.WARNING,
    "{count} characters that XML cannot hold were replaced in the saved plant",
    why="XML 1.0 holds no control characters (clause 2.2).",
    wrong='Package p "Pl\\u0001ant"\n  Class gate "Gate" role="block"\n',
    right=_GATE,
)
ADDED = rule(
    "SM746",
    "caex-required",
    Severity.INFO,
    "'{element}' has no {what}, which the schema of CAEX 3.0 wants: '{value}' is written",
    why="Without it other tools refuse the file.",
    wrong='Document "a.aml#" "a.aml" subkind="caex"\n',
    right=_GATE,
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
