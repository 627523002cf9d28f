"""View models: the data of the templates, and the aliases of elements.

Every text is PlantUML text, already escaped. Aliases are deterministic. ``shows`` are the ids of
the elements that a shape or line shows.
"""

import re
from collections import Counter
from collections.abc import Iterator
from functools import lru_cache

from msgspec import Struct


class Compartment(Struct, frozen=True):
    """Titled rows of a box."""

    title: str
    rows: tuple[str, ...]


class Box(Struct, frozen=True):
    """A classifier or a requirement."""

    alias: str
    label: str
    style: str
    compartments: tuple[Compartment, ...] = ()
    shows: tuple[str, ...] = ()


class Line(Struct, frozen=True):
    """A relation: ``source "near" arrow "far" target : label``."""

    source: str
    arrow: str
    target: str
    label: str = ""
    near: str = ""
    far: str = ""
    shows: tuple[str, ...] = ()


class BoxView(Struct, frozen=True):
    """Boxes and lines of block definition and requirement diagrams.

    ``guides`` are invisible lines that arrange unconnected boxes in a grid.
    """

    boxes: tuple[Box, ...]
    lines: tuple[Line, ...]
    guides: tuple[Line, ...] = ()


class Node(Struct, frozen=True):
    """A state, an activity node or a group of them.

    ``shape`` is the word by which PlantUML knows a special form (``choice``, ``fork``), or the
    style of a box. ``rows`` stand below the name, ``note`` beside the node; ``tint`` is the style
    of its partition.
    """

    alias: str
    label: str
    shape: str
    rows: tuple[str, ...] = ()
    children: tuple["Node", ...] = ()
    note: str = ""
    shows: tuple[str, ...] = ()
    tint: str = ""


class Note(Struct, frozen=True):
    """A note, tied to the nodes whose aliases are in ``targets``."""

    alias: str
    text: str
    targets: tuple[str, ...] = ()
    shows: tuple[str, ...] = ()


class GraphView(Struct, frozen=True):
    """Nodes and lines of activity and state machine diagrams."""

    nodes: tuple[Node, ...]
    lines: tuple[Line, ...]
    notes: tuple[Note, ...] = ()


class PortView(Struct, frozen=True):
    """A port on the border of a part; ``form`` is ``portin``, ``portout`` or ``port``."""

    alias: str
    label: str
    form: str
    shows: tuple[str, ...] = ()


class PartView(Struct, frozen=True):
    """A part with its ports and its inner parts."""

    alias: str
    label: str
    style: str
    ports: tuple[PortView, ...] = ()
    parts: tuple["PartView", ...] = ()
    shows: tuple[str, ...] = ()


class InternalView(Struct, frozen=True):
    """Parts in the frame of an internal block diagram; ``guides`` are invisible layout lines."""

    frame: PartView
    lines: tuple[Line, ...]
    has_ports: bool
    guides: tuple[Line, ...] = ()
    domains: tuple[str, ...] = ()
    """The domains (``physical``, ``information``) of the items that flow in the diagram."""


class Participant(Struct, frozen=True):
    """A lifeline; ``form`` is PlantUML's keyword (``participant``, ``actor``)."""

    alias: str
    label: str
    form: str
    shows: tuple[str, ...] = ()


class Step(Struct, frozen=True):
    """One line of a sequence diagram.

    ``word`` is ``message`` (``source arrow target : text``), a keyword of PlantUML about the
    lifeline ``source`` (``activate``, ``deactivate``, ``create``, ``destroy``), ``open`` (a frame
    ``arrow`` with ``text``), ``else``, ``end``, or a box over the lifelines ``over`` (``note``,
    ``hnote``, ``ref``), over all lifelines if ``over`` is empty.
    """

    word: str
    text: str = ""
    source: str = ""
    arrow: str = ""
    target: str = ""
    over: tuple[str, ...] = ()
    shows: tuple[str, ...] = ()


class SequenceView(Struct, frozen=True):
    """Lifelines and steps of sequence diagrams."""

    participants: tuple[Participant, ...]
    steps: tuple[Step, ...]


class Figure(Struct, frozen=True):
    """An actor or a use case; ``form`` is PlantUML's keyword, ``style`` the style of a stub."""

    alias: str
    label: str
    form: str
    style: str = ""
    shows: tuple[str, ...] = ()


