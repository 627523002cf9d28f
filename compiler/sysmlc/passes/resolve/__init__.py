"""Pass ``resolve``: references become edges, what lies outside the unit becomes a stand-in."""

from collections.abc import Iterator
from dataclasses import field
from typing import ClassVar, NamedTuple

from sysmlc.diagnostics import Place, Rule, Sink, Subject
from sysmlc.ir import AttrValue, Edge, Element, Graph, Kind
from sysmlc.ir.identity import derived_id, is_made_by_tools
from sysmlc.ir.query import ids_in
from sysmlc.ir.reference import id_of
from sysmlc.passes.resolve.ends import keep_first_ends
from sysmlc.passes.resolve.libraries import (
    PRIMITIVE_TYPES,
    PRIMITIVES,
    has_primitives_only,
    is_href,
    is_standard,
    kind_of,
    name_of,
    primitive,
    split,
)
from sysmlc.passes.resolve.outside import add, known
from sysmlc.passes.resolve.rules import (
    BROKEN_ID,
    BROKEN_REFERENCE,
    MANY_BROKEN,
    MISSING_LIBRARY,
    UNKNOWN_IN_LIBRARY,
)
from sysmlc.passes.resolve.targets import Targets
from sysmlc.passes.standins import StandIn
from sysmlc.values import dataclass

_ATTRIBUTES: dict[Kind, dict[str, Kind]] = {
    Kind.CONTROL: {"decision_input": Kind.ACTIVITY, "decision_input_flow": Kind.OBJECT_FLOW},
    Kind.CONTROL_FLOW: {"interrupts": Kind.STRUCTURED},
    Kind.OBJECT_FLOW: {"interrupts": Kind.STRUCTURED},
    Kind.ITEM_FLOW: {"item_property": Kind.PROPERTY},
    Kind.ACTION: {"on_port": Kind.PORT},
    Kind.TRIGGER: {"port": Kind.PORT},
    Kind.CONNECTOR_END: {"defining_end": Kind.PROPERTY},
    Kind.MESSAGE: {"connector": Kind.CONNECTOR},
    Kind.OPERATION: {"raised_exception": Kind.CLASS},
    Kind.STRUCTURED: dict.fromkeys(("test", "body_part", "setup_part", "clauses"), Kind.ACTION),
}
"""Attributes that hold ids (docs/ir.md), by the kind of their element: what they name."""

_UNSAID = (Kind.CLASS, "")
"""What a reference says of its target that says nothing of it."""

_LISTED = 10
_SINGLY = 4
"""References of one element and relation that lead nowhere and are reported one by one."""


class _Use(NamedTuple):
    """One place that needs an element: an edge to come, or an attribute that holds an id."""

    holder: Element
    target: str
    kind: Kind
    path: str = ""
    ordinal: int = -1
    edge: Edge | None = None
    attribute: str = ""

    @property
    def relation(self) -> str:
        return self.edge.value if self.edge else self.attribute

    def place(self) -> tuple[str, int, str]:
        ordinal = self.ordinal if self.ordinal >= 0 else self.holder.ordinal
        return self.holder.source, ordinal, self.holder.id


@dataclass(frozen=True, slots=True)
class Resolve:
    """Turn every reference into an edge.

    Assumes what a front end leaves: elements, edges it could draw at once, ``graph.pending``.
    Guarantees: nothing is pending; the ids in attributes exist; every edge's target is an
    element, a stand-in (``external``, ``href``) when its file is not part of the unit. A
    reference that leads nowhere is reported, and the holder's attribute ``unresolved`` names
    the relation so that later rules do not complain about what follows from it. The result
    does not depend on the order of the files.
    """

    name: ClassVar[str] = "resolve"
    after: ClassVar[tuple[str, ...]] = ()

    def run(self, graph: Graph, sink: Sink) -> None:
        """Resolve in place; see the class."""
        pending = graph.pending
        targets = graph.find_all(pending.targets)
        elsewhere = _elsewhere(graph, targets)
        uses = [*_attributes(graph)]
        answers = _Answers(graph, Targets(graph))
        answers.find([*elsewhere.values(), *uses])
        for number, use in elsewhere.items():
            targets[number] = answers.get(use.holder, use.target)
        graph.connect_all(pending.edges, pending.sources, targets)
        pending.clear()
        lost = [use for number, use in elsewhere.items() if targets[number] is None]
        lost += [use for use in uses if answers.get(use.holder, use.target) is None]
        _report_lost(graph, sink, lost)
        keep_first_ends(graph, sink)
        _rewrite(graph, answers, uses)
        missing = {h: uses for h, uses in answers.outside.items() if h not in answers.known}
        _report_libraries(graph, sink, missing)


