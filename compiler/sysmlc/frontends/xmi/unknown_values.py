"""Values that UML does not know for an attribute: each is told once for each file."""

from itertools import islice

from sysmlc.diagnostics import Subject, Verdict
from sysmlc.frontends.xmi import rules
from sysmlc.frontends.xmi.context import Context
from sysmlc.frontends.xmi.feature_names import VALUES

_MOST = 50
"""So many are told one by one, the others as a number."""


def report(context: Context) -> None:
    """Report what the readers met; the elements that have such a value are approximated."""
    found: dict[tuple[str, str], list[int]] = {}
    for row, name, value in context.odd_values:
        found.setdefault((name, value), []).append(row)
        if context.verdicts[row] is Verdict.MAPPED:
            context.verdicts[row] = Verdict.APPROXIMATED
            context.told[row] = rules.UNKNOWN_VALUE, f"'{name}' has a value that UML does not know"
    more = len(found) - _MOST
    for number, ((name, value), rows) in enumerate(islice(found.items(), _MOST), 1):
        _report(context, name, value, rows, more if number == _MOST else 0)


def _report(context: Context, name: str, value: str, rows: list[int], more: int) -> None:
    first, others = rows[0], len(rows) - 1
    element = context.qualified_name(first)
    context.sink.report(
        rules.UNKNOWN_VALUE,
        Subject(element, context.gids[first], context.place(first)),
        notes=(f"{more} more such values are in the file",) if more > 0 else (),
        attribute=name,
        element=element,
        others=f" and {others} more" if others else "",
        value=value,
        known=", ".join(VALUES[name]),
    )
