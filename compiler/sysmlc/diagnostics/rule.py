"""Rules: what can be wrong with a model, and how it is explained."""

from enum import StrEnum

from msgspec import Struct


class Severity(StrEnum):
    """How much a finding matters."""

    ERROR = "error"
    """No right answer can be given."""
    WARNING = "warning"
    """An answer can be given, but it is probably not what was meant."""
    INFO = "info"
    """Worth knowing."""


class Rule(Struct, frozen=True):
    """One kind of finding.

    ``phrase`` is a format string filled by the facts given to ``Sink.report``. ``wrong`` and
    ``right`` are small models (IR text, or source text) that have and nearly have the fault.
    """

    code: str
    name: str
    severity: Severity
    phrase: str
    why: str
    help: str = ""
    wrong: str = ""
    right: str = ""


_rules: dict[str, Rule] = {}
_names: set[str] = set()


def rule(
    code: str,
    name: str,
    severity: Severity,
    phrase: str,
    why: str,
    help: str = "",
    wrong: str = "",
    right: str = "",
) -> Rule:
    """Make a rule and enter it in the catalogue; codes and names are never used twice."""
    made = Rule(code, name, severity, phrase, why, help, wrong, right)
    if code in _rules or name in _names:
        raise ValueError(f"rule {code} {name}: the code or the name is taken")
    _rules[code] = made
    _names.add(name)
    return made


def catalogue() -> dict[str, Rule]:
    """All rules of the modules imported so far, by code in order."""
    return dict(sorted(_rules.items()))
