"""Internal block diagrams of authors: parts nested as the author drew them, ports, connectors."""

from collections.abc import Iterator
from dataclasses import dataclass, field

from sysmlc.backends.plantuml import internal_block, labels
from sysmlc.backends.plantuml.author_selection import Selection
from sysmlc.backends.plantuml.connections import Connection, Path, find_free_flows, list_connections
from sysmlc.backends.plantuml.layout import iter_port_guides
from sysmlc.backends.plantuml.views import Aliases, InternalView, Line, PartView, PortView
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.ir.query import features, generals, type_of
from sysmlc.support.plantuml_text import (
    escape_line,
    format_keyword_label,
    join_rows,
    shrink,
    wrap_lines,
)

_Ids = tuple[str, ...]
_PORTS = (Kind.PORT,)
_PARTS = (Kind.PROPERTY, Kind.FLOW_PROPERTY)
_PORT_WIDTH = 24
_IMPLIED_STEREOTYPES = frozenset(["partProperty", "referenceProperty"])
"""Stereotypes that tools apply to every part; the border already shows the difference."""
_CONNECTIONS = (Kind.CONNECTOR, Kind.ITEM_FLOW)


def build_view(selection: Selection) -> InternalView:
    """Return the view of the selected elements in the frame of the block."""
    return _AuthorDrawing(selection).build()


@dataclass(slots=True)
class _AuthorDrawing:
    """Builder of the view of one internal block diagram.

    ``paths`` has the path of ids to each part and port, as an ordered set.
    """

    selection: Selection
    aliases: Aliases = field(default_factory=Aliases)
    paths: dict[_Ids, None] = field(default_factory=dict)
    used: list[Connection] = field(default_factory=list)
    """Connections that are drawn."""

    def build(self) -> InternalView:
        self.paths = _find_paths(self.selection)
        about = self.selection.about
        frame = PartView(
            self.aliases.make("frame", about.name if about else "", "block"),
            " ",
            "frame",
            tuple(self._iter_ports(())),
            tuple(self._iter_parts(())),
        )
        lines = tuple(self._iter_lines())
        has_ports = any(self._is_port(path) for path in self.paths)
        domains = internal_block.domains_of(self.used)
        return InternalView(frame, lines, has_ports, tuple(iter_port_guides(frame, lines)), domains)

    # -- parts ---------------------------------------------------------------------------------

    def _find_element(self, path: _Ids) -> Element:
        return self.selection.graph[path[-1]]

    def _is_port(self, path: _Ids) -> bool:
        return self._find_element(path).kind in _PORTS

    def _list_below(self, path: _Ids) -> list[_Ids]:
        return [candidate for candidate in self.paths if candidate[:-1] == path]

    def _iter_parts(self, path: _Ids) -> Iterator[PartView]:
        for inner in self._list_below(path):
            if not self._is_port(inner):
                yield self._make_part(inner)

    def _make_part(self, path: _Ids) -> PartView:
        graph, part = self.selection.graph, self._find_element(path)
        words = (
            word
            for word in labels.list_stereotypes(graph, part)
            if word not in _IMPLIED_STEREOTYPES
        )
        features = list(self._iter_listed_features(part))
        rows = [
            *internal_block.embolden(labels.format_typed(graph, part)),
            *(_format_row(graph, feature) for feature in features),
        ]
        return PartView(
            self._make_alias(path),
            join_rows([shrink(escape_line(labels.guillemets(words))), *rows]),
            "part" if part.attrs.get("aggregation") == "composite" else "reference",
            tuple(self._iter_ports(path)),
            tuple(self._iter_parts(path)),
            (part.id, *(feature.id for feature in features)),
        )

    def _iter_listed_features(self, part: Element) -> Iterator[Element]:
        """Yield the features of the part's type that a compartment of the part lists."""
        type_ = type_of(self.selection.graph, part)
        if type_ is not None and self.selection.listed:
            candidates = (
                *self.selection.graph.owned(type_),
                *features(self.selection.graph, type_),
            )
            yield from dict.fromkeys(
                feature for feature in candidates if feature.id in self.selection.listed
            )

    def _iter_ports(self, path: _Ids) -> Iterator[PortView]:
        """Yield the ports on the border, and the ports nested in these."""
        for inner in self._list_below(path):
            if self._is_port(inner):
                yield self._make_port(inner)
                yield from self._iter_ports(inner)

    def _make_port(self, path: _Ids) -> PortView:
        port = self._find_element(path)
        outer = [id for id in path[:-1] if self.selection.graph[id].kind in _PORTS]
        names = [labels.name(self.selection.graph[id]) for id in (*outer, port.id)]
        text = (
            ".".join(names)
            if port.name.strip()
            else labels.format_typed(self.selection.graph, port)
        )
        rows = (f"<back:#FFFFFF>{row}</back>" for row in wrap_lines(text, _PORT_WIDTH))
        form = internal_block.FORMS.get(str(port.attrs.get("direction", "")), "port")
        return PortView(self._make_alias(path), join_rows(rows), form, (port.id,))

    def _make_alias(self, path: _Ids) -> str:
        return self.aliases.make(
            "\x1f".join(("part", *path)), self._find_element(path).name, "part"
        )

    # -- lines ---------------------------------------------------------------------------------

    def _iter_lines(self) -> Iterator[Line]:
        graph = self.selection.graph
        owners = [element.owner for element in self.selection.shown if element.kind in _CONNECTIONS]
        for id in dict.fromkeys(owners):
            owner = graph.get(id)
            if owner is not None:
                for prefix in self._list_prefixes(owner):
                    yield from self._iter_connection_lines(owner, prefix)
        for item in self.selection.shown:
            if item.kind is Kind.DEPENDENCY:
                yield from self._iter_dependency_lines(item)

    def _list_prefixes(self, owner: Element) -> list[_Ids]:
        """Return the paths to the places where the parts of a classifier are drawn.

        These are the frame, and the parts that are typed by the classifier.
        """
        graph, about = self.selection.graph, self.selection.about
        in_frame = about is None or owner in (about, *generals(graph, about))
        typed = [path for path in self.paths if _is_typed(graph, self._find_element(path), owner)]
        return [(), *typed] if in_frame or not typed else typed

    def _iter_connection_lines(self, owner: Element, prefix: _Ids) -> Iterator[Line]:
        graph = self.selection.graph
        for connection in list_connections(graph, owner, find_free_flows(graph).get(owner.id, ())):
            if not self.selection.ids.isdisjoint(connection.shows):
                source = self._find_end_alias(prefix, connection.source)
                target = self._find_end_alias(prefix, connection.target)
                if source and target:
                    self.used.append(connection)
                    yield internal_block.make_line(source, target, connection)

    def _find_end_alias(self, prefix: _Ids, end: Path) -> str:
        """Return the alias of the end, or of the innermost drawn part or port that contains it."""
        full = (*prefix, *end.ids())
        for length in range(len(full), len(prefix), -1):
            drawn = self._find_drawn_path(full[:length], prefix)
            if drawn is not None:
                return self._make_alias(drawn)
        return "" if prefix or end.parts else self.aliases["frame"]

    def _find_drawn_path(self, path: _Ids, prefix: _Ids) -> _Ids | None:
        """Return the drawn path to the last element of *path*, or None if it is not drawn.

        The author may have omitted parts between the frame and the element.
        """
        if path in self.paths:
            return path
        ends = [candidate for candidate in self.paths if candidate[-1] == path[-1]]
        fitting = [candidate for candidate in ends if candidate[: len(prefix)] == prefix]
        through = [candidate for candidate in fitting if set(path) <= set(candidate)]
        return next(iter(through or fitting), None)

    def _iter_dependency_lines(self, item: Element) -> Iterator[Line]:
        graph = self.selection.graph
        text = format_keyword_label(labels.guillemets(labels.keywords(graph, item)))
        for client in graph.targets(item, Edge.CLIENT):
            for supplier in graph.targets(item, Edge.SUPPLIER):
                source = self._find_drawn_path((client.id,), ())
                target = self._find_drawn_path((supplier.id,), ())
                if source is not None and target is not None:
                    ends = (self._make_alias(source), "..>", self._make_alias(target))
                    yield Line(*ends, text, shows=(item.id,))


