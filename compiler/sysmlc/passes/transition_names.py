"""Names of transitions in the notation of diagrams, ``trigger [guard] / effect``, read as these.

Some modellers and tools have the whole text of a transition only in its name (UML 2.5.1, 14.2.4.9).
"""

from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.ir import AttrValue, Edge, Element, Graph, Kind
from sysmlc.ir.element import derived_id

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
