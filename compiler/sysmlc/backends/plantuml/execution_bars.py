"""Execution bars across the operands of a combined fragment, of which only one runs."""

from collections import Counter
from collections.abc import Iterator, Sequence

from sysmlc.backends.plantuml.views import Step

_CHANGES = {"activate": 1, "deactivate": -1}


def balance_operands(contents: Sequence[Sequence[Step]]) -> list[list[Step]]:
    """Return the steps of the operands, so that each begins with the bars that the first begins
    with.

    PlantUML continues from one operand to the next as if all of them ran. Bars are corrected after
    the first message, because one line cannot end and start a bar. The last list closes the bars
    that end in any of the operands.
    """
    balanced: list[list[Step]] = []
    open_bars: Counter[str] = Counter()
    for content in contents:
        balanced.append(_correct(content, open_bars))
        open_bars.update(_count_bars(balanced[-1]))
    wanted = _count_bars([step for content in contents for step in content])
    if balanced:
        balanced.append([*_iter_corrections(_subtract(wanted, open_bars))])
    return balanced


def _correct(content: Sequence[Step], open_bars: Counter[str]) -> list[Step]:
    first = next((i for i, step in enumerate(content) if step.word == "message"), None)
    if first is None:
        return list(content)
    corrections = _iter_corrections(_subtract(Counter(), open_bars))
    return [*content[: first + 1], *corrections, *content[first + 1 :]]


def _count_bars(steps: Sequence[Step]) -> Counter[str]:
    """Return by how many bars each lifeline has more (or less) after the steps."""
    bars: Counter[str] = Counter()
    for step in steps:
        if step.word in _CHANGES:
            bars[step.source] += _CHANGES[step.word]
    return bars


def _subtract(wanted: Counter[str], open_bars: Counter[str]) -> Counter[str]:
    result = Counter(wanted)
    result.subtract(open_bars)
    return result


def _iter_corrections(bars: Counter[str]) -> Iterator[Step]:
    for alias, number in bars.items():
        word = "activate" if number > 0 else "deactivate"
        for _ in range(abs(number)):
            yield Step(word, source=alias)
