"""How messages, guards, times and notes of interactions read (UML 2.5.1 clauses 17.4, 8.4)."""

import re
from collections.abc import Iterable

from sysmlc.backends.plantuml import labels
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.ir.query import interactions

_TIMES = ("duration", "time")
_TOOL_NAME = re.compile(r"(interaction ?)?operand[ _]?\d*", re.IGNORECASE)


def message_text(graph: Graph, message: Element) -> str:
    """``name(arguments)``: the name of the signature, when the message has one."""
    names = [labels.name(item) for item in graph.targets(message, Edge.CALLS)]
    words = labels.guillemets(labels.applied(graph, message))
    name = ", ".join(names) or message.name.strip()
    text = f"{name}{arguments(message)}" if name else ""
    return f"{words} {text}".strip()


def arguments(item: Element) -> str:
    """``(1, x)``, or nothing when the model gives no arguments."""
    found = item.attrs.get("arguments")
    if found is None:
        return ""
    texts = found if isinstance(found, tuple) else (found,)
    words = (" ".join(labels.literal(text).split()) for text in texts)
    return f"({', '.join(words)})"


def operand_text(operand: Element) -> str:
    """``(1, 3) guard`` of an operand, without guard its name; bounds are a loop's (17.6.4)."""
    bounds = [operand.attrs.get(key) for key in ("min", "max")]
    told = [labels.literal(value) for value in bounds if value is not None]
    guard = labels.literal(operand.attrs.get("guard", "")).strip()
    if guard.startswith("[") and guard.endswith("]"):
        guard = guard[1:-1]  # Modellers write the brackets of the notation into the guard.
    if not guard and not _TOOL_NAME.fullmatch(operand.name):
        guard = operand.name.strip()
    parts = [f"({', '.join(told)})" if told else "", guard]
    return " ".join(part for part in parts if part)


def time_text(graph: Graph, item: Element) -> str:
    """``{2..5 s}`` of a constraint, ``t = now`` of an observation; ``since`` the first event."""
    if item.kind is Kind.OBSERVATION:
        text = f"{labels.name(item)} = {'now' if item.subkind == 'time' else 'duration'}"
    else:
        text = labels.condition(item)
    about = graph.targets(item, Edge.REFERENCES)
    return f"{text} since {event_name(graph, about[0])}" if len(about) > 1 else text


def event_name(graph: Graph, event: Element) -> str:
    """The message of an occurrence, else the name of the element."""
    message = (
        interactions.sent_message(graph, event)
        or interactions.received_message(graph, event)
        or event
    )
    return (message_text(graph, message) if message.kind is Kind.MESSAGE else "") or (
        labels.name(message)
    )


def times(graph: Graph, interaction: Element) -> dict[str, list[Element]]:
    """Constraints and observations of time, by the id of the last event that they are about."""
    own = [item for item in graph.owned(interaction) if _is_time(item)]
    inside = {item.id for item in graph.subtree(interaction)}
    found: dict[str, list[Element]] = {}
    for item in [*own, *graph.of_kind(Kind.OBSERVATION)]:
        about = graph.targets(item, Edge.REFERENCES)
        if about and about[-1].id in inside:
            found.setdefault(about[-1].id, []).append(item)
    return found


def _is_time(item: Element) -> bool:
    return item.kind is Kind.CONSTRAINT and item.subkind in _TIMES


def notes(graph: Graph, interaction: Element) -> dict[str, list[Element]]:
    """Comments inside, and other constraints, by the id of what they are about."""
    found: dict[str, list[Element]] = {}
    for item in graph.subtree(interaction):
        if item.kind is Kind.COMMENT or _is_rule(item, interaction):
            about = graph.targets(item, Edge.REFERENCES)
            found.setdefault(_place(about, interaction), []).append(item)
    return found


def _is_rule(item: Element, interaction: Element) -> bool:
    is_own = item.kind is Kind.CONSTRAINT and item.owner == interaction.id
    return is_own and item.subkind not in _TIMES


def _place(about: Iterable[Element], interaction: Element) -> str:
    return next((item.id for item in about), interaction.id)