class SubjectView(Struct, frozen=True):
    """The subject of use cases, drawn as a rectangle around them."""

    alias: str
    label: str
    cases: tuple[Figure, ...]


class UseCaseView(Struct, frozen=True):
    """Actors, subjects with use cases, use cases without subject, and lines."""

    actors: tuple[Figure, ...]
    subjects: tuple[SubjectView, ...]
    cases: tuple[Figure, ...]
    lines: tuple[Line, ...]
    notes: tuple[Note, ...] = ()


View = BoxView | GraphView | InternalView | SequenceView | UseCaseView


class Diagram(Struct, frozen=True, eq=False, weakref=True):
    """One diagram: its names, its view, and the element that it is about.

    ``kind`` is the type in its file name and template (bdd, ibd, act, stm, req, sd, uc), ``name``
    the qualified name behind its file name, ``about`` the id of the element, ``details`` the ids of
    the elements in the frame's heading.
    """

    kind: str
    name: str
    frame: str
    heading: tuple[str, str]
    view: View
    about: str = ""
    footer: str = ""
    details: tuple[str, ...] = ()

    def list_trace(self) -> tuple[str, ...]:
        """Return the ids of all elements that the diagram shows, each once."""
        ids = [self.about, *self.details] if self.about else []
        return tuple(dict.fromkeys([*ids, *_iter_shown_ids(self.view)]))


def _iter_shown_ids(view: View) -> Iterator[str]:
    if isinstance(view, SequenceView):
        for participant in view.participants:
            yield from participant.shows
        for step in view.steps:
            yield from step.shows
        return
    for line in view.lines:
        yield from line.shows
    if isinstance(view, UseCaseView):
        yield from _iter_use_case_ids(view)
    elif isinstance(view, BoxView):
        for box in view.boxes:
            yield from box.shows
    elif isinstance(view, GraphView):
        for node in view.nodes:
            yield from _iter_node_ids(node)
        for note in view.notes:
            yield from note.shows
    else:
        yield from _iter_part_ids(view.frame)


def _iter_use_case_ids(view: UseCaseView) -> Iterator[str]:
    inside = (case for subject in view.subjects for case in subject.cases)
    for figure in (*view.actors, *inside, *view.cases):
        yield from figure.shows
    for note in view.notes:
        yield from note.shows


def _iter_node_ids(node: Node) -> Iterator[str]:
    yield from node.shows
    for child in node.children:
        yield from _iter_node_ids(child)


def _iter_part_ids(part: PartView) -> Iterator[str]:
    yield from part.shows
    for port in part.ports:
        yield from port.shows
    for inner in part.parts:
        yield from _iter_part_ids(inner)


# -- aliases -----------------------------------------------------------------------------------

_NORMALIZED_NAMES = 1 << 12
"""Size of the cache of normalised names; the same names of states and actions occur often."""


Key = str | tuple[str, ...]
"""The id of an element, or the ids on the path to it."""


class Aliases:
    """Assigns an alias to each key: words of its name and a number.

    An alias is never a keyword of PlantUML, because no keyword ends in a number. The number counts
    equal words in the order of the diagram, so that adding an element elsewhere changes no line.
    """

    def __init__(self) -> None:
        self._alias_by_key: dict[Key, str] = {}
        self._uses_of_words: Counter[str] = Counter()

    def make(self, key: Key, name: str, fallback: str) -> str:
        """Return the alias of *key*, made of *name*, or of *fallback* if *name* has no letters."""
        if key not in self._alias_by_key:
            words = _normalize(name) or _normalize(fallback) or "e"
            self._uses_of_words[words] += 1
            self._alias_by_key[key] = f"{words}_{self._uses_of_words[words]}"
        return self._alias_by_key[key]

    def __contains__(self, key: object) -> bool:
        return key in self._alias_by_key

    def __getitem__(self, key: Key) -> str:
        return self._alias_by_key[key]


@lru_cache(_NORMALIZED_NAMES)
def _normalize(name: str) -> str:
    return re.sub(r"[^a-z0-9]+", "_", name.lower())[:24].strip("_")
