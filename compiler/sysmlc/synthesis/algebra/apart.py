"""Parts of a composition that have nothing to do with one another, each set by itself.

What shares no variable, directly or through others, neither keeps nor breaks anything of one
another: a line of forty machines is as many small questions, not one that nobody can answer.
"""

from collections.abc import Iterator

from msgspec.structs import replace

from sysmlc.logic import formula as f
from sysmlc.logic.contract import Composite, Conjunct, Contract
from sysmlc.support.disjoint_sets import DisjointSets


def apart(composite: Composite) -> list[Composite]:
    """The sets of parts that share something, in the order of the first of each.

    The whole is with those that it speaks of; beside the others stands one that promises nothing
    and assumes nothing.
    """
    shared: DisjointSets[str] = DisjointSets()
    for names in _together(composite):
        for other in names[1:]:
            shared.union(names[0], other)
    groups: dict[str, list[int]] = {}
    for number, part in enumerate(composite.parts):
        first = next((one.name for one in part.contract.variables), f"#{number}")
        groups.setdefault(shared.find(first), []).append(number)
    if composite.whole is not None and composite.whole.variables:
        groups.setdefault(shared.find(composite.whole.variables[0].name), [])
    return [_only(composite, group, shared, key) for key, group in groups.items()]


def is_joined(composite: Composite) -> bool:
    """Whether any two of the parts, or a part and the whole, share anything."""
    return any(len(one.parts) > 1 or _speaks(one.whole) for one in apart(composite))


def _speaks(whole: Contract | None) -> bool:
    return whole is not None and bool(whole.variables)


def _together(composite: Composite) -> Iterator[list[str]]:
    """The variables that each contract and each wire brings together."""
    for part in composite.parts:
        yield [one.name for one in part.contract.variables]
    for wire in composite.wiring:
        yield _names(wire)
    if composite.whole is not None:
        yield [one.name for one in composite.whole.variables]


def _names(conjunct: Conjunct) -> list[str]:
    return list(dict.fromkeys(one.name for one in f.variables(conjunct.formula)))


def _only(composite: Composite, group: list[int], shared: DisjointSets[str], key: str) -> Composite:
    def ours(conjuncts: tuple[Conjunct, ...]) -> tuple[Conjunct, ...]:
        return tuple(one for one in conjuncts if shared.find(_names(one)[0]) == key)

    return replace(
        composite,
        parts=tuple(composite.parts[number] for number in group),
        wiring=ours(composite.wiring),
        crowding=ours(composite.crowding),
        whole=_whole(composite.whole, shared, key),
    )


def _whole(whole: Contract | None, shared: DisjointSets[str], key: str) -> Contract | None:
    if whole is None or not whole.variables:
        return whole
    if shared.find(whole.variables[0].name) == key:
        return whole
    return replace(whole, variables=(), assumptions=(), guarantees=())
