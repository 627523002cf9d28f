"""Project archives among the inputs: what they say of themselves is held against what they are."""

from collections.abc import Sequence

from sysmlc.diagnostics import Sink
from sysmlc.frontends.sysml.detect import is_description
from sysmlc.language.exchange import project, used
from sysmlc.sources import Source

_SUFFIX = ".kpar"


def examine(sources: Sequence[Source], sink: Sink, *, has_library: bool) -> None:
    """Report files that are not as their project says, and used projects that are not given.

    ``has_library`` says whether the standard library was found, which projects use by its IRI.
    """
    archives: dict[str, list[Source]] = {}
    for source in sources:
        archive, mark, _ = source.name.partition("!")
        if mark:
            archives.setdefault(archive, []).append(source)
    found = [
        project(archive, inside, sink)
        for archive, inside in archives.items()
        if archive.lower().endswith(_SUFFIX) or any(map(is_description, inside))
    ]
    for one in found:
        used(one, found, sink, has_standard=has_library)
