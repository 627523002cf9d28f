"""Names of transitions in the notation of diagrams, ``trigger [guard] / effect``, read as these.

Some modellers and tools have the whole text of a transition only in its name (UML 2.5.1, 14.2.4.9).
"""

import re

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
_NOTATION = re.compile(r"\s*(?P<trigger>[^\[\]]*?)\s*\[(?P<guard>[^\[\]]+)\]\s*(/(?P<effect>.*))?")


def read_transition_names(graph: Graph, sink: Sink) -> None:
    """Give transitions the trigger, guard and effect that only their names state."""
    for transition in graph.of_kind(Kind.TRANSITION):
        match = _NOTATION.fullmatch(transition.name)
        has_guard = "guard" in transition.attrs or graph.targets(transition, Edge.GUARD)
        if match is None or has_guard:
            continue
        graph.set(transition, guard=match["guard"].strip())
        parts = [f"the guard '{match['guard'].strip()}'"]
        if match["trigger"] and not graph.targets(transition, Edge.TRIGGER):
            _add_trigger(graph, transition, match["trigger"])
            parts.insert(0, f"the trigger '{match['trigger']}'")
        effect = (match["effect"] or "").strip()
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
