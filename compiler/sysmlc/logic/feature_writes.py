"""Writes of features: which features an action writes, and which actions write a feature.

An action assigns a feature (``x := e`` in its body), writes a structural feature (UML 2.5.1,
16.8.3: Add Structural Feature Value, with a literal as value), or binds an output of what it calls
to a feature (SysML 2.0, 7.16: ``out x = level``).
"""

import re
from collections.abc import Iterable, Iterator
from functools import cached_property

from msgspec import Struct

from sysmlc.diagnostics import Severity, rule
from sysmlc.ir import Edge, Element, Graph, Kind, query
from sysmlc.ir.expressions import (
    Assignment,
    Expression,
    ExpressionError,
    last_name,
    list_names,
    name_of,
    print_expression,
)
from sysmlc.logic.expressions.named_elements import VALUE_KINDS, find_named_values
from sysmlc.logic.expressions.parsing import statements_of, tree_of

_FOREIGN_ASSIGNMENT = re.compile(r"(?<![=<>!:])=(?!=)|\+\+|--")
"""A sign of an assignment in a programming language; KerML and UML write ``:=``."""
_PATH_SEPARATOR = re.compile(r"::|\.")
_NAMED = (*VALUE_KINDS, *query.CLASSIFIERS, Kind.PACKAGE)
"""Kinds that a path of names may lead through."""


class FeatureWrite(Struct, frozen=True):
    """A write of a feature by an action; ``value`` is None if the model does not give the value."""

    action: Element
    name: str
    value: Expression | None
    is_bound: bool = False
    """Whether an output of what the action calls is bound to the feature, so that the environment
    decides the value.
    """

    @property
    def text(self) -> str:
        """The value as text, empty without a value."""
        return "" if self.value is None else print_expression(self.value)


# -- features that an action writes ----------------------------------------------------------------


def iter_writes(graph: Graph, action: Element) -> Iterator[FeatureWrite]:
    """Yield the writes of an action in the order of execution."""
    if action.subkind == "write":
        yield from _read_write_action(graph, action)
    yield from _iter_assignments(action)
    for name in _iter_bound_names(graph, action):
        yield FeatureWrite(action, name, None, is_bound=True)


def _iter_written_names(graph: Graph, action: Element) -> Iterator[str]:
    """Yield the paths of the features that an action assigns or binds.

    Write actions, which refer to their feature by an edge, are not considered.
    """
    yield from (write.name for write in _iter_assignments(action))
    yield from _iter_bound_names(graph, action)


def _iter_bound_names(graph: Graph, action: Element) -> Iterator[str]:
    """Yield the names of features to which outputs of what the action calls are bound."""
    if action.kind is not Kind.ACTION:
        return
    for pin in graph.owned(action):
        if pin.attrs.get("direction") in ("out", "inout", "return"):
            name = find_bound_name(graph, action, pin)
            if name:
                yield name


def find_bound_name(graph: Graph, action: Element, pin: Element) -> str | None:
    """Return the path of the feature that an output pin of an action sets, or None.

    A pin without a value sets the attribute of its activity that has its name, as in recipes.
    """
    text = pin.attrs.get("value")
    if isinstance(text, str):
        return _parse_name(text)
    activity = next((item for item in graph.ancestors(action) if item.kind is Kind.ACTIVITY), None)
    attributes = () if activity is None else graph.owned(activity)
    is_own = any(item.kind is Kind.PROPERTY and item.name == pin.name for item in attributes)
    return pin.name if is_own and pin.name else None


def _parse_name(text: str) -> str | None:
    """Return the path of names in a text; None if the text is another expression."""
    try:
        return name_of(tree_of(text))
    except ExpressionError:
        return None


def _iter_assignments(action: Element) -> Iterator[FeatureWrite]:
    """Yield the assignments in the body of an opaque action or function behaviour."""
    body = action.attrs.get("body")
    if action.subkind not in ("opaque", "function"):
        return
    if not isinstance(body, str) or ":=" not in body:
        return
    try:
        statements = statements_of(body)
    except ExpressionError:
        return
    for statement in statements:
        name = name_of(statement.target) if isinstance(statement, Assignment) else None
        if name and isinstance(statement, Assignment):
            yield FeatureWrite(action, name.removeprefix("self."), statement.value)


def takes_one_step(action: Element) -> bool:
    """Whether the body of an action consists of assignments alone."""
    return bool(read_assignments(action))


def read_assignments(action: Element) -> tuple[Assignment, ...]:
    """Return the assignments in the body of an action; none if the body has other statements."""
    body = action.attrs.get("body")
    if not isinstance(body, str) or ":=" not in body:
        return ()
    try:
        statements = statements_of(body)
    except ExpressionError:
        return ()
    assignments = tuple(item for item in statements if isinstance(item, Assignment))
    return assignments if len(assignments) == len(statements) else ()


def _read_write_action(graph: Graph, action: Element) -> Iterator[FeatureWrite]:
    """Yield the write of an Add Structural Feature Value action."""
    feature = graph.target(action, Edge.CALLS)
    if feature is not None:
        yield FeatureWrite(action, feature.name, _read_written_value(graph, action))


