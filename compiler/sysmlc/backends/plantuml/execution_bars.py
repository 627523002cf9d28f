"""Bars of executions across the operands of a fragment: only one of these happens."""

from collections import Counter
from collections.abc import Iterator, Sequence

from sysmlc.backends.plantuml.views import Step

_CHANGES = {"activate": 1, "deactivate": -1}


def operands(contents: Sequence[Sequence[Step]]) -> list[list[Step]]:
    """The contents of the operands, so that each begins with the bars of the first.

    PlantUML goes from one to the next as if all happened; bars are corrected behind the first
    message, for the same line may not end and begin one. Behind the last operand has ended what
    ends in any of them.
    """
    made: list[list[Step]] = []
    now: Counter[str] = Counter()
    for content in contents:
        made.append(_corrected(content, now))
        now.update(_change(made[-1]))
    wanted = _change([step for content in contents for step in content])
    if made:
        made.append([*_changes(_difference(wanted, now))])
    return made


def _corrected(content: Sequence[Step], now: Counter[str]) -> list[Step]:
    first = next((i for i, step in enumerate(content) if step.word == "message"), None)
    if first is None:
        return list(content)
    back = _changes(_difference(Counter(), now))
    return [*content[: first + 1], *back, *content[first + 1 :]]


def _change(steps: Sequence[Step]) -> Counter[str]:
    """By how many bars each lifeline has more (or less) after the steps."""
    bars: Counter[str] = Counter()
    for step in steps:
        if step.word in _CHANGES:
            bars[step.source] += _CHANGES[step.word]
    return bars


def _difference(wanted: Counter[str], now: Counter[str]) -> Counter[str]:
    made = Counter(wanted)
    made.subtract(now)
    return made


def _changes(bars: Counter[str]) -> Iterator[Step]:
    for alias, number in bars.items():
        word = "activate" if number > 0 else "deactivate"
        for _ in range(abs(number)):
            yield Step(word, source=alias)
