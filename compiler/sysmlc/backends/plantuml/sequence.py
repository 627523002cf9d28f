"""Sequence diagrams: one for each interaction with lifelines (UML 2.5.1 clauses 17.4 and 17.8).

Operands of a combined fragment are alternatives, so each begins with the execution bars that are
open before the fragment.
"""

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

from sysmlc.backends.plantuml import labels
from sysmlc.backends.plantuml.sequence_labels import (
    format_arguments,
    format_message,
    format_operand,
    format_time,
    index_notes,
    index_times,
)
from sysmlc.backends.plantuml.views import Aliases, Diagram, Participant, SequenceView, Step
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.ir.query import interactions
from sysmlc.support.plantuml_text import escape_line, format_label, join_rows, shrink, wrap_lines

_CHANGES = {"activate": 1, "deactivate": -1}


def balance_operands(contents: Sequence[Sequence[Step]]) -> list[list[Step]]:
    """Return the steps of the operands with corrections, and a list of steps after the fragment.

    PlantUML continues the bars of one operand in the next, as if the operands ran in sequence. The
    corrections restore the bars that were open before the fragment; they follow the first message
    of the operand, because PlantUML cannot end and start a bar on one line. The last list changes
    the bars by the sum of what the operands change.
    """
    balanced: list[list[Step]] = []
    open_bars: Counter[str] = Counter()
    for content in contents:
        balanced.append(_correct(content, open_bars))
        open_bars.update(_count_bars(balanced[-1]))
    wanted = _count_bars([step for content in contents for step in content])
    if balanced:
        balanced.append([*_iter_corrections(_subtract(wanted, open_bars))])
    return balanced


def _correct(content: Sequence[Step], open_bars: Counter[str]) -> list[Step]:
    first = next((i for i, step in enumerate(content) if step.word == "message"), None)
    if first is None:
        return list(content)
    corrections = _iter_corrections(_subtract(Counter(), open_bars))
    return [*content[: first + 1], *corrections, *content[first + 1 :]]


def _count_bars(steps: Sequence[Step]) -> Counter[str]:
    """Return, by lifeline, how many bars the steps open, minus those that they close."""
    bars: Counter[str] = Counter()
    for step in steps:
        if step.word in _CHANGES:
            bars[step.source] += _CHANGES[step.word]
    return bars


def _subtract(wanted: Counter[str], open_bars: Counter[str]) -> Counter[str]:
    result = Counter(wanted)
    result.subtract(open_bars)
    return result


def _iter_corrections(bars: Counter[str]) -> Iterator[Step]:
    for alias, number in bars.items():
        word = "activate" if number > 0 else "deactivate"
        for _ in range(abs(number)):
            yield Step(word, source=alias)


# -- diagrams --------------------------------------------------------------------------------------


_NOTE_WIDTH = 44
_FRAME_KINDS = (Kind.PARAMETER,)


@dataclass(slots=True)
class Walk:
    """State of the traversal of one interaction; ``aliases`` has the lifelines."""

    graph: Graph
    aliases: Aliases
    drawn: set[str] = field(default_factory=set)
    """Ids of messages, executions, times and notes that are in the drawing."""
    _participants: list[Element] = field(default_factory=list)
    _times: dict[str, list[Element]] = field(default_factory=dict)
    _notes: dict[str, list[Element]] = field(default_factory=dict)

    def begin(self, interaction: Element) -> None:
        """Index the times and notes about the elements of the interaction."""
        self._participants = interactions.lifelines(self.graph, interaction)
        self._times = index_times(self.graph, interaction)
        self._notes = index_notes(self.graph, interaction)

    def list_lifelines(self, item: Element) -> tuple[str, ...]:
        """Return the aliases of the lifelines that *item* covers.

        An interaction use that names no lifelines covers all.
        """
        covered = interactions.covered_lifelines(self.graph, item)
        if not covered and item.subkind in interactions.INTERACTION_USES:
            covered = self._participants
        return tuple(
            self.aliases[lifeline.id] for lifeline in covered if lifeline.id in self.aliases
        )

    def is_new(self, item: Element) -> bool:
        """Whether *item* is not drawn yet; the call marks it as drawn."""
        is_new = item.id not in self.drawn
        self.drawn.add(item.id)
        return is_new

    def format_text(self, about: Sequence[Element], *texts: str) -> tuple[str, tuple[str, ...]]:
        """Return a label and the ids of the time constraints and observations in it.

        The label has the *texts*, then the times that refer to an element of *about*.
        """
        times_found = [
            item
            for element in about
            for item in self._times.get(element.id, ())
            if self.is_new(item)
        ]
        rows = [*texts, *(format_time(self.graph, item) for item in times_found)]
        text = join_rows(row for part in rows for row in wrap_lines(part, _NOTE_WIDTH))
        return text, tuple(item.id for item in times_found)

    def iter_notes(self, item: Element, over: Sequence[str] = ()) -> Iterator[Step]:
        """Yield the notes about the element; they span the lifelines *over* (all if empty)."""
        for note in self._notes.get(item.id, ()):
            text = format_label(labels.note_text(note), _NOTE_WIDTH)
            if self.is_new(note) and text:
                yield Step("note", text, over=tuple(over), shows=(note.id,))


