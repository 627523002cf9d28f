"""Findings: a rule, the element it is about, and where that element stands."""

from msgspec import Struct

from sysmlc.diagnostics.rule import Rule, Severity


class Place(Struct, frozen=True):
    """Where something stands in an input.

    XML elements are found by ``ordinal`` (number of the start tag in document order, from 0),
    because parsers' line numbers stop at 65,535; text by ``offset`` (bytes from 0), which is
    the ordinal too of elements that a text defines (an overlay). Line and
    column, where they are known already, count characters from 1. -1 and 0 mean unknown.
    """

    file: str
    ordinal: int = -1
    offset: int = -1
    line: int = 0
    column: int = 0


class Subject(Struct, frozen=True):
    """What a finding is about: its qualified name, its id in the graph, its place."""

    name: str = ""
    id: str = ""
    place: Place | None = None


class Diagnostic(Struct, frozen=True):
    """One finding, ready to be shown."""

    rule: Rule
    severity: Severity
    message: str
    subject: Subject
    notes: tuple[str, ...] = ()
    help: str = ""

    @property
    def is_error(self) -> bool:
        """Whether it makes the model wrong."""
        return self.severity is Severity.ERROR
