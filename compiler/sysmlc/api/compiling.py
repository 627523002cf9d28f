"""Compile models, list findings, compare models and write outputs from Python.

Programs import these names from ``sysmlc``. Everything else in the package may change with any
version.
"""

import gc
import sys
from collections.abc import Collection, Iterable, Mapping
from os import PathLike
from pathlib import Path

from sysmlc.backends.base import Backend
from sysmlc.config import Config, ConfigError, find_config_file, read_config
from sysmlc.diagnostics import Diagnostic, Rule, Severity, Sink, rule
from sysmlc.diagnostics.renderers import Finding, Report, make_report, render
from sysmlc.driver import (
    BackendError,
    Compilation,
    Publication,
    Request,
    Target,
    open_texts,
    publish,
    registry,
    select_backends,
    summarize,
)
from sysmlc.driver import compile_model as compile_request
from sysmlc.ir import Edge, Element, Graph, Kind, query
from sysmlc.ir.compare import Change, compare
from sysmlc.logic.contract import Contract
from sysmlc.passes import pipeline
from sysmlc.passes.pipeline import Pass
from sysmlc.recipe.model import Model as RecipeModel

__all__ = [
    "BackendError",
    "Change",
    "Compilation",
    "Config",
    "ConfigError",
    "Contract",
    "Diagnostic",
    "Edge",
    "Element",
    "Finding",
    "Graph",
    "Kind",
    "Pass",
    "RecipeModel",
    "Request",
    "Rule",
    "Severity",
    "Sink",
    "compile_model",
    "compile_texts",
    "diff",
    "format_findings",
    "list_findings",
    "query",
    "rule",
    "write",
]


def compile_model(
    paths: Request | str | PathLike[str] | Iterable[str | PathLike[str]],
    *,
    emit: Iterable[str | Backend] = (),
    passes: Iterable[Pass] = (),
    config: Config | None = None,
) -> Compilation:
    """Compile files or folders as one compile unit, in memory; no file is written.

    *emit* has back ends, or their names as for ``--emit``; without it there are no artefacts.
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
        backends=_load_backends(emit),
        passes=_load_passes(config, passes),
    )
    return compile_request(request)


def compile_texts(
    texts: Mapping[str, str | bytes],
    *,
    emit: Iterable[str | Backend] = (),
    passes: Iterable[Pass] = (),
    config: Config | None = None,
) -> Compilation:
    """Compile texts in memory, such as unsaved buffers of an editor, as one compile unit.

    The keys are the names of the files that the texts stand for; findings show them. Nothing is
    read from disk but the libraries, and no configuration file. The rest equals ``compile_model``.
    """
    _free_earlier_compilations()
    config = config or Config()
    request = Request((), config, _load_backends(emit), passes=_load_passes(config, passes))
    return compile_request(request, opened=open_texts(texts, request))


def _load_backends(emit: Iterable[str | Backend]) -> tuple[Backend, ...]:
    """Return the back ends, those with a name loaded. Raises BackendError."""
    items = [emit] if isinstance(emit, str) else list(emit)
    names = [item for item in items if isinstance(item, str)]
    values = [item for item in items if not isinstance(item, str)]
    return (*(select_backends(names) if names else ()), *values)


def _load_passes(config: Config, passes: Iterable[Pass]) -> tuple[Pass, ...]:
    """Return the passes of sysmlc and *passes* in their order. Raises ConfigError."""
    return tuple(pipeline.sort_passes([*registry.load_passes(config.passes), *passes]))


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


# -- findings and files ----------------------------------------------------------------------------


def list_findings(compilation: Compilation) -> list[Finding]:
    """Return the diagnostics of a compilation with file, line and column, sorted by location."""
    return list(make_report(compilation.diagnostics, compilation.sources).findings)


def format_findings(findings: Iterable[Finding], form: str = "text") -> str:
    """Return findings in a format of ``--format``, such as ``text``, ``json`` or ``sarif``.

    Raises KeyError for an unknown format.
    """
    return render(Report(tuple(findings)), form)


def write(
    compilation: Compilation, folder: str | PathLike[str], *, force: bool = False
) -> Publication:
    """Write the artefacts, the manifest, the trace and the coverage as ``sysmlc -o`` does.

    Files change only if their content does. Files that sysmlc did not write, or that were edited,
    are replaced only with *force*; otherwise nothing is written, and the diagnostics of the result
    name them.
    """
    return publish(summarize(compilation), Target(Path(folder), is_forced=force))


def diff(
    old: str | PathLike[str], new: str | PathLike[str], *, ignore: Collection[str] = ()
) -> list[Change]:
    """Return the differences of two models as they are written, each one compile unit.

    *ignore* names attributes that do not count; ``id`` matches elements without their ids. Raises
    ValueError, with the findings, if a file cannot be read.
    """
    return compare(_read_as_written(old), _read_as_written(new), ignore)


def _read_as_written(path: str | PathLike[str]) -> Graph:
    passes = tuple(map(pipeline.load, pipeline.READING))
    compilation = compile_request(Request((Path(path),), passes=passes), analyses=())
    if not compilation.is_complete:
        raise ValueError(format_findings(list_findings(compilation), "concise"))
    return compilation.graph
