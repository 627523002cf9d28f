"""Compile models, list findings, compare models and write outputs from Python.

Programs import these names from ``sysmlc``. Everything else in the package may change with any
version.
"""

import gc
import sys
from collections.abc import Collection, Iterable, Mapping
from functools import partial
from os import PathLike, fspath
from pathlib import Path
from typing import Any

from msgspec.structs import replace

from sysmlc.api.arguments import check_arguments
from sysmlc.backends.base import Backend
from sysmlc.config import Config, ConfigError, find_config_file, read_config
from sysmlc.diagnostics import Diagnostic, Rule, Severity, Sink, rule
from sysmlc.diagnostics.renderers import FORMATS, Finding, Report, make_report, render
from sysmlc.driver import (
    BackendError,
    Compilation,
    Publication,
    Request,
    Target,
    open_texts,
    open_unit,
    publish,
    registry,
    select_backends,
    summarize,
)
from sysmlc.driver import compile_model as compile_request
from sysmlc.driver.faults import report_ignored_plug_in
from sysmlc.ir import Edge, Element, Graph, Kind, query
from sysmlc.ir.compare import Change, compare
from sysmlc.ir.compare.content import check_ignored
from sysmlc.logic.contract import Contract
from sysmlc.passes import pipeline
from sysmlc.passes.pipeline import Pass
from sysmlc.recipe.model import Model as RecipeModel
from sysmlc.support.suggestions import did_you_mean

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

_NO_RULES: Mapping[str | Rule, str | None] = {}


@check_arguments
def compile_model(
    paths: Request | str | PathLike[str] | Iterable[str | PathLike[str]],
    *,
    emit: str | Iterable[str | Backend] = (),
    passes: Iterable[Pass] = (),
    rules: Mapping[str | Rule, str | None] = _NO_RULES,
    config: Config | str | PathLike[str] | None = None,
) -> Compilation:
    """Compile files or folders as one compile unit, in memory; no file is written.

    *emit* has back ends, or their names as for ``--emit``; without it there are no artefacts.
    *passes* run in addition to those of sysmlc, each after the passes in its ``after``. *rules*
    maps rules, or their names or codes, to a severity, or to "off". *config* is a configuration or
    its file, by default that of the project that contains the first path. A ``Request`` in place of
    paths contains all these options, so that the others are ignored.

    Faults of the model, including missing files, are diagnostics of the result. Raises
    ``ConfigError`` for a configuration that cannot be used, ``BackendError`` for an unknown back
    end, and TypeError for an option of another kind.
    """
    _free_earlier_compilations()
    if isinstance(paths, Request):
        return compile_request(paths)
    inputs = tuple(map(Path, [paths] if isinstance(paths, str | PathLike) else paths))
    if config is None:
        config = find_config_file(inputs[0].absolute()) if inputs else Config()
    request = Request(inputs, _make_config(config, rules))
    opened = open_unit(request)
    return compile_request(_add_steps(request, emit, passes, opened.sink), opened=opened)


@check_arguments
def compile_texts(
    texts: Mapping[str | PathLike[str], str | bytes],
    *,
    emit: str | Iterable[str | Backend] = (),
    passes: Iterable[Pass] = (),
    rules: Mapping[str | Rule, str | None] = _NO_RULES,
    config: Config | str | PathLike[str] | None = None,
) -> Compilation:
    """Compile texts in memory, such as unsaved buffers of an editor, as one compile unit.

    The keys are the names of the files that the texts stand for; findings show them. Nothing is
    read from disk but the libraries, and no configuration file that is not named. The rest equals
    ``compile_model``.
    """
    _free_earlier_compilations()
    for name, text in texts.items():
        if not isinstance(text, str | bytes):
            kind = type(text).__name__
            raise TypeError(
                f"compile_texts(): the text of '{name}' must be str or bytes, not {kind}"
            )
    request = Request((), _make_config(config or Config(), rules))
    opened = open_texts({fspath(name): text for name, text in texts.items()}, request)
    return compile_request(_add_steps(request, emit, passes, opened.sink), opened=opened)