def _format_row(graph: Graph, feature: Element) -> str:
    return join_rows(map(shrink, wrap_lines(labels.feature(graph, feature))))


def _is_typed(graph: Graph, part: Element, classifier: Element) -> bool:
    type_ = type_of(graph, part)
    return type_ is not None and classifier in (type_, *generals(graph, type_))


# -- nesting -----------------------------------------------------------------------------------


def _find_paths(selection: Selection) -> dict[_Ids, None]:
    """Return a path to each part and port.

    The path follows the nesting of the shapes. If the tool stores no nesting, it follows the types
    of the parts.
    """
    graph = selection.graph
    candidates = (element for element in selection.shown if element.id not in selection.listed)
    drawables = [element for element in candidates if element.kind in (*_PARTS, *_PORTS)]
    # Tools draw parts and ports inside the box of the block itself.
    drawn = [
        tuple(id for id in path if graph[id].kind in (*_PARTS, *_PORTS))
        for path in selection.nesting
    ]
    deeper = {path[-1] for path in drawn if len(path) > 1}
    if not selection.nesting:
        return _nest_by_type(graph, drawables)
    paths: dict[_Ids, None] = {
        (element.id,): None for element in drawables if element.id not in deeper
    }
    for path in drawn:
        for length in range(1, len(path) + 1):
            paths[path[:length]] = None
    return paths


def _nest_by_type(graph: Graph, elements: list[Element]) -> dict[_Ids, None]:
    """Nest each element in all parts whose types have it as a feature, else in the frame."""
    holders = {element.id: _find_holders(graph, element, elements) for element in elements}
    paths: dict[_Ids, None] = {
        (element.id,): None for element in elements if not holders[element.id]
    }
    level = list(paths)
    while level:
        level = [
            (*path, element.id)
            for path in level
            for element in elements
            # A block may contain itself through its parts; no path has an element twice.
            if path[-1] in holders[element.id] and element.id not in path
        ]
        paths |= dict.fromkeys(level)
    return paths


def _find_holders(graph: Graph, feature: Element, parts: list[Element]) -> list[str]:
    def has(part: Element) -> bool:
        type_ = type_of(graph, part)
        return type_ is not None and feature in (*graph.owned(type_), *features(graph, type_))

    return [part.id for part in parts if part is not feature and has(part)]
