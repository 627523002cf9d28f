"""Pass ``behaviours``: methods of operations, calls and their arguments, behaviours of states."""

from collections import Counter
from typing import ClassVar

from msgspec import Struct

from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.ir import AttrValue, Edge, Element, Graph, Kind, list_items
from sysmlc.ir.element import derived_id
from sysmlc.ir.query import BEHAVIORS, features, parameters, redefined_features
from sysmlc.support.counts import count

CALL_OF_NOTHING = rule(
    "SM400",
    "call-of-nothing",
    Severity.WARNING,
    "action '{action}' does not say which {what} it calls",
    help="choose the {what} in the modelling tool",
)
CALL_WITHOUT_BEHAVIOR = rule(
    "SM406",
    "call-without-behavior",
    Severity.INFO,
    "action '{action}' calls no behaviour, so it counts as an elementary action",
    help="choose the behaviour in the modelling tool if there is one",
)
CALL_ARGUMENTS = rule(
    "SM401",
    "call-arguments",
    Severity.WARNING,
    "action '{action}' has {pins}, but '{called}' has {parameters}",
    help="let the modelling tool synchronise the pins of the action",
)
NO_BEHAVIOR = rule(
    "SM402",
    "no-behavior",
    Severity.WARNING,
    "the {relation} of '{element}' leads to '{target}', which is not a behaviour",
    help="let it lead to an activity, state machine or interaction",
)
METHOD_BY_NAME = rule(
    "SM403",
    "method-by-name",
    Severity.INFO,
    "operation '{operation}' has no method, but '{owner}' has a behaviour of the same name",
    help="set the behaviour's specification to the operation if it implements it",
)
METHOD_PARAMETERS = rule(
    "SM404",
    "method-parameters",
    Severity.WARNING,
    "operation '{operation}' has the parameters ({own}), its method '{method}' ({other})",
    help="give the behaviour the same parameters, in the same order",
)
TRIGGER_OF_NOTHING = rule(
    "SM405",
    "trigger-of-nothing",
    Severity.WARNING,
    "{what} trigger of '{element}' does not say which {what} it waits for",
    help="choose the {what} in the modelling tool",
)


_CALLED: dict[str, tuple[str, tuple[Kind, ...]]] = {
    "call-behavior": ("behaviour", BEHAVIORS),
    "call-operation": ("operation", (Kind.OPERATION,)),
    "send": ("signal", (Kind.SIGNAL,)),
    "broadcast": ("signal", (Kind.SIGNAL,)),
}
_BEHAVIOR_EDGES = (
    Edge.ENTRY,
    Edge.DO,
    Edge.EXIT,
    Edge.EFFECT,
    Edge.METHOD,
    Edge.CLASSIFIER_BEHAVIOR,
)
_NO_ARGUMENT = frozenset({"target", "object", "exception", "insert-at", "remove-at"})
_IN = ("in", "inout")
_OUT = ("out", "inout", "return")


class Behaviours(Struct, frozen=True):
    """Link operations to the methods that they inherit, and check calls.

    Assumes effective features. Guarantees: a transition whose name is in the notation of diagrams
    has the trigger, guard and effect that the name states; an operation without a method has the
    method of the operation that it redefines; every call, trigger and behaviour of a state leads to
    an element of the right kind, or is reported. The component of a behaviour is
    ``ir.query.component_name``.
    """

    name: ClassVar[str] = "behaviours"
    after: ClassVar[tuple[str, ...]] = ("inherit", "classify")

    def run(self, graph: Graph, sink: Sink) -> None:
        """Link methods in place and report; see the class."""
        read_transition_names(graph, sink)
        for operation in graph.of_kind(Kind.OPERATION):
            _inherit_method(graph, operation)
            _check_method(graph, sink, operation)
        for action in graph.of_kind(Kind.ACTION):
            if action.subkind in _CALLED:
                _check_call(graph, sink, action)
        for trigger in graph.of_kind(Kind.TRIGGER):
            _check_trigger(graph, sink, trigger)
        for edge, source, target in graph.edges(*_BEHAVIOR_EDGES):
            _check_behavior(graph, sink, edge, graph[source], graph[target])


