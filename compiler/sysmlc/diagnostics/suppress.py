"""Findings that a project accepts: ``[[suppress]]`` of its configuration."""

from collections.abc import Iterable, Sequence
from fnmatch import fnmatchcase

from msgspec import Struct

from sysmlc.diagnostics.diagnostic import Diagnostic


class Suppression(Struct, frozen=True):
    """A rule (code or name) that does not matter for elements whose qualified name matches."""

    rule: str
    element: str
    reason: str

    def covers(self, found: Diagnostic) -> bool:
        """Whether the finding is one that is accepted."""
        names = (found.rule.code, found.rule.name)
        return self.rule in names and fnmatchcase(found.subject.name, self.element)


def suppress(
    found: Iterable[Diagnostic], suppressions: Sequence[Suppression]
) -> tuple[list[Diagnostic], list[Suppression]]:
    """The findings that are left, and the suppressions that covered none."""
    left: list[Diagnostic] = []
    used: set[Suppression] = set()
    for diagnostic in found:
        covering = [entry for entry in suppressions if entry.covers(diagnostic)]
        used.update(covering)
        if not covering:
            left.append(diagnostic)
    return left, [entry for entry in suppressions if entry not in used]
