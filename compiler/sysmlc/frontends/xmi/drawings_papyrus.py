"""Diagrams of Papyrus: the file ``.notation`` beside a model, in GMF's notation."""

from collections.abc import Iterator
from dataclasses import dataclass, field

from sysmlc.frontends.xmi import drawing_relations
from sysmlc.frontends.xmi.drawing_shapes import target_of
from sysmlc.frontends.xmi.drawing_types import diagram_word
from sysmlc.ir.drawing import Drawing
from sysmlc.sources import Source
from sysmlc.sources.xml import parse, plain_parser

SUFFIX = ".notation"
_DIAGRAM = "Diagram"
_NODES = ("children", "edges", "persistedChildren", "transientChildren", "persistedEdges")
_LABELS = ("StereotypeLabel", "StereotypeBrace", "StereotypeCompartment", "StereotypeComment")
"""Nodes that name a stereotype; a stereotype that is drawn itself is a ``Stereotype_Shape``."""


def drawings(notation: Source, model: Source) -> Iterator[Drawing]:
    """The diagrams in the notation file of a model. Raises SourceError."""
    relations = drawing_relations.relations(model)
    reader = _Reader()
    made = plain_parser()
    made.StartElementHandler = reader.start
    made.EndElementHandler = reader.end
    parse(notation, made)
    for draft in reader.drafts:
        shown = tuple(dict.fromkeys(path[-1] for path in draft.paths))
        yield Drawing(
            draft.id,
            draft.name,
            draft.type,
            diagram_word(draft.kind, draft.type),
            model.name,
            notation.name,
            draft.ordinal,
            draft.owner or draft.context,
            draft.context,
            shown,
            tuple(path for path in draft.paths if len(path) > 1),
            relations=drawing_relations.shown(relations, shown),
        )


@dataclass(slots=True)
class _Draft:
    """A diagram while it is read; ``kind`` is the profile's word for it (Papyrus SysML)."""

    id: str
    name: str
    type: str
    ordinal: int
    kind: str = ""
    owner: str = ""
    context: str = ""
    paths: dict[tuple[str, ...], None] = field(default_factory=dict)


@dataclass(slots=True)
class _Node:
    """A node that is open: what it shows, and whether it can be seen."""

    is_seen: bool
    is_label: bool
    shows: str = ""


class _Reader:
    """Told of everything in a notation file; ids of what is not seen are left out."""

    def __init__(self) -> None:
        self.drafts: list[_Draft] = []
        self._ordinal = -1
        self._open: list[str] = []
        self._nodes: list[_Node] = []

    def start(self, name: str, attributes: dict[str, str]) -> None:
        self._ordinal += 1
        local = name.rpartition(":")[2]
        above = self._open[-1] if self._open else ""
        self._open.append(local)
        if local == _DIAGRAM and not self._nodes:
            self._begin(attributes)
        elif self.drafts:
            self._inside(local, above, attributes)

    def end(self, _name: str) -> None:
        if self._open.pop() in _NODES and self._nodes:
            self._nodes.pop()

    def _begin(self, attributes: dict[str, str]) -> None:
        get = attributes.get
        id, name = get("xmi:id", ""), get("name", "")
        self.drafts.append(_Draft(id, name, get("type", ""), self._ordinal))

    def _inside(self, local: str, above: str, attributes: dict[str, str]) -> None:
        draft = self.drafts[-1]
        if local in _NODES:
            is_seen = attributes.get("visible") != "false"
            is_label = attributes.get("type", "").startswith(_LABELS)
            self._nodes.append(_Node(is_seen, is_label))
        elif local == "element" and above in _NODES:
            self._show(target_of(attributes))
        elif local == "element" and above == _DIAGRAM:
            draft.context = target_of(attributes)
        elif local == "owner":
            draft.owner = target_of(attributes)
        draft.kind = attributes.get("diagramKindId", draft.kind)

    def _show(self, target: str) -> None:
        if not target or self._nodes[-1].is_label or not all(node.is_seen for node in self._nodes):
            return
        self._nodes[-1].shows = target
        path = [node.shows for node in self._nodes if node.shows]
        self.drafts[-1].paths[tuple(path)] = None
