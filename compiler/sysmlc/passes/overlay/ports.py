"""Ports: the direction and the type that the author gives."""

from sysmlc.ir import Edge
from sysmlc.overlay.model import PortEntry
from sysmlc.passes.overlay import rules
from sysmlc.passes.overlay.finder import PORT, TYPE, Finder


def refine_port(finder: Finder, entry: PortEntry) -> None:
    """Give a port its direction and type; who contradicts the model is told so."""
    graph = finder.graph
    port = finder.entry(entry.key, PORT)
    if port is None:
        return
    known = port.attrs.get("direction")
    if entry.direction and known not in (None, entry.direction):
        finder.report(
            rules.OTHER_WISE,
            entry.key,
            name=graph.qualified_name(port),
            what="direction",
            new=entry.direction,
            old=str(known),
        )
    graph.set(port, direction=entry.direction or known)
    type_ = None if entry.type is None else finder.term(entry.type, TYPE)
    if type_ is not None:
        graph.replace_targets(Edge.TYPED_BY, port, [type_])
