"""Rules for what CAEX cannot express, and the counter of such losses."""

from sysmlc.backends.base import LossCounter
from sysmlc.diagnostics import Severity, rule
from sysmlc.ir import Element

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
    "{construct} is saved as {replacement} ({count})",
)
ILLEGAL_CHARACTERS = rule(
    "SM745",
    "caex-illegal-character",
    Severity.WARNING,
    "{count} not allowed in XML, replaced in the saved plant",
)
ADDED = rule(
    "SM746",
    "caex-required",
    Severity.INFO,
    "'{element}' has no {what}, which the schema of CAEX 3.0 requires: '{value}' is written",
)
EMPTY = rule(
    "SM764",
    "caex-empty-plant",
    Severity.ERROR,
    "no file is written: {reason}",
    help="--emit uml, sysml, ir or ecore saves the model",
)


class Losses(LossCounter):
    """Counts what CAEX does not express."""

    def record_approximation(self, element: Element, original: str, replacement: str) -> None:
        """Count an element that is saved in another form."""
        self.record(APPROXIMATED, element, construct=original, replacement=replacement)

    def record_untyped(self, feature: Element, kind: str, type_: Element) -> None:
        """Count a feature whose type CAEX cannot reference."""
        facts = {"edge": "typed-by", "kind": kind, "target": str(type_.kind)}
        self.record(UNSUPPORTED_EDGE, feature, **facts)
