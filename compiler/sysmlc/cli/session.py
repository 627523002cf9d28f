"""Compile the units of a command: options, configuration, cache, requests."""

import sys
from collections.abc import Iterable, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, NoReturn

import click
from msgspec import Struct
from msgspec.structs import replace

from sysmlc.cli import terminal
from sysmlc.cli.limits import LIMITS

if TYPE_CHECKING:
    from sysmlc.cli.units import Unit
    from sysmlc.config import Config
    from sysmlc.diagnostics import Rule, Sink
    from sysmlc.driver import Compilation, OpenedUnit, Outcome, Request, Target
    from sysmlc.sources.user_schemas import Schemas
    from sysmlc.support.cache import Cache


class Settings(Struct, frozen=True):
    """The options of the command line that concern reading, emitting and reporting."""

    config: Path | None = None
    isolated: bool = False
    strict_input: bool = False
    schema: Path | None = None
    verify_each: bool = False
    print_after: tuple[str, ...] = ()
    verbose: bool = False
    form: str = "text"
    max_diagnostics: int | None = None
    min_severity: str | None = None
    select: tuple[str, ...] = ()
    ignore: tuple[str, ...] = ()
    strict: bool = False
    emit: tuple[str, ...] = ()
    templates: Path | None = None
    uses_shipped_templates: bool = False
    """Whether templates that the configuration names are ignored."""
    diagrams: str | None = None
    overlay: tuple[Path, ...] = ()
    library: str = ""
    include: tuple[Path, ...] = ()
    has_cache: bool = True
    is_forced: bool = False
    """Whether results may replace files that sysmlc did not write."""

    @property
    def is_plain(self) -> bool:
        """Whether a cached outcome can answer the command.

        Options such as ``--print-after`` have effects during the compilation.
        """
        if self.schema is not None:
            return False
        return self.has_cache and not (self.verify_each or self.print_after or self.verbose)


def fail(message: str, *details: str) -> NoReturn:
    """Print a message, with each detail on a line of its own, and exit with code 2.

    If findings were requested as JSON or SARIF, standard output gets a document with the message.
    """
    terminal.echo(f"sysmlc: {message}", err=True)
    for detail in details:
        terminal.echo(f"  {detail}", err=True)
    context = click.get_current_context(silent=True)
    parameters = context.params if context is not None else {}
    form = parameters.get("form")
    # The documents of 'diff' and 'coverage', which lack this option, have other formats.
    if form in ("json", "sarif") and "max_diagnostics" in parameters:
        from sysmlc.diagnostics.renderers import render_failure

        click.echo(render_failure("\n".join([message, *details]), form), nl=False)
    sys.exit(2)


def load_rules() -> "dict[str, Rule]":
    """Return all rules by code; print a note for each module that cannot be imported."""
    from sysmlc.driver import load_full_catalogue

    return load_full_catalogue(lambda note: terminal.echo(f"sysmlc: note: {note}", err=True))


def load_config(models: Sequence[Path], settings: Settings) -> "Config":
    """Return the configuration for these models; exit with code 2 if it is wrong.

    An isolated command reads no configuration file.
    """
    from sysmlc import config

    _check_rule_names([*settings.select, *settings.ignore])
    if settings.isolated:
        if settings.config is not None:
            raise click.UsageError("--isolated and --config exclude each other")
        return config.Config()
    try:
        loaded = config.read_config(settings.config or config.find_config_file(_find_start(models)))
    except config.ConfigError as problem:
        fail(str(problem))
    chosen: dict[tuple[str | int, ...], str] = {("rules", name): name for name in loaded.rules}
    for number, entry in enumerate(loaded.suppress):
        chosen["suppress", number, "rule"] = entry.rule
    _check_rule_names_in_config(loaded, chosen)
    LIMITS.lower(loaded.time_limit, loaded.memory_limit)
    return loaded


def _check_rule_names(names: Sequence[str]) -> None:
    """Exit with code 2 unless each name is a name, a code or the start of a code (``SM4``)."""
    from sysmlc.driver.registry import describe_unknown_rule

    # The catalogue imports every module that defines rules, so it is loaded only if needed.
    rules = load_rules().values() if names else ()
    for name in names:
        if not any(name == rule.name or rule.code.startswith(name) for rule in rules):
            fail(describe_unknown_rule(name, rules))


