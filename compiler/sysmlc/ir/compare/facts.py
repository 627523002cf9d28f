"""Facts about elements, which a comparison compares one by one, and the reported changes."""

import re
from collections.abc import Callable, Iterator
from enum import StrEnum
from functools import partial
from typing import NamedTuple

from msgspec import Struct

from sysmlc.ir.compare.content import DECLARATION, ENDS, NOT_CONTENT, TYPES, WIRES, WORDS
from sysmlc.ir.compare.side import Side, declared_class, is_own_class, is_part_instance
from sysmlc.ir.compare.titles import (
    format_detail,
    format_ends,
    format_path,
    format_stereotype,
    format_value,
    path_of_end,
    separate_words,
    title,
)
from sysmlc.ir.element import AttrValue, Element
from sysmlc.ir.kinds import Edge, Kind
from sysmlc.ir.query.names import spell_for_xml


class What(StrEnum):
    """Kind of change of an element."""

    ADDED = "added"
    REMOVED = "removed"
    RENAMED = "renamed"
    RETYPED = "retyped"
    REWIRED = "rewired"
    MOVED = "moved"
    REORDERED = "reordered"
    CHANGED = "changed"


class Ref(Struct, frozen=True):
    """A reference to an element of one of the models: id, qualified name and position."""

    id: str
    qualified_name: str
    file: str = ""
    ordinal: int = -1


class Change(Struct, frozen=True):
    """One difference of the element ``name``, whose owner has the qualified name ``owner``.

    ``kind`` is the role or kind of the element in words, ``aspect`` the attribute or relation that
    differs; ``before`` and ``after`` are texts, empty for an absent value. ``contents`` is the
    number of elements below an added or removed element. ``old`` or ``new`` is None when only one
    model has the element.
    """

    what: What
    owner: str
    name: str
    kind: str
    aspect: str = ""
    before: str = ""
    after: str = ""
    contents: int = 0
    old: Ref | None = None
    new: Ref | None = None


# -- facts -------------------------------------------------------------------------------------

FROM_TO = ("from", "to")
BETWEEN = ("between",)
"""Keys of the ends of a relation, with and without an order."""
_NO_SPACE = re.compile(r" (;|::\*|\)|])| (\.) |(\() ")
"""Words of declarations without blanks around them."""
_LABELS = {Edge.TYPED_BY: "type", Edge.INSTANCE_OF: "type"}

Value = object
"""A scalar, an Element, or a tuple of values."""


class Fact(NamedTuple):
    """A value of an element under a key, and how a difference of it is reported.

    ``format`` returns the text of the value, from the element ``about``. It is called only for
    facts that differ, because nearly all facts are equal on both sides.
    """

    key: tuple[Value, ...]
    value: Value
    label: str
    what: What = What.CHANGED
    format: Callable[[Side, Element], str] | None = None
    about: Element | None = None

    def text(self, side: Side) -> str:
        """Return the value as a text for people."""
        if self.format is None or self.about is None:
            return format_value(side, self.value)
        return self.format(side, self.about)


def iter_facts(side: Side, element: Element) -> Iterator[Fact]:
    """Iterate over the facts about an element, those of its details included."""
    if element.attrs:
        yield from _attribute_facts(side, element)
    if element.id in side.edges:
        yield from _edge_facts(side, element, side.edges[element.id])
    if element.id in side.details:
        yield from _detail_facts(side, element, side.details[element.id])


def _attribute_facts(side: Side, element: Element) -> Iterator[Fact]:
    for name, value in element.attrs.items():
        if name not in NOT_CONTENT and value is not None:
            what = What.RETYPED if name == "role" else What.CHANGED
            yield Fact((name,), _resolve_ids(side, name, value), name.replace("_", " "), what)


def _resolve_ids(side: Side, name: str, value: AttrValue) -> Value:
    """Return the value of the attribute *name* with elements in place of their ids."""
    if isinstance(value, tuple):
        return tuple(_resolve_ids(side, name, item) for item in value)
    if name in WORDS or not isinstance(value, str):
        return value
    return side.find_by_id(value) or value


def _edge_facts(side: Side, element: Element, edges: dict[Edge, list[Element]]) -> Iterator[Fact]:
    for edge, targets in edges.items():
        if edge in ENDS or (edge is Edge.REPRESENTS and is_part_instance(element)):
            continue
        if edge is Edge.SPECIALIZES and is_own_class(element):
            continue
        if edge is Edge.PATH:
            yield Fact((edge,), tuple(targets), str(edge), What.REWIRED, format_path, element)
            continue
        for target in targets:
            if target.id not in side.hidden or target.owner != element.id:
                value = declared_class(side, target) if edge in _LABELS else target
                yield Fact((edge,), value, _LABELS.get(edge, str(edge)), _classify(edge))
    if not edges.keys().isdisjoint(ENDS):
        ends = tuple(tuple(edges.get(edge, ())) for edge in ENDS)
        yield Fact(FROM_TO, ends, "ends", What.REWIRED, format_ends, element)


def _classify(edge: Edge) -> What:
    if edge in TYPES:
        return What.RETYPED
    return What.REWIRED if edge in WIRES else What.CHANGED