_HEAD_WIDTH = 24


def draw_sequences(graph: Graph) -> Iterator[Diagram]:
    """Yield all sequence diagrams, in the order of the model."""
    for interaction in graph.of_kind(Kind.INTERACTION):
        lifelines = interactions.lifelines(graph, interaction)
        if lifelines and not interaction.attrs.get("external"):
            yield _make_diagram(graph, interaction, lifelines)


def _make_diagram(graph: Graph, interaction: Element, lifelines: list[Element]) -> Diagram:

    aliases = Aliases()
    participants = tuple(_make_participant(graph, lifeline, aliases) for lifeline in lifelines)
    title = graph.qualified_name(interaction)
    features = [item.id for item in graph.owned(interaction) if item.kind in _FRAME_KINDS]
    return Diagram(
        kind="sd",
        name=title,
        frame=escape_line(f"sd {labels.name(interaction)}{labels.signature(graph, interaction)}"),
        heading=("Sequence diagram", title),
        view=SequenceView(participants, tuple(_iter_steps(graph, interaction, aliases))),
        about=interaction.id,
        details=tuple(features),
    )


def _make_participant(graph: Graph, lifeline: Element, aliases: Aliases) -> Participant:
    represented = interactions.participant(graph, lifeline)
    shows = [lifeline.id]
    if represented is not None and represented.owner == lifeline.owner:
        shows.append(represented.id)
    words = shrink(escape_line(labels.guillemets(labels.list_stereotypes(graph, lifeline))))
    kinds = (item.kind for item in (represented, interactions.type_of(graph, lifeline)) if item)
    is_actor = Kind.ACTOR in kinds
    return Participant(
        aliases.make(lifeline.id, _name_of_lifeline(graph, lifeline), "lifeline"),
        join_rows([words, format_label(_format_lifeline(graph, lifeline), _HEAD_WIDTH)]),
        "actor" if is_actor else "participant",
        tuple(shows),
    )


def _format_lifeline(graph: Graph, lifeline: Element) -> str:
    """Return ``name[selector] : Type`` (UML 2.5.1, 17.3.4)."""
    name = _name_of_lifeline(graph, lifeline)
    if lifeline.attrs.get("selector"):
        name += f"[{lifeline.attrs['selector']}]"
    type_ = interactions.type_of(graph, lifeline)
    if type_ is None:
        return name or labels.name(lifeline)
    return f"{name} : {labels.name(type_)}".strip()


def _name_of_lifeline(graph: Graph, lifeline: Element) -> str:
    """Return the name of the represented element, else the name of the lifeline.

    Tools generate names such as ``Lifeline1``.
    """
    represented = interactions.participant(graph, lifeline)
    if represented is None:
        return lifeline.name.strip()
    has_name = represented.name.strip() or interactions.type_of(graph, lifeline) is not None
    return (represented.name if has_name else lifeline.name).strip()


_ARROWS = {
    "asynch-call": "->>",
    "asynch-signal": "->>",
    "reply": "-->>",
    "create-message": "-->>",
}
"""Arrows by message sort; a filled head is a synchronous call (17.4.4)."""


