"""Helpers of the readers of all tools: types of diagrams, paths of shapes, drawn relations."""

from collections.abc import Iterable, Mapping

from sysmlc.frontends.xmi.vocabulary import FOLDED_REFERENCES
from sysmlc.ir import Edge
from sysmlc.sources import Source
from sysmlc.sources.xml import make_plain_parser, parse

Relation = tuple[Edge, str, str]
"""An edge with the ids or hrefs of its ends."""

_MAX_DEPTH = 40
"""Longest path of shapes inside shapes; damaged files can nest shapes without end."""

_DIAGRAM_TYPES = (
    ("table", "table"),
    ("matrix", "matrix"),
    ("relationmap", "matrix"),
    ("blockdefinition", "bdd"),
    ("internalblock", "ibd"),
    ("compositestructure", "ibd"),
    ("parametric", "par"),
    ("requirement", "req"),
    ("usecase", "uc"),
    ("activity", "act"),
    ("statemachine", "stm"),
    ("statechart", "stm"),
    ("sequence", "sd"),
    ("package", "pkg"),
    ("class", "class"),
    ("logical", "class"),
    ("object", "class"),
    ("component", "class"),
    ("deployment", "class"),
    ("profile", "class"),
)
"""Parts of the names that tools give diagrams, with the abbreviations of SysML and UML (annex A).

The first part that a name contains decides: "blockdefinition" stands before "class".
"""


def abbreviate_type(*types: str) -> str:
    """Return the abbreviation of a diagram type; the first of *types* that is known counts.

    Empty for diagrams that are neither SysML's nor UML's, such as mind maps.
    """
    for type_ in types:
        plain = type_.lower().replace(" ", "").replace("_", "")
        for part, abbreviation in _DIAGRAM_TYPES:
            if part in plain:
                return abbreviation
    return ""


def read_target(attributes: Mapping[str, str]) -> str:
    """Return the id or href that an XML element refers to, or the empty string.

    The prefix of the attribute is ignored, because tools choose different ones for XMI.
    """
    for name, value in attributes.items():
        if name.rpartition(":")[2] in ("idref", "href"):
            return value
    return ""


def extend_path(path: tuple[str, ...], id: str) -> tuple[str, ...]:
    """Return the path of a shape that is drawn inside *path* and shows the element *id*.

    Some symbols consist of two shapes of the same element. Shapes deeper than the limit
    become siblings of the last shape above it.
    """
    return path if path[-1:] == (id,) else (*path[: _MAX_DEPTH - 1], id)


class RelationReader:
    """Parser handlers that collect the relations of a model file that become edges of the graph.

    Diagrams refer to ids of generalizations, for example, but edges of the graph have no ids.
    """

    def __init__(self) -> None:
        self.relations: dict[str, Relation] = {}
        self._ids: list[str] = []

    def start(self, name: str, attributes: Mapping[str, str]) -> None:
        """Handle the start of an element.

        The feature that states the target, such as ``general``, is a child of the relation or one
        of its attributes.
        """
        if len(self._ids) > 1 and name in FOLDED_REFERENCES:
            owner, relation = self._ids[-2:]
            self._add(FOLDED_REFERENCES[name], owner, relation, read_target(attributes))
        id = attributes.get("xmi:id", "")
        if self._ids:
            for feature in FOLDED_REFERENCES.keys() & attributes.keys():
                self._add(FOLDED_REFERENCES[feature], self._ids[-1], id, attributes[feature])
        self._ids.append(id)

    def end(self, _name: str) -> None:
        """Handle the end of an element."""
        self._ids.pop()

    def _add(self, edge: Edge, owner: str, id: str, target: str) -> None:
        if owner and id and target:
            self.relations[id] = (edge, owner, target)


def read_relations(model: Source) -> dict[str, Relation]:
    """Return the relations of a model file by their ids. Raises SourceError."""
    reader = RelationReader()
    xml_parser = make_plain_parser()
    xml_parser.StartElementHandler = reader.start
    xml_parser.EndElementHandler = reader.end
    parse(model, xml_parser)
    return reader.relations


def select_relations(
    relations: Mapping[str, Relation], targets: Iterable[str]
) -> tuple[Relation, ...]:
    """Return the relations that are among the ids and hrefs that a diagram shows."""
    ids = (target.rpartition("#")[2] for target in targets)
    return tuple(relations[id] for id in ids if id in relations)
