"""Resolution of the names in expressions: each name gets the element that it denotes."""

from collections import defaultdict
from collections.abc import Iterable, Iterator
from functools import cached_property
from typing import TypeVar, cast

from sysmlc.ir import Edge, Element, Graph, Kind, query
from sysmlc.ir.expressions import Expression, Literal, Member, Name, Statement
from sysmlc.logic.expressions.named_elements import VALUE_KINDS, find_named_values

_Node = TypeVar("_Node")
_TYPES = tuple(kind for kind in query.CLASSIFIERS if kind not in query.BEHAVIORS)
_FIRST = (*VALUE_KINDS, *_TYPES, Kind.PACKAGE)
"""Kinds of the elements that hide all others of the same name, also nearer ones."""
_STEPS = (Kind.TRIGGER, Kind.ACTION, Kind.STRUCTURED)
_LATER = (Kind.INSTANCE, Kind.OPERATION, *query.BEHAVIORS, *_STEPS)
_MEMBERS = (*_LATER, Kind.PIN, Kind.ENUMERATION_LITERAL, *_FIRST)
"""Kinds of the members of a scope, of which later ones hide earlier ones."""
_QUALIFIED = (Kind.ENUMERATION_LITERAL, Kind.PROPERTY, Kind.PORT, Kind.OPERATION, Kind.INSTANCE)
"""Kinds of the elements that an incomplete qualified name may denote."""

_TRUTH_VALUES = {("True",): True, ("False",): False}
"""Names that are truth values, as in Python, unless an element has the name."""


