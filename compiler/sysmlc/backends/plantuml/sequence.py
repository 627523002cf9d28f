"""Sequence diagrams: one for each interaction with lifelines (UML 2.5.1 clause 17.8)."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

from sysmlc.backends.plantuml import labels
from sysmlc.backends.plantuml.aliases import Aliases
from sysmlc.backends.plantuml.execution_bars import operands
from sysmlc.backends.plantuml.sequence_labels import (
    arguments,
    message_text,
    notes,
    operand_text,
    time_text,
    times,
)
from sysmlc.backends.plantuml.views import Diagram, Participant, SequenceView, Step
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.ir.query import interactions as sequence
from sysmlc.support.plantuml_text import label, lines, plain, small, stack

_NOTE_WIDTH = 44


@dataclass(slots=True)
class Walk:
    """The state of one drawing; ``aliases`` has the lifelines."""

    graph: Graph
    aliases: Aliases
    drawn: set[str] = field(default_factory=set)
    """Ids of messages, executions, times and notes that are in the drawing."""
    _participants: list[Element] = field(default_factory=list)
    _times: dict[str, list[Element]] = field(default_factory=dict)
    _notes: dict[str, list[Element]] = field(default_factory=dict)

    def begin(self, interaction: Element) -> None:
        """Find what is said about the elements of the interaction."""
        self._participants = sequence.lifelines(self.graph, interaction)
        self._times = times(self.graph, interaction)
        self._notes = notes(self.graph, interaction)

    def lifelines(self, item: Element) -> tuple[str, ...]:
        """Aliases of the lifelines that it covers; a use that names none covers all."""
        covered = sequence.covered(self.graph, item)
        if not covered and item.subkind in sequence.USES:
            covered = self._participants
        return tuple(self.aliases[one.id] for one in covered if one.id in self.aliases)

    def is_new(self, item: Element) -> bool:
        """Whether it is not drawn yet; from now on it is."""
        is_new = item.id not in self.drawn
        self.drawn.add(item.id)
        return is_new

    def text(self, about: Sequence[Element], *texts: str) -> tuple[str, tuple[str, ...]]:
        """The texts, with the times that are said of the elements below; and those times' ids."""
        found = [item for one in about for item in self._times.get(one.id, ()) if self.is_new(item)]
        rows = [*texts, *(time_text(self.graph, item) for item in found)]
        text = stack(row for part in rows for row in lines(part, _NOTE_WIDTH))
        return text, tuple(item.id for item in found)

    def notes(self, item: Element, over: Sequence[str] = ()) -> Iterator[Step]:
        """Notes about the element, over these lifelines or all."""
        for note in self._notes.get(item.id, ()):
            text = label(labels.note_text(note), _NOTE_WIDTH)
            if self.is_new(note) and text:
                yield Step("note", text, over=tuple(over), shows=(note.id,))


_HEAD_WIDTH = 24


def diagrams(graph: Graph) -> Iterator[Diagram]:
    """All sequence diagrams, in the order of the model."""
    for interaction in graph.of_kind(Kind.INTERACTION):
        lifelines = sequence.lifelines(graph, interaction)
        if lifelines and not interaction.attrs.get("external"):
            yield _diagram(graph, interaction, lifelines)


def _diagram(graph: Graph, interaction: Element, lifelines: list[Element]) -> Diagram:

    aliases = Aliases()
    participants = tuple(_participant(graph, one, aliases) for one in lifelines)
    whole = graph.qualified_name(interaction)
    features = [item.id for item in graph.owned(interaction) if item.kind in _IN_FRAME]
    return Diagram(
        kind="sd",
        name=whole,
        frame=plain(f"sd {labels.name(interaction)}{labels.signature(graph, interaction)}"),
        heading=("Sequence diagram", whole),
        view=SequenceView(participants, tuple(steps(graph, interaction, aliases))),
        about=interaction.id,
        details=tuple(features),
    )


_IN_FRAME = (Kind.PARAMETER,)


def _participant(graph: Graph, lifeline: Element, aliases: Aliases) -> Participant:
    represented = sequence.participant(graph, lifeline)
    shows = [lifeline.id]
    if represented is not None and represented.owner == lifeline.owner:
        shows.append(represented.id)
    words = small(plain(labels.guillemets(labels.applied(graph, lifeline))))
    return Participant(
        aliases.make(lifeline.id, _name(graph, lifeline), "lifeline"),
        stack([words, label(_title(graph, lifeline), _HEAD_WIDTH)]),
        "actor" if _is_actor(graph, lifeline) else "participant",
        tuple(shows),
    )