def _check_rule_names_in_config(
    config: "Config", names: Mapping[tuple[str | int, ...], str]
) -> None:
    """Exit with code 2 unless each name is the name or the code of a rule.

    The keys of *names* are the paths of the names in the configuration.
    """
    from sysmlc.config import locate_key
    from sysmlc.driver.registry import describe_unknown_rule

    rules = load_rules().values() if names else ()
    rule_names = {rule.code for rule in rules} | {rule.name for rule in rules}
    for path, name in names.items():
        if name not in rule_names and config.file is not None:
            where = locate_key(config.file, path)
            fail(f"{where}: {describe_unknown_rule(name, rules)}")


def _find_start(models: Sequence[Path]) -> Path:
    if not models:
        return Path.cwd()
    first = models[0].absolute()
    return first if first.is_dir() else first.parent


def compile_unit(
    files: tuple[Path, ...],
    config: "Config",
    settings: Settings,
    emit: tuple[str, ...] | None = None,
) -> "Compilation":
    """Compile files, which must be one unit, with the back ends of *emit* (None for no back end).

    Findings about the project are dropped if the files are only a part of the project.
    """
    from sysmlc.cli.units import open_single_unit
    from sysmlc.driver.project_findings import select_project_findings, without_project_findings

    unit = open_single_unit(files, config, settings)
    request = _set_backends(unit.request, emit, settings, unit.opened.sink)
    compilation = _compile(request, settings, unit.opened)
    project_findings = select_project_findings(config, [unit.opened], [compilation.diagnostics])
    return replace(
        compilation,
        diagnostics=tuple(without_project_findings(compilation.diagnostics, project_findings)),
    )


def read_as_written(unit: "Unit", settings: Settings) -> "Compilation":
    """Read a unit and resolve its references without refining the graph."""
    from sysmlc.passes import pipeline

    passes = unit.request.load_passes(unit.opened.sink)
    reading = tuple(step for step in passes if step.name in pipeline.READING)
    return _compile(replace(unit.request, passes=reading), settings, unit.opened, analyses=())


def compile_units(
    units: "Sequence[Unit]", settings: Settings, *, has_files: bool = True, uses_cache: bool = True
) -> "list[Outcome]":
    """Return the outcome of each unit, from the cache if nothing has changed since it was stored.

    A finding about the project remains if all units have it. Without *has_files* the outcomes have
    diagnostics only.
    """
    from sysmlc.driver.project_findings import judge_project_findings

    files = [file for unit in units for file in unit.request.inputs]
    is_cached = uses_cache and settings.is_plain
    cache = open_cache(files, units[0].config) if is_cached else None
    outcomes = [
        compute_outcome(unit, settings, has_files)
        if cache is None
        else _reuse_outcome(cache, unit, settings, has_files)
        for unit in units
    ]
    return judge_project_findings([(unit.config, unit.opened) for unit in units], outcomes)


def open_cache(inputs: Iterable[Path], config: "Config") -> "Cache | None":
    """Return the user's cache; print a warning and return None if its folder cannot be trusted."""
    from sysmlc.config import find_project_root
    from sysmlc.support import cache

    roots = {find_project_root(file) for file in inputs}
    roots |= {folder for folder in (config.root, config.folder) if folder is not None}
    try:
        return cache.open_cache(sorted(roots))
    except cache.CacheError as problem:
        terminal.echo(f"sysmlc: warning: no cache is used: {problem}", err=True)
        return None


def _reuse_outcome(cache: "Cache", unit: "Unit", settings: Settings, has_files: bool) -> "Outcome":
    from sysmlc.driver.outcome_cache import compute_outcome_key, load_outcome, store_outcome

    key = compute_outcome_key(unit.opened, unit.request, unit.emit, has_files)
    outcome = load_outcome(cache, key, unit.opened.root)
    if outcome is None:
        outcome = compute_outcome(unit, settings, has_files)
        store_outcome(cache, key, outcome)
    return outcome