def _iter_message_steps(walk: Walk, message: Element) -> Iterator[Step]:
    """Yield the message once, at the first of its two occurrences."""
    source, target = (
        _find_end(walk, message, Edge.FLOW_SOURCE),
        _find_end(walk, message, Edge.FLOW_TARGET),
    )
    if not (source or target) or not walk.is_new(message):
        return
    graph = walk.graph
    ends = [*graph.targets(message, Edge.SEND_EVENT), *graph.targets(message, Edge.RECEIVE_EVENT)]
    about = [message, *(end for end in ends if end.kind is Kind.OCCURRENCE)]
    text, times = walk.format_text(about, format_message(graph, message))
    if message.subkind == "create-message" and target != source:
        yield Step("create", source=target)
    yield Step(
        "message",
        text,
        source or _choose_outer_end(graph, message, Edge.SEND_EVENT),
        _ARROWS.get(message.subkind, "->"),
        target or _choose_outer_end(graph, message, Edge.RECEIVE_EVENT),
        shows=(message.id, *(end.id for end in ends), *times),
    )
    for item in about:
        yield from walk.iter_notes(item, [alias for alias in (source, target) if alias])


def _find_end(walk: Walk, message: Element, edge: Edge) -> str:
    lifeline = walk.graph.target(message, edge)
    return walk.aliases[lifeline.id] if lifeline is not None and lifeline.id in walk.aliases else ""


def _choose_outer_end(graph: Graph, message: Element, edge: Edge) -> str:
    """Return PlantUML's sign for an end that is on no lifeline (17.4.4).

    It is a gate on the frame, or a point for a lost or found message.
    """
    is_sent = edge is Edge.SEND_EVENT
    end = graph.target(message, Edge.SEND_EVENT if is_sent else Edge.RECEIVE_EVENT)
    if end is not None and end.kind is Kind.GATE:
        return "[" if is_sent else "]"
    return "?o" if is_sent else "o?"


_OPERATOR_KEYWORDS = frozenset(["alt", "opt", "loop", "par", "break", "critical"])
"""Operators with a keyword in PlantUML; other operators are drawn as ``group``."""


def _iter_steps(graph: Graph, interaction: Element, aliases: Aliases) -> Iterator[Step]:
    """Yield the steps of an interaction in their order; *aliases* has the lifelines."""
    walk = Walk(graph, aliases)
    walk.begin(interaction)
    known_aliases: set[str] = set()
    # PlantUML rejects "create" for a participant that an earlier line has used.
    for step in _iter_all_steps(walk, interaction):
        if step.word != "create" or (step.source and step.source not in known_aliases):
            yield step
        known_aliases.update((step.source, step.target, *step.over))


def _iter_all_steps(walk: Walk, interaction: Element) -> Iterator[Step]:
    """Yield all steps, including "create" for existing lifelines, which SM447 reports."""
    graph, aliases = walk.graph, walk.aliases
    yield from walk.iter_notes(interaction)
    for lifeline in interactions.lifelines(graph, interaction):
        yield from walk.iter_notes(lifeline, [aliases[lifeline.id]])
    yield from _iter_container(walk, interaction)
    # Messages without occurrences in a fragment come last; is_new skips those already drawn.
    for message in interactions.messages(graph, interaction):
        yield from _iter_message_steps(walk, message)


def _iter_container(walk: Walk, container: Element) -> Iterator[Step]:
    for item in interactions.interaction_fragments(walk.graph, container):
        if item.kind is Kind.OCCURRENCE:
            yield from _iter_occurrence(walk, item)
        elif item.kind is Kind.FRAGMENT:
            yield from _iter_fragment(walk, item)
        elif walk.graph.target(item, Edge.START) is None:
            yield from _iter_start(walk, item)


# -- occurrences -------------------------------------------------------------------------------


def _iter_occurrence(walk: Walk, item: Element) -> Iterator[Step]:
    candidates = (
        interactions.sent_message(walk.graph, item),
        interactions.received_message(walk.graph, item),
    )
    messages = [message for message in candidates if message is not None]
    for message in messages:
        yield from _iter_message_steps(walk, message)
    if not messages:
        yield from _iter_note_steps(walk, item)
    # Finish before start: a bar that ends where the next one starts is not nested in it.
    for execution in walk.graph.sources(item, Edge.FINISH):
        aliases = walk.list_lifelines(execution)
        if aliases and not walk.is_new(execution):
            yield Step("deactivate", source=aliases[0], shows=(execution.id,))
    for execution in walk.graph.sources(item, Edge.START):
        yield from _iter_start(walk, execution)
    if item.subkind == "destruction":
        for alias in walk.list_lifelines(item):
            yield Step("destroy", source=alias, shows=(item.id,))


