"""The Python API: compile models, and read the graph and its derived values (docs/python-api.md).

Programs import these names from ``sysmlc``. Everything else in the package may change with any
version.
"""

import gc
import sys
from collections.abc import Iterable
from os import PathLike
from pathlib import Path

from sysmlc.config import Config, find_config_file, read_config
from sysmlc.diagnostics import Diagnostic, Rule, Severity, Sink, rule
from sysmlc.driver import Compilation, Request, registry, select_backends
from sysmlc.driver import compile_model as compile_request
from sysmlc.ir import Edge, Element, Graph, Kind, query
from sysmlc.logic.contract import Contract
from sysmlc.passes import pipeline
from sysmlc.passes.pipeline import Pass
from sysmlc.recipe.model import Model as RecipeModel

__all__ = [
    "Compilation",
    "Config",
    "Contract",
    "Diagnostic",
    "Edge",
    "Element",
    "Graph",
    "Kind",
    "Pass",
    "RecipeModel",
    "Request",
    "Rule",
    "Severity",
    "Sink",
    "compile_model",
    "query",
    "rule",
]


def compile_model(
    paths: Request | str | PathLike[str] | Iterable[str | PathLike[str]],
    *,
    emit: Iterable[str] = (),
    passes: Iterable[Pass] = (),
    config: Config | None = None,
) -> Compilation:
    """Compile files or folders as one compile unit, in memory; no file is written.

    *emit* names back ends as ``--emit`` does; without it the compilation has no artefacts.
    *passes* run in addition to those of sysmlc, each after the passes in its ``after``. *config* is
    by default the configuration of the project that contains the first path. A ``Request`` in
    place of paths contains all these options, so that the others are ignored.

    Faults of the model, including missing files, are diagnostics of the result. Raises
    ``ConfigError`` for a configuration that cannot be used and ``BackendError`` for an unknown
    back end.
    """
    _free_earlier_compilations()
    if isinstance(paths, Request):
        return compile_request(paths)
    inputs = _list_paths(paths)
    if config is None:
        config = read_config(find_config_file(inputs[0].absolute())) if inputs else Config()
    request = Request(
        inputs=inputs,
        config=config,
        backends=tuple(select_backends(list(emit))) if emit else (),
        passes=tuple(pipeline.sort_passes([*registry.load_passes(config.passes), *passes])),
    )
    return compile_request(request)


_MAX_GROWTH = 1.25
"""Factor by which memory may grow before garbage is collected."""
_blocks = 0
"""Blocks of memory after the last collection."""


def _free_earlier_compilations() -> None:
    """Collect garbage if memory has grown.

    The nodes of syntax trees form cycles, and the collector is paused while models are read: each
    compilation of the ICE laboratory in a loop left up to 14 MB. A collection takes longer than the
    compilation of a small model.
    """
    global _blocks
    if sys.getallocatedblocks() > _MAX_GROWTH * _blocks:
        gc.collect()
        _blocks = sys.getallocatedblocks()


def _list_paths(
    paths: str | PathLike[str] | Iterable[str | PathLike[str]],
) -> tuple[Path, ...]:
    if isinstance(paths, str | PathLike):
        return (Path(paths),)
    return tuple(Path(path) for path in paths)
