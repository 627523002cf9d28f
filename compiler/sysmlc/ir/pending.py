"""What front ends store beside the graph: references to resolve, and what authors wrote."""

from collections.abc import Callable, Iterable, Mapping
from functools import cached_property
from typing import NamedTuple

from msgspec import Struct

from sysmlc.ir.kinds import Edge, Kind


class Reference(NamedTuple):
    """An edge to an element that the front end has not found.

    ``target`` is an id of the graph, or an ``href`` (``file#id``) into another file. ``kind`` and
    ``name`` describe an external target as far as the source does; the external stub takes them
    when the file is not part of the compile unit. ``ordinal`` is the position of the reference in
    its file, -1 for the position of its source.
    """

    edge: Edge
    source: str
    target: str
    kind: Kind = Kind.CLASS
    name: str = ""
    ordinal: int = -1


class TextFile(NamedTuple):
    """A file whose elements follow the rules of SysML v2 where those of UML differ."""

    path: str


class Drawing(Struct, frozen=True):
    """A diagram as its author drew it, which the pass ``views`` turns into a View element.

    All references are ids of ``file`` or hrefs, as the tool wrote them. ``type`` is the type of the
    diagram in the tool's words, ``diagram`` in those of docs/ir.md. ``source`` and ``ordinal`` are
    the position of the diagram. ``paths`` are nested elements, outermost first. ``listed`` are
    elements that the diagram shows only in a compartment of another element. ``relations`` are
    lines for edges of the graph, which have no element of their own.
    """

    id: str
    name: str
    type: str
    diagram: str
    file: str
    source: str
    ordinal: int
    owner: str = ""
    context: str = ""
    shown: tuple[str, ...] = ()
    paths: tuple[tuple[str, ...], ...] = ()
    listed: tuple[str, ...] = ()
    relations: tuple[tuple[Edge, str, str], ...] = ()


class Statement(NamedTuple):
    """A part of an element's declaration, such as its keyword or a feature that it subsets.

    ``element`` is the id of the element, ``aspect`` the name of the part. ``words`` are texts, and
    ids of elements in place of their names.
    """

    element: str
    aspect: str
    words: tuple[str, ...]


class Declarations:
    """How the authors of texts in SysML v2 declared the elements, for the comparison of texts.

    ``read`` returns the statements; it is called at most once, and only by a comparison.
    """

    def __init__(self, read: Callable[[], Iterable[Statement]]) -> None:
        self._read = read

    @cached_property
    def statements(self) -> Mapping[str, list[Statement]]:
        """The statements by the id of their element."""
        index: dict[str, list[Statement]] = {}
        for statement in self._read():
            index.setdefault(statement.element, []).append(statement)
        return index
