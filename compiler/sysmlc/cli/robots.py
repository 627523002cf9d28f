"""``sysmlc robots``: robots on a floor, from a model to a mission that is validated."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from sysmlc.cli import options, terminal

if TYPE_CHECKING:
    from collections.abc import Sequence

    from sysmlc.config import Config
    from sysmlc.driver import Compilation
    from sysmlc.robots.crew_cache import CrewCache
    from sysmlc.robots.outcome import Outcome
    from sysmlc.synthesis.decision import Options


@click.command(
    "robots",
    short_help="Plan missions of robots on a floor, and validate them.",
    epilog="""\b
Examples:
  sysmlc robots hall.sysml
  sysmlc robots hall.uml -o out
  sysmlc robots hall.sysml --no-relations

Exit codes: 0 the mission is done from every start, 1 it is not,
2 the work could not be done.""",
)
@options.models(required=True)
@options.folder("Write report, controller, mission contract and a run there.")
@click.option(
    "--relations/--no-relations",
    "has_relations",
    default=True,
    help="Decide what the thesis claims of the contracts.  [default: relations]",
)
@options.question_limit(default=10.0)
@options.reporting
@options.reading
@options.caching
@click.pass_context
def command(
    ctx: click.Context,
    /,
    models: tuple[Path, ...],
    output: Path | None,
    has_relations: bool,
    seconds: float,
    **given: Any,  # noqa: ANN401 - the fields of Settings
) -> None:
    """Plan the mission of robots on a floor that specialises Floors::Floor in MODEL.

    A controller of the robots is synthesised from their contract, travel times are measured,
    targets are allocated, and robots and environment are simulated together from every admissible
    start. Where that fails another allocation is tried; a run shows what happens. Controller and
    travel times are kept: new targets on a floor that stays ask for another allocation only.
    """
    from sysmlc.cli import session
    from sysmlc.cli.progress import Progress
    from sysmlc.synthesis import Limits
    from sysmlc.synthesis.decision import Options

    settings = session.Settings(**given)
    config = session.load_config(models, settings)
    made = session.compile_unit(models, config, settings)
    progress = Progress(settings.verbose)
    chosen = Options("", Limits(seconds=seconds), progress.note, is_explained=True)
    try:
        keeper = _open_keeper(models, config) if settings.has_cache else None
        ctx.exit(_studied(made, config.rules, settings, output, has_relations, chosen, keeper))
    except ImportError as problem:
        session.fail(f"the library of decision diagrams cannot be loaded: {problem}")
    finally:
        progress.clear()


def _studied(
    made: "Compilation",
    rules: Any,  # noqa: ANN401 - as the configuration has them
    settings: Any,  # noqa: ANN401 - Settings
    output: Path | None,
    has_relations: bool,
    chosen: "Options",
    keeper: "CrewCache | None",
) -> int:
    from sysmlc.cli import reports, session
    from sysmlc.cli.result_files import write_files
    from sysmlc.diagnostics import Severity, Sink, Subject
    from sysmlc.diagnostics.render import make_report
    from sysmlc.robots.outcome import studied
    from sysmlc.robots.report import files, summary
    from sysmlc.robots.study import Study

    def place(origin: str) -> Subject:
        element = made.graph.get(origin)
        return Subject() if element is None else made.graph.subject(element)

    sink, code = Sink(rules), made.exit_code()
    known = made.graph.derived(Study) if code < 2 else ()
    if not known and not code:
        session.fail("the model has no floor with robots: nothing specialises 'Floors::Floor'")
    outcomes = [studied(one, place, sink, chosen, has_relations, keeper) for one in known]
    if output is not None:
        write_files([file for one in outcomes for file in files(one)], output)
    of_model = reports.list_findings(made, only_errors=not settings.verbose)
    found = reports.localize(made.root, make_report(sink, made.sources).findings)
    reports.print_findings([*of_model, *found], settings)
    for one in outcomes:
        terminal.echo(summary(one), err=not reports.allows_sentences(settings))
    has_errors = any(one.severity is Severity.ERROR for one in sink)
    return max(code, _code(outcomes, has_errors))


def _open_keeper(models: "Sequence[Path]", config: "Config") -> "CrewCache | None":
    """Return the store of controllers and travel times in the user's cache, if there is a cache."""
    from sysmlc.cli import session
    from sysmlc.driver.cache_key import compute_tool_digest
    from sysmlc.robots.crew_cache import CrewCache

    cache = session.open_cache(models, config)
    return None if cache is None else CrewCache(cache, compute_tool_digest())


def _code(outcomes: "Sequence[Outcome]", has_errors: bool) -> int:
    """0 when every mission is done, 1 when one is not, 2 without a controller."""
    if any(one.controller.verdict.is_realizable is None for one in outcomes):
        return 2
    return int(has_errors or not all(one.is_good for one in outcomes))
