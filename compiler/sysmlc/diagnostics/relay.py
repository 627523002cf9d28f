"""A sink that hands on what is reported, for who wants to know of it or to report it again."""

from sysmlc.diagnostics.diagnostic import Subject
from sysmlc.diagnostics.rule import Rule
from sysmlc.diagnostics.sink import Sink
from sysmlc.values import dataclass


@dataclass(frozen=True, slots=True)
class Report:
    """What a sink was told."""

    rule: Rule
    subject: Subject
    notes: tuple[str, ...]
    help: str
    facts: dict[str, object]

    def tell(self, sink: Sink, subject: Subject) -> None:
        """Report the same about a subject."""
        sink.report(self.rule, subject, notes=self.notes, help=self.help, **self.facts)


class Relay(Sink):
    """Hands on what is reported, and keeps it in order."""

    def __init__(self, sink: Sink) -> None:
        super().__init__()
        self._sink = sink
        self.reports: list[Report] = []

    def report(
        self,
        rule: Rule,
        subject: Subject,
        *,
        notes: tuple[str, ...] = (),
        help: str = "",
        **facts: object,
    ) -> None:
        """Report to the other sink."""
        self.reports.append(Report(rule, subject, notes, help, facts))
        self._sink.report(rule, subject, notes=notes, help=help, **facts)
