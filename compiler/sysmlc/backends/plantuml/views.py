"""View models: the data of the templates. Every text in them is PlantUML text, already escaped."""

from collections.abc import Iterator

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
    """Boxes and lines: block definition and requirement diagrams.

    ``guides`` are invisible lines that set boxes without lines in a grid.
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
    """Nodes and lines: activities and state machines."""

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
    """Parts in their frame: internal block diagrams. ``guides`` are invisible, for the layout."""

    frame: PartView
    lines: tuple[Line, ...]
    has_ports: bool
    guides: tuple[Line, ...] = ()
    domains: tuple[str, ...] = ()
    """``physical`` and ``information``, where something of the kind flows."""


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
    """Lifelines and the steps between them: sequence diagrams."""

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
    """A subject as a rectangle with its use cases."""

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
