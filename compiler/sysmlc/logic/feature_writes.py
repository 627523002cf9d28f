"""Writes of features: which features an action writes, and which actions write a feature.

An action assigns a feature (``x := e`` in its body), writes a structural feature (UML 2.5.1,
16.8.3: Add Structural Feature Value, with a literal as value), or binds an output of what it calls
to a feature (SysML 2.0, 7.16: ``out x = level``).
"""

import re
from collections import defaultdict
from collections.abc import Iterable, Iterator
from functools import cached_property

from msgspec import Struct

from sysmlc.diagnostics import Severity, rule
from sysmlc.ir import Edge, Element, Graph, Kind, query
from sysmlc.ir.expressions import (
    Assignment,
    EffectText,
    Expression,
    ExpressionError,
    Name,
    element_of,
    last_name,
    list_names,
    name_of,
    print_expression,
)
from sysmlc.logic.expressions.named_elements import VALUE_KINDS
from sysmlc.logic.expressions.parsing import tree_of

_OPAQUE = re.compile(r"(?<![=<>!])=(?!=)|\+\+|--")
"""A sign of an assignment in a language that the compiler does not read."""


class FeatureWrite(Struct, frozen=True):
    """A write of a feature by an action; ``value`` is None if the model does not give the value.

    ``target`` is None if the name of the feature denotes no value.
    """

    action: Element
    name: str
    target: Element | None
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
        feature = graph.target(action, Edge.CALLS)
        if feature is not None:
            value = _read_written_value(graph, action)
            yield FeatureWrite(action, feature.name, feature, value)
    for assignment in _list_assignments(action) if action.subkind in ("opaque", "function") else ():
        name = name_of(assignment.target)
        if name:
            target = _find_value(graph, assignment.target)
            yield FeatureWrite(action, name, target, assignment.value)
    for pin in graph.owned(action) if action.kind is Kind.ACTION else ():
        if pin.attrs.get("direction") in ("out", "inout", "return"):
            path = find_bound_path(graph, action, pin)
            name = None if path is None else name_of(path)
            if path is not None and name:
                yield FeatureWrite(action, name, _find_value(graph, path), None, is_bound=True)


def _find_value(graph: Graph, path: Expression) -> Element | None:
    """Return the feature that a path (``full``, ``arm.load``, ``Plant::total``) denotes."""
    element = graph.get(element_of(path))
    return element if element is not None and element.kind in VALUE_KINDS else None


def find_bound_path(graph: Graph, action: Element, pin: Element) -> Expression | None:
    """Return the path of the feature that an output pin of an action sets, or None.

    A pin without a value sets the attribute of its activity that has its name, as in recipes.
    """
    text = pin.attrs.get("value")
    if isinstance(text, str):
        try:
            return tree_of(text)
        except ExpressionError:
            return None
    activity = next((item for item in graph.ancestors(action) if item.kind is Kind.ACTIVITY), None)
    attributes = () if activity is None else graph.owned(activity)
    same_name = (a for a in attributes if a.kind is Kind.PROPERTY and a.name == pin.name != "")
    return next((Name((attribute.name,), attribute.id) for attribute in same_name), None)


def find_bound_name(graph: Graph, action: Element, pin: Element) -> str | None:
    """Return ``find_bound_path`` as text; None for an expression that is no path."""
    path = find_bound_path(graph, action, pin)
    return None if path is None else name_of(path)


def _list_assignments(action: Element) -> tuple[Assignment, ...]:
    body = action.attrs.get("body")
    statements = body.tree if isinstance(body, EffectText) else ()
    return tuple(item for item in statements if isinstance(item, Assignment))


def takes_one_step(action: Element) -> bool:
    """Whether the body of an action consists of assignments alone."""
    return bool(read_assignments(action))


def read_assignments(action: Element) -> tuple[Assignment, ...]:
    """Return the assignments in the body of an action; none if the body has other statements."""
    body, assignments = action.attrs.get("body"), _list_assignments(action)
    is_plain = isinstance(body, EffectText) and len(assignments) == len(body.tree)
    return assignments if is_plain else ()


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

    def find_other_writer(self, feature: Element, behaviour: Element) -> Element | None:
        """Return the first writer of the feature that is outside the behaviour."""
        for writer in self.iter_writers(feature):
            if writer is not behaviour and behaviour not in self._graph.ancestors(writer):
                return writer
        return None

    def iter_writers(self, feature: Element) -> Iterator[Element]:
        """Yield the actions and effects that write the feature or one that it redefines."""
        # An object has one value for a feature and for all features that redefine it.
        redefinitions = (
            feature,
            *query.redefined_features(self._graph, feature),
            *self._list_redefining(feature),
        )
        for slot in redefinitions:
            yield from self._writers.get(slot.id, ())

    def iter_unclear_writers(self, feature: Element) -> Iterator[Element]:
        """Yield the actions and effects of which it is not known whether they write the feature.

        Their text names it beside an assignment that is not understood (``this.level++``), or they
        clear the feature or remove a value.
        """
        redefined = query.redefined_features(self._graph, feature)
        for name in dict.fromkeys(slot.name for slot in (feature, *redefined)):
            yield from self._unclear_writers.get(name, ())

    def _list_candidates(self) -> tuple[Element, ...]:
        return (*self._graph.of_kind(Kind.ACTION), *self._graph.of_kind(Kind.ACTIVITY))

    @cached_property
    def _writers(self) -> dict[str, list[Element]]:
        """The writers of each feature by its id."""
        writers = defaultdict(list)
        for writer in self._list_candidates():
            targets = self._graph.targets(writer, Edge.CALLS) if writer.subkind == "write" else []
            targets += [write.target for write in iter_writes(self._graph, writer) if write.target]
            for target in dict.fromkeys(targets):
                writers[target.id].append(writer)
        return writers

    @cached_property
    def _unclear_writers(self) -> dict[str, list[Element]]:
        """The writers by the names that they may write."""
        writers = defaultdict(list)
        for writer in self._list_candidates():
            for name in dict.fromkeys(self._iter_unclear_names(writer)):
                writers[name].append(writer)
        return writers

    def _iter_unclear_names(self, writer: Element) -> Iterator[str]:
        if writer.subkind in ("clear", "remove"):
            yield from (feature.name for feature in self._graph.targets(writer, Edge.CALLS))
        body = writer.attrs.get("body")
        if isinstance(body, str) and not isinstance(body, EffectText) and _OPAQUE.search(body):
            yield from list_names(body)
        for assignment in _list_assignments(writer):
            path = name_of(assignment.target)
            if path and _find_value(self._graph, assignment.target) is None:
                yield last_name(path)

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


class Sharing(Struct, frozen=True):
    """Finds further writers of the features that a state machine writes."""

    graph: Graph
    machine: Element
    writers: WriterIndex | None = None
    """The writers of each feature; None if only the machine itself is considered."""
    classifier: Element | None = None
    """The classifier in which names are resolved; None if no classifier is around the machine."""

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