def _title(graph: Graph, lifeline: Element) -> str:
    """``name[selector] : Type`` (UML 2.5.1, 17.3.4)."""
    name = _name(graph, lifeline)
    if lifeline.attrs.get("selector"):
        name += f"[{lifeline.attrs['selector']}]"
    type_ = sequence.type_of(graph, lifeline)
    if type_ is None:
        return name or labels.name(lifeline)
    return f"{name} : {labels.name(type_)}".strip()


def _name(graph: Graph, lifeline: Element) -> str:
    """The name of what it represents; tools number the lifelines themselves."""
    represented = sequence.participant(graph, lifeline)
    if represented is None:
        return lifeline.name.strip()
    is_told = represented.name.strip() or sequence.type_of(graph, lifeline) is not None
    return (represented.name if is_told else lifeline.name).strip()


def _is_actor(graph: Graph, lifeline: Element) -> bool:
    found = (sequence.participant(graph, lifeline), sequence.type_of(graph, lifeline))
    return any(item is not None and item.kind is Kind.ACTOR for item in found)


_ARROWS = {
    "asynch-call": "->>",
    "asynch-signal": "->>",
    "reply": "-->>",
    "create-message": "-->>",
}
"""Arrows by message sort; a filled head is a synchronous call (17.4.4)."""


def message_steps(walk: Walk, message: Element) -> Iterator[Step]:
    """The message, once: at the first of its two occurrences."""
    source, target = (
        _find_end(walk, message, Edge.FLOW_SOURCE),
        _find_end(walk, message, Edge.FLOW_TARGET),
    )
    if not (source or target) or not walk.is_new(message):
        return
    graph = walk.graph
    ends = [*graph.targets(message, Edge.SEND_EVENT), *graph.targets(message, Edge.RECEIVE_EVENT)]
    about = [message, *(end for end in ends if end.kind is Kind.OCCURRENCE)]
    text, times = walk.text(about, message_text(graph, message))
    if message.subkind == "create-message" and target != source:
        yield Step("create", source=target)
    yield Step(
        "message",
        text,
        source or _outside(graph, message, Edge.SEND_EVENT),
        _ARROWS.get(message.subkind, "->"),
        target or _outside(graph, message, Edge.RECEIVE_EVENT),
        shows=(message.id, *(end.id for end in ends), *times),
    )
    for item in about:
        yield from walk.notes(item, [alias for alias in (source, target) if alias])


def _find_end(walk: Walk, message: Element, edge: Edge) -> str:
    lifeline = walk.graph.target(message, edge)
    return walk.aliases[lifeline.id] if lifeline is not None and lifeline.id in walk.aliases else ""


def _outside(graph: Graph, message: Element, edge: Edge) -> str:
    """A gate is on the frame; an end that nobody knows is a point (17.4.4)."""
    is_sent = edge is Edge.SEND_EVENT
    end = graph.target(message, Edge.SEND_EVENT if is_sent else Edge.RECEIVE_EVENT)
    if end is not None and end.kind is Kind.GATE:
        return "[" if is_sent else "]"
    return "?o" if is_sent else "o?"


_FRAMES = frozenset(["alt", "opt", "loop", "par", "break", "critical"])
"""Operators that PlantUML has words for; others are groups."""


def steps(graph: Graph, interaction: Element, aliases: Aliases) -> Iterator[Step]:
    """The steps in their order; ``aliases`` has the lifelines."""
    walk = Walk(graph, aliases)
    walk.begin(interaction)
    seen: set[str] = set()
    for step in _every(walk, interaction):
        if step.word != "create" or (step.source and step.source not in seen):
            yield step
        seen.update((step.source, step.target, *step.over))


def _every(walk: Walk, interaction: Element) -> Iterator[Step]:
    """All steps; PlantUML cannot create what is there already (SM447 reports it)."""
    graph, aliases = walk.graph, walk.aliases
    yield from walk.notes(interaction)
    for lifeline in sequence.lifelines(graph, interaction):
        yield from walk.notes(lifeline, [aliases[lifeline.id]])
    yield from _inside(walk, interaction)
    for message in sequence.messages(graph, interaction):
        yield from message_steps(walk, message)


def _inside(walk: Walk, container: Element) -> Iterator[Step]:
    for item in sequence.happenings(walk.graph, container):
        if item.kind is Kind.OCCURRENCE:
            yield from _occurrence(walk, item)
        elif item.kind is Kind.FRAGMENT:
            yield from _fragment(walk, item)
        elif walk.graph.target(item, Edge.START) is None:
            yield from _start(walk, item)