def _make_config(
    config: Config | str | PathLike[str] | None, rules: Mapping[str | Rule, str | None]
) -> Config:
    """Return the configuration with the severities of *rules*. Raises ConfigError."""
    if not isinstance(config, Config):
        config = read_config(Path(config) if config is not None else None)
    severities = {
        key.code if isinstance(key, Rule) else str(key): _read_severity(value)
        for key, value in rules.items()
    }
    config = replace(config, rules={**config.rules, **severities})
    values = {rule.code for rule in rules if isinstance(rule, Rule)}
    registry.check_rule_names({*config.rules, *(e.rule for e in config.suppress)} - values)
    return config


def _read_severity(value: str | None) -> Severity | None:
    names = [*Severity, "off"]
    if value is None or value == "off":
        return None
    if value not in names:
        raise ConfigError(f"unknown severity '{value}'; {did_you_mean(str(value), names)}")
    return Severity(value)


def _add_steps(
    request: Request, emit: str | Iterable[str | Backend], passes: Iterable[Pass], sink: Sink
) -> Request:
    """Return the request with its back ends and passes. Raises BackendError and ConfigError.

    Plug-ins that cannot be used are reported to *sink*.
    """
    items: list[Any] = [emit] if isinstance(emit, str) else list(emit)
    names = [item for item in items if isinstance(item, str)]
    backends = [item for item in items if not isinstance(item, str)]
    added = list(passes)
    registry.check_interfaces(backends, "back end")
    registry.check_interfaces(added, "pass")
    report = partial(report_ignored_plug_in, sink)
    return replace(
        request,
        backends=(*(select_backends(names, report) if names else ()), *backends),
        passes=tuple(pipeline.sort_passes([*request.load_passes(sink), *added])),
    )


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


# -- findings and files ----------------------------------------------------------------------------


@check_arguments
def list_findings(
    compilation: Compilation, diagnostics: Iterable[Diagnostic] | None = None
) -> list[Finding]:
    """Return diagnostics with file, line and column of their start and their end.

    *diagnostics* are by default those of the compilation, sorted by location.
    """
    chosen = compilation.diagnostics if diagnostics is None else diagnostics
    return list(make_report(chosen, compilation.sources).findings)


@check_arguments
def format_findings(findings: Iterable[Finding], form: str = "text") -> str:
    """Return findings in a format of ``--format``, such as ``text``, ``json`` or ``sarif``.

    Raises ValueError for an unknown format.
    """
    if form not in FORMATS:
        raise ValueError(f"unknown format '{form}'; {did_you_mean(form, FORMATS)}")
    return render(Report(tuple(findings)), form)


@check_arguments
def write(
    compilation: Compilation, folder: str | PathLike[str], *, force: bool = False
) -> Publication:
    """Write the artefacts, the manifest, the trace and the coverage as ``sysmlc -o`` does.

    Files change only if their content does. Files that sysmlc did not write, or that were edited,
    are replaced only with *force*; otherwise nothing is written, and the diagnostics of the result
    name them.
    """
    return publish(summarize(compilation), Target(Path(folder), is_forced=force))


@check_arguments
def diff(
    old: str | PathLike[str], new: str | PathLike[str], *, ignore: str | Collection[str] = ()
) -> list[Change]:
    """Return the differences of two models as they are written, each one compile unit.

    *ignore* names attributes that do not count; ``id`` matches elements without their ids. Raises
    ValueError, with the findings, if a file cannot be read, and for an unknown attribute.
    """
    graphs = _read_as_written(old), _read_as_written(new)
    ignored = [ignore] if isinstance(ignore, str) else ignore
    check_ignored(ignored, graphs)
    return compare(*graphs, ignored)


def _read_as_written(path: str | PathLike[str]) -> Graph:
    passes = tuple(map(pipeline.load, pipeline.READING))
    compilation = compile_request(Request((Path(path),), passes=passes), analyses=())
    if not compilation.is_complete:
        findings = make_report(compilation.diagnostics, compilation.sources)
        raise ValueError(render(findings, "concise"))
    return compilation.graph
