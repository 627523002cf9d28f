"""Reports attributes of library elements that UML does not have, each once for each snapshot."""

from collections.abc import Iterable

from sysmlc.diagnostics import Place, Sink, Subject
from sysmlc.frontends.xmi import rules
from sysmlc.frontends.xmi.snapshots.entries import Snapshots
from sysmlc.frontends.xmi.uml_features import FEATURES
from sysmlc.frontends.xmi.unit import Unit
from sysmlc.frontends.xmi.unknown_names import TOOL_ATTRIBUTES, suggest
from sysmlc.sources import Source
from sysmlc.sources.xml import SEPARATOR, parse, parser

_KNOWN_BESIDE_UML = TOOL_ATTRIBUTES | {"ID", "_extensionEndOfType"}
"""Attributes without namespace that MagicDraw writes in snapshots beside those of UML."""


def report_unknown_attributes(
    snapshots: Snapshots, sources: Iterable[Source], unit: Unit, sink: Sink
) -> set[str]:
    """Report the unknown attributes of the elements that are added to the unit.

    Return the ids of the elements that have one.
    """
    incomplete: set[str] = set()
    for source in sources:
        names = snapshots.attribute_names.get(source.name, frozenset())
        unknown = frozenset(filter(_is_unknown, names))
        for name, holders in _find_holders(source, unknown).items() if unknown else ():
            added = {id: ordinal for id, ordinal in holders.items() if id in unit.library_ids}
            if added:
                _report(snapshots, source, unit, sink, name, added)
                incomplete |= added.keys()
    return incomplete


def _is_unknown(name: str) -> bool:
    return SEPARATOR not in name and name not in FEATURES and name not in _KNOWN_BESIDE_UML


def _find_holders(source: Source, names: frozenset[str]) -> dict[str, dict[str, int]]:
    """Return the ids and ordinals of the elements that have an attribute, by attribute name.

    The snapshot is parsed again: few have unknown attributes, and all are large.
    """
    holders: dict[str, dict[str, int]] = {}
    ids, ordinal = [""], -1

    def start(_: str, values: dict[str, str]) -> None:
        nonlocal ordinal
        ordinal += 1
        ids.append(values.get("ID", ids[-1]))
        for name in names.intersection(values):
            holders.setdefault(name, {}).setdefault(ids[-1], ordinal)

    xml_parser = parser()
    xml_parser.StartElementHandler = start
    xml_parser.EndElementHandler = lambda _: ids.pop()
    try:
        parse(source, xml_parser)
    finally:
        # The parser and its handlers refer to one another; the garbage collector is off.
        xml_parser.StartElementHandler = xml_parser.EndElementHandler = None
    return dict(sorted(holders.items()))


def _report(
    snapshots: Snapshots, source: Source, unit: Unit, sink: Sink, name: str, holders: dict[str, int]
) -> None:
    first = next(iter(holders))
    path = list(snapshots.iter_owners(snapshots.entries[first]))
    element = "::".join(owner.name or owner.metaclass for owner in reversed(path))
    sink.report(
        rules.UNKNOWN_IN_LIBRARY,
        # The subject is the snapshot: diagnostics about elements of libraries are suppressed.
        Subject(element, place=Place(source.name, holders[first])),
        help=suggest(name, FEATURES),
        attribute=name,
        element=element,
        others=f" and {len(holders) - 1} more" if len(holders) > 1 else "",
        library=unit.library_ids[first][1],
    )
