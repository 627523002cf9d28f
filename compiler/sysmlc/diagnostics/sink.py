"""The sink that collects the diagnostics of one compilation, and suppressions of projects."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from fnmatch import fnmatchcase
from typing import NamedTuple

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.diagnostics.diagnostic import Diagnostic, Place, Subject
from sysmlc.diagnostics.rule import Rule, Severity

_MAX_TEXT = 2_000
"""Characters of a message or a note; longer facts and notes are cut."""
_MAX_FACT = 200
"""Characters of a fact in a message that would be longer than ``_MAX_TEXT``."""


class Wording(NamedTuple):
    """Message and advice of a rule in the words of one language.

    An empty phrase stands for the phrase of the rule.
    """

    phrase: str
    help: str


class Sink:
    """Collects diagnostics; the same message about the same element is stored once.

    *severities* maps the code or name of a rule to the severity that the project chose, or to None
    for a rule that the project switched off.
    """

    def __init__(self, severities: Mapping[str, Severity | None] | None = None) -> None:
        self._severities = dict(severities or {})
        self._file_severities: dict[str, Mapping[str, Severity | None]] = {}
        self._file_wordings: dict[str, Mapping[str, Wording]] = {}
        self._diagnostics: dict[tuple[str, str, Subject], Diagnostic] = {}
        self._codes_by_place: dict[Place, set[str]] = {}

    def set_file_severities(
        self, files: Iterable[str], severities: Mapping[str, Severity | None]
    ) -> None:
        """Set severities by code for diagnostics in *files*; those of the project take precedence.

        A front end calls this method for rules that have another severity in its language. None
        switches off rules that checks of the front end replace.
        """
        self._file_severities.update(dict.fromkeys(files, severities))

    def set_file_wordings(self, files: Iterable[str], wordings: Mapping[str, Wording]) -> None:
        """Set messages and advice by code for diagnostics in *files*, in the words of a language.

        A front end calls this method for rules whose texts name constructs of another language.
        """
        self._file_wordings.update(dict.fromkeys(files, wordings))

    def report(
        self,
        rule: Rule,
        subject: Subject,
        *,
        notes: tuple[str, ...] = (),
        help: str = "",
        cause: str = "",
        **facts: object,
    ) -> None:
        """Report *rule* about *subject*; *facts* fill the phrase and the help of the rule.

        Reports show diagnostics of one file with the same *cause* as one finding with a count.
        """
        severity = self._find_severity(rule, subject)
        if severity is None:
            return
        wording = self._find_wording(rule, subject)
        message = wording.phrase.format(**facts)
        if len(message) > _MAX_TEXT:
            facts = {
                name: _shorten(fact, _MAX_FACT) if isinstance(fact, str) else fact
                for name, fact in facts.items()
            }
            message = wording.phrase.format(**facts)
        advice = (help or wording.help).format(**facts)
        short_notes = tuple(_shorten(note, _MAX_TEXT) for note in notes)
        diagnostic = Diagnostic(rule, severity, message, subject, short_notes, advice, cause)
        self._diagnostics.setdefault(_make_key(diagnostic), diagnostic)
        if subject.place is not None:
            self._codes_by_place.setdefault(subject.place, set()).add(rule.code)

    def has_reported(self, codes: Iterable[str], place: Place | None) -> bool:
        """Whether a diagnostic with one of the *codes* was reported at *place*.

        A caller omits what would be another diagnostic about the same fact.
        """
        return place is not None and not self._codes_by_place.get(place, set()).isdisjoint(codes)

    def subset(self, diagnostics: Iterable[Diagnostic]) -> "Sink":
        """Return a new sink with the same severities that already holds *diagnostics*."""
        sink = Sink(self._severities)
        sink._diagnostics = {_make_key(diagnostic): diagnostic for diagnostic in diagnostics}
        return sink

    def extend(self, diagnostics: Iterable[Diagnostic]) -> None:
        """Add diagnostics of another sink as they are."""
        for diagnostic in diagnostics:
            self._diagnostics.setdefault(_make_key(diagnostic), diagnostic)

    def set_element(self, diagnostic: Diagnostic, id: str) -> None:
        """Add the id of an element to a diagnostic that was reported with only a place."""
        subject = replace(diagnostic.subject, id=id)
        self._diagnostics[_make_key(diagnostic)] = replace(diagnostic, subject=subject)

    def _find_severity(self, rule: Rule, subject: Subject) -> Severity | None:
        for key in (rule.code, rule.name):
            if key in self._severities:
                return self._severities[key]
        if self._file_severities and subject.place is not None:
            file_severities = self._file_severities.get(subject.place.file, {})
            return file_severities.get(rule.code, rule.severity)
        return rule.severity

    def _find_wording(self, rule: Rule, subject: Subject) -> Wording:
        if self._file_wordings and subject.place is not None:
            wording = self._file_wordings.get(subject.place.file, {}).get(rule.code)
            if wording is not None:
                return Wording(wording.phrase or rule.phrase, wording.help)
        return Wording(rule.phrase, rule.help)

    def __iter__(self) -> Iterator[Diagnostic]:
        return iter(self._diagnostics.values())

    def __len__(self) -> int:
        return len(self._diagnostics)

    def has_errors(self) -> bool:
        """Whether any diagnostic is an error."""
        return any(diagnostic.is_error for diagnostic in self)


def _make_key(diagnostic: Diagnostic) -> tuple[str, str, Subject]:
    return diagnostic.rule.code, diagnostic.message, diagnostic.subject


def _shorten(text: str, limit: int) -> str:
    return f"{text[:limit]}..." if len(text) > limit else text


# -- suppressions ------------------------------------------------------------------------------


class Suppression(Struct, frozen=True):
    """An entry ``[[suppress]]`` of the configuration: diagnostics that the project accepts.

    The entry covers diagnostics of a rule (code or name) about elements whose qualified name
    matches the pattern ``element``, in files whose path ends in a match of the pattern ``file``.
    """

    rule: str
    reason: str
    element: str = "*"
    file: str = "*"

    def covers(self, diagnostic: Diagnostic) -> bool:
        """Whether the project accepts the diagnostic."""
        if self.rule not in (diagnostic.rule.code, diagnostic.rule.name):
            return False
        place = diagnostic.subject.place
        file = "" if place is None else place.file
        is_in_file = self.file == "*" or fnmatchcase(f"/{file}", f"*/{self.file}")
        return is_in_file and fnmatchcase(diagnostic.subject.name, self.element)


def suppress(
    diagnostics: Iterable[Diagnostic], suppressions: Sequence[Suppression]
) -> tuple[list[Diagnostic], list[Suppression]]:
    """Return the diagnostics that no entry covers, and the entries that cover none."""
    remaining: list[Diagnostic] = []
    used: set[Suppression] = set()
    for diagnostic in diagnostics:
        covering = [entry for entry in suppressions if entry.covers(diagnostic)]
        used.update(covering)
        if not covering:
            remaining.append(diagnostic)
    return remaining, [entry for entry in suppressions if entry not in used]