def _iter_note_steps(walk: Walk, item: Element, *texts: str) -> Iterator[Step]:
    """Yield the note about an element, if it has text."""
    over = walk.list_lifelines(item)
    text, times = walk.format_text([item], *texts)
    if text:
        yield Step("note", text, over=over, shows=(item.id, *times))
    yield from walk.iter_notes(item, over)


def _iter_start(walk: Walk, execution: Element) -> Iterator[Step]:
    """Yield the start of an execution bar, unless the execution has ended already (SM445)."""
    aliases = walk.list_lifelines(execution)
    if aliases and walk.is_new(execution):
        behaviours = [labels.name(item) for item in walk.graph.targets(execution, Edge.CALLS)]
        yield Step("activate", source=aliases[0], shows=(execution.id,))
        yield from _iter_note_steps(walk, execution, *behaviours)


# -- fragments ---------------------------------------------------------------------------------


def _iter_fragment(walk: Walk, item: Element) -> Iterator[Step]:
    if item.subkind in interactions.INTERACTION_USES:
        yield _make_use(walk, item)
    elif item.subkind == "state-invariant":
        yield _make_invariant(walk, item)
    elif item.subkind == "continuation":
        text = format_label(labels.name(item))
        yield Step("hnote", text, over=walk.list_lifelines(item), shows=(item.id,))
    else:
        yield from _iter_combined_fragment(walk, item)
    yield from walk.iter_notes(item, walk.list_lifelines(item))


def _make_use(walk: Walk, item: Element) -> Step:
    called = [labels.name(interaction) for interaction in walk.graph.targets(item, Edge.CALLS)]
    result = item.attrs.get("return_value")
    text = f"{', '.join(called) or labels.name(item)}{format_arguments(item)}"
    text += f" : {labels.literal(result)}" if result is not None else ""
    return Step("ref", format_label(text), over=walk.list_lifelines(item), shows=(item.id,))


def _make_invariant(walk: Walk, item: Element) -> Step:
    constraints = [
        constraint for constraint in walk.graph.owned(item) if constraint.kind is Kind.CONSTRAINT
    ]
    texts = [
        str(constraint.attrs.get("body") or labels.name(constraint)) for constraint in constraints
    ]
    text = join_rows(row for text in texts or [labels.name(item)] for row in wrap_lines(text))
    shows = (item.id, *(constraint.id for constraint in constraints))
    return Step("hnote", text, over=walk.list_lifelines(item), shows=shows)


def _iter_combined_fragment(walk: Walk, item: Element) -> Iterator[Step]:
    parts = interactions.operands(walk.graph, item)
    contents = [[*walk.iter_notes(part), *_iter_container(walk, part)] for part in parts]
    heads = [_make_operand_head(walk, part) for part in parts] or [("", ())]
    is_group = item.subkind not in _OPERATOR_KEYWORDS
    first = f"[{heads[0][0]}]" if heads[0][0] and is_group else heads[0][0]
    yield Step("open", first, arrow=_format_operator(walk, item), shows=(item.id, *heads[0][1]))
    *inside, after = balance_operands(contents) or [[]]
    for number, content in enumerate(inside):
        if number:
            text, shown = heads[number]
            yield Step("else", text, shows=shown)
        yield from content
    yield Step("end")
    yield from after


def _make_operand_head(walk: Walk, operand: Element) -> tuple[str, tuple[str, ...]]:
    """Return the text above an operand, and the ids that it shows."""
    guards = (guard.id for guard in walk.graph.targets(operand, Edge.GUARD))
    return escape_line(format_operand(operand)), (operand.id, *guards)


def _format_operator(walk: Walk, item: Element) -> str:
    if item.subkind in _OPERATOR_KEYWORDS:
        return item.subkind
    gates = ", ".join(labels.name(gate) for gate in walk.graph.targets(item, Edge.REFERENCES))
    text = f"{item.subkind} {{{gates}}}" if gates else item.subkind
    return f"group {escape_line(text)}"
