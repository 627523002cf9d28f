"""The standard libraries of AutomationML, for files that refer to them without holding them."""

from functools import cache

from sysmlc.frontends.caex import features, libraries
from sysmlc.frontends.caex.columns import read_document
from sysmlc.frontends.caex.context import Context
from sysmlc.frontends.caex.vocabulary import LIBRARIES, Family
from sysmlc.sources import Source
from sysmlc.support import resources

FILE = "automationml-libraries.aml"


class Standard:
    """The standard libraries for one unit; each is added to its graph when it is needed."""

    def __init__(self) -> None:
        # A tree of its own for each unit: nodes remember what they became.
        self._document = read_document(Source(FILE, _data()), is_built_in=True)
        roots = self._document.root.of(*LIBRARIES)
        self._left = {(LIBRARIES[node.tag][0], node.name): node for node in roots}

    def forget(self) -> None:
        """Let the nodes go."""
        self._document.forget()

    def provide(self, context: Context, family: Family, name: str) -> bool:
        """Add the library to the graph; False when there is none (more) of that name."""
        library = self._left.pop((family, name), None)
        if library is None:
            return False
        context.types.hold(self._document, family, name)
        types = list(libraries.library(context, self._document, library))
        libraries.specialise(context, types)
        for type in types:
            features.lower_own(context, type)
        return True


@cache
def _data() -> bytes:
    return resources.path("metamodels", FILE).read_bytes()
