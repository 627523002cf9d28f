"""How far the drawing of one interaction has come, and what is said about its elements."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

from sysmlc.backends.plantuml import labels
from sysmlc.backends.plantuml.aliases import Aliases
from sysmlc.backends.plantuml.sd_texts import notes, time_text, times
from sysmlc.backends.plantuml.views import Step
from sysmlc.ir import Element, Graph
from sysmlc.ir.query import interactions
from sysmlc.support.plantuml_text import label, lines, stack

_WIDTH = 44


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
        self._participants = interactions.lifelines(self.graph, interaction)
        self._times = times(self.graph, interaction)
        self._notes = notes(self.graph, interaction)

    def lifelines(self, item: Element) -> tuple[str, ...]:
        """Aliases of the lifelines that it covers; a use that names none covers all."""
        covered = interactions.covered_lifelines(self.graph, item)
        if not covered and item.subkind in interactions.INTERACTION_USES:
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
        text = stack(row for part in rows for row in lines(part, _WIDTH))
        return text, tuple(item.id for item in found)

    def notes(self, item: Element, over: Sequence[str] = ()) -> Iterator[Step]:
        """Notes about the element, over these lifelines or all."""
        for note in self._notes.get(item.id, ()):
            text = label(labels.note_text(note), _WIDTH)
            if self.is_new(note) and text:
                yield Step("note", text, over=tuple(over), shows=(note.id,))
