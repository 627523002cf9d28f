"""Stand-ins in the graph for what the libraries of UML, SysML and MagicDraw hold."""

from collections.abc import Collection

from sysmlc.ir import AttrValue, Edge, Element, Graph, Kind
from sysmlc.ir.identity import derived_id
from sysmlc.passes.resolve.hrefs import split
from sysmlc.passes.resolve.libraries import StandIn, libraries


def known(target: str, paths: Collection[str], kinds: Collection[Kind]) -> StandIn | None:
    """The element of a known library that a reference means, or None.

    ``paths`` and ``kinds`` are what all references to it say: their order must not matter.
    """
    file, fragment = split(target)
    return libraries().find(file, fragment, min(filter(None, paths), default=""), kinds)


def add(graph: Graph, stand_in: StandIn, origin: str) -> Element:
    """Add the stand-in with its packages, generals and metaclasses, unless it is there.

    The packages of SysML are profiles, for Eclipse applies them one by one: what a stand-in is
    must not depend on the dialect that uses it.
    """
    owner = _of(graph, stand_in.owner, origin)
    id = derived_id(stand_in.href, "stub")
    found = graph.get(id)
    if found is not None:
        return found
    attrs: dict[str, AttrValue] = {"external": True, "library": True, "href": stand_in.href}
    attrs["origin"] = origin
    made = graph.add(
        Element(id, stand_in.kind, stand_in.name, None if owner is None else owner.id, attrs=attrs)
    )
    for edge, names in (
        (Edge.SPECIALIZES, stand_in.generals),
        (Edge.EXTENDS, stand_in.metaclasses),
    ):
        for name in names:
            general = _of(graph, name, origin)
            if general is not None:
                graph.connect(edge, made, general)
    return made


def _of(graph: Graph, name: str, origin: str) -> Element | None:
    stand_in = libraries().get(name) if name else None
    return None if stand_in is None else add(graph, stand_in, origin)
