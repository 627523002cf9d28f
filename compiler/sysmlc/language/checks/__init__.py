"""Checks of a resolved model: constraints of the specification that say what is well formed."""

from sysmlc.diagnostics import Rule, Sink, Subject
from sysmlc.language.names import Model


def check(model: Model, sink: Sink) -> None:
    """Report what in the documents of the model breaks a constraint of the specification.

    Nodes in which nothing was found are noted as sound in the model, and not checked again.
    """
    from sysmlc.language.checks import families

    counted, lookup, sound = _Counted(sink), model.lookup, model.sound
    for document in model.documents:
        for node in model.nodes(document):
            if node not in sound:
                before = counted.reports + lookup.cuts
                families.check(model, document, node, counted)
                if counted.reports + lookup.cuts == before:
                    sound.add(node)


class _Counted(Sink):
    """A sink that hands on what is reported, and counts it."""

    def __init__(self, sink: Sink) -> None:
        super().__init__()
        self._sink = sink
        self.reports = 0

    def report(
        self,
        rule: Rule,
        subject: Subject,
        *,
        notes: tuple[str, ...] = (),
        help: str = "",
        **facts: object,
    ) -> None:
        """Report to the sink."""
        self.reports += 1
        self._sink.report(rule, subject, notes=notes, help=help, **facts)
