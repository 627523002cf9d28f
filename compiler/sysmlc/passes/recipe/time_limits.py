"""Times that requirements state for the tasks and recipes that satisfy them."""

import re
from collections.abc import Iterator

from sysmlc.ir import Edge, Element, query
from sysmlc.logic.machines.transitions import parse_milliseconds
from sysmlc.passes.recipe.context import Context
from sysmlc.recipe.model import TimeLimit

_NUMBER = r"(\d+(?:\.\d+)?)\s*([a-z]+)\b"
_MOST = re.compile(
    rf"\b(?:at most|within|in less than|no longer than|not longer than|no more than|not more than"
    rf"|less than|up to)\s+{_NUMBER}",
    re.IGNORECASE,
)
_LEAST = re.compile(
    rf"\b(?:at least|no less than|not less than|more than|longer than)\s+{_NUMBER}", re.IGNORECASE
)
_NOT_BOUND = re.compile(r"\b(?:no|not)\s+(?:more|longer) than", re.IGNORECASE)
_PART = re.compile(
    r"\b(?:after|before|when|whenever|if|while|once|until|unless|each|every|between|since"
    r"|per|interval)\b",
    re.IGNORECASE,
)
"""Words of statements about a part of an execution, which its whole time does not decide."""


def read_limits(context: Context, elements: list[Element | None]) -> tuple[TimeLimit, ...]:
    """Return the times in the texts of the requirements that *elements* satisfy, sorted."""
    limits = {
        requirement.id: limit
        for element in elements
        if element is not None
        for requirement in context.graph.targets(element, Edge.SATISFIES)
        if query.is_requirement(requirement)
        and (limit := _read_limit(context, requirement)) is not None
    }
    return tuple(sorted(limits.values(), key=lambda limit: limit.requirement))


def _read_limit(context: Context, requirement: Element) -> TimeLimit | None:
    text = str(requirement.attrs.get("text", ""))
    if _PART.search(text):
        return None
    least = list(_iter_times(_LEAST, _NOT_BOUND.sub("at most", text)))
    most = list(_iter_times(_MOST, text))
    if len(least) > 1 or len(most) > 1 or not (least or most):
        return None
    return TimeLimit(
        context.name(requirement),
        least[0] if least else None,
        most[0] if most else None,
        requirement.id,
    )


def _iter_times(pattern: re.Pattern[str], text: str) -> Iterator[int]:
    for number, unit in pattern.findall(text):
        # In prose, "5 m" are metres rather than minutes.
        time = None if unit.lower() == "m" else parse_milliseconds(f"{number} {unit}")
        if time is not None:
            yield time