class NameResolver:
    """Finds the elements that names denote. The graph must not change while it is in use."""

    def __init__(self, graph: Graph) -> None:
        self._graph = graph
        self._members_by_scope: dict[str, dict[str, Element]] = {}

    def resolve(self, user: Element, node: _Node) -> _Node:
        """Return a tree, or a part of one, in which the names carry the elements that they denote.

        The tree belongs to a text of *user*. A name whose element is known keeps it.
        """
        match node:
            case Name(path, ""):
                element = self._find_name(user, path)
                if element is None and path in _TRUTH_VALUES and path[0] not in self._by_name:
                    return cast("_Node", Literal(_TRUTH_VALUES[path]))
                if self._is_own_feature(user, path, element):
                    path = path[-1:]
                return type(node)(path, _id(element))
            case Member(base, name, known):
                base = self.resolve(user, base)
                return type(node)(base, name, known or _id(self._find_feature(user, base, name)))
            case tuple():
                return type(node)(self.resolve(user, part) for part in node)
            case _ if isinstance(node, Expression | Statement):
                parts = (getattr(node, key) for key in node.__match_args__)
                return type(node)(*(self.resolve(user, part) for part in parts))
        return node

    def _find_name(self, user: Element, path: tuple[str, ...]) -> Element | None:
        """Return the element of a qualified name (``full``, ``Plant::total``).

        The first name is looked up in the scopes around the user, nearest first. An incomplete
        name denotes the only element whose qualified name ends with it.
        """
        element = self._find_visible(user, path[0])
        for name in path[1:]:
            element = None if element is None else self._find_member_of_value(element, name)
        return element or self._find_in_event(user, path[-1]) or self._find_by_suffix(path)

    def _is_own_feature(
        self, user: Element, path: tuple[str, ...], element: Element | None
    ) -> bool:
        """Whether a qualified name denotes a feature that its last name alone denotes, too.

        ``Door::open`` in a text of Door is ``open``.
        """
        is_feature = element is not None and element.kind in VALUE_KINDS
        return len(path) > 1 and is_feature and self._find_visible(user, path[-1]) is element

    def _find_feature(self, user: Element, base: Expression, name: str) -> Element | None:
        match base:
            case Name(("self" | "this",)):
                return self._find_name(user, (name,))
            case Name(_, element) | Member(_, _, element) if element:
                return self._find_member_of_value(self._graph[element], name)
            case Name((event,)):
                return self._find_in_event(user, name, event)
        return None

    def _find_in_event(self, user: Element, name: str, event_name: str = "") -> Element | None:
        """Return the parameter or attribute of the event that triggers the transition of a text."""
        transition = self._graph.owner(user) if user.kind in query.BEHAVIORS else user
        for trigger in () if transition is None else self._graph.targets(transition, Edge.TRIGGER):
            event = query.type_of(self._graph, trigger)
            if event is not None and event_name in ("", event.name):
                feature = find_named_values(self._graph, event).get(name)
                if feature is not None:
                    return feature
        return None

    def _find_visible(self, user: Element, name: str) -> Element | None:
        """Return the member called *name* in the nearest scope around the user, else a root."""
        scopes = (user, *self._graph.ancestors(user))
        members = [m for scope in scopes if (m := self._find_member(scope, name)) is not None]
        for kinds in (_FIRST, _LATER):
            for member in members:
                if member.kind in kinds:
                    return member
        return next((root for root in self._graph.roots() if root.name == name), None)

    def _find_member_of_value(self, element: Element, name: str) -> Element | None:
        """Return the member of that name of an element, or else of its type."""
        type_ = query.type_of(self._graph, element)
        return self._find_member(element, name) or (type_ and self._find_member(type_, name))

    def _find_member(self, scope: Element, name: str) -> Element | None:
        """Return the member of a scope, imported and inherited ones and opposite ends included."""
        members = self._members_by_scope.get(scope.id)
        if members is None:
            owned = ((str(e.attrs.get("payload") or e.name), e) for e in self._graph.owned(scope))
            imports = self._list_imports(scope)
            named = (*self._iter_imported(imports, {scope.id}), *owned)
            members = {
                name: element
                for name, element in sorted(named, key=lambda pair: pair[1].kind in _FIRST)
                if name and element.kind in _MEMBERS
            }
            if scope.kind in query.CLASSIFIERS:
                members |= find_named_values(self._graph, scope)
                members = {end.name: end for end in self._iter_opposite_ends(scope)} | members
            self._members_by_scope[scope.id] = members
        return members.get(name)

    def _list_imports(self, scope: Element) -> list[Element]:
        return [element for element in self._graph.owned(scope) if element.kind is Kind.IMPORT]

    def _iter_imported(
        self, imports: Iterable[Element], visited: set[str]
    ) -> Iterator[tuple[str, Element]]:
        """Yield the elements that are imported, singly or with their package, by name.

        A package passes on what its public imports import (UML 2.5.1, 7.4.3), those with an id in
        *visited* excepted.
        """
        for import_ in imports:
            for target in self._graph.targets(import_, Edge.REFERENCES):
                if import_.subkind != "package":
                    yield str(import_.attrs.get("alias") or target.name), target
                elif target.id not in visited:
                    visited.add(target.id)
                    inner = self._list_imports(target)
                    public = [i for i in inner if i.attrs.get("visibility") != "private"]
                    yield from self._iter_imported(public, visited)
                    yield from ((element.name, element) for element in self._graph.owned(target))

    def _iter_opposite_ends(self, classifier: Element) -> Iterator[Element]:
        """Yield the association ends that are opposite to ends of the classifier."""
        for end in self._graph.sources(classifier, Edge.TYPED_BY):
            for association in self._graph.sources(end, Edge.END):
                ends = self._graph.targets(association, Edge.END)
                yield from (opposite for opposite in ends if opposite is not end)

    @cached_property
    def _by_name(self) -> dict[str, list[Element]]:
        elements = defaultdict(list)
        for element in self._graph.of_kind(*_QUALIFIED):
            elements[element.name].append(element)
        return elements

    def _find_by_suffix(self, path: tuple[str, ...]) -> Element | None:
        """Return the only element whose qualified name ends with the path.

        A single name may only be that of an enumeration literal.
        """
        kinds = _QUALIFIED if len(path) > 1 else (Kind.ENUMERATION_LITERAL,)
        candidates = []
        for element in self._by_name.get(path[-1], ()):
            names = [owner.name for owner in self._graph.ancestors(element)][: len(path) - 1]
            if element.kind in kinds and tuple(reversed(names)) == path[:-1]:
                candidates.append(element)
        return candidates[0] if len(candidates) == 1 else None


def _id(element: Element | None) -> str:
    return "" if element is None else element.id
