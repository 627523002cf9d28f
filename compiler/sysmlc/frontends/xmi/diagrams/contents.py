"""Lines of diagrams that are edges of the graph: a generalization has an id in the file only."""

from collections.abc import Iterable, Mapping

from sysmlc.frontends.xmi.diagrams.shapes import target_of
from sysmlc.frontends.xmi.vocabulary import FOLDED_REFERENCES
from sysmlc.ir import Edge
from sysmlc.sources import Source
from sysmlc.sources.xml import parse, plain_parser

Relation = tuple[Edge, str, str]
"""An edge with the ids or hrefs of its ends."""


class Relations:
    """Collects the relations of a model file; told of every start and end of an element."""

    def __init__(self) -> None:
        self.found: dict[str, Relation] = {}
        self._ids: list[str] = []

    def start(self, name: str, attributes: Mapping[str, str]) -> None:
        """An element begins; ``generalization`` has ``general`` as attribute or as a child."""
        if len(self._ids) > 1 and name in FOLDED_REFERENCES:
            self._note(FOLDED_REFERENCES[name], self._ids[-2:], target_of(attributes))
        id = attributes.get("xmi:id", "")
        for feature in FOLDED_REFERENCES.keys() & attributes.keys() if self._ids else ():
            self._note(FOLDED_REFERENCES[feature], [self._ids[-1], id], attributes[feature])
        self._ids.append(id)

    def end(self) -> None:
        """An element ends."""
        self._ids.pop()

    def _note(self, edge: Edge, ids: list[str], target: str) -> None:
        owner, id = ids
        if owner and id and target:
            self.found[id] = (edge, owner, target)


def relations(model: Source) -> dict[str, Relation]:
    """The relations of a model file by their ids. Raises SourceError."""
    found = Relations()
    made = plain_parser()
    made.StartElementHandler = found.start
    made.EndElementHandler = lambda _name: found.end()
    parse(model, made)
    return found.found


def shown(known: Mapping[str, Relation], targets: Iterable[str]) -> tuple[Relation, ...]:
    """The relations among what a diagram shows."""
    ids = (target.rpartition("#")[2] for target in targets)
    return tuple(known[id] for id in ids if id in known)
