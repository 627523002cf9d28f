"""Who asks for values: a pass, a back end, or one part of its work."""

from sysmlc.passes.pipeline import NAMES
from sysmlc.values import dataclass

PASS, EMIT = "pass", "emit"


@dataclass(frozen=True, slots=True)
class Reader:
    """A pass or a back end (``what``) by its name, perhaps while it was at one ``part``."""

    what: str
    name: str
    part: str = ""

    @property
    def whole(self) -> "Reader":
        """The pass or back end with all that it does."""
        return Reader(self.what, self.name)

    @property
    def order(self) -> int:
        """When it runs: the front ends first, then the passes, then the back ends."""
        return NAMES.index(self.name) if self.what == PASS else len(NAMES) * (self.what == EMIT)


def reader(text: str) -> Reader:
    """The reader as it is noted (``ir.reads``)."""
    return Reader(*text.split(" ", 2)) if " " in text else Reader(text, "")
