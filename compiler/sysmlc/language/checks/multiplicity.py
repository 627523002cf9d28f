"""How many there may be of what subsets or redefines, as far as bounds are constant."""

from collections.abc import Iterator
from math import inf
from typing import NamedTuple

from sysmlc.diagnostics import Severity, rule
from sysmlc.language.checks.found import Found, name_of, written
from sysmlc.language.checks.values import value
from sysmlc.language.names import Model
from sysmlc.language.names.implied import find_owning_type
from sysmlc.language.tree import Node

MORE = rule(
    "SM281",
    "more-than-general",
    Severity.WARNING,
    "'{name}' may have {own} values, and '{general}' has at most {most}",
    help="lower the bound, or raise that of '{general}'",
)
FEWER = rule(
    "SM282",
    "fewer-than-redefined",
    Severity.WARNING,
    "'{name}' may have {own} values only, and '{general}', which it redefines, at least {least}",
    help="raise the bound, or lower that of '{general}'",
)

_SUBSETTING = frozenset({"Subsetting", "Redefinition"})
_REDEFINITION = frozenset({"Redefinition"})
_SINGLE = frozenset({"AttributeUsage", "ItemUsage", "PartUsage", "PortUsage"})
"""Usages of a type that are there once where nothing is said (SysML 2.0, 8.3.6.4)."""
_DEEP = 20


class Bounds(NamedTuple):
    """The least and the greatest number of values."""

    least: float
    most: float


def check(model: Model, node: Node) -> Iterator[Found]:
    """Report bounds that are wider than those of what is subset or redefined."""
    own = _said(model, node)
    if own is None:
        return
    for relation, target in written(node, _SUBSETTING):
        theirs = bounds(model, target)
        if theirs is not None:
            names = {"name": name_of(model, node), "general": name_of(model, target)}
            start = relation.reference.start
            if own.most > theirs.most:
                most = {"own": _words(own.most), "most": _words(theirs.most)}
                yield Found(MORE, start, {**names, **most})
            if relation.kind == "Redefinition" and own.least < theirs.least:
                least = {"own": _words(own.least), "least": _words(theirs.least)}
                yield Found(FEWER, start, {**names, **least})


def bounds(model: Model, feature: Node, depth: int = 0) -> Bounds | None:
    """The bounds of a feature: its own, those of what it redefines, else one; None if unknown."""
    if any(one.kind == "MultiplicityRange" for one in feature.members):
        return _said(model, feature)
    for _, target in written(feature, _REDEFINITION):
        return bounds(model, target, depth + 1) if depth < _DEEP else None
    is_single = feature.kind in _SINGLE and find_owning_type(feature) is not None
    return Bounds(1, 1) if is_single else None


def _said(model: Model, feature: Node) -> Bounds | None:
    """The bounds that a feature says itself and that are constant."""
    for member in feature.members:
        if member.kind == "MultiplicityRange":
            ends = [_number(model, one) for one in member.members]
            numbers = [one for one in ends if one is not None]
            if not numbers or len(numbers) < len(ends):
                return None
            is_any = len(numbers) == 1 and numbers[0] == inf
            return Bounds(0 if is_any else numbers[0], numbers[-1])
    return None


def _number(model: Model, bound: Node) -> float | None:
    if bound.kind == "LiteralInfinity":
        return inf
    found = value(model, bound)
    return found if isinstance(found, int) and not isinstance(found, bool) else None


def _words(number: float) -> str:
    return "any number of" if number == inf else f"{number:g}"


BY_RELATION = ((_SUBSETTING, check),)
