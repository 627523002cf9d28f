"""Project archives among the inputs: what they say of themselves is held against what they are."""

from collections.abc import Sequence
from pathlib import Path

from sysmlc.diagnostics import Sink
from sysmlc.frontends.sysml.detect import is_description
from sysmlc.language.interchange import open_archive, read_project, resolve_usages
from sysmlc.sources import DEFAULT_LIMITS, Source
from sysmlc.sources.whole import read_whole

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
        read_project(archive, inside, sink)
        for archive, inside in archives.items()
        if archive.lower().endswith(_SUFFIX) or any(map(is_description, inside))
    ]
    for one in found:
        resolve_usages(one, found, sink, has_standard=has_library)


def examine_library(path: Path, sink: Sink) -> None:
    """Report files of a library's archives that are not as the archives say.

    ``path`` is an archive or a folder of some. Raises SourceError for one that cannot be opened.
    """
    archives = [path] if path.is_file() else sorted(path.glob(f"*{_SUFFIX}"))
    for archive in archives:
        if archive.suffix.lower() == _SUFFIX:
            data = read_whole(archive, archive.name, DEFAULT_LIMITS)
            open_archive(Source(archive.name, data), sink)
