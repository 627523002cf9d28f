"""What an element says, as facts that can be compared one by one."""

from collections.abc import Callable, Iterator
from typing import NamedTuple

from sysmlc.ir.compare.change import What
from sysmlc.ir.compare.content import ENDS, NOT_CONTENT, TYPES, WIRES, WORDS
from sysmlc.ir.compare.plants import declared, is_own_class, is_part_instance
from sysmlc.ir.compare.side import Side
from sysmlc.ir.compare.titles import dotted, relation, shown, steps, stereotype, told
from sysmlc.ir.element import AttrValue, Element
from sysmlc.ir.kinds import Edge, Kind

FROM_TO = ("from", "to")
BETWEEN = ("between",)
"""Keys of the ends of a relation, with and without an order."""

Value = object
"""A scalar, an Element, or a tuple of values."""


class Fact(NamedTuple):
    """One thing that an element says: under which key, what, and how both are told.

    The text is made only when it is asked for: nearly all facts are equal on both sides.
    """

    key: tuple[Value, ...]
    value: Value
    label: str
    what: What = What.CHANGED
    tell: Callable[[Side, Element], str] | None = None
    about: Element | None = None

    def text(self, side: Side) -> str:
        """The value for the reader."""
        if self.tell is None or self.about is None:
            return shown(side, self.value)
        return self.tell(side, self.about)


def facts(side: Side, element: Element) -> Iterator[Fact]:
    """Everything that the element says, with what its details say of it."""
    if element.attrs:
        yield from _attributes(side, element)
    if element.id in side.out:
        yield from _edges(side, element, side.out[element.id])
    if element.id in side.details:
        yield from _said_by_details(side, element, side.details[element.id])


def _attributes(side: Side, element: Element) -> Iterator[Fact]:
    for name, raw in element.attrs.items():
        if name not in NOT_CONTENT and raw is not None:
            what = What.RETYPED if name == "role" else What.CHANGED
            yield Fact((name,), _resolved(side, name, raw), name.replace("_", " "), what)


def _resolved(side: Side, name: str, raw: AttrValue) -> Value:
    """The value, with elements for their ids."""
    if isinstance(raw, tuple):
        return tuple(_resolved(side, name, part) for part in raw)
    if name in WORDS or not isinstance(raw, str):
        return raw
    return side.graph.get(raw) or raw


def _edges(side: Side, element: Element, edges: dict[Edge, list[Element]]) -> Iterator[Fact]:
    for edge, targets in edges.items():
        if edge in ENDS or (edge is Edge.REPRESENTS and is_part_instance(element)):
            continue
        if edge is Edge.SPECIALIZES and is_own_class(element):
            continue
        if edge is Edge.PATH:
            yield Fact((edge,), tuple(targets), str(edge), What.REWIRED, dotted, element)
            continue
        for one in targets:
            if one.id not in side.hidden or one.owner != element.id:
                value = declared(side, one) if edge in _LABELS else one
                yield Fact((edge,), value, _LABELS.get(edge, str(edge)), _kind(edge))
    if not edges.keys().isdisjoint(ENDS):
        ends = tuple(tuple(edges.get(edge, ())) for edge in ENDS)
        yield Fact(FROM_TO, ends, "ends", What.REWIRED, relation, element)


_LABELS = {Edge.TYPED_BY: "type", Edge.INSTANCE_OF: "type"}


def _kind(edge: Edge) -> What:
    if edge in TYPES:
        return What.RETYPED
    return What.REWIRED if edge in WIRES else What.CHANGED


# -- details -----------------------------------------------------------------------------------


def _said_by_details(side: Side, element: Element, details: list[Element]) -> Iterator[Fact]:
    for detail in details:
        if detail.kind is not Kind.CONNECTOR_END:
            yield from _DETAILS.get(detail.kind, _plain)(side, detail)
    ends = tuple(_end(side, one) for one in details if one.kind is Kind.CONNECTOR_END)
    if ends:
        yield Fact(BETWEEN, ends, "ends", What.REWIRED, relation, element)


def _end(side: Side, end: Element) -> Value:
    types = side.out.get(end.id, {}).get(Edge.TYPED_BY, ())
    return (tuple(steps(side, end)), tuple(types), _given(side, end))


def _given(side: Side, detail: Element) -> tuple[Value, ...]:
    """The attributes of a detail, sorted by name."""
    given = sorted((n, v) for n, v in detail.attrs.items() if n not in NOT_CONTENT)
    return tuple((name, _resolved(side, name, value)) for name, value in given)


def _slot(side: Side, slot: Element) -> Iterator[Fact]:
    """A value of an instance, under the feature that has it."""
    edges = side.out.get(slot.id, {})
    feature: Value = next(iter(edges.get(Edge.INSTANCE_OF, ())), slot.name)
    label = f"value of {slot.name or shown(side, feature)}"
    for key, raw in slot.attrs.items():
        if key not in NOT_CONTENT:
            inner = key.removeprefix("value")
            yield Fact(("value", feature, key), _resolved(side, key, raw), label + inner)
    for one in edges.get(Edge.REFERENCES, ()):
        yield Fact(("value", feature, "of"), one, label)
    for one in side.graph.owned(slot):
        yield Fact(("value", feature, "in"), _content(side, one), label, tell=told, about=one)


def _application(side: Side, application: Element) -> Iterator[Fact]:
    """The stereotype, and each of its tags; tools differ in the case of the first letter."""
    name = str(application.attrs.get("stereotype", "")) or application.name
    yield Fact(("stereotype",), name, "stereotype", What.RETYPED, stereotype, application)
    for key, raw in application.attrs.items():
        if key.startswith("tag."):
            tag = key[4:5].lower() + key[5:]
            yield Fact(("tag", name, tag), _resolved(side, key, raw), f"«{name}» {tag}")


def _plain(side: Side, detail: Element) -> Iterator[Fact]:
    key = detail.name if detail.kind is Kind.METADATA else ""
    label = key or _words(detail)
    if detail.name and not key:
        yield Fact((detail.kind, "name"), detail.name, f"{label} name")
    yield Fact((detail.kind, key), _content(side, detail), label, tell=told, about=detail)


def _words(detail: Element) -> str:
    return "".join(f" {c.lower()}" if c.isupper() else c for c in detail.kind).strip()


def _content(side: Side, detail: Element) -> Value:
    """Everything that a detail and all below it say, whatever their kinds."""
    inside = list(side.graph.subtree(detail))
    return tuple((one.name if one is not detail else "", *_alone(side, one)) for one in inside)


def _alone(side: Side, detail: Element) -> tuple[Value, ...]:
    edges = side.out.get(detail.id, {})
    targets = tuple((edge, *_others(found, detail)) for edge, found in edges.items())
    return (detail.kind, len(side.graph.owned(detail)), _given(side, detail), targets)


def _others(targets: list[Element], detail: Element) -> list[Value]:
    """Where a detail leads, with a word for its own owner."""
    return ["owner" if one.id == detail.owner else one for one in targets]


_DETAILS: dict[Kind, Callable[[Side, Element], Iterator[Fact]]] = {
    Kind.SLOT: _slot,
    Kind.APPLICATION: _application,
}
