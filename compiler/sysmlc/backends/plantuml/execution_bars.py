"""Execution bars of lifelines in the operands of a combined fragment.

Operands are alternatives, so each begins with the bars that are open before the fragment.
"""

from collections import Counter
from collections.abc import Iterator, Sequence

from sysmlc.backends.plantuml.views import Step

_CHANGES = {"activate": 1, "deactivate": -1}


def balance_operands(contents: Sequence[Sequence[Step]]) -> list[list[Step]]:
    """Return the steps of the operands with corrections, and a list of steps after the fragment.

    PlantUML continues the bars of one operand in the next, as if the operands ran in sequence. The
    corrections restore the bars that were open before the fragment; they follow the first message
    of the operand, because PlantUML cannot end and start a bar on one line. The last list changes
    the bars by the sum of what the operands change.
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
    """Return, by lifeline, how many bars the steps open, minus those that they close."""
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
