"""Lines and columns for back ends and for trace.json."""

from collections.abc import Iterable, Mapping, Sequence

from msgspec import Struct

from sysmlc.diagnostics import Place
from sysmlc.diagnostics.locate import locate
from sysmlc.sources import Source


class Locator(Struct, frozen=True):
    """Finds lines and columns in the inputs of one compilation (``backends.base.Locate``)."""

    sources: Sequence[Source]

    def __call__(self, places: Iterable[Place]) -> Mapping[Place, Place]:
        """The places that can be found, with line and column."""
        found = locate(self.sources, places)
        return {
            p: Place(p.file, p.ordinal, p.offset, at.line, at.column) for p, at in found.items()
        }
