"""What every compiling command does: configuration, compile units, findings, exit code."""

import os
import sys
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, NoReturn

import click
from msgspec import Struct
from msgspec.structs import replace

from sysmlc.cli import terminal
from sysmlc.cli.limits import LIMITS
from sysmlc.support.escapes import escape_undecodable

if TYPE_CHECKING:
    from sysmlc.backends.base import Backend
    from sysmlc.cli.units import Unit
    from sysmlc.config import Config
    from sysmlc.diagnostics import Rule
    from sysmlc.diagnostics.render import Finding
    from sysmlc.driver import Compilation, OpenedUnit, Outcome, Publication, Request, Target
    from sysmlc.sources.schema import Schemas
    from sysmlc.support.cache import Cache

_AS_WRITTEN = frozenset({"resolve", "kept"})
"""Passes that add nothing to what the authors wrote."""
_SHOWN = 1_000
"""Findings that a reader is shown unless all are asked for: nobody reads more at once."""
_ON_STDOUT = frozenset({"json", "sarif", "github"})


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
    most: int | None = None
    strict: bool = False
    emit: tuple[str, ...] = ()
    templates: Path | None = None
    uses_shipped_templates: bool = False
    """Whether templates that the configuration names are ignored."""
    diagrams: str | None = None
    overlay: tuple[Path, ...] = ()
    library: str = ""
    has_cache: bool = True

    @property
    def is_plain(self) -> bool:
        """Whether nothing was asked for that only a compilation that really runs can show."""
        if self.schema is not None:
            return False
        return self.has_cache and not (self.verify_each or self.print_after or self.verbose)


class Selection(Struct, frozen=True):
    """Files and folders that were named, or a ``[[model]]``, and where their outputs go.

    ``name`` is that of the ``[[model]]``; without one the files may be several compile units.
    Nothing is written outside ``boundary``: the project root, or what ``find_boundary`` returns for
    a folder that the user named.
    """

    files: tuple[Path, ...]
    output: Path
    emit: tuple[str, ...]
    boundary: Path
    name: str = ""


def fail(message: str, *details: str) -> NoReturn:
    """End with a sentence, each detail on a line below it, and exit code 2."""
    terminal.echo(f"sysmlc: {message}", err=True)
    for detail in details:
        terminal.echo(f"  {detail}", err=True)
    sys.exit(2)


def known_rules() -> "dict[str, Rule]":
    """Every rule by its code; those of a module that cannot be imported are noted as missing."""
    from sysmlc.driver import load_full_catalogue

    return load_full_catalogue(lambda note: terminal.echo(f"sysmlc: note: {note}", err=True))


def load_config(models: Sequence[Path], settings: Settings) -> "Config":
    """Return the configuration for these models; end with exit code 2 if it is wrong.

    An isolated command reads no configuration file.
    """
    from sysmlc import config
    from sysmlc.support.suggestions import did_you_mean

    if settings.isolated:
        if settings.config is not None:
            raise click.UsageError("--isolated and --config exclude each other")
        return config.Config()
    try:
        loaded = config.load(settings.config or config.find(_start(models)))
    except config.ConfigError as problem:
        fail(str(problem))
    chosen = [*loaded.rules, *(entry.rule for entry in loaded.suppress)]
    if chosen:
        rules = known_rules().values()
        known = {rule.code for rule in rules} | {rule.name for rule in rules}
        for name in chosen:
            if name not in known:
                fail(f"{loaded.file}: unknown rule '{name}'; {did_you_mean(name, known)}")
    LIMITS.lower(loaded.time_limit, loaded.memory_limit)
    return loaded


def _start(models: Sequence[Path]) -> Path:
    if not models:
        return Path.cwd()
    first = models[0].absolute()
    return first if first.is_dir() else first.parent


def select(
    models: Sequence[Path], config: "Config", output: Path | None, emit: tuple[str, ...]
) -> list[Selection]:
    """Return what was named, or every ``[[model]]``.

    A named file that a ``[[model]]`` lists brings the whole unit with it, and so does a named
    folder that such a file lies in. What else was named comes last.
    """
    from sysmlc.config import find_boundary

    folder = config.folder or Path.cwd()
    declared = [(unit, _expand(config, unit.files)) for unit in config.models]
    chosen = [
        Selection(
            tuple(files),
            output / unit.name if output and len(declared) > 1 else output or folder / unit.output,
            emit or unit.emit or config.emit,
            find_boundary(output) if output else config.root or Path.cwd(),
            unit.name,
        )
        for unit, files in declared
        if not models or any(_contains(model, file) for model in models for file in files)
    ]
    listed = [file for unit in chosen for file in unit.files]
    rest = tuple(m for m in models if not any(_same(m, file) for file in listed))
    if rest:
        plain = output or (folder / config.output if config.folder else Path(config.output))
        boundary = find_boundary(output) if output else config.root or Path.cwd()
        chosen.append(Selection(rest, plain, emit or config.emit, boundary))
    if not chosen:
        raise click.UsageError("name a model, or list [[model]] units in sysmlc.toml")
    return chosen