# -- declarations ------------------------------------------------------------------------------


def iter_statements(side: Side, element: Element) -> Iterator[Fact]:
    """Iterate over the parts of an element's declaration in SysML v2, as facts."""
    for _, aspect, words in side.statements.get(element.id, ()):
        value = tuple(side.graph.get(word) or word for word in words)
        format = partial(_format_words, value)
        yield Fact((DECLARATION, aspect), value, aspect, format=format, about=element)


def _format_words(words: tuple[Element | str, ...], side: Side, _element: Element) -> str:
    texts = [word if isinstance(word, str) else title(side, word) for word in words]
    return _NO_SPACE.sub(r"\1\2\3", " ".join(text for text in texts if text))


# -- details -----------------------------------------------------------------------------------


def _detail_facts(side: Side, element: Element, details: list[Element]) -> Iterator[Fact]:
    for detail in details:
        if detail.kind is not Kind.CONNECTOR_END:
            yield from _DETAILS.get(detail.kind, _general_facts)(side, detail)
    ends = tuple(_end_value(side, d) for d in details if d.kind is Kind.CONNECTOR_END)
    if ends:
        yield Fact(BETWEEN, ends, "ends", What.REWIRED, format_ends, element)


def _end_value(side: Side, end: Element) -> Value:
    types = side.edges.get(end.id, {}).get(Edge.TYPED_BY, ())
    return (tuple(path_of_end(side, end)), tuple(types), _sorted_attributes(side, end))


def _sorted_attributes(side: Side, detail: Element) -> tuple[Value, ...]:
    attributes = sorted((n, v) for n, v in detail.attrs.items() if n not in NOT_CONTENT)
    return tuple((name, _resolve_ids(side, name, value)) for name, value in attributes)


def _slot_facts(side: Side, slot: Element) -> Iterator[Fact]:
    """Iterate over the values of a slot, under the feature that the slot gives values to."""
    edges = side.edges.get(slot.id, {})
    feature: Value = next(iter(edges.get(Edge.INSTANCE_OF, ())), slot.name)
    label = f"value of {slot.name or format_value(side, feature)}"
    for name, value in slot.attrs.items():
        if name not in NOT_CONTENT:
            suffix = name.removeprefix("value")
            resolved = _resolve_ids(side, name, value)
            yield Fact(("value", feature, name), resolved, label + suffix.replace("_", " "))
    for target in edges.get(Edge.REFERENCES, ()):
        yield Fact(("value", feature, "of"), target, label)
    for nested in side.graph.owned(slot):
        content = _content(side, nested)
        yield Fact(("value", feature, "in"), content, label, format=format_detail, about=nested)


def _application_facts(side: Side, application: Element) -> Iterator[Fact]:
    """Iterate over the stereotype and its tags.

    Tools differ in the case of the first letter, and XML files without the profile have only the
    names of XML tags, without blanks and other special characters.
    """
    name = spell_for_xml(str(application.attrs.get("stereotype", "")) or application.name)
    what = What.RETYPED
    yield Fact(("stereotype",), name, "stereotype", what, format_stereotype, application)
    for key, value in application.attrs.items():
        if key.startswith("tag."):
            tag = spell_for_xml(key[4:5].lower() + key[5:])
            yield Fact(("tag", name, tag), _resolve_ids(side, key, value), f"«{name}» {tag}")


def _general_facts(side: Side, detail: Element) -> Iterator[Fact]:
    key = detail.name if detail.kind is Kind.METADATA else ""
    label = key or separate_words(detail.kind)
    if detail.name and not key:
        yield Fact((detail.kind, "name"), detail.name, f"{label} name")
    content = _content(side, detail)
    yield Fact((detail.kind, key), content, label, format=format_detail, about=detail)


def _content(side: Side, detail: Element) -> Value:
    """Return the content of a detail and its subtree, for all kinds of details."""
    return tuple(
        (element.name if element is not detail else "", *_own_content(side, element))
        for element in side.graph.subtree(detail)
    )


def _own_content(side: Side, detail: Element) -> tuple[Value, ...]:
    edges = side.edges.get(detail.id, {})
    targets = tuple(
        (edge, *_abstract_owner(found, detail))
        for edge, found in edges.items()
        if not _is_about_owner(detail, edge, found)
    )
    size = len(side.graph.owned(detail))
    return (detail.kind, size, _sorted_attributes(side, detail), targets)


def _is_about_owner(detail: Element, edge: Edge, targets: list[Element]) -> bool:
    """Whether the edge only states that a comment is about its owner, as is every other detail.

    SysML v1 and AutomationML have comments without an annotated element, SysML v2 has none.
    """
    is_comment = detail.kind is Kind.COMMENT and edge is Edge.REFERENCES
    return is_comment and [target.id for target in targets] == [detail.owner]


def _abstract_owner(targets: list[Element], detail: Element) -> list[Value]:
    """Return the targets, with "owner" for the owner of the detail: the owner may have moved."""
    return ["owner" if target.id == detail.owner else target for target in targets]


_DETAILS: dict[Kind, Callable[[Side, Element], Iterator[Fact]]] = {
    Kind.SLOT: _slot_facts,
    Kind.APPLICATION: _application_facts,
}
