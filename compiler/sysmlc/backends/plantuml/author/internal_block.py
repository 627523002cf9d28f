"""Authors' internal block diagrams: parts in parts as they were drawn, ports, connectors."""

from collections.abc import Iterator
from dataclasses import dataclass, field

from sysmlc.backends.plantuml import internal_block, labels
from sysmlc.backends.plantuml.aliases import Aliases
from sysmlc.backends.plantuml.author.selection import Choice
from sysmlc.backends.plantuml.connections import Connection, Path, connections, free_flows
from sysmlc.backends.plantuml.layout import iter_port_guides
from sysmlc.backends.plantuml.views import InternalView, Line, PartView, PortView
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.ir.query import features, generals, type_of
from sysmlc.support.plantuml_text import keyword_label, label, lines, plain, small, stack

_Ids = tuple[str, ...]
_PORTS = (Kind.PORT,)
_PARTS = (Kind.PROPERTY, Kind.FLOW_PROPERTY)
_PORT_WIDTH = 24


def view(choice: Choice) -> InternalView:
    """What the author chose, in the frame of the block that the diagram is about."""
    return _Drawing(choice).view()


@dataclass(slots=True)
class _Drawing:
    """One internal block diagram in the making; ``paths`` lead to all parts and ports."""

    choice: Choice
    aliases: Aliases = field(default_factory=Aliases)
    paths: dict[_Ids, None] = field(default_factory=dict)
    used: list[Connection] = field(default_factory=list)
    """Connections that are drawn."""

    def view(self) -> InternalView:
        self.paths = paths(self.choice)
        about = self.choice.about
        frame = PartView(
            self.aliases.make("frame", about.name if about else "", "block"),
            " ",
            "frame",
            tuple(self._ports(())),
            tuple(self._parts(())),
        )
        drawn = tuple(self._lines())
        has_ports = any(self._is_port(path) for path in self.paths)
        domains = internal_block.domains_of(self.used)
        return InternalView(frame, drawn, has_ports, tuple(iter_port_guides(frame, drawn)), domains)

    # -- parts ---------------------------------------------------------------------------------

    def _element(self, path: _Ids) -> Element:
        return self.choice.graph[path[-1]]

    def _is_port(self, path: _Ids) -> bool:
        return self._element(path).kind in _PORTS

    def _below(self, path: _Ids) -> list[_Ids]:
        return [one for one in self.paths if one[:-1] == path]

    def _parts(self, path: _Ids) -> Iterator[PartView]:
        for one in self._below(path):
            if not self._is_port(one):
                yield self._part(one)

    def _part(self, path: _Ids) -> PartView:
        graph, part = self.choice.graph, self._element(path)
        words = (word for word in labels.applied(graph, part) if word not in _SAID)
        listed = list(self._listed(part))
        rows = [
            *internal_block.bold(labels.typed(graph, part)),
            *(_row(graph, one) for one in listed),
        ]
        return PartView(
            self._alias(path),
            stack([small(plain(labels.guillemets(words))), *rows]),
            "part" if part.attrs.get("aggregation") == "composite" else "reference",
            tuple(self._ports(path)),
            tuple(self._parts(path)),
            (part.id, *(one.id for one in listed)),
        )

    def _listed(self, part: Element) -> Iterator[Element]:
        """Features of the part's type that a compartment of the part names."""
        type_ = type_of(self.choice.graph, part)
        if type_ is not None and self.choice.listed:
            every = (*self.choice.graph.owned(type_), *features(self.choice.graph, type_))
            yield from dict.fromkeys(one for one in every if one.id in self.choice.listed)

    def _ports(self, path: _Ids) -> Iterator[PortView]:
        """Ports on the border, and ports of these ports."""
        for one in self._below(path):
            if self._is_port(one):
                yield self._port(one)
                yield from self._ports(one)

    def _port(self, path: _Ids) -> PortView:
        port = self._element(path)
        above = [one for one in path[:-1] if self.choice.graph[one].kind in _PORTS]
        named = [labels.name(self.choice.graph[id]) for id in (*above, port.id)]
        text = ".".join(named) if port.name.strip() else labels.typed(self.choice.graph, port)
        rows = (f"<back:#FFFFFF>{row}</back>" for row in lines(text, _PORT_WIDTH))
        form = internal_block.FORMS.get(str(port.attrs.get("direction", "")), "port")
        return PortView(self._alias(path), stack(rows), form, (port.id,))

    def _alias(self, path: _Ids) -> str:
        return self.aliases.make("\x1f".join(("part", *path)), self._element(path).name, "part")

    # -- lines ---------------------------------------------------------------------------------

    def _lines(self) -> Iterator[Line]:
        graph = self.choice.graph
        owners = [one.owner for one in self.choice.shown if one.kind in _CONNECTIONS]
        for id in dict.fromkeys(owners):
            owner = graph.get(id)
            if owner is not None:
                for prefix in self._places(owner):
                    yield from self._of(owner, prefix)
        for item in self.choice.shown:
            if item.kind is Kind.DEPENDENCY:
                yield from self._dependency(item)

    def _places(self, owner: Element) -> list[_Ids]:
        """Where the parts of a classifier are drawn: in the frame, or in parts of that type."""
        graph, about = self.choice.graph, self.choice.about
        in_frame = about is None or owner in (about, *generals(graph, about))
        typed = [path for path in self.paths if _is_typed(graph, self._element(path), owner)]
        return [(), *typed] if in_frame or not typed else typed

    def _of(self, owner: Element, prefix: _Ids) -> Iterator[Line]:
        graph = self.choice.graph
        for one in connections(graph, owner, free_flows(graph).get(owner.id, ())):
            if not self.choice.ids.isdisjoint(one.shows):
                source, target = self._end(prefix, one.source), self._end(prefix, one.target)
                if source and target:
                    self.used.append(one)
                    yield _line(source, target, one)

    def _end(self, prefix: _Ids, end: Path) -> str:
        """Alias of the end, or of the nearest thing around it that is drawn."""
        full = (*prefix, *end.ids())
        for length in range(len(full), len(prefix), -1):
            found = self._drawn(full[:length], prefix)
            if found is not None:
                return self._alias(found)
        return "" if prefix or end.parts else self.aliases["frame"]

    def _drawn(self, path: _Ids, prefix: _Ids) -> _Ids | None:
        """The path as it is drawn: parts may be left out, and stand for what inherits them."""
        if path in self.paths:
            return path
        ends = [one for one in self.paths if one[-1] == path[-1]]
        fitting = [one for one in ends if one[: len(prefix)] == prefix]
        through = [one for one in fitting if set(path) <= set(one)]
        return next(iter(through or fitting), None)

    def _dependency(self, item: Element) -> Iterator[Line]:
        graph = self.choice.graph
        text = keyword_label(labels.guillemets(labels.keywords(graph, item)))
        for client in graph.targets(item, Edge.CLIENT):
            for supplier in graph.targets(item, Edge.SUPPLIER):
                ends = [self._drawn((one.id,), ()) for one in (client, supplier)]
                if ends[0] is not None and ends[1] is not None:
                    source, target = map(self._alias, (ends[0], ends[1]))
                    yield Line(source, "..>", target, text, shows=(item.id,))