def _expand(config: "Config", patterns: Iterable[str]) -> list[Path]:
    """Return the files of a ``[[model]]``; ends with exit code 2 when one leads out of the root."""
    from sysmlc.config import ConfigError, expand_files

    try:
        return expand_files(config, patterns)
    except ConfigError as problem:
        fail(str(problem))


def _contains(model: Path, file: Path) -> bool:
    """Whether *model* is the file, or a folder that the file lies in."""
    return Path(os.path.realpath(file)).is_relative_to(os.path.realpath(model))


def _same(left: Path, right: Path) -> bool:
    return os.path.realpath(left) == os.path.realpath(right)


def compile_unit(
    files: tuple[Path, ...],
    config: "Config",
    settings: Settings,
    emit: tuple[str, ...] | None = None,
) -> "Compilation":
    """Compile files, which must be one unit, with the back ends of ``emit`` (None: with none).

    Findings about the configuration are dropped unless the files are the whole project.
    """
    from sysmlc.cli.units import open_single_unit
    from sysmlc.driver.project_findings import select_project_findings, without_project_findings

    unit = open_single_unit(files, config, settings)
    compilation = compile_opened(unit, settings, emit)
    kept = select_project_findings(config, [unit.opened], [compilation.diagnostics])
    return replace(
        compilation, diagnostics=tuple(without_project_findings(compilation.diagnostics, kept))
    )


def compile_opened(
    unit: "Unit", settings: Settings, emit: tuple[str, ...] | None = None
) -> "Compilation":
    """Compile a unit with the back ends of ``emit`` (None: with none)."""
    return _compile(_with_backends(unit.request, emit), settings, unit.opened)


def read_as_written(unit: "Unit", settings: Settings) -> "Compilation":
    """Read a unit as its authors wrote it: references are resolved, nothing is refined."""
    passes = tuple(step for step in unit.request.load_passes() if step.name in _AS_WRITTEN)
    return _compile(replace(unit.request, passes=passes), settings, unit.opened)


def compile_units(
    units: "Sequence[Unit]", settings: Settings, *, has_files: bool = True, uses_cache: bool = True
) -> "list[Outcome]":
    """Return the outcome of each unit, from the cache if nothing has changed since it was stored.

    Findings about the configuration are judged for all units together. Without *has_files* the
    outcomes hold diagnostics only.
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
    """Return the user's cache, or None. A folder that cannot be trusted is reported once."""
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
    from sysmlc.driver.cache_key import compute_outcome_key
    from sysmlc.driver.outcome_cache import load_outcome, store_outcome

    key = compute_outcome_key(unit.opened, unit.request, unit.emit, has_files)
    outcome = load_outcome(cache, key, unit.opened.root)
    if outcome is None:
        outcome = compute_outcome(unit, settings, has_files)
        store_outcome(cache, key, outcome)
    return outcome


def compute_outcome(unit: "Unit", settings: Settings, has_files: bool = True) -> "Outcome":
    """Compile the unit in this process and return the outcome; the cache is not used."""
    from sysmlc.driver import summarize

    return summarize(compile_opened(unit, settings, unit.emit), has_files)


def make_request(files: tuple[Path, ...], config: "Config", settings: Settings) -> "Request":
    """Return the request to compile files with no back end."""
    from sysmlc.driver import Request

    return Request(
        inputs=files,
        config=config,
        templates=_templates(config, settings),
        strict_input=settings.strict_input or config.strict_input,
        diagrams=settings.diagrams or config.diagrams,
        overlays=settings.overlay,
        verify_each=settings.verify_each,
        schemas=_schemas(settings),
        library=settings.library,
    )


def _schemas(settings: Settings) -> "Schemas | None":
    """The schemas that the user gives; ends with exit code 2 when they cannot be used."""
    if settings.schema is None:
        return None
    from sysmlc.sources.schema import SchemaError, load_schemas

    try:
        return load_schemas(settings.schema)
    except SchemaError as problem:
        fail(str(problem))


def _with_backends(request: "Request", emit: tuple[str, ...] | None) -> "Request":
    return request if emit is None else replace(request, backends=_backends(emit))


def _compile(
    request: "Request", settings: Settings, opened: "OpenedUnit | None" = None
) -> "Compilation":
    from sysmlc.cli.progress import Progress
    from sysmlc.config import ConfigError
    from sysmlc.driver import compile_model

    progress = Progress(settings.verbose, settings.print_after)
    try:
        _check_pass_names([step.name for step in request.load_passes()], settings.print_after)
        return compile_model(request, progress, opened)
    except ConfigError as problem:
        fail(f"{request.config.file}: {problem}" if request.config.file else str(problem))
    finally:
        progress.clear()


