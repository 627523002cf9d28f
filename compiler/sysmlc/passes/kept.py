"""Pass ``kept``: a plant that was saved as UML gets back what UML has no words for."""

import json
from collections.abc import Iterable, Iterator
from typing import Any, ClassVar, NamedTuple

from msgspec import Struct

from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.ir import AttrValue, Edge, Element, Graph, Kind
from sysmlc.ir.round_trip import PREFIX

UNREADABLE = rule(
    "SM189",
    "kept-comment",
    Severity.WARNING,
    "the comment that keeps what UML cannot say was changed: it is not used",
    help="restore the comment, or remove it and save the plant again",
)


class _Kept(NamedTuple):
    """An element that is not in the model; ``href`` is where references to it lead outside."""

    id: str
    kind: Kind
    name: str
    owner: str | None
    href: str | None


class _Record(Struct, frozen=True):
    """What the comment says (metamodels/sysmlc-kept.schema.json)."""

    elements: list[_Kept]
    attributes: dict[str, dict[str, AttrValue]]
    names: dict[str, str]
    owners: dict[str, str | None]
    edges: list[tuple[Edge, str, str]]
    made: list[str]
    applied: list[str]


class Kept(Struct, frozen=True):
    """Restores what back end ``uml`` kept; what is no longer in the model is passed over."""

    name: ClassVar[str] = "kept"
    after: ClassVar[tuple[str, ...]] = ("resolve",)

    def run(self, graph: Graph, sink: Sink) -> None:
        """Restore and remove the comment."""
        for comment in graph.of_kind(Kind.COMMENT):
            # Whether a text begins so is no secret: one that does is never watched.
            body = dict.get(comment.attrs, "body")
            if isinstance(body, str) and body.startswith(PREFIX):
                try:
                    record = _read(json.loads(body.removeprefix(PREFIX)))
                except (ValueError, TypeError, KeyError, AttributeError):
                    sink.report(UNREADABLE, graph.subject(comment))
                else:
                    graph.remove(comment)
                    _restore(graph, record)


# -- reading -----------------------------------------------------------------------------------


def _read(given: Any) -> _Record:  # noqa: ANN401 - JSON
    """Raises ValueError, TypeError, KeyError or AttributeError for a damaged record."""
    return _Record(
        elements=[
            _Kept(_text(id), Kind(kind), _text(name), _maybe(owner), _maybe(href))
            for id, kind, name, owner, href in given["elements"]
        ],
        attributes={
            id: {_text(name): _value(value) for name, value in attrs.items()}
            for id, attrs in given["attributes"].items()
        },
        names={id: _text(name) for id, name in given["names"].items()},
        owners={id: _maybe(owner) for id, owner in given["owners"].items()},
        edges=[(Edge(edge), _text(a), _text(b)) for edge, a, b in given["edges"]],
        made=[_text(id) for id in given["made"]],
        applied=[_text(id) for id in given["applied"]],
    )


def _text(value: object) -> str:
    if isinstance(value, str):
        return value
    raise TypeError(value)


def _maybe(value: object) -> str | None:
    return None if value is None else _text(value)


def _value(value: object) -> AttrValue:
    if isinstance(value, list):
        return tuple(_value(one) for one in value)
    if value is None or isinstance(value, str | int | float):
        return value
    raise TypeError(value)


# -- restoring ---------------------------------------------------------------------------------


def _restore(graph: Graph, record: _Record) -> None:
    for one in _found(graph, record.made):
        graph.remove(one)
    _forget_profiles(graph, record.applied)
    _add(graph, record.elements)
    for one in _found(graph, record.attributes):
        graph.set(one, **record.attributes[one.id])
    for one in _found(graph, record.names):
        graph.rename(one, record.names[one.id])
    _move(graph, record.owners)
    _redirect(graph, record.elements)
    _connect(graph, record.edges)


def _found(graph: Graph, ids: Iterable[str]) -> Iterator[Element]:
    return (one for id in ids if (one := graph.get(id)) is not None)


def _add(graph: Graph, elements: list[_Kept]) -> None:
    for one in elements:
        if one.id and one.id not in graph and (one.owner is None or one.owner in graph):
            graph.add(Element(one.id, one.kind, one.name, one.owner))


def _move(graph: Graph, owners: dict[str, str | None]) -> None:
    for id, owner in owners.items():
        one, above = graph.get(id), graph.get(owner)
        if one is None or (owner is not None and above is None):
            continue
        if above is None or one not in (above, *graph.ancestors(above)):
            graph.move(one, above)


def _redirect(graph: Graph, elements: list[_Kept]) -> None:
    """Let what refers to a library element outside refer to the element that is restored."""
    own = {kept.id for kept in elements}
    outside = [one for one in graph if "href" in one.attrs and one.id not in own]
    stubs = {str(one.attrs["href"]): one for one in outside}
    for kept in elements:
        stub, new = stubs.get(kept.href or ""), graph.get(kept.id)
        if stub is None or new is None or stub.id not in graph:
            continue
        for edge in Edge:
            for source in graph.sources(stub, edge) if edge is not Edge.OWNS else ():
                targets = [new if one is stub else one for one in graph.targets(source, edge)]
                graph.replace_targets(edge, source, targets)
        if not graph.owned(stub):
            graph.remove(stub)


def _connect(graph: Graph, edges: list[tuple[Edge, str, str]]) -> None:
    """Draw the relations, in their order where the model has no others."""
    wanted: dict[tuple[Edge, str], list[Element]] = {}
    for edge, source, target in edges:
        if source in graph and target in graph and edge is not Edge.OWNS:
            wanted.setdefault((edge, source), []).append(graph[target])
    for (edge, source), targets in wanted.items():
        known = graph.targets(graph[source], edge)
        others = [one for one in known if one not in targets]
        graph.replace_targets(edge, graph[source], [*others, *targets])


def _forget_profiles(graph: Graph, packages: list[str]) -> None:
    """Take off the profiles that were applied for roles that are restored."""
    profiles: dict[str, Element] = {}
    for package in _found(graph, packages):
        for profile in graph.targets(package, Edge.APPLIES):
            profiles[profile.id] = profile
            graph.disconnect(Edge.APPLIES, package, profile)
    for profile in profiles.values():
        for one in (profile, *graph.ancestors(profile)):
            if one.id in graph and not graph.owned(one) and one.attrs.get("external"):
                graph.remove(one)
