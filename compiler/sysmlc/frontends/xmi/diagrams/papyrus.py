"""Diagrams of Papyrus: the file ``.notation`` beside a model, in GMF's notation."""

from collections.abc import Iterator
from dataclasses import dataclass, field

from sysmlc.frontends.xmi.diagrams import contents as drawing_relations
from sysmlc.frontends.xmi.diagrams.shapes import inside, target_of
from sysmlc.frontends.xmi.diagrams.types import diagram_word
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
        paths = draft.paths()
        shown = tuple(dict.fromkeys(path[-1] for path in paths))
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
            tuple(path for path in paths if len(path) > 1),
            relations=drawing_relations.shown(relations, shown),
        )


@dataclass(slots=True)
class _Node:
    """A node of a diagram: where it is, whether it can be seen, and what it shows."""

    above: "_Node | None"
    is_seen: bool
    shows: str = ""
    path: tuple[str, ...] = ()


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
    nodes: list[_Node] = field(default_factory=list)

    def paths(self) -> list[tuple[str, ...]]:
        """What is seen, outermost first; a node says what it shows after what is inside it."""
        found: dict[tuple[str, ...], None] = {}
        for node in self.nodes:
            above = node.above
            node.path = above.path if above else ()
            node.is_seen = node.is_seen and (above is None or above.is_seen)
            if node.is_seen and node.shows:
                node.path = inside(node.path, node.shows)
                found[node.path] = None
        return list(found)


class _Reader:
    """Told of everything in a notation file, it keeps the diagrams."""

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
            self._node(draft, attributes)
        elif local == "element" and above in _NODES:
            self._nodes[-1].shows = target_of(attributes)
        elif local == "element" and above == _DIAGRAM:
            draft.context = target_of(attributes)
        elif local == "owner":
            draft.owner = target_of(attributes)
        draft.kind = attributes.get("diagramKindId", draft.kind)

    def _node(self, draft: _Draft, attributes: dict[str, str]) -> None:
        is_label = attributes.get("type", "").startswith(_LABELS)
        is_seen = attributes.get("visible") != "false" and not is_label
        node = _Node(self._nodes[-1] if self._nodes else None, is_seen)
        self._nodes.append(node)
        draft.nodes.append(node)
