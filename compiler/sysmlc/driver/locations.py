"""Lines and columns of locations, for back ends and for trace.json."""

from collections.abc import Iterable, Mapping, Sequence

from msgspec import Struct

from sysmlc.diagnostics import Place
from sysmlc.diagnostics.locations import locate
from sysmlc.sources import Source


class Locator(Struct, frozen=True):
    """Computes lines and columns in the inputs of one compilation (``backends.base.Locate``)."""

    sources: Sequence[Source]

    def __call__(self, places: Iterable[Place]) -> Mapping[Place, Place]:
        """Return the locations in these sources, each with its line and column."""
        positions = locate(self.sources, places)
        return {
            place: Place(place.file, place.ordinal, place.offset, position.line, position.column)
            for place, position in positions.items()
        }
