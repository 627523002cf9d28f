"""Diagnostics: a rule, a message, and the element and the place that the message is about."""

from msgspec import Struct

from sysmlc.diagnostics.rule import Rule, Severity

KEY_MARK = "  <-- "
"""What a note contains that is shown even if others are not, in front of the reason."""


class Place(Struct, frozen=True):
    """A position in an input, from which line and column are computed when they are shown.

    An XML element is found by ``ordinal``, the number of its start tag in document order from 0,
    because parsers' line numbers stop at 65,535. A position in text is found by ``offset``, in
    bytes from 0; an element that a text (an overlay) defines has its offset as ordinal. Line and
    column count characters from 1 and may be known already. -1 and 0 mean unknown.
    """

    file: str
    ordinal: int = -1
    offset: int = -1
    line: int = 0
    column: int = 0


def format_position(file: str, line: int, column: int) -> str:
    """Return ``file:line:column``; a line or column of 0 is unknown and omitted."""
    return ":".join([file, *(str(number) for number in (line, column) if number)])


class Subject(Struct, frozen=True):
    """The subject of a diagnostic: qualified name, id in the graph, and place."""

    name: str = ""
    id: str = ""
    place: Place | None = None


class Diagnostic(Struct, frozen=True):
    """A fault of the model, or information about it, as a sink collects it.

    ``cause`` identifies the fact that several diagnostics of a file are about, such as a name that
    is missing; reports show them as one finding. It is empty for a fact of its own.
    """

    rule: Rule
    severity: Severity
    message: str
    subject: Subject
    notes: tuple[str, ...] = ()
    help: str = ""
    cause: str = ""

    @property
    def is_error(self) -> bool:
        """Whether the severity is error."""
        return self.severity is Severity.ERROR
