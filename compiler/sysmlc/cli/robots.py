"""``sysmlc robots``: plan missions of robots on a floor, and validate them."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from sysmlc.cli import options, terminal
from sysmlc.cli.limits import LIMITS

if TYPE_CHECKING:
    from collections.abc import Sequence

    from sysmlc.config import Config
    from sysmlc.diagnostics.renderers import Finding
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
    help="Decide the relations between contracts that the thesis claims.  [default: relations]",
)
@click.option(
    "--allocation",
    type=click.Choice(("best", "printed")),
    default="best",
    show_default=True,
    help="Try the best allocations, or only that of the thesis's Algorithm 1 as it is printed, "
    "with its defects.",
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
    allocation: str,
    seconds: float,
    **setting_values: Any,  # noqa: ANN401 - the fields of Settings
) -> None:
    """Plan the mission of robots on a floor that specialises Floors::Floor in MODEL.

    A controller of the robots is synthesised from their contract, travel times are measured,
    targets are allocated, and robots and environment are simulated together from every admissible
    start. If the mission fails, another allocation is tried, and a run shows the failure.
    Controller and travel times are cached: new targets on the same floor require only another
    allocation.
    """
    from sysmlc.cli import session
    from sysmlc.cli.progress import Progress
    from sysmlc.synthesis import Limits
    from sysmlc.synthesis.decision import Options

    settings = session.Settings(**setting_values)
    config = session.load_config(models, settings)
    compilation = session.compile_unit(models, config, settings)
    progress = Progress(settings.verbose)
    decision_options = Options(
        "", Limits(memory=LIMITS.memory, seconds=seconds), progress.note, is_explained=True
    )
    try:
        crew_cache = _open_crew_cache(models, config) if settings.has_cache else None
        ctx.exit(
            _run_studies(
                compilation,
                config.rules,
                settings,
                output,
                has_relations,
                decision_options,
                crew_cache,
                is_printed=allocation == "printed",
            )
        )
    except ImportError as problem:
        session.fail(f"the library of decision diagrams cannot be loaded: {problem}")
    finally:
        progress.clear()


def _run_studies(
    compilation: "Compilation",
    rules: Any,  # noqa: ANN401 - as the configuration has them
    settings: Any,  # noqa: ANN401 - Settings
    output: Path | None,
    has_relations: bool,
    decision_options: "Options",
    crew_cache: "CrewCache | None",
    *,
    is_printed: bool,
) -> int:
    from sysmlc.cli import reports, session
    from sysmlc.cli.reports import publish_results
    from sysmlc.diagnostics import Severity, Sink, Subject
    from sysmlc.diagnostics.renderers import make_report
    from sysmlc.robots.outcome import run_study
    from sysmlc.robots.report import study_files, summarise_outcome
    from sysmlc.robots.study import Study

    def place(origin: str) -> Subject:
        element = compilation.graph.get(origin)
        return Subject() if element is None else compilation.graph.subject(element)

    sink, code = Sink(rules), compilation.exit_code()
    studies = compilation.graph.derived(Study) if code < 2 else ()
    if not studies and not code:
        session.fail("the model has no floor with robots: nothing specialises 'Floors::Floor'")
    outcomes = [
        run_study(study, place, sink, decision_options, has_relations, crew_cache, is_printed)
        for study in studies
    ]
    refusals: list[Finding] = []
    if output is not None:
        files = [file for outcome in outcomes for file in study_files(outcome)]
        refusals = publish_results("robots", files, output, [compilation], settings)
    of_model = reports.list_findings(compilation, only_errors=not settings.verbose)
    findings = reports.localize(compilation.root, make_report(sink, compilation.sources).findings)
    reports.print_findings([*of_model, *findings, *refusals], settings)
    for outcome in outcomes:
        terminal.echo(summarise_outcome(outcome), err=not reports.allows_sentences(settings))
    has_errors = any(d.severity is Severity.ERROR for d in sink)
    return 2 if refusals else max(code, _compute_exit_code(outcomes, has_errors))


def _open_crew_cache(models: "Sequence[Path]", config: "Config") -> "CrewCache | None":
    """Return the cache of controllers and travel times, or None if the user has no cache."""
    from sysmlc.cli import session
    from sysmlc.driver.outcome_cache import compute_tool_digest
    from sysmlc.robots.crew_cache import CrewCache

    cache = session.open_cache(models, config)
    return None if cache is None else CrewCache(cache, compute_tool_digest())


def _compute_exit_code(outcomes: "Sequence[Outcome]", has_errors: bool) -> int:
    """Return 0 if every mission is accomplished, 1 if one fails, 2 if one was not decided."""
    if any(outcome.controller.verdict.is_realizable is None for outcome in outcomes):
        return 2
    return int(has_errors or not all(outcome.is_good for outcome in outcomes))