def compute_outcome(unit: "Unit", settings: Settings, has_files: bool = True) -> "Outcome":
    """Compile the unit and return the outcome, without the cache.

    All analyses run if only the findings are wanted, else those that the back ends need.
    """
    from sysmlc.driver import summarize

    request = _set_backends(unit.request, unit.emit, settings, unit.opened.sink)
    analyses = () if has_files else None
    return summarize(_compile(request, settings, unit.opened, analyses), has_files)


def make_request(files: tuple[Path, ...], config: "Config", settings: Settings) -> "Request":
    """Return the request to compile files with no back end."""
    from sysmlc.driver import Request

    return Request(
        inputs=files,
        config=config,
        templates=_find_templates(config, settings),
        strict_input=settings.strict_input or config.strict_input,
        diagrams=settings.diagrams or config.diagrams,
        overlays=settings.overlay,
        verify_each=settings.verify_each,
        schemas=_load_schemas(settings),
        library=settings.library,
    )


def _load_schemas(settings: Settings) -> "Schemas | None":
    """Load the schemas of ``--schema``; exit with code 2 if they cannot be used."""
    if settings.schema is None:
        return None
    from sysmlc.sources.user_schemas import SchemaError, load_schemas

    try:
        return load_schemas(settings.schema)
    except SchemaError as problem:
        fail(str(problem))


def _set_backends(
    request: "Request", emit: tuple[str, ...] | None, settings: Settings, sink: "Sink"
) -> "Request":
    """Return the request with the back ends of *emit*; exit with code 2 if one is unknown."""
    from sysmlc.config import locate_key
    from sysmlc.driver import BackendError, select_backends
    from sysmlc.driver.faults import report_ignored_plug_in

    if emit is None:
        return request
    try:
        report = partial(report_ignored_plug_in, sink)
        return replace(request, backends=tuple(select_backends(emit, report)))
    except BackendError as problem:
        file = None if settings.emit else request.config.file
        fail(f"{locate_key(file, ['emit'])}: {problem}" if file else str(problem))


def _compile(
    request: "Request",
    settings: Settings,
    opened: "OpenedUnit",
    analyses: Iterable[str] | None = None,
) -> "Compilation":
    """Compile a unit with these analyses, by default with those that report findings."""
    from sysmlc.analyses import analysis
    from sysmlc.cli.progress import Progress
    from sysmlc.config import ConfigError
    from sysmlc.driver import compile_model

    progress = Progress(settings.verbose, settings.print_after)
    try:
        request = replace(request, passes=request.load_passes(opened.sink))
        names = [*(step.name for step in request.passes or ()), *analysis.CHECKED]
        _check_pass_names(names, settings.print_after)
        wanted = analysis.CHECKED if analyses is None else analyses
        printed = [name for name in settings.print_after if name in analysis.CHECKED]
        return compile_model(request, progress, opened, [*wanted, *printed])
    except ConfigError as problem:
        from sysmlc.config import locate_key

        file = request.config.file
        fail(f"{locate_key(file, problem.path)}: {problem}" if file else str(problem))
    finally:
        progress.clear()


def _find_templates(config: "Config", settings: Settings) -> Path | None:
    if settings.uses_shipped_templates:
        return None
    folder = settings.templates
    if folder is None and config.templates and config.folder:
        folder = config.folder / config.templates
    if folder is not None and not folder.is_dir():
        fail(f"there is no folder '{folder}' for templates")
    return folder


def _check_pass_names(names: Sequence[str], print_after: Iterable[str]) -> None:
    from sysmlc.support.suggestions import did_you_mean

    for name in print_after:
        if name not in ("read", *names):
            fail(f"unknown pass '{name}'; {did_you_mean(name, ['read', *names])}")


def target_of(unit: "Unit", *, is_forced: bool = False) -> "Target":
    """Return the output folder of the unit, with its boundary and protected files."""
    from sysmlc.driver import Target

    configurations = (unit.config.file,) if unit.config.file else ()
    return Target(unit.output, unit.boundary, configurations, is_forced)
