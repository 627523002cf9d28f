"""Diagrams of Enterprise Architect: ``xmi:Extension/diagrams`` in the model file."""

import re
from collections.abc import Iterator
from dataclasses import dataclass, field

from sysmlc.frontends.xmi.diagrams import common
from sysmlc.ir.pending import Drawing
from sysmlc.sources import Source
from sysmlc.sources.xml import make_plain_parser, parse

_DIAGRAM_PATH = ["Extension", "diagrams", "diagram"]
_PROFILE_TYPE = re.compile(r"MDGDgm=[\w.]+::(\w+)")
"""The type of a diagram of a profile, as in ``MDGDgm=SysML1.4::BlockDefinition``."""


def read_diagrams(model: Source) -> Iterator[Drawing]:
    """Yield the diagrams of a model. Raises SourceError."""
    if b"<diagrams" not in model.data:
        return
    reader = _DiagramReader()
    xml_parser = make_plain_parser()
    xml_parser.StartElementHandler = reader.start
    xml_parser.EndElementHandler = reader.end
    parse(model, xml_parser)
    relations = common.read_relations(model)
    for draft in reader.drafts:
        yield Drawing(
            draft.id,
            draft.name,
            draft.type,
            common.abbreviate_type(draft.profile_type, draft.type),
            model.name,
            model.name,
            draft.ordinal,
            draft.owner,
            shown=tuple(draft.shown),
            relations=common.select_relations(relations, draft.shown),
        )


@dataclass(slots=True)
class _Draft:
    """A diagram that is being read."""

    id: str
    ordinal: int
    name: str = ""
    type: str = ""
    profile_type: str = ""
    owner: str = ""
    shown: dict[str, None] = field(default_factory=dict)

    def add(self, name: str, attributes: dict[str, str]) -> None:
        """Add the element *name* inside the diagram."""
        if name == "model":
            self.owner = attributes.get("parent") or attributes.get("owner", "")
        elif name == "properties":
            self.name = attributes.get("name", "")
            self.type = attributes.get("type", "")
        elif name == "element" and "subject" in attributes:
            self.shown[attributes["subject"]] = None
        match = _PROFILE_TYPE.search(attributes.get("value", ""))
        if match:
            self.profile_type = match[1]


class _DiagramReader:
    """Parser handlers that collect the diagrams in the extension of a model file."""

    def __init__(self) -> None:
        self.drafts: list[_Draft] = []
        self._ordinal = -1
        self._open: list[str] = []

    def start(self, name: str, attributes: dict[str, str]) -> None:
        self._ordinal += 1
        self._open.append(name.rpartition(":")[2])
        if self._open[-3:] == _DIAGRAM_PATH:
            self.drafts.append(_Draft(attributes.get("xmi:id", ""), self._ordinal))
        elif _DIAGRAM_PATH[-1] in self._open and self.drafts:
            self.drafts[-1].add(self._open[-1], attributes)

    def end(self, _name: str) -> None:
        self._open.pop()
