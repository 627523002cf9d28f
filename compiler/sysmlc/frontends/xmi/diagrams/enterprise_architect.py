"""Diagrams of Enterprise Architect: ``xmi:Extension/diagrams`` in the model file."""

import re
from collections.abc import Iterator
from dataclasses import dataclass, field

from sysmlc.frontends.xmi.diagrams import contents as drawing_relations
from sysmlc.frontends.xmi.diagrams.types import diagram_word
from sysmlc.ir.drawing import Drawing
from sysmlc.sources import Source
from sysmlc.sources.xml import parse, plain_parser

_PLACE = ["Extension", "diagrams", "diagram"]
_TECHNOLOGY = re.compile(r"MDGDgm=[\w.]+::(\w+)")
"""How a diagram of a profile says its kind, ``MDGDgm=SysML1.4::BlockDefinition``."""


def drawings(model: Source) -> Iterator[Drawing]:
    """The diagrams of a model. Raises SourceError."""
    if b"<diagrams" not in model.data:
        return
    reader = _Reader()
    made = plain_parser()
    made.StartElementHandler = reader.start
    made.EndElementHandler = reader.end
    parse(model, made)
    relations = drawing_relations.relations(model)
    for draft in reader.drafts:
        yield Drawing(
            draft.id,
            draft.name,
            draft.type,
            diagram_word(draft.kind, draft.type),
            model.name,
            model.name,
            draft.ordinal,
            draft.owner,
            shown=tuple(draft.shown),
            relations=drawing_relations.shown(relations, draft.shown),
        )


@dataclass(slots=True)
class _Draft:
    """A diagram while it is read; ``kind`` is the profile's word for it."""

    id: str
    ordinal: int
    name: str = ""
    type: str = ""
    kind: str = ""
    owner: str = ""
    shown: dict[str, None] = field(default_factory=dict)


class _Reader:
    """Told of every element of a model file, it keeps the diagrams of the extension."""

    def __init__(self) -> None:
        self.drafts: list[_Draft] = []
        self._ordinal = -1
        self._open: list[str] = []

    def start(self, name: str, attributes: dict[str, str]) -> None:
        self._ordinal += 1
        self._open.append(name.rpartition(":")[2])
        if self._open[-3:] == _PLACE:
            self.drafts.append(_Draft(attributes.get("xmi:id", ""), self._ordinal))
        elif _PLACE[-1] in self._open and self.drafts:
            _fill(self.drafts[-1], self._open[-1], attributes)

    def end(self, _name: str) -> None:
        self._open.pop()


def _fill(draft: _Draft, name: str, attributes: dict[str, str]) -> None:
    if name == "model":
        draft.owner = attributes.get("parent") or attributes.get("owner", "")
    elif name == "properties":
        draft.name = attributes.get("name", "")
        draft.type = attributes.get("type", "")
    elif name == "element" and "subject" in attributes:
        draft.shown[attributes["subject"]] = None
    kind = _TECHNOLOGY.search(attributes.get("value", ""))
    draft.kind = kind[1] if kind else draft.kind
