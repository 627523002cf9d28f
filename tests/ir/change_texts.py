"""The changes that a comparison of two models reports, as lines."""

from collections.abc import Iterable

from sysmlc.ir.compare import Change


def print_changes(changes: Iterable[Change]) -> list[str]:
    """Return a line for each change: owner, what, kind, name, aspect, and the two values."""
    return [print_change(change) for change in changes]


def print_change(change: Change) -> str:
    text = f"{change.owner}: {change.what} {change.kind} {change.name}"
    if change.aspect:
        text += f", {change.aspect}: {change.before or None} => {change.after or None}"
    if change.contents:
        text += f" ({change.contents})"
    return text
