"""Differences between a model and the graph of its SysML v2 text, with the losses near them."""

import re
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from functools import cached_property

from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.ir.compare import Change

BEHAVIOURS = (Kind.ACTIVITY, Kind.INTERACTION, Kind.STATE_MACHINE)
_NEAR_EDGES = (
    Edge.SUBJECT,
    Edge.END,
    Edge.FLOW_SOURCE,
    Edge.FLOW_TARGET,
    Edge.REPRESENTS,
    Edge.CLIENT,
    Edge.SUPPLIER,
)
_NAMESPACES = (Kind.PACKAGE, Kind.PROFILE, Kind.CLASS, *BEHAVIOURS)


@dataclass
class RoundTrip:
    """A model, the graph of its text, and the losses by element id: codes and facts."""

    old: Graph
    new: Graph
    losses: dict[str, list[tuple[str, dict[str, str]]]]
    _losses_below: dict[str, list[str]] = field(default_factory=dict)

    @cached_property
    def old_by_name(self) -> dict[str, list[Element]]:
        """The elements of the model by qualified name."""
        index: dict[str, list[Element]] = {}
        for element in self.old:
            index.setdefault(self.old.qualified_name(element), []).append(element)
        return index

    def list_losses(self, element: Element) -> list[str]:
        """Return the losses of an element as texts: code and facts."""
        losses = self.losses.get(element.id, ())
        return [f"{code} {' '.join(facts.values())}" for code, facts in losses]

    def list_losses_below(self, element: Element) -> list[str]:
        """Return the losses of an element and of all that it owns, each once."""
        if element.id not in self._losses_below:
            losses = (loss for e in self.old.subtree(element) for loss in self.list_losses(e))
            self._losses_below[element.id] = list(dict.fromkeys(losses))
        return self._losses_below[element.id]

    def explain(
        self, changes: list[Change], reasons: "list[Reason]"
    ) -> tuple[Counter[str], list[str]]:
        """Count the changes by the first reason that fits, and list the unexplained ones."""
        counts: Counter[str] = Counter()
        unexplained: list[str] = []
        for change in changes:
            difference = Difference(self, change)
            reason = next((r for r in reasons if r.explains(difference)), None)
            if reason is None:
                unexplained.append(str(difference))
            else:
                counts[reason.sentence] += 1
        return counts, unexplained


@dataclass
class Difference:
    """One change, with its elements and the losses near them."""

    trip: RoundTrip
    change: Change
    old: Element | None = field(init=False)
    new: Element | None = field(init=False)

    def __post_init__(self) -> None:
        old, new = self.change.old, self.change.new
        self.old = None if old is None else self.trip.old.get(old.id)
        self.new = None if new is None else self.trip.new.get(new.id)

    def __str__(self) -> str:
        change = self.change
        kind = self.kind
        return (
            f"{change.what} {kind} {change.owner}::{change.name} {change.aspect}: "
            f"{change.before} => {change.after}"
        )

    @property
    def kind(self) -> Kind | None:
        """The kind of the element in the model, or in the text if only the text has it."""
        element = self.old or self.new
        return None if element is None else element.kind

    def is_about(self, *aspects: str) -> bool:
        """Whether the change is about one of these aspects."""
        return self.change.aspect in aspects

    @cached_property
    def losses(self) -> list[str]:
        """The losses of the element, its details, its owners and the elements beside it."""
        elements = dict.fromkeys(self._iter_near())
        return [loss for element in elements for loss in self.trip.list_losses(element)]

    def _iter_near(self) -> Iterator[Element]:
        graph = self.trip.old
        if self.old is not None:
            for child in (self.old, *graph.owned(self.old)):
                yield child
                yield from graph.owned(child) if child.kind not in _NAMESPACES else ()
            yield from graph.ancestors(self.old)
            for edge in _NEAR_EDGES:
                yield from graph.sources(self.old, edge)
                yield from graph.targets(self.old, edge)
            for end in graph.sources(self.old, Edge.ROLE):
                yield from graph.ancestors(end)
            return
        for owner in self.trip.old_by_name.get(self.change.owner, ()):
            yield owner
            yield from graph.ancestors(owner)
            for child in graph.owned(owner):
                yield child
                yield from graph.sources(child, Edge.REALIZING)
                yield from graph.sources(child, Edge.CLIENT)
                for member in graph.owned(child):
                    if child.kind is Kind.ENUMERATION:
                        yield member
                    yield from graph.sources(member, Edge.CLIENT)
            yield from graph.sources(owner, Edge.CLIENT)

    @cached_property
    def behaviour_losses(self) -> list[str]:
        """The losses in the outermost behaviour around the element."""
        graph = self.trip.old
        starts = [self.old] if self.old else self.trip.old_by_name.get(self.change.owner, [])
        behaviours = {
            ancestor.id: ancestor
            for start in starts
            for ancestor in (start, *graph.ancestors(start))
            if ancestor.kind in BEHAVIOURS
        }
        return [
            loss
            for behaviour in behaviours.values()
            for loss in self.trip.list_losses_below(behaviour)
        ]


@dataclass(frozen=True)
class Reason:
    """Why differences of one form remain; ``loss`` is the start of the loss that announces them."""

    sentence: str
    fits: Callable[[Difference], bool]
    loss: str = ""
    is_in_behaviour: bool = False
    """Whether the loss may stand anywhere in the same behaviour."""

    def explains(self, difference: Difference) -> bool:
        """Whether the reason fits and the loss was reported."""
        if not self.fits(difference):
            return False
        losses = difference.behaviour_losses if self.is_in_behaviour else difference.losses
        return not self.loss or any(re.match(self.loss, loss) for loss in losses)
