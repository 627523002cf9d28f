"""What the textual notation cannot say, or not yet says: each loss once, with its number."""

from dataclasses import dataclass, field

from sysmlc.diagnostics import Rule, Severity, Sink, rule
from sysmlc.ir import Element, Graph

UNSAID_KIND = rule(
    "SM730",
    "sysml-unsaid-kind",
    Severity.WARNING,
    "SysML v2 text has no place for {kind} ({count} left out of the text)",
    why="The textual notation of SysML v2 knows no such element, or we do not write it yet.",
    wrong='Package p "Plant"\n  Class a "A"\n    TemplateParameter t ""\n',
    right='Package p "Plant"\n  Class a "A"\n',
)
UNSAID_EDGE = rule(
    "SM731",
    "sysml-unsaid-relation",
    Severity.WARNING,
    "SysML v2 text does not say '{edge}' from {kind} to {target} ({count} left out)",
    why="The textual notation of SysML v2 knows no such relation between such elements.",
    wrong='Package p "Plant"\n  Class a "A"\n    -> mirrors t\n    TemplateParameter t\n',
    right='Package p "Plant"\n  Class a "A"\n    -> specializes b\n  Class b "B"\n',
)
UNSAID_ATTRIBUTE = rule(
    "SM732",
    "sysml-unsaid-attribute",
    Severity.WARNING,
    "SysML v2 text does not say '{attribute}' of {kind} ({count} left out)",
    why="The textual notation of SysML v2 has no such property. What is text or a number is kept "
    "as metadata; what names several elements, or one without a name, is not.",
    wrong='Package p "Plant"\n  Class a "A" near=["b"]\n  Class b "B"\n',
    right='Package p "Plant"\n  Class a "A" abstract=true\n',
)
RENAMED = rule(
    "SM733",
    "sysml-renamed",
    Severity.INFO,
    "the name '{name}' is taken in its namespace; it is written '{written}'",
    why="In SysML v2 all members of a namespace have different names (KerML 1.0, 8.3.2.4); UML "
    "asks this only of members of one kind.",
    wrong='Package p "Plant"\n  Class a "Gate"\n  Activity b "Gate"\n',
    right='Package p "Plant"\n  Class a "Gate"\n  Activity b "Open"\n',
)
APPROXIMATED = rule(
    "SM734",
    "sysml-approximated",
    Severity.INFO,
    "{said} is written as {written} ({count} in the text)",
    why="SysML v2 says it in another way, from which it cannot be read back the same.",
    wrong='Package p "Plant"\n  Enumeration a "A"\n    -> specializes b\n  Enumeration b "B"\n',
    right='Package p "Plant"\n  DataType a "A"\n    -> specializes b\n  DataType b "B"\n',
)
TEXT_AS_NAME = rule(
    "SM735",
    "sysml-text-as-name",
    Severity.INFO,
    "'{text}' is no expression over the model; it is written as a feature of that name",
    why="A condition of SysML v2 is an expression whose names are found in the model. Text that is "
    "none becomes a Boolean attribute that nobody sets, so that the condition can still be read.",
    wrong="""
Package p "Plant"
  StateMachine m "Gate"
    Region r ""
      State s "A"
      State t "B"
      Transition x "" guard="door is shut"
        -> flow-source s
        -> flow-target t
""",
    right="""
Package p "Plant"
  StateMachine m "Gate"
    Region r ""
      State s "A"
      State t "B"
      Transition x "" guard="1 < 2"
        -> flow-source s
        -> flow-target t
""",
)
UNREACHABLE = rule(
    "SM736",
    "sysml-unreachable",
    Severity.WARNING,
    "'{edge}' of {kind} leads to what the text does not name ({count} left out)",
    why="What has no name, or is not part of the text, cannot be referred to.",
    wrong="""
Package p "Plant"
  Comment c "" body="see there"
    -> references d
  Comment d "" body="there"
""",
    right='Package p "Plant"\n  Comment c "" body="see there"\n    -> references p\n',
)
NAME_LEFT_OUT = rule(
    "SM737",
    "sysml-name-left-out",
    Severity.INFO,
    "{said} has no name in SysML v2 ({count} names left out)",
    why="SysML v2 has fixed words, or nothing at all, where UML has an element with a name.",
    wrong="""
Package p "Plant"
  Activity m "Run"
    Control i "begin" subkind="initial"
""",
    right="""
Package p "Plant"
  Activity m "Run"
    Control i "" subkind="initial"
""",
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
