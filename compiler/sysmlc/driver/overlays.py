"""The overlay documents of a unit: those beside its models, and those that the user names."""

import os
from collections.abc import Iterable
from pathlib import Path

from msgspec import Struct

from sysmlc.diagnostics import Sink
from sysmlc.driver import faults
from sysmlc.driver.inputs import name_of
from sysmlc.ir import Graph
from sysmlc.overlay import SUFFIX, Refinement, list_files, read_overlay
from sysmlc.sources import Roots, Source, SourceError
from sysmlc.sources.limits import DOCUMENT_LIMITS
from sysmlc.sources.whole import read_whole


class LoadedOverlay(Struct, frozen=True):
    """The file of an overlay and its content; no content if the overlay has errors."""

    path: Path
    source: Source
    refinement: Refinement | None


def find_overlay(model: Path) -> Path | None:
    """Return the overlay beside a model, ``gate.overlay.yaml`` for ``gate.aml``, if it exists."""
    path = model.with_name(model.stem + SUFFIX)
    return path if os.path.lexists(path) else None


def load_overlay(
    path: Path, root: Path, roots: Roots, sink: Sink, *, is_named: bool
) -> LoadedOverlay | None:
    """Read an overlay; report it if it cannot be read or lies outside the allowed roots.

    An overlay that the user names may lie anywhere.
    """
    name = name_of(path, root)
    if is_named and not path.exists():
        sink.report(faults.MISSING_FILE, faults.about_file(name), path=name)
        return None
    if not is_named and not roots.allows(path):
        sink.report(faults.LEADS_OUT, faults.about_file(name), path=name)
        return None
    try:
        source = Source(name, read_whole(path, name, DOCUMENT_LIMITS))
    except SourceError as problem:
        faults.report_unreadable(problem, sink)
        return None
    return LoadedOverlay(path, source, read_overlay(source, sink))


def store_refinements(overlays: Iterable[LoadedOverlay], graph: Graph) -> None:
    """Store the content of the overlays in the graph, for the pass ``overlay``."""
    refinements = [o.refinement for o in overlays if o.refinement is not None]
    if refinements:
        graph.store(Refinement, refinements)


def list_models(overlay: LoadedOverlay) -> list[str]:
    """Return the files that the entries of an overlay name, each once, as written there."""
    if overlay.refinement is None:
        return []
    return list_files(overlay.refinement)