# -- methods -----------------------------------------------------------------------------------


def _inherit_method(graph: Graph, operation: Element) -> None:
    for candidate in (operation, *redefined_features(graph, operation)):
        methods = graph.targets(candidate, Edge.METHOD)
        if methods:
            if candidate is not operation or not _is_only_user(graph, operation, methods):
                graph.replace_targets(Edge.METHOD, operation, methods)
            return


def _is_only_user(graph: Graph, operation: Element, methods: list[Element]) -> bool:
    """Whether no other operation has the methods, so that their edges may stay as they are."""
    return all(graph.sources(method, Edge.METHOD) == [operation] for method in methods)


def _check_method(graph: Graph, sink: Sink, operation: Element) -> None:
    methods = graph.targets(operation, Edge.METHOD)
    if not methods and operation.attrs.get("abstract") is None:
        _suggest_method(graph, sink, operation)
    for method in methods:
        own_parameters, method_parameters = (
            _parameter_directions(graph, element) for element in (operation, method)
        )
        if own_parameters != method_parameters and not method.attrs.get("external"):
            sink.report(
                METHOD_PARAMETERS,
                graph.subject(operation),
                operation=graph.qualified_name(operation),
                own=", ".join(own_parameters),
                method=graph.qualified_name(method),
                other=", ".join(method_parameters),
            )


def _parameter_directions(graph: Graph, owner: Element) -> list[str]:
    """Return the directions of the parameters in their order, with results at the end."""
    # Tools put the result first or last.
    directions = [
        str(parameter.attrs.get("direction", "in")) for parameter in parameters(graph, owner)
    ]
    return sorted(directions, key=lambda direction: direction == "return")


def _suggest_method(graph: Graph, sink: Sink, operation: Element) -> None:
    owner = graph.owner(operation)
    if owner is None or "method" in _list_unresolved(operation):
        return
    for behavior in graph.owned(owner):
        is_unused = behavior.kind in BEHAVIORS and graph.source(behavior, Edge.METHOD) is None
        if is_unused and behavior.name == operation.name and behavior.name:
            sink.report(
                METHOD_BY_NAME,
                graph.subject(operation),
                operation=graph.qualified_name(operation),
                owner=owner.name,
            )


# -- calls -------------------------------------------------------------------------------------


def _check_call(graph: Graph, sink: Sink, action: Element) -> None:
    what, kinds = _CALLED[action.subkind]
    called = graph.target(action, Edge.CALLS)
    if called is None:
        if Edge.CALLS.value not in _list_unresolved(action):
            empty = CALL_WITHOUT_BEHAVIOR if what == "behaviour" else CALL_OF_NOTHING
            name = graph.qualified_name(action)
            sink.report(empty, graph.subject(action), action=name, what=what)
    elif called.kind in kinds and not called.attrs.get("external"):
        _check_pins(graph, sink, action, called)


def _check_pins(graph: Graph, sink: Sink, action: Element, called: Element) -> None:
    pins = [pin for pin in graph.owned(action) if pin.kind is Kind.PIN]
    pins = [pin for pin in pins if pin.subkind not in _NO_ARGUMENT]
    pin_counts = Counter(str(pin.attrs.get("direction", "in")) for pin in pins)
    ins, outs = _count_parameters(graph, called)
    differing = [
        (word, pin_counts[direction], wanted)
        for direction, word, wanted in (("in", "input", ins), ("out", "output", outs))
        if pin_counts[direction] != wanted
    ]
    if differing:
        sink.report(
            CALL_ARGUMENTS,
            graph.subject(action),
            action=graph.qualified_name(action),
            pins=" and ".join(count(number, f"{word} pin") for word, number, _ in differing),
            called=graph.qualified_name(called),
            parameters=" and ".join(
                count(wanted, f"{word} parameter") for word, _, wanted in differing
            ),
        )


