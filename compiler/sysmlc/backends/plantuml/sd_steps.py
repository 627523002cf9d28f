"""What happens in an interaction, line by line: messages, bars, frames, uses, invariants."""

from collections.abc import Iterator

from sysmlc.backends.plantuml import labels
from sysmlc.backends.plantuml.aliases import Aliases
from sysmlc.backends.plantuml.sd_bars import operands
from sysmlc.backends.plantuml.sd_messages import message_steps
from sysmlc.backends.plantuml.sd_texts import arguments, operand_text
from sysmlc.backends.plantuml.sd_walk import Walk
from sysmlc.backends.plantuml.views import Step
from sysmlc.ir import Edge, Element, Kind
from sysmlc.ir.graph import Graph
from sysmlc.ir.query import interactions
from sysmlc.support.plantuml_text import label, lines, plain, stack

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
    for lifeline in interactions.lifelines(graph, interaction):
        yield from walk.notes(lifeline, [aliases[lifeline.id]])
    yield from _inside(walk, interaction)
    for message in interactions.messages(graph, interaction):
        yield from message_steps(walk, message)


def _inside(walk: Walk, container: Element) -> Iterator[Step]:
    for item in interactions.interaction_fragments(walk.graph, container):
        if item.kind is Kind.OCCURRENCE:
            yield from _occurrence(walk, item)
        elif item.kind is Kind.FRAGMENT:
            yield from _fragment(walk, item)
        elif walk.graph.target(item, Edge.START) is None:
            yield from _start(walk, item)


# -- occurrences -------------------------------------------------------------------------------


def _occurrence(walk: Walk, item: Element) -> Iterator[Step]:
    found = (
        interactions.sent_message(walk.graph, item),
        interactions.received_message(walk.graph, item),
    )
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
    if item.subkind in interactions.INTERACTION_USES:
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
    parts = interactions.operands(walk.graph, item)
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
