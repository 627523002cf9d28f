"""Bytes of the inputs, with the files that they refer to, ready for the front ends."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from sysmlc.diagnostics import Sink
from sysmlc.driver import faults
from sysmlc.driver.inputs import Recognised, collect, name_of, recognise
from sysmlc.frontends.base import Frontend
from sysmlc.sources import Source, SourceError, load


@dataclass(frozen=True, slots=True)
class Reading:
    """The recognised sources, sorted by name, and whether nothing was left out."""

    recognised: tuple[Recognised, ...]
    is_complete: bool

    def sources(self) -> tuple[Source, ...]:
        """The sources alone."""
        return tuple(found.source for found in self.recognised)


def read_unit(
    inputs: Sequence[Path], root: Path, frontends: Sequence[Frontend], sink: Sink
) -> Reading:
    """The sources of the unit; what cannot be read is reported."""
    files = collect(inputs, root, sink)
    recognised: dict[str, Recognised] = {}
    for path, named in files.items():
        for found in recognise(_sources(path, root, sink), frontends, named, sink):
            recognised.setdefault(found.source.name, found)
    ordered = tuple(recognised[name] for name in sorted(recognised))
    return Reading(ordered, not sink.has_errors())


def _sources(path: Path, root: Path, sink: Sink) -> list[Source]:
    name = name_of(path, root)
    try:
        return load(path, name)
    except SourceError as problem:
        faults.report_unreadable(problem, sink)
        return []
