"""Attributes of library elements that UML does not have: each is told once for each snapshot."""

from collections import Counter
from collections.abc import Iterable

from sysmlc.diagnostics import Place, Sink, Subject
from sysmlc.frontends.xmi.feature_names import FEATURES
from sysmlc.frontends.xmi.snapshot_rules import UNKNOWN_IN_LIBRARY
from sysmlc.frontends.xmi.snapshots.closure import type_of
from sysmlc.frontends.xmi.snapshots.entries import Entry, Snapshots
from sysmlc.frontends.xmi.unit import Unit
from sysmlc.frontends.xmi.unknown_attributes import WITH_READERS
from sysmlc.sources import Source
from sysmlc.sources.xml import SEPARATOR, parse, parser
from sysmlc.support.suggestions import did_you_mean

_OF_THE_TOOL = WITH_READERS | {"ID", "_extensionEndOfType"}
"""Attributes without namespace that MagicDraw writes in snapshots beside UML's own."""

_Odd = dict[str, dict[str, int]]
"""Ids of the elements that have an unknown attribute, by its name, with their places."""


def report(snapshots: Snapshots, sources: Iterable[Source], unit: Unit, sink: Sink) -> set[str]:
    """Report them for what is taken from the snapshots; ids of the elements that have any."""
    told: set[str] = set()
    for source in sources:
        names = frozenset(filter(_is_unknown, snapshots.attributes.get(source.name, ())))
        for name, holders in _holders(source, names).items() if names else ():
            taken = {id: ordinal for id, ordinal in holders.items() if id in unit.library}
            if taken:
                _report(snapshots, source, unit, sink, name, taken)
                told |= taken.keys()
    return told


def _is_unknown(name: str) -> bool:
    return SEPARATOR not in name and name not in FEATURES and name not in _OF_THE_TOOL


def _holders(source: Source, names: frozenset[str]) -> _Odd:
    """The snapshot is read again: hardly one has such an attribute, and all are large."""
    made, found, stack, ordinal = parser(), dict[str, dict[str, int]](), [""], -1

    def start(_: str, values: dict[str, str]) -> None:
        nonlocal ordinal
        ordinal += 1
        stack.append(values.get("ID", stack[-1]))
        for name in names.intersection(values):
            found.setdefault(name, {}).setdefault(stack[-1], ordinal)

    made.StartElementHandler = start
    made.EndElementHandler = lambda _: stack.pop()
    try:
        parse(source, made)
    finally:
        made.StartElementHandler = made.EndElementHandler = None
    return dict(sorted(found.items()))


def _report(
    snapshots: Snapshots, source: Source, unit: Unit, sink: Sink, name: str, taken: dict[str, int]
) -> None:
    first, others = next(iter(taken)), len(taken) - 1
    element = "::".join(one.name or type_of(one) for one in reversed([*_path(snapshots, first)]))
    near = did_you_mean(name, FEATURES)
    sink.report(
        UNKNOWN_IN_LIBRARY,
        # It is about the snapshot: what is about an element of a library is nobody's to mend.
        Subject(element, place=Place(source.name, taken[first])),
        help=near if near.startswith("did you mean") else "",
        attribute=name,
        element=element,
        others=f" and {others} more" if others else "",
        library=unit.library[first][1],
    )


def _path(snapshots: Snapshots, id: str) -> Iterable[Entry]:
    return snapshots.path(snapshots.entries[id])


def by_file(snapshots: Snapshots, ids: Iterable[str]) -> dict[str, Counter[str]]:
    """Number of elements of each type, by the snapshot that they are counted in."""
    found = {name: Counter[str]() for name in snapshots.counts}
    for id in ids:
        entry = snapshots.entries[id]
        found[entry.source][entry.written] += 1
    return found
