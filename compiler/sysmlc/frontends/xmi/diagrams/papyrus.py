"""Diagrams of Papyrus: the file ``.notation`` beside a model, in GMF's notation."""

from collections.abc import Iterator
from dataclasses import dataclass, field

from sysmlc.frontends.xmi.diagrams import common
from sysmlc.ir.pending import Drawing
from sysmlc.sources import Source
from sysmlc.sources.xml import make_plain_parser, parse

SUFFIX = ".notation"
_DIAGRAM = "Diagram"
_NODES = ("children", "edges", "persistedChildren", "transientChildren", "persistedEdges")
_LABELS = ("StereotypeLabel", "StereotypeBrace", "StereotypeCompartment", "StereotypeComment")
"""Nodes that name a stereotype; a stereotype that is drawn itself is a ``Stereotype_Shape``."""


def read_diagrams(notation: Source, model: Source) -> Iterator[Drawing]:
    """Yield the diagrams in the notation file of a model. Raises SourceError."""
    relations = common.read_relations(model)
    reader = _NotationReader()
    xml_parser = make_plain_parser()
    xml_parser.StartElementHandler = reader.start
    xml_parser.EndElementHandler = reader.end
    parse(notation, xml_parser)
    for draft in reader.drafts:
        paths = draft.list_paths()
        shown = tuple(dict.fromkeys(path[-1] for path in paths))
        yield Drawing(
            draft.id,
            draft.name,
            draft.type,
            common.abbreviate_type(draft.profile_type, draft.type),
            model.name,
            notation.name,
            draft.ordinal,
            draft.owner or draft.context,
            draft.context,
            shown,
            tuple(path for path in paths if len(path) > 1),
            relations=common.select_relations(relations, shown),
        )


@dataclass(slots=True)
class _Node:
    """A node of a diagram; ``target`` is the element that it shows."""

    parent: "_Node | None"
    is_visible: bool
    target: str = ""
    path: tuple[str, ...] = ()


@dataclass(slots=True)
class _Draft:
    """A diagram that is being read; ``profile_type`` is its type in the profile of SysML."""

    id: str
    name: str
    type: str
    ordinal: int
    profile_type: str = ""
    owner: str = ""
    context: str = ""
    nodes: list[_Node] = field(default_factory=list)

    def list_paths(self) -> list[tuple[str, ...]]:
        """Return the paths of the visible elements.

        The paths are known when the diagram is complete: the target of a node may come after the
        nodes inside it.
        """
        paths: dict[tuple[str, ...], None] = {}
        for node in self.nodes:
            parent = node.parent
            node.path = parent.path if parent else ()
            node.is_visible = node.is_visible and (parent is None or parent.is_visible)
            if node.is_visible and node.target:
                node.path = common.extend_path(node.path, node.target)
                paths[node.path] = None
        return list(paths)


class _NotationReader:
    """Parser handlers that collect the diagrams of a notation file."""

    def __init__(self) -> None:
        self.drafts: list[_Draft] = []
        self._ordinal = -1
        self._open: list[str] = []
        self._open_nodes: list[_Node] = []

    def start(self, name: str, attributes: dict[str, str]) -> None:
        self._ordinal += 1
        local_name = name.rpartition(":")[2]
        parent = self._open[-1] if self._open else ""
        self._open.append(local_name)
        if local_name == _DIAGRAM and not self._open_nodes:
            self._add_diagram(attributes)
        elif self.drafts:
            self._add_content(local_name, parent, attributes)

    def end(self, _name: str) -> None:
        if self._open.pop() in _NODES and self._open_nodes:
            self._open_nodes.pop()

    def _add_diagram(self, attributes: dict[str, str]) -> None:
        id, name = attributes.get("xmi:id", ""), attributes.get("name", "")
        self.drafts.append(_Draft(id, name, attributes.get("type", ""), self._ordinal))

    def _add_content(self, name: str, parent: str, attributes: dict[str, str]) -> None:
        draft = self.drafts[-1]
        if name in _NODES:
            self._add_node(draft, attributes)
        elif name == "element" and parent in _NODES:
            self._open_nodes[-1].target = common.read_target(attributes)
        elif name == "element" and parent == _DIAGRAM:
            draft.context = common.read_target(attributes)
        elif name == "owner":
            draft.owner = common.read_target(attributes)
        draft.profile_type = attributes.get("diagramKindId", draft.profile_type)

    def _add_node(self, draft: _Draft, attributes: dict[str, str]) -> None:
        is_label = attributes.get("type", "").startswith(_LABELS)
        is_visible = attributes.get("visible") != "false" and not is_label
        node = _Node(self._open_nodes[-1] if self._open_nodes else None, is_visible)
        self._open_nodes.append(node)
        draft.nodes.append(node)