def _read_written_value(graph: Graph, action: Element) -> Expression | None:
    """Return the literal that a write action stores in the object that performs the activity."""
    pins = {pin.subkind or pin.name: pin for pin in graph.owned(action) if pin.kind is Kind.PIN}
    object_pin, value_pin = pins.get("object"), pins.get("value")
    if value_pin is None or not _is_self(graph, object_pin):
        return None
    text = _read_literal(graph, value_pin)
    try:
        return None if text is None else tree_of(text)
    except ExpressionError:
        return None


def _is_self(graph: Graph, pin: Element | None) -> bool:
    """Whether the object at the pin is the one that performs the activity."""
    source = None if pin is None else _find_source(graph, pin)
    return source is None or source.subkind == "read-self"


def _read_literal(graph: Graph, pin: Element) -> str | None:
    """Return the literal that flows into the pin, as text; None if there is none.

    It is the literal of the value action at the other end of the flow, or of the pin itself.
    """
    source = _find_source(graph, pin)
    holder = source if source is not None and source.subkind == "value" else pin
    value = holder.attrs.get("value")
    if value is None:
        return None
    return str(value).lower() if isinstance(value, bool) else str(value)


def _find_source(graph: Graph, pin: Element) -> Element | None:
    """Return the action at the other end of the only flow into a pin; None for several flows."""
    flows = list(graph.sources(pin, Edge.FLOW_TARGET))
    source = graph.target(flows[0], Edge.FLOW_SOURCE) if len(flows) == 1 else None
    return graph.owner(source) if source is not None and source.kind is Kind.PIN else source


# -- actions that write a feature ------------------------------------------------------------------


class WriterIndex:
    """The actions and effects of a graph by the features that they write.

    The first query builds the index. The graph must not change while the index is in use.
    """

    def __init__(self, graph: Graph) -> None:
        self._graph = graph
        self._candidates_by_name: dict[str, list[Element]] | None = None
        self._members_by_scope: dict[str, dict[str, Element]] = {}
        self._writers_by_name: dict[str, dict[str, list[Element]]] = {}
        self._unclear_by_name: dict[str, list[Element]] | None = None

    def find_other_writer(self, feature: Element, behaviour: Element) -> Element | None:
        """Return the first writer of the feature that is outside the behaviour."""
        for writer in self.iter_writers(feature):
            if writer is not behaviour and behaviour not in self._graph.ancestors(writer):
                return writer
        return None

    def resolve_target(self, writer: Element, path: str) -> Element | None:
        """Return the feature that a path (``full``, ``arm.load``, ``Plant::total``) denotes.

        The first name is looked up in the scopes around the writer, nearest first.
        """
        first, *rest = _PATH_SEPARATOR.split(path)
        element = self._find_visible(writer, first)
        for name in rest:
            element = None if element is None else self._find_member_of_value(element, name)
        return element if element is not None and element.kind in VALUE_KINDS else None

    def iter_writers(self, feature: Element) -> Iterator[Element]:
        """Yield the actions and effects that write the feature or one that it redefines."""
        # An object has one value for a feature and for all features that redefine it.
        redefinitions = (
            feature,
            *query.redefined_features(self._graph, feature),
            *self._list_redefining(feature),
        )
        for slot in redefinitions:
            yield from self._index_writers(slot.name).get(slot.id, ())

    def iter_unclear_writers(self, feature: Element) -> Iterator[Element]:
        """Yield the actions and effects of which it is not known whether they write the feature.

        Their text names it beside an assignment that is not understood (``this.level++``), or they
        clear the feature or remove a value.
        """
        if self._unclear_by_name is None:
            self._unclear_by_name = {}
            for writer in (*self._graph.of_kind(Kind.ACTION), *self._graph.of_kind(Kind.ACTIVITY)):
                for name in dict.fromkeys(self._iter_unclear_names(writer)):
                    self._unclear_by_name.setdefault(name, []).append(writer)
        redefined = query.redefined_features(self._graph, feature)
        for name in dict.fromkeys(slot.name for slot in (feature, *redefined)):
            yield from self._unclear_by_name.get(name, ())

    def _iter_unclear_names(self, writer: Element) -> Iterator[str]:
        if writer.subkind in ("clear", "remove"):
            yield from (feature.name for feature in self._graph.targets(writer, Edge.CALLS))
        body = writer.attrs.get("body")
        if not isinstance(body, str):
            return
        if _FOREIGN_ASSIGNMENT.search(body):
            yield from list_names(body)
        elif ":=" in body:
            try:
                statements = statements_of(body)
            except ExpressionError:
                yield from list_names(body)
                return
            for statement in statements:
                path = name_of(statement.target) if isinstance(statement, Assignment) else None
                if path and self.resolve_target(writer, path.removeprefix("self.")) is None:
                    yield last_name(path)

    def _index_writers(self, name: str) -> dict[str, list[Element]]:
        """Return the writers of all features of a name, by the id of the feature."""
        # In a large model many blocks have a feature of this name: each path is resolved once.
        if name not in self._writers_by_name:
            writers: dict[str, list[Element]] = {}
            for writer in self._list_candidates(name):
                features = self._iter_written_features(writer, name)
                for feature_id in dict.fromkeys(feature.id for feature in features if feature):
                    writers.setdefault(feature_id, []).append(writer)
            self._writers_by_name[name] = writers
        return self._writers_by_name[name]

    def _list_candidates(self, name: str) -> list[Element]:
        """Return the actions that may write a feature of the name."""
        if self._candidates_by_name is None:
            self._candidates_by_name = _index_candidates(self._graph)
        return self._candidates_by_name.get(name, [])

    def _iter_written_features(self, writer: Element, name: str) -> Iterator[Element | None]:
        """Yield the features that the action writes, of those whose path ends with *name*."""
        if writer.subkind == "write":
            yield from self._graph.targets(writer, Edge.CALLS)
        for path in _iter_written_names(self._graph, writer):
            if last_name(path) == name:
                yield self.resolve_target(writer, path)

    def _list_redefining(self, feature: Element) -> Iterable[Element]:
        """Return the features that redefine the feature, directly or transitively."""
        visited = {feature.id: feature}
        worklist = [feature]
        for redefined in worklist:
            redefining = self._graph.sources(redefined, Edge.REDEFINES)
            new = [element for element in redefining if element.id not in visited]
            visited.update((element.id, element) for element in new)
            worklist += new
        return worklist[1:]

    def _find_visible(self, writer: Element, name: str) -> Element | None:
        """Return the member called *name* in the nearest scope around the writer, else a root."""
        for scope in (writer, *self._graph.ancestors(writer)):
            member = self._find_member(scope, name)
            if member is not None:
                return member
        return next((root for root in self._graph.roots() if root.name == name), None)

    def _find_member_of_value(self, element: Element, name: str) -> Element | None:
        """Return the member of that name of an element, or else of its type."""
        type_ = query.type_of(self._graph, element)
        return self._find_member(element, name) or (type_ and self._find_member(type_, name))

    def _find_member(self, scope: Element, name: str) -> Element | None:
        """Return the member of a scope, inherited ones of a classifier included."""
        members = self._members_by_scope.get(scope.id)
        if members is None:
            owned = (element for element in self._graph.owned(scope) if element.kind in _NAMED)
            members = {element.name: element for element in owned if element.name}
            if scope.kind in query.CLASSIFIERS:
                members |= find_named_values(self._graph, scope)
            self._members_by_scope[scope.id] = members
        return members.get(name)