# -- occurrences -------------------------------------------------------------------------------


def _occurrence(walk: Walk, item: Element) -> Iterator[Step]:
    found = (sequence.sent(walk.graph, item), sequence.received(walk.graph, item))
    messages = [message for message in found if message is not None]
    for message in messages:
        yield from message_steps(walk, message)
    if not messages:
        yield from _said(walk, item)
    for execution in walk.graph.sources(item, Edge.FINISH):
        yield from _finish(walk, execution)
    for execution in walk.graph.sources(item, Edge.START):
        yield from _start(walk, execution)
    if item.subkind == "destruction":
        for alias in walk.lifelines(item):
            yield Step("destroy", source=alias, shows=(item.id,))


def _said(walk: Walk, item: Element, *texts: str) -> Iterator[Step]:
    """What is said of it, in a note; nothing when that is nothing."""
    over = walk.lifelines(item)
    text, times = walk.text([item], *texts)
    if text:
        yield Step("note", text, over=over, shows=(item.id, *times))
    yield from walk.notes(item, over)


def _start(walk: Walk, execution: Element) -> Iterator[Step]:
    """The bar begins; one that has ended already is not drawn (SM445 reports it)."""
    aliases = walk.lifelines(execution)
    if aliases and walk.is_new(execution):
        called = [labels.name(item) for item in walk.graph.targets(execution, Edge.CALLS)]
        yield Step("activate", source=aliases[0], shows=(execution.id,))
        yield from _said(walk, execution, *called)


def _finish(walk: Walk, execution: Element) -> Iterator[Step]:
    aliases = walk.lifelines(execution)
    if aliases and not walk.is_new(execution):
        yield Step("deactivate", source=aliases[0], shows=(execution.id,))


# -- fragments ---------------------------------------------------------------------------------


def _fragment(walk: Walk, item: Element) -> Iterator[Step]:
    if item.subkind in sequence.USES:
        yield _use(walk, item)
    elif item.subkind == "state-invariant":
        yield _invariant(walk, item)
    elif item.subkind == "continuation":
        text = label(labels.name(item))
        yield Step("hnote", text, over=walk.lifelines(item), shows=(item.id,))
    else:
        yield from _combined(walk, item)
    yield from walk.notes(item, walk.lifelines(item))


def _use(walk: Walk, item: Element) -> Step:
    called = [labels.name(one) for one in walk.graph.targets(item, Edge.CALLS)]
    result = item.attrs.get("return_value")
    text = f"{', '.join(called) or labels.name(item)}{arguments(item)}"
    text += f" : {labels.literal(result)}" if result is not None else ""
    return Step("ref", label(text), over=walk.lifelines(item), shows=(item.id,))


def _invariant(walk: Walk, item: Element) -> Step:
    owned = [one for one in walk.graph.owned(item) if one.kind is Kind.CONSTRAINT]
    texts = [str(one.attrs.get("body") or labels.name(one)) for one in owned]
    text = stack(row for text in texts or [labels.name(item)] for row in lines(text))
    shows = (item.id, *(one.id for one in owned))
    return Step("hnote", text, over=walk.lifelines(item), shows=shows)


def _combined(walk: Walk, item: Element) -> Iterator[Step]:
    parts = sequence.operands(walk.graph, item)
    contents = [[*walk.notes(part), *_inside(walk, part)] for part in parts]
    heads = [_head(walk, part) for part in parts] or [("", ())]
    is_group = item.subkind not in _FRAMES
    first = f"[{heads[0][0]}]" if heads[0][0] and is_group else heads[0][0]
    yield Step("open", first, arrow=_operator(walk, item), shows=(item.id, *heads[0][1]))
    *inside, after = operands(contents) or [[]]
    for number, content in enumerate(inside):
        if number:
            text, shown = heads[number]
            yield Step("else", text, shows=shown)
        yield from content
    yield Step("end")
    yield from after


def _head(walk: Walk, operand: Element) -> tuple[str, tuple[str, ...]]:
    """What stands above an operand, and the ids that it shows."""
    guards = (one.id for one in walk.graph.targets(operand, Edge.GUARD))
    return plain(operand_text(operand)), (operand.id, *guards)


def _operator(walk: Walk, item: Element) -> str:
    if item.subkind in _FRAMES:
        return item.subkind
    named = ", ".join(labels.name(one) for one in walk.graph.targets(item, Edge.REFERENCES))
    text = f"{item.subkind} {{{named}}}" if named else item.subkind
    return f"group {plain(text)}"