def _count_parameters(graph: Graph, called: Element) -> tuple[int, int]:
    if called.kind is Kind.SIGNAL:
        return sum(1 for feature in features(graph, called) if feature.kind is Kind.PROPERTY), 0
    return len(parameters(graph, called, *_IN)), len(parameters(graph, called, *_OUT))


def _check_trigger(graph: Graph, sink: Sink, trigger: Element) -> None:
    if trigger.subkind not in ("signal", "call") or Edge.TYPED_BY.value in _list_unresolved(
        trigger
    ):
        return
    if graph.target(trigger, Edge.TYPED_BY) is None:
        sink.report(
            TRIGGER_OF_NOTHING,
            graph.subject(trigger),
            what="operation" if trigger.subkind == "call" else "signal",
            element=graph.qualified_name(graph.owner(trigger) or trigger),
        )


def _check_behavior(
    graph: Graph, sink: Sink, edge: Edge, element: Element, target: Element
) -> None:
    if target.kind in BEHAVIORS or target.attrs.get("external"):
        return
    sink.report(
        NO_BEHAVIOR,
        graph.subject(element),
        relation=edge.value.replace("-", " "),
        element=graph.qualified_name(element),
        target=graph.qualified_name(target),
    )


def _list_unresolved(element: Element) -> tuple[object, ...]:
    return list_items(element.attrs.get("unresolved"))


# -- names of transitions --------------------------------------------------------------------------


TRANSITION_FROM_NAME = rule(
    "SM487",
    "transition-from-name",
    Severity.INFO,
    "the name of transition '{transition}' is read as {parts}",
    help="write the trigger, the guard and the effect of the transition instead of its name",
)


def _split_name(name: str) -> tuple[str, str, str] | None:
    """Return trigger, guard and effect of a name; None for a name without a guard in brackets."""
    trigger, _, behind = name.partition("[")
    guard, closing, rest = behind.partition("]")
    rest = rest.strip()
    is_notation = closing and guard and "[" not in guard and "]" not in trigger
    if not is_notation or (rest and not rest.startswith("/")):
        return None
    return trigger.strip(), guard.strip(), rest.removeprefix("/").strip()


def read_transition_names(graph: Graph, sink: Sink) -> None:
    """Give transitions the trigger, guard and effect that only their names state."""
    for transition in graph.of_kind(Kind.TRANSITION):
        texts = _split_name(transition.name)
        has_guard = "guard" in transition.attrs or graph.targets(transition, Edge.GUARD)
        if texts is None or has_guard:
            continue
        trigger, guard, effect = texts
        graph.set(transition, guard=guard)
        parts = [f"the guard '{guard}'"]
        if trigger and not graph.targets(transition, Edge.TRIGGER):
            _add_trigger(graph, transition, trigger)
            parts.insert(0, f"the trigger '{trigger}'")
        if effect and not graph.targets(transition, Edge.EFFECT):
            _add_effect(graph, transition, effect)
            parts.append(f"the effect '{effect}'")
        subject = graph.subject(transition)
        sink.report(
            TRANSITION_FROM_NAME, subject, transition=transition.name, parts=" and ".join(parts)
        )


def _add_trigger(graph: Graph, transition: Element, text: str) -> None:
    """Add a trigger for the signal of this name, or for the event that only the name describes."""
    id = derived_id(transition.id, "trigger of the name")
    trigger = graph.add(
        Element(id, Kind.TRIGGER, text, transition.id, attrs={"origin": transition.id})
    )
    graph.connect(Edge.TRIGGER, transition, trigger)
    signals = [signal for signal in graph.of_kind(Kind.SIGNAL) if signal.name == text]
    if len(signals) == 1:
        graph.set(trigger, subkind="signal")
        graph.connect(Edge.TYPED_BY, trigger, signals[0])


def _add_effect(graph: Graph, transition: Element, text: str) -> None:
    id = derived_id(transition.id, "effect of the name")
    attributes: dict[str, AttrValue] = {"subkind": "opaque", "body": text, "origin": transition.id}
    effect = graph.add(Element(id, Kind.ACTIVITY, "", transition.id, attrs=attributes))
    graph.connect(Edge.EFFECT, transition, effect)
