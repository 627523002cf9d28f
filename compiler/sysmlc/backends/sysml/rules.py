"""Losses: content of the graph that SysML v2 cannot express or can only approximate."""

from dataclasses import dataclass, field

from sysmlc.backends.base import LossCounter
from sysmlc.diagnostics import Rule, Severity, rule
from sysmlc.ir import Element

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
    "the name '{name}' is already used in its namespace; it is written '{replacement}'",
)
APPROXIMATED = rule(
    "SM734",
    "sysml-approximated",
    Severity.INFO,
    "{construct} is written as {replacement} ({count} in the text)",
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
    "{construct} has no name in SysML v2 ({count} names omitted)",
)
WAITS_FOR_CHANGE = rule(
    "SM463",
    "sysml-when-is-immediate",
    Severity.INFO,
    "a change event of UML waits until its condition becomes true; 'accept when' of SysML v2 also "
    "fires if the condition is already true ({count} in the text)",
    help="sysmlc reads the metadata of the text and waits as in UML; for other tools, let the "
    "behaviour ensure that the condition is false when the wait begins",
)

UNCHANGED_TEXT = rule(
    "SM738",
    "sysml-unchanged-text",
    Severity.WARNING,
    "the SysML v2 text of '{name}' omits {fact}, which the overlay states",
    help="write it into '{file}': sysmlc does not change declarations of authors",
)


@dataclass
class Losses(LossCounter):
    """Counts what SysML v2 text does not express."""

    author_files: frozenset[str] = frozenset()
    """Files in SysML v2, whose text the output contains: nothing of it is lost."""
    by_element: dict[str, list[tuple[str, dict[str, str]]]] = field(default_factory=dict)
    """Code and facts of each loss by the id of the element."""

    def record(self, loss: Rule, element: Element, /, **facts: str) -> None:
        """Count a loss of *element*, unless its author's text is preserved.

        *facts* fill the placeholders of the message.
        """
        if element.source in self.author_files:
            return
        self.by_element.setdefault(element.id, []).append((loss.code, facts))
        super().record(loss, element, **facts)