def _elsewhere(graph: Graph, targets: list[Element | None]) -> dict[int, _Use]:
    """The references, by number, whose target is no id of the graph."""
    pending, uses = graph.pending, {}
    numbers = [number for number, target in enumerate(targets) if target is None]
    holders = graph.find_all(pending.sources[number] for number in numbers)
    for number, holder in zip(numbers, holders, strict=True):
        if holder is not None:
            kind, name = pending.said.get(number, _UNSAID)
            target, ordinal = id_of(pending.targets[number]), pending.ordinals[number]
            uses[number] = _Use(holder, target, kind, name, ordinal, pending.edges[number])
    return uses


def _attributes(graph: Graph) -> Iterator[_Use]:
    for holder_kind, named in _ATTRIBUTES.items():
        for element in graph.of_kind(holder_kind):
            attrs = element.attrs
            if attrs and not attrs.keys().isdisjoint(named):
                for name, kind in named.items():
                    for id in ids_in(attrs.get(name)):
                        yield _Use(element, id, kind, attribute=name)


# -- finding -----------------------------------------------------------------------------------


@dataclass(slots=True)
class _Answers:
    """What each target means, by the file that names it."""

    graph: Graph
    targets: Targets
    outside: dict[str, list[_Use]] = field(default_factory=dict)
    """Uses of elements outside the unit, by the href of the stand-in."""
    known: dict[str, StandIn] = field(default_factory=dict)
    """Those of ``outside`` that are elements of a known library."""
    _found: dict[tuple[str, str], str | None] = field(default_factory=dict)
    _stubs: dict[str, str] = field(default_factory=dict)

    def find(self, uses: list[_Use]) -> None:
        """Look for every target, and make the stand-ins for those outside the unit."""
        distant: dict[str, list[_Use]] = {}
        for (file, target), together in _by_target(uses).items():
            if target not in self.graph and self._is_outside(file, target):
                distant.setdefault(target, []).extend(together)
        for target in sorted(distant):
            href = self._canonical(target, distant[target])
            self._stubs[target] = _stand_in_id(href)
            self.outside.setdefault(href, []).extend(distant[target])
        for href in sorted(self.outside):
            self._add(href, self.outside[href])

    def get(self, holder: Element, target: str) -> Element | None:
        """The element that ``target`` means in the holder's file."""
        if target in self.graph:
            return self.graph[target]
        found = self._found.get((holder.source, target))
        return self.graph.get(found or self._stubs.get(target))

    def _is_outside(self, file: str, target: str) -> bool:
        element = self.targets.find(file, target)
        self._found[file, target] = element.id if element else None
        if element is not None or not is_href(target):
            return False
        return not self.targets.files(file, split(target)[0])

    def _canonical(self, target: str, uses: list[_Use]) -> str:
        # All uses are asked, for the order in which they come must not matter.
        said = {(use.path, use.kind) for use in uses}
        name = max({primitive(target, path, kind) for path, kind in said})
        if name:
            return PRIMITIVE_TYPES + name
        found = known(target, {path for path, _ in said}, {kind for _, kind in said})
        if found is None:
            return target
        if found.owner == "PrimitiveTypes":
            return PRIMITIVE_TYPES + found.name
        self.known[found.href] = found
        return found.href

    def _add(self, href: str, uses: list[_Use]) -> None:
        if href in self.known:
            origin = min(uses, key=_Use.place).holder.id
            add(self.graph, self.known[href], origin)
        else:
            _stand_in(self.graph, href, uses)


def _by_target(uses: list[_Use]) -> dict[tuple[str, str], list[_Use]]:
    """Uses by the file that they stand in, and what they name."""
    found: dict[tuple[str, str], list[_Use]] = {}
    for use in uses:
        key = (use.holder.source, use.target)
        known = found.get(key)
        if known is None:
            found[key] = [use]
        else:
            known.append(use)
    return found


def _stand_in_id(href: str) -> str:
    return derived_id(href, "stub")


def _stand_in(graph: Graph, href: str, uses: list[_Use]) -> None:
    id = _stand_in_id(href)
    if id in graph:
        return
    path = min((use.path for use in uses if use.path), default="")
    kind = kind_of(href, {use.kind for use in uses})
    attrs: dict[str, AttrValue] = {"external": True, "href": href}
    if href.startswith(PRIMITIVE_TYPES):
        kind, path = Kind.DATA_TYPE, ""
        attrs["subkind"] = "primitive"
    if "::" in path:
        attrs["qualified_name"] = path
    attrs["origin"] = min(uses, key=_Use.place).holder.id
    graph.add(Element(id, kind, name_of(href, path), attrs=attrs))


