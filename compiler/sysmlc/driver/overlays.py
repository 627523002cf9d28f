"""Overlays of a unit: those beside its models, and those that are named."""

import os
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING

from msgspec import Struct

from sysmlc.diagnostics import Sink
from sysmlc.driver import faults
from sysmlc.driver.inputs import name_of
from sysmlc.ir import Graph
from sysmlc.overlay import SUFFIX
from sysmlc.sources import Roots, Source, SourceError
from sysmlc.sources.limits import DOCUMENT_LIMITS
from sysmlc.sources.whole import read_whole

if TYPE_CHECKING:
    from sysmlc.overlay import Refinement


class LoadedOverlay(Struct, frozen=True):
    """The file of an overlay and what it says; nothing when it cannot be used."""

    path: Path
    source: Source
    refinement: "Refinement | None"


def beside(model: Path) -> Path | None:
    """The overlay that lies beside a model: ``gate.overlay.yaml`` for ``gate.aml``."""
    path = model.with_name(model.stem + SUFFIX)
    return path if os.path.lexists(path) else None


def load_overlay(
    path: Path, root: Path, roots: Roots, sink: Sink, *, is_named: bool
) -> LoadedOverlay | None:
    """Read an overlay. One that cannot be read is reported, or is a link out of the roots.

    An overlay that the user named may be anywhere.
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
    from sysmlc.overlay import read

    return LoadedOverlay(path, source, read(source, sink))


def store_all(overlays: Iterable[LoadedOverlay], graph: Graph) -> None:
    """Keep what overlays say for the pass ``overlay``."""
    said = [laid.refinement for laid in overlays if laid.refinement is not None]
    if said:
        from sysmlc.overlay import Refinement

        graph.store(Refinement, said)


def models_of(overlay: LoadedOverlay) -> list[str]:
    """Files that the terms of an overlay name, each once, as it writes them."""
    if overlay.refinement is None:
        return []
    from sysmlc.overlay import files_of

    return files_of(overlay.refinement)
