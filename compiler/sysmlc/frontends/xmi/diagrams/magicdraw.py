"""Diagrams of MagicDraw and Cameo: ``ownedDiagram`` in the model, shapes in entries beside it."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field

from sysmlc.frontends.xmi.diagrams import contents as drawing_relations
from sysmlc.frontends.xmi.diagrams.contents import Relation, Relations
from sysmlc.frontends.xmi.diagrams.shapes import Shapes
from sysmlc.frontends.xmi.diagrams.types import diagram_word
from sysmlc.ir.drawing import Drawing
from sysmlc.sources import Source
from sysmlc.sources.xml import parse, plain_parser

ENTRY = "BINARY-"
"""How the names of entries with shapes begin."""


@dataclass(slots=True)
class _Draft:
    """A diagram while it is read."""

    ordinal: int
    attributes: Mapping[str, str]
    type: str = ""
    base_type: str = ""
    shapes: str = ""
    used: dict[str, None] = field(default_factory=dict)


@dataclass(slots=True)
class _Found:
    """What one model file says of diagrams."""

    drafts: list[_Draft] = field(default_factory=list)
    shapes: dict[str, Shapes] = field(default_factory=dict)
    relations: Mapping[str, Relation] = field(default_factory=dict)


def drawings(model: Source, shapes_of: Callable[[str], Shapes]) -> Iterator[Drawing]:
    """The diagrams of a model; ``shapes_of`` reads an entry of its archive.

    Raises SourceError.
    """
    if b"ownedDiagram" not in model.data:
        return
    found = _read(model)
    for draft in found.drafts:
        drawn = found.shapes.get(draft.shapes) or shapes_of(draft.shapes)
        yield _drawing(model.name, draft, drawn, found.relations)


def _drawing(
    file: str, draft: _Draft, shapes: Shapes, relations: Mapping[str, Relation]
) -> Drawing:
    id = _id(draft.attributes)
    drawn = {path[-1]: None for path in shapes.paths}
    shown = [one for one in dict.fromkeys((*drawn, *draft.used)) if one != id]
    return Drawing(
        id,
        draft.attributes.get("name", ""),
        draft.type,
        diagram_word(draft.type, draft.base_type),
        file,
        file,
        draft.ordinal,
        draft.attributes.get("ownerOfDiagram", ""),
        draft.attributes.get("context", ""),
        tuple(shown),
        tuple(path for path in shapes.paths if len(path) > 1),
        tuple(one for one in shown if drawn and one not in drawn),
        drawing_relations.shown(relations, shown),
    )


def _id(attributes: Mapping[str, str]) -> str:
    return attributes.get("xmi:id", "")


def shapes(entry: Source) -> Shapes:
    """The shapes in an entry of an archive; none in one that is no XML. Raises SourceError."""
    found = Shapes()
    made = plain_parser()
    made.StartElementHandler = found.start
    made.EndElementHandler = found.end
    if entry.data.lstrip().startswith(b"<"):
        parse(entry, made)
    return found


def _read(model: Source) -> _Found:
    reader = _Reader()
    made = plain_parser()
    made.StartElementHandler = reader.start
    made.EndElementHandler = reader.end
    made.CharacterDataHandler = reader.text
    parse(model, made)
    return reader.found


class _Reader:
    """Told of everything in a model file, it keeps what concerns diagrams."""

    def __init__(self) -> None:
        self._relations = Relations()
        self.found = _Found(relations=self._relations.found)
        self._ordinal = -1
        self._open: list[str] = []
        self._draft: _Draft | None = None
        self._shapes: Shapes | None = None
        self._used = ""

    def start(self, name: str, attributes: dict[str, str]) -> None:
        self._ordinal += 1
        if self._shapes is not None:
            self._shapes.start(name, attributes)
            return
        if name == "filePart":
            self._begin_shapes(attributes)
        elif name == "ownedDiagram":
            self._draft = _Draft(self._ordinal, attributes)
            self.found.drafts.append(self._draft)
        elif self._draft is not None:
            _fill(self._draft, name, attributes)
        self._relations.start(name, attributes)
        self._open.append(name)

    def end(self, name: str) -> None:
        if name == "filePart":
            self._shapes = None
        if self._shapes is not None:
            self._shapes.end(name)
            return
        self._open.pop()
        self._relations.end()
        if name == "ownedDiagram":
            self._draft = None
        elif name == "usedElements" and self._draft is not None:
            self._draft.used[self._used.strip()] = None
            self._used = ""

    def text(self, data: str) -> None:
        if self._open and self._open[-1] == "usedElements":
            self._used += data

    def _begin_shapes(self, attributes: Mapping[str, str]) -> None:
        entry = attributes.get("name", "")
        if entry.startswith(ENTRY):
            self._shapes = self.found.shapes[entry] = Shapes()


def _fill(draft: _Draft, name: str, attributes: Mapping[str, str]) -> None:
    if name.endswith("DiagramRepresentationObject"):
        draft.type = attributes.get("type", "")
        draft.base_type = attributes.get("umlType", "")
    elif name == "binaryObject":
        draft.shapes = attributes.get("streamContentID", "")
