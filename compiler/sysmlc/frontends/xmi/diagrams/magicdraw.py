"""Diagrams of MagicDraw and Cameo: ``ownedDiagram`` in the model, shapes in entries beside it.

An entry ``BINARY-...`` of a project archive is XML that does not declare its prefix ``xmi``, and is
therefore read without namespaces. A project saved as one XML file contains it as a ``filePart``.
"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field

from sysmlc.frontends.xmi.diagrams import common
from sysmlc.ir.pending import Drawing
from sysmlc.sources import Source
from sysmlc.sources.xml import make_plain_parser, parse

ENTRY_PREFIX = "BINARY-"
"""Start of the names of entries with shapes."""

_FRAME = "DiagramFrame"


class ShapeReader:
    """Parser handlers that collect the drawn elements and their nesting.

    ``paths`` are ids, outermost first. An id of MagicDraw means the same element in every file, so
    that only the fragment of an href counts.
    """

    def __init__(self) -> None:
        self.paths: dict[tuple[str, ...], None] = {}
        self._open_paths: list[tuple[str, ...]] = [()]
        self._has_element: list[bool] = [True]

    def start(self, name: str, attributes: Mapping[str, str]) -> None:
        """Handle the start of an element."""
        if name == "mdElement":
            self._open_paths.append(self._open_paths[-1])
            self._has_element.append(attributes.get("elementClass") == _FRAME)
        elif name == "elementID" and not self._has_element[-1]:
            self._has_element[-1] = True
            id = common.read_target(attributes).rpartition("#")[2]
            if id:
                path = common.extend_path(self._open_paths[-1], id)
                self._open_paths[-1] = path
                self.paths[path] = None

    def end(self, name: str) -> None:
        """Handle the end of an element."""
        if name == "mdElement":
            self._open_paths.pop()
            self._has_element.pop()


def read_shapes(entry: Source) -> ShapeReader:
    """Return the shapes in an entry of an archive, none if it is not XML. Raises SourceError."""
    reader = ShapeReader()
    xml_parser = make_plain_parser()
    xml_parser.StartElementHandler = reader.start
    xml_parser.EndElementHandler = reader.end
    if entry.data.lstrip().startswith(b"<"):
        parse(entry, xml_parser)
    return reader


def read_diagrams(model: Source, read_entry: Callable[[str], ShapeReader]) -> Iterator[Drawing]:
    """Yield the diagrams of a model; *read_entry* reads an entry of its archive.

    Raises SourceError.
    """
    if b"ownedDiagram" not in model.data:
        return
    reader = _ModelReader()
    xml_parser = make_plain_parser()
    xml_parser.StartElementHandler = reader.start
    xml_parser.EndElementHandler = reader.end
    xml_parser.CharacterDataHandler = reader.add_text
    parse(model, xml_parser)
    for draft in reader.drafts:
        shapes = reader.shapes.get(draft.entry) or read_entry(draft.entry)
        yield _finish(model.name, draft, shapes, reader.relation_reader.relations)


@dataclass(slots=True)
class _Draft:
    """A diagram that is being read."""

    ordinal: int
    attributes: Mapping[str, str]
    type: str = ""
    base_type: str = ""
    entry: str = ""
    used: dict[str, None] = field(default_factory=dict)

    def add(self, name: str, attributes: Mapping[str, str]) -> None:
        """Add the element *name* inside the diagram."""
        if name.endswith("DiagramRepresentationObject"):
            self.type = attributes.get("type", "")
            self.base_type = attributes.get("umlType", "")
        elif name == "binaryObject":
            self.entry = attributes.get("streamContentID", "")


def _finish(
    file: str, draft: _Draft, shapes: ShapeReader, relations: Mapping[str, common.Relation]
) -> Drawing:
    id = draft.attributes.get("xmi:id", "")
    drawn = {path[-1]: None for path in shapes.paths}
    shown = [target for target in dict.fromkeys((*drawn, *draft.used)) if target != id]
    return Drawing(
        id,
        draft.attributes.get("name", ""),
        draft.type,
        common.abbreviate_type(draft.type, draft.base_type),
        file,
        file,
        draft.ordinal,
        draft.attributes.get("ownerOfDiagram", ""),
        draft.attributes.get("context", ""),
        tuple(shown),
        tuple(path for path in shapes.paths if len(path) > 1),
        tuple(target for target in shown if drawn and target not in drawn),
        common.select_relations(relations, shown),
    )


class _ModelReader:
    """Parser handlers that collect diagrams, shapes and relations of a model file."""

    def __init__(self) -> None:
        self.drafts: list[_Draft] = []
        self.shapes: dict[str, ShapeReader] = {}
        self.relation_reader = common.RelationReader()
        self._ordinal = -1
        self._open: list[str] = []
        self._draft: _Draft | None = None
        self._shape_reader: ShapeReader | None = None
        """Receives the elements while a file part with shapes is open."""
        self._used_element = ""

    def start(self, name: str, attributes: dict[str, str]) -> None:
        self._ordinal += 1
        if self._shape_reader is not None:
            self._shape_reader.start(name, attributes)
            return
        if name == "filePart":
            entry = attributes.get("name", "")
            if entry.startswith(ENTRY_PREFIX):
                self._shape_reader = self.shapes[entry] = ShapeReader()
        elif name == "ownedDiagram":
            self._draft = _Draft(self._ordinal, attributes)
            self.drafts.append(self._draft)
        elif self._draft is not None:
            self._draft.add(name, attributes)
        self.relation_reader.start(name, attributes)
        self._open.append(name)

    def end(self, name: str) -> None:
        if name == "filePart":
            self._shape_reader = None
        if self._shape_reader is not None:
            self._shape_reader.end(name)
            return
        self._open.pop()
        self.relation_reader.end(name)
        if name == "ownedDiagram":
            self._draft = None
        elif name == "usedElements" and self._draft is not None:
            self._draft.used[self._used_element.strip()] = None
            self._used_element = ""

    def add_text(self, data: str) -> None:
        if self._open and self._open[-1] == "usedElements":
            self._used_element += data