def _backends(emit: tuple[str, ...]) -> "tuple[Backend, ...]":
    from sysmlc.driver import BackendError, select_backends

    try:
        return tuple(select_backends(emit))
    except BackendError as problem:
        fail(str(problem))


def _templates(config: "Config", settings: Settings) -> Path | None:
    if settings.uses_shipped_templates:
        return None
    folder = settings.templates
    if folder is None and config.templates and config.folder:
        folder = config.folder / config.templates
    if folder is not None and not folder.is_dir():
        fail(f"there is no folder '{folder}' for templates")
    return folder


def _check_pass_names(known: Sequence[str], asked: Iterable[str]) -> None:
    from sysmlc.support.suggestions import did_you_mean

    for name in asked:
        if name not in ("read", *known):
            fail(f"unknown pass '{name}'; {did_you_mean(name, ['read', *known])}")


def target_of(unit: "Unit", *, is_forced: bool = False) -> "Target":
    """Return the output folder of the unit, with what bounds it."""
    from sysmlc.driver import Target

    configurations = (unit.config.file,) if unit.config.file else ()
    return Target(unit.output, unit.boundary, configurations, is_forced)


def report(
    outcomes: "Iterable[Outcome]", settings: Settings, publications: "Iterable[Publication]" = ()
) -> None:
    """Show the findings of all outcomes, and those about their output folders, as one report.

    A finding about a library is shown once, although several units use the library.
    """
    from sysmlc.diagnostics.render import make_report

    found = [finding for made in outcomes for finding in named(made.root, made.findings)]
    diagnostics = [one for publication in publications for one in publication.diagnostics]
    found += named(Path.cwd(), make_report(diagnostics, ()).findings)
    show(dict.fromkeys(found), settings)


def findings(compilation: "Compilation", only_errors: bool = False) -> "list[Finding]":
    """The findings of a compilation, with places as the reader knows them."""
    from sysmlc.diagnostics.render import make_report

    chosen = [found for found in compilation.diagnostics if found.is_error or not only_errors]
    return named(compilation.root, make_report(chosen, compilation.sources).findings)


def named(root: Path, found: "Iterable[Finding]") -> "list[Finding]":
    found = list(found)
    files = {one.file for one in found if one.file}
    names = {file: name_of(root, file) for file in files} | {"": ""}
    return [
        one if names[one.file] == one.file else replace(one, file=names[one.file]) for one in found
    ]


def name_of(root: Path, name: str) -> str:
    """Name of an input as the reader knows it: relative to the working folder."""
    path, here = root / name, Path.cwd()
    if not path.is_relative_to(here):
        return name
    return escape_undecodable(path.relative_to(here).as_posix())


def show(found: "Iterable[Finding]", settings: Settings) -> None:
    """Print findings in the form that was asked for."""
    from sysmlc.diagnostics.render import XPATH_FORMATS, render, shortened

    on_stdout = settings.form in _ON_STDOUT
    stream = sys.stdout if on_stdout else sys.stderr
    report = shortened(found, _most(settings))
    if settings.form not in XPATH_FORMATS and not settings.verbose:
        bare = tuple(replace(one, xpath="") if one.xpath else one for one in report.findings)
        report = replace(report, findings=bare)
    text = render(report, settings.form, color=has_color(stream))
    click.echo(text, nl=False, err=not on_stdout, color=True)
    if report.left:
        click.echo(
            f"{len(report.left)} more are not shown; --max-diagnostics 0 shows all", err=True
        )


def _most(settings: Settings) -> int:
    """How many findings are shown; programs get all unless they ask for less. 0 means all."""
    if settings.most is None:
        return 0 if settings.form in ("json", "sarif") else _SHOWN
    return settings.most


def says_more(settings: Settings) -> bool:
    """Whether sentences may be printed on standard output beside the findings."""
    return settings.form not in ("json", "sarif")


def exit_code(outcome: "Outcome | Compilation", config: "Config", settings: Settings) -> int:
    """Return the exit code of an outcome, with ``--strict`` or ``strict`` of the configuration."""
    return outcome.exit_code(settings.strict or config.strict)


def exit_code_of_all(
    units: "Sequence[Unit]", outcomes: "Sequence[Outcome]", settings: Settings
) -> int:
    """Return the highest exit code; each unit is judged by the configuration of its project."""
    pairs = zip(units, outcomes, strict=True)
    return max(exit_code(outcome, unit.config, settings) for unit, outcome in pairs)


def has_color(stream: object) -> bool:
    is_terminal = getattr(stream, "isatty", lambda: False)()
    return bool(is_terminal) and not os.environ.get("NO_COLOR") and os.environ.get("TERM") != "dumb"
