"""What lies beside the models and holds the diagrams of their authors; read on demand only."""

from collections.abc import Iterator
from fnmatch import fnmatchcase
from pathlib import Path

from sysmlc.diagnostics import Sink
from sysmlc.driver import faults
from sysmlc.driver.reading import Reading
from sysmlc.frontends.base import DiagramReader
from sysmlc.sources import Roots, Source, SourceError, entries
from sysmlc.sources.limits import DEFAULT_LIMITS
from sysmlc.sources.whole import read_whole


def beside(reading: Reading, root: Path, sink: Sink) -> tuple[Source, ...]:
    """The companions of all sources that are there, by name; what cannot be read is reported."""
    names = dict.fromkeys(
        name
        for found in reading.recognised
        if isinstance(found.frontend, DiagramReader)
        for name in found.frontend.companions(found.source.name)
    )
    found = {
        source.name: source for name in names for source in _load(name, root, reading.roots, sink)
    }
    return tuple(found[name] for name in sorted(found))


def _load(name: str, root: Path, roots: Roots, sink: Sink) -> Iterator[Source]:
    """Read the file, if one of the roots holds it, or entries of an archive that was an input."""
    file, is_archive, pattern = name.partition("!")
    if not (root / file).is_file() or not (is_archive or roots.allows(root / file)):
        return
    try:
        source = Source(file, read_whole(root / file, file, DEFAULT_LIMITS))
        yield from entries(source, lambda entry: _fits(entry, pattern)) if is_archive else [source]
    except SourceError as problem:
        faults.report_unreadable(problem, sink)


def _fits(entry: str, pattern: str) -> bool:
    return fnmatchcase(entry.rpartition("/")[2], pattern)