def _index_candidates(graph: Graph) -> dict[str, list[Element]]:
    """Return the actions and activities that may write a feature, by the last name of its path."""
    candidates: dict[str, list[Element]] = {}
    for action in (*graph.of_kind(Kind.ACTION), *graph.of_kind(Kind.ACTIVITY)):
        written = graph.targets(action, Edge.CALLS) if action.subkind == "write" else ()
        paths = _iter_written_names(graph, action)
        for name in dict.fromkeys((*(feature.name for feature in written), *map(last_name, paths))):
            candidates.setdefault(name, []).append(action)
    return candidates


def find_label(graph: Graph, writer: Element, other: str = "") -> str:
    """Return the name of a writer, or else of its nearest owner with a name.

    The name is qualified if it is *other*, the name of another behaviour in the same message.
    """
    elements = (writer, *graph.ancestors(writer))
    named = next((element for element in elements if element.name), None)
    if named is None:
        return writer.subkind
    return graph.qualified_name(named) if named.name == other else named.name


SHARED = rule(
    "SM546",
    "others-write-it-too",
    Severity.INFO,
    "'{name}' is also assigned by '{writer}', so the contract of '{machine}' treats it "
    "as an input and shows '{text}' as output '{variable}'",
    help="let only one behaviour assign it, or specify it in a requirement",
)


class Sharing(Struct, frozen=True, dict=True):
    """Finds further writers of the features that a state machine writes."""

    graph: Graph
    machine: Element
    writers: WriterIndex | None = None
    """The writers of each feature; None if only the machine itself is considered."""
    classifier: Element | None = None
    """The classifier in which names are resolved; None if no classifier is around the machine."""

    @cached_property
    def index(self) -> WriterIndex:
        """The index in which names are looked up: that of the writers, if there is one."""
        return self.writers or WriterIndex(self.graph)

    def find_other_writer(self, feature: Element) -> Element | None:
        """Return a behaviour that writes *feature* and is no part of the steps of the machine.

        These are behaviours outside the machine, do behaviours, and the exit of the machine itself.
        """
        exits = self.graph.targets(self.machine, Edge.EXIT)
        for writer in () if self.writers is None else self.writers.iter_writers(feature):
            scopes = (writer, *self.graph.ancestors(writer))
            if self.machine not in scopes or any(
                scope in exits or self.graph.sources(scope, Edge.DO) for scope in scopes
            ):
                return writer
        return None