_SAID = frozenset(["partProperty", "referenceProperty"])
"""Stereotypes that every part has."""


def _row(graph: Graph, feature: Element) -> str:
    return stack(map(small, lines(labels.feature(graph, feature))))


_CONNECTIONS = (Kind.CONNECTOR, Kind.ITEM_FLOW)


def _line(source: str, target: str, one: Connection) -> Line:
    near, far = label(one.near), label(one.far)
    return Line(source, one.arrow, target, one.text(), near, far, one.shows)


def _is_typed(graph: Graph, part: Element, classifier: Element) -> bool:
    type_ = type_of(graph, part)
    return type_ is not None and classifier in (type_, *generals(graph, type_))


# -- nesting -----------------------------------------------------------------------------------


def paths(choice: Choice) -> dict[_Ids, None]:
    """A path to each part and port: as it is drawn, else as the types of the parts say."""
    graph = choice.graph
    every = (one for one in choice.shown if one.id not in choice.listed)
    wanted = [one for one in every if one.kind in (*_PARTS, *_PORTS)]
    drawn = [_inside(graph, path) for path in choice.nesting]
    deeper = {path[-1] for path in drawn if len(path) > 1}
    found: dict[_Ids, None] = {(one.id,): None for one in wanted if one.id not in deeper}
    if not choice.nesting:
        found = _by_type(graph, wanted)
    for path in drawn:
        for length in range(1, len(path) + 1):
            found[path[:length]] = None
    return found


def _inside(graph: Graph, path: _Ids) -> _Ids:
    """The parts and ports on a path; tools draw them inside the block's own box."""
    return tuple(id for id in path if graph[id].kind in (*_PARTS, *_PORTS))


def _by_type(graph: Graph, wanted: list[Element]) -> dict[_Ids, None]:
    """Each below the parts whose type has it as a feature, else in the frame."""
    holders = {one.id: _holders(graph, one, wanted) for one in wanted}
    found: dict[_Ids, None] = {(one.id,): None for one in wanted if not holders[one.id]}
    level = list(found)
    while level:
        level = [
            (*path, one.id)
            for path in level
            for one in wanted
            if path[-1] in holders[one.id] and one.id not in path
        ]
        found |= dict.fromkeys(level)
    return found


def _holders(graph: Graph, feature: Element, wanted: list[Element]) -> list[str]:
    def has(part: Element) -> bool:
        type_ = type_of(graph, part)
        return type_ is not None and feature in (*graph.owned(type_), *features(graph, type_))

    return [part.id for part in wanted if part is not feature and has(part)]
