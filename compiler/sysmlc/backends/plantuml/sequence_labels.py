"""Labels of messages, guards, times and notes of interactions (UML 2.5.1 clauses 17.4, 8.4)."""

import re
from collections.abc import Iterable

from sysmlc.backends.plantuml import labels
from sysmlc.ir import Edge, Element, Graph, Kind, as_items
from sysmlc.ir.query import interactions

_TIMES = ("duration", "time")
_TOOL_NAME = re.compile(r"(interaction ?)?operand[ _]?\d*", re.IGNORECASE)


def format_message(graph: Graph, message: Element) -> str:
    """Return ``name(arguments)`` with the name of the signature if the message has one."""
    names = [labels.name(item) for item in graph.targets(message, Edge.CALLS)]
    words = labels.guillemets(labels.list_stereotypes(graph, message))
    name = ", ".join(names) or message.name.strip()
    text = f"{name}{format_arguments(message)}" if name else ""
    return f"{words} {text}".strip()


def format_arguments(item: Element) -> str:
    """Return ``(1, x)``, or an empty text if the model gives no arguments."""
    values = item.attrs.get("arguments")
    if values is None:
        return ""
    words = (" ".join(labels.literal(value).split()) for value in as_items(values))
    return f"({', '.join(words)})"


def format_operand(operand: Element) -> str:
    """Return ``(1, 3) guard`` of an operand, or its name if it has no guard.

    The numbers are the bounds of a loop (17.6.4).
    """
    bounds = [operand.attrs.get(key) for key in ("min", "max")]
    bound_texts = [labels.literal(value) for value in bounds if value is not None]
    guard = labels.literal(operand.attrs.get("guard", "")).strip()
    if guard.startswith("[") and guard.endswith("]"):
        guard = guard[1:-1]  # Modellers write the brackets of the notation into the guard.
    if not guard and not _TOOL_NAME.fullmatch(operand.name):
        guard = operand.name.strip()
    parts = [f"({', '.join(bound_texts)})" if bound_texts else "", guard]
    return " ".join(part for part in parts if part)


def format_time(graph: Graph, item: Element) -> str:
    """Return ``{2..5 s}`` of a time constraint, or ``t = now`` of an observation.

    If it refers to two events, ``since`` and the name of the first event follow.
    """
    if item.kind is Kind.OBSERVATION:
        text = f"{labels.name(item)} = {'now' if item.subkind == 'time' else 'duration'}"
    else:
        text = labels.condition(item)
    about = graph.targets(item, Edge.REFERENCES)
    return f"{text} since {name_of_event(graph, about[0])}" if len(about) > 1 else text


def name_of_event(graph: Graph, event: Element) -> str:
    """Return the label of the message that is sent or received at *event*, else its name."""
    message = (
        interactions.sent_message(graph, event)
        or interactions.received_message(graph, event)
        or event
    )
    return (format_message(graph, message) if message.kind is Kind.MESSAGE else "") or (
        labels.name(message)
    )


def index_times(graph: Graph, interaction: Element) -> dict[str, list[Element]]:
    """Return time constraints and observations, by the id of the last event to which they refer."""
    constraints = [
        item
        for item in graph.owned(interaction)
        if item.kind is Kind.CONSTRAINT and item.subkind in _TIMES
    ]
    inside = {item.id for item in graph.subtree(interaction)}
    times_by_event: dict[str, list[Element]] = {}
    for item in [*constraints, *graph.of_kind(Kind.OBSERVATION)]:
        about = graph.targets(item, Edge.REFERENCES)
        if about and about[-1].id in inside:
            times_by_event.setdefault(about[-1].id, []).append(item)
    return times_by_event


def index_notes(graph: Graph, interaction: Element) -> dict[str, list[Element]]:
    """Return comments and other constraints inside the interaction, by the id of their subject."""
    notes_by_id: dict[str, list[Element]] = {}
    for item in graph.subtree(interaction):
        if item.kind is Kind.COMMENT or _is_constraint_note(item, interaction):
            about = graph.targets(item, Edge.REFERENCES)
            notes_by_id.setdefault(_find_subject(about, interaction), []).append(item)
    return notes_by_id


def _is_constraint_note(item: Element, interaction: Element) -> bool:
    is_own = item.kind is Kind.CONSTRAINT and item.owner == interaction.id
    return is_own and item.subkind not in _TIMES


def _find_subject(about: Iterable[Element], interaction: Element) -> str:
    return next((item.id for item in about), interaction.id)