# -- writing down ------------------------------------------------------------------------------


def _report_lost(graph: Graph, sink: Sink, lost: list[_Use]) -> None:
    """Report what leads nowhere; of a long list of one element all at once."""
    lists: dict[tuple[str, str], list[_Use]] = {}
    for use in lost:
        lists.setdefault((use.holder.id, use.relation), []).append(use)
    for uses in lists.values():
        for use in uses if len(uses) <= _SINGLY else ():
            _report_broken(graph, sink, use)
        if len(uses) > _SINGLY:
            _report_many(graph, sink, uses)


def _report_many(graph: Graph, sink: Sink, uses: list[_Use]) -> None:
    first = uses[0]
    _mark(graph, first)
    subject = _subject(graph, first)
    sink.report(
        MANY_BROKEN,
        subject,
        relation=first.relation,
        element=subject.name,
        target=first.target,
        others=len(uses) - 1,
    )


def _mark(graph: Graph, use: _Use) -> None:
    known = use.holder.attrs.get("unresolved")
    names = {str(name) for name in known} if isinstance(known, tuple) else set()
    graph.set(use.holder, unresolved=tuple(sorted(names | {use.relation})))


def _report_broken(graph: Graph, sink: Sink, use: _Use) -> None:
    _mark(graph, use)
    subject = _subject(graph, use)
    sink.report(
        BROKEN_REFERENCE if use.edge else BROKEN_ID,
        subject,
        relation=use.relation,
        element=subject.name,
        target=use.target,
    )


def _subject(graph: Graph, use: _Use) -> Subject:
    holder = use.holder
    if use.ordinal < 0:
        return graph.subject(holder)
    return Subject(graph.qualified_name(holder), holder.id, Place(holder.source, use.ordinal))


def _rewrite(graph: Graph, answers: _Answers, held: list[_Use]) -> None:
    for holder, name in dict.fromkeys((use.holder, use.attribute) for use in held):
        graph.set(holder, **{name: _renamed(answers, holder, holder.attrs[name])})


def _renamed(answers: _Answers, holder: Element, value: AttrValue) -> AttrValue:
    if isinstance(value, str):
        found = answers.get(holder, value)
        return found.id if found else None
    if isinstance(value, tuple):
        items = (_renamed(answers, holder, item) for item in value)
        return tuple(item for item in items if item is not None)
    return value


def _report_libraries(graph: Graph, sink: Sink, outside: dict[str, list[_Use]]) -> None:
    libraries: dict[str, dict[str, list[_Use]]] = {}
    for href, uses in outside.items():
        library, _ = split(href)
        if not is_standard(library) or _is_doubtful(graph, href):
            libraries.setdefault(library, {})[href] = uses
    for library in sorted(libraries):
        rule = UNKNOWN_IN_LIBRARY if is_standard(library) else MISSING_LIBRARY
        _report_library(graph, sink, rule, library, libraries[library])


def _is_doubtful(graph: Graph, href: str) -> bool:
    """Whether a standard library surely has no such element, or only its id is known.

    Newer versions may have new elements; profiles that are applied say nothing by themselves.
    """
    stub = graph[_stand_in_id(href)]
    is_nameless = is_made_by_tools(stub.name) and stub.kind is not Kind.PROFILE
    return is_nameless or (has_primitives_only(split(href)[0]) and stub.name not in PRIMITIVES)


def _report_library(
    graph: Graph, sink: Sink, rule: Rule, library: str, missing: dict[str, list[_Use]]
) -> None:
    first = min((use for uses in missing.values() for use in uses), key=_Use.place)
    file, ordinal, _ = first.place()
    lines = [_takes_down(graph, href, missing[href]) for href in sorted(missing)]
    more = [f"and {len(lines) - _LISTED} more"] if len(lines) > _LISTED else []
    sink.report(
        rule,
        _user(graph, first, Place(file, ordinal) if file else None),
        notes=(*lines[:_LISTED], *more),
        library=library,
        count=len(missing),
    )


def _user(graph: Graph, first: _Use, place: Place | None) -> Subject:
    """The first element that uses a library; what another library uses is told all the same."""
    holder = first.holder
    id = "" if holder.attrs.get("library") else holder.id
    return Subject(graph.qualified_name(holder), id, place)


def _takes_down(graph: Graph, href: str, uses: list[_Use]) -> str:
    stand_in = graph[_stand_in_id(href)]
    users = sorted({graph.qualified_name(use.holder) for use in uses})
    more = f" and {len(users) - 2} more" if len(users) > 2 else ""
    return f"{stand_in.kind} '{stand_in.name}', used by {', '.join(users[:2])}{more}"
