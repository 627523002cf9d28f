"""Invisible lines that keep the ports of internal block diagrams on the border of their parts."""

from collections.abc import Iterator, Sequence

from sysmlc.backends.plantuml.views import Line, PartView


def guides(part: PartView, drawn: Sequence[Line]) -> Iterator[Line]:
    """Lines for the ports of each part: dot ranks what is inside between them.

    PlantUML puts the ports of a side on one rank, so that the first of each side is enough. A
    part that has a line to that side needs none; one more would only make lines cross.
    """
    joined = {frozenset((line.source, line.target)) for line in drawn}
    yield from _guides(part, joined)


def _guides(part: PartView, joined: set[frozenset[str]]) -> Iterator[Line]:
    left = [port.alias for port in part.ports if port.form != "portout"]
    right = [port.alias for port in part.ports if port.form == "portout"]
    for inner in part.parts:
        into = next((port.alias for port in inner.ports if port.form != "portout"), inner.alias)
        out = next((port.alias for port in inner.ports if port.form == "portout"), into)
        own = [inner.alias, *(port.alias for port in inner.ports)]
        if left and not _are_joined(left, own, joined):
            yield Line(left[0], "-[hidden]->", into)
        if right and not _are_joined(own, right, joined):
            yield Line(out, "-[hidden]---->", right[0])
        yield from _guides(inner, joined)


def _are_joined(some: list[str], others: list[str], joined: set[frozenset[str]]) -> bool:
    return any(frozenset((one, other)) in joined for one in some for other in others)
