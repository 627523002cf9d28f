"""The sink that takes the findings of one compilation."""

from collections.abc import Iterable, Iterator, Mapping

from msgspec.structs import replace

from sysmlc.diagnostics.diagnostic import Diagnostic, Subject
from sysmlc.diagnostics.rule import Rule, Severity

_LONG = 2_000
_SHOWN = 200


class Sink:
    """Collects findings; the same finding about the same element is kept once.

    ``severities`` maps a rule's code or name to the severity that the project chose, or to
    None to silence the rule.
    """

    def __init__(self, severities: Mapping[str, Severity | None] | None = None) -> None:
        self._severities = dict(severities or {})
        self._settled: dict[str, Mapping[str, Severity | None]] = {}
        self._found: dict[tuple[str, str, Subject], Diagnostic] = {}

    def settle(self, files: Iterable[str], severities: Mapping[str, Severity | None]) -> None:
        """Say by code how much rules matter in files whose language rules otherwise.

        What the language's own checks answer for is silent (None). The project has the last word.
        """
        self._settled.update(dict.fromkeys(files, severities))

    def report(
        self,
        rule: Rule,
        subject: Subject,
        *,
        notes: tuple[str, ...] = (),
        help: str = "",
        **facts: object,
    ) -> None:
        """Report ``rule`` about ``subject``; ``facts`` fill the rule's phrase and its help."""
        severity = self._severity(rule, subject)
        if severity is None:
            return
        message = rule.phrase.format(**facts)
        if len(message) > _LONG:
            facts = {name: _shorten(fact) for name, fact in facts.items()}
            message = rule.phrase.format(**facts)
        advice = (help or rule.help).format(**facts)
        told = tuple(f"{note[:_LONG]}..." if len(note) > _LONG else note for note in notes)
        found = Diagnostic(rule, severity, message, subject, told, advice)
        self._found.setdefault((rule.code, message, subject), found)

    def subset(self, diagnostics: Iterable[Diagnostic]) -> "Sink":
        """Return a new sink with the same severities that already holds *diagnostics*."""
        part = Sink(self._severities)
        part._found = {(d.rule.code, d.message, d.subject): d for d in diagnostics}
        return part

    def relate(self, found: Diagnostic, id: str) -> None:
        """Say which element of the graph a finding is about that only knew its place."""
        key = (found.rule.code, found.message, found.subject)
        self._found[key] = replace(found, subject=replace(found.subject, id=id))

    def _severity(self, rule: Rule, subject: Subject) -> Severity | None:
        for key in (rule.code, rule.name):
            if key in self._severities:
                return self._severities[key]
        if self._settled and subject.place is not None:
            return self._settled.get(subject.place.file, {}).get(rule.code, rule.severity)
        return rule.severity

    def __iter__(self) -> Iterator[Diagnostic]:
        return iter(self._found.values())

    def __len__(self) -> int:
        return len(self._found)

    def has_errors(self) -> bool:
        """Whether any finding makes the model wrong."""
        return any(found.is_error for found in self)


def _shorten(fact: object) -> object:
    """Return a text that would fill pages by its beginning."""
    return f"{fact[:_SHOWN]}..." if isinstance(fact, str) and len(fact) > _SHOWN else fact
