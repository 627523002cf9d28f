"""Rules: what can be wrong with a model, and how it is explained."""

from enum import StrEnum

from msgspec import Struct

from sysmlc.diagnostics.rule_page import RulePage, parse_page, read_shipped_page


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

    ``phrase`` and ``help`` are format strings filled by the facts given to ``Sink.report``.
    ``page`` is the text of the rule's page if the rule is not sysmlc's own (see ``rule_page``).
    """

    code: str
    name: str
    severity: Severity
    phrase: str
    help: str = ""
    page: str = ""

    def read_page(self) -> RulePage:
        """Return why the rule exists and its examples; the page is empty if nobody wrote one."""
        if self.page:
            return parse_page(self.page)
        try:
            return read_shipped_page(self.code)
        except OSError:
            return RulePage()


_rules: dict[str, Rule] = {}
_names: set[str] = set()


def rule(
    code: str, name: str, severity: Severity, phrase: str, help: str = "", page: str = ""
) -> Rule:
    """Make a rule and enter it in the catalogue; codes and names are never used twice."""
    made = Rule(code, name, severity, phrase, help, page)
    if code in _rules or name in _names:
        raise ValueError(f"rule {code} {name}: the code or the name is taken")
    _rules[code] = made
    _names.add(name)
    return made


def catalogue() -> dict[str, Rule]:
    """All rules of the modules imported so far, by code in order."""
    return dict(sorted(_rules.items()))
