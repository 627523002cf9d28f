"""``sysmlc synth``: decide whether contracts are realizable, and synthesise controllers."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from sysmlc.cli import options, terminal
from sysmlc.cli.limits import LIMITS

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from sysmlc.cli.contract_files import ContractFile
    from sysmlc.cli.session import Settings
    from sysmlc.diagnostics.renderers import Finding
    from sysmlc.logic.contract import Contract
    from sysmlc.synthesis.controller_synthesis import Synthesis
    from sysmlc.synthesis.decision import Deadline, Options, Verdict


@click.command(
    "synth",
    short_help="Decide whether a contract is realizable; synthesise a controller.",
    epilog="""\b
Examples:
  sysmlc synth gate.contract.json --realizable
  sysmlc synth gate.contract.json -o out
  sysmlc synth plant.uml -c Plant::Gate --realizable
  sysmlc synth plant.uml -c Plant::Gate --play
  sysmlc synth cart.gr1.json --deadline timer
  sysmlc synth amba.tlsf --realizable --time-limit 60 --memory-limit 2

Exit codes: 0 realizable, 1 unrealizable or the model has errors, 2 outside
GR(1), beyond a limit, no controller, or the work could not be done.""",
)
@click.argument(
    "files", nargs=-1, required=True, type=click.Path(path_type=Path), metavar="FILE..."
)
@click.option("-c", "--component", default="", metavar="NAME", help="Only this component.")
@click.option("--realizable", "is_decided_only", is_flag=True, help="Decide, write nothing.")
@options.folder("Write controllers there, and counter-strategies of unrealizable contracts.")
@click.option(
    "--machine",
    "machine_form",
    type=click.Choice(("own", "table", "gr1c")),
    default="own",
    show_default=True,
    help="Format of the controllers.",
)
@click.option(
    "--play",
    "is_played",
    is_flag=True,
    help="Play against the counter-strategy of an unrealizable contract.",
)
@click.option(
    "--deadline",
    "timers",
    multiple=True,
    metavar="VAR",
    help="Find the smallest bound of this variable that can be guaranteed (one bound for all).",
)
@options.contract_formats
@click.option(
    "--engine",
    type=click.Choice(("cudd", "autoref")),
    help="Library of decision diagrams.  [default: cudd if it is there]",
)
@options.question_limit(default=0.0)
@click.option(
    "--nodes",
    type=click.IntRange(min=0),
    default=0,
    metavar="N",
    help="Decision-diagram nodes in memory.  [default: no limit]",
)
@options.reporting
@options.reading
@click.pass_context
def command(
    ctx: click.Context,
    /,
    files: tuple[Path, ...],
    component: str,
    is_decided_only: bool,
    output: Path | None,
    machine_form: str,
    is_played: bool,
    timers: tuple[str, ...],
    language: str,
    engine: str | None,
    seconds: float,
    nodes: int,
    **setting_values: Any,  # noqa: ANN401 - the fields of Settings
) -> None:
    """Decide whether the contracts in FILE... are realizable, and synthesise controllers.

    FILE... are the files or folders of one model, or a contract in one of the formats of
    docs/synthesis.md. Each controller is checked against its contract. With -o it is written as
    JSON and, when it is small, as a PlantUML diagram; one with too many states is written as a
    table of decisions. For an
    unrealizable contract -o writes a counter-strategy of the environment, as diagrams and in
    SysML v2; with --play you take the part of the component against it.
    """
    from sysmlc.cli import session
    from sysmlc.cli.contract_files import read_contracts
    from sysmlc.cli.progress import Progress
    from sysmlc.synthesis import Limits
    from sysmlc.synthesis.decision import Options

    if (is_decided_only or timers) and output is not None:
        word = "--deadline" if timers else "--realizable"
        session.fail(f"{word} decides only: nothing can be written to a folder")
    settings = session.Settings(**setting_values)
    config = session.load_config(files, settings)
    progress = Progress(settings.verbose)
    limits = Limits(nodes, LIMITS.memory, seconds or LIMITS.seconds)
    contract_file = read_contracts(files, language, config, settings)
    options = Options(engine or "", limits, progress.note, is_explained=not is_decided_only)
    try:
        if is_played:
            ctx.exit(_play(contract_file, component, options))
        if timers:
            ctx.exit(_find_deadlines(contract_file, component, timers, settings, options))
        if is_decided_only:
            ctx.exit(_decide(contract_file, component, settings, options))
        ctx.exit(_synthesize(contract_file, component, settings, options, output, machine_form))
    except ImportError as problem:
        session.fail(f"the library of decision diagrams cannot be loaded: {problem}")
    finally:
        progress.clear()


def _select(contract_file: "ContractFile", component: str) -> "tuple[Contract, ...]":
    """Return the selected contracts, in which no literal has the name of a variable."""
    from sysmlc.cli.contract_files import select_contracts
    from sysmlc.logic.formats.lowering import rename_ambiguous_literals

    contracts = contract_file.contracts
    selected = select_contracts(contracts, component) if contracts else ()
    return tuple(map(rename_ambiguous_literals, selected))


def _decide(
    contract_file: "ContractFile", component: str, settings: "Settings", options: "Options"
) -> int:
    from sysmlc.synthesis.decision import decide

    place, sink = contract_file.place, contract_file.sink
    contracts = _select(contract_file, component)
    verdicts = [decide(contract, place, sink, options) for contract in contracts]
    return _report(contract_file, settings, verdicts)


def _find_deadlines(
    contract_file: "ContractFile",
    component: str,
    timers: tuple[str, ...],
    settings: "Settings",
    options: "Options",
) -> int:
    from sysmlc.synthesis.decision import find_deadline

    place, sink = contract_file.place, contract_file.sink
    contracts = _select(contract_file, component)
    results = [find_deadline(contract, timers, place, sink, options) for contract in contracts]
    return _report(contract_file, settings, results)


def _synthesize(
    contract_file: "ContractFile",
    component: str,
    settings: "Settings",
    options: "Options",
    output: Path | None,
    form: str,
) -> int:
    from sysmlc.analyses.controllers import Controllers
    from sysmlc.cli.reports import publish_results
    from sysmlc.synthesis.controller_files import TABLE, write_controllers
    from sysmlc.synthesis.controller_synthesis import Form, Synthesis

    graph, place, sink = contract_file.graph, contract_file.place, contract_file.sink
    _select(contract_file, component)  # exits if there is no such component
    kind = Form.TABLE if form == TABLE else Form.ANY
    Controllers(options, component, kind).run(graph, sink)
    controllers = graph.derived(Synthesis)
    for controller in controllers:
        sink.extend(controller.diagnostics)
    written = write_controllers(controllers, place, sink, form)
    refusals: Sequence[Finding] = ()
    if output is not None:
        files = (*written.files, *_find_counter_strategies(contract_file, controllers, options))
        refusals = publish_results("synth", files, output, [contract_file], settings)
    return _report(contract_file, settings, written.results, refusals)


def _find_counter_strategies(
    contract_file: "ContractFile", counters: "Sequence[Synthesis]", options: "Options"
) -> "Iterable[tuple[str, str]]":
    """Return files with counter-strategies of the unrealizable contracts.

    Contracts whose counter-strategy exceeds a limit have none.
    """
    from sysmlc.synthesis.counterstrategy.counter_files import counterstrategy_files
    from sysmlc.synthesis.counterstrategy.counter_machine import find_counterstrategies

    lost = [contract.contract for contract in counters if contract.verdict.is_realizable is False]
    return counterstrategy_files(
        find_counterstrategies(lost, contract_file.place, contract_file.sink, options),
        lambda id: contract_file.place(id).name,
    )


def _play(contract_file: "ContractFile", component: str, options: "Options") -> int:
    """Let the user play against the counter-strategy of the selected contract."""
    from sysmlc.cli.session import fail
    from sysmlc.synthesis import LimitError
    from sysmlc.synthesis.counterstrategy.counter_machine import find_environment_strategy
    from sysmlc.synthesis.counterstrategy.environment_strategy import NotLostError
    from sysmlc.synthesis.counterstrategy.play import Player
    from sysmlc.synthesis.games.game import OutsideGr1Error

    contracts = _select(contract_file, component)
    if len(contracts) != 1:
        fail(f"{len(contracts)} contracts are in the file: choose one with -c")
    try:
        environment = find_environment_strategy(contracts[0], options)
    except NotLostError:
        terminal.echo(f"{contracts[0].component}: realizable, so no environment defeats it")
        return 0
    except (LimitError, OutsideGr1Error) as problem:
        fail(str(problem))
    # The time in which the user thinks does not count (decision 41).
    LIMITS.stop_timer()
    Player(environment, contracts[0], input, terminal.echo_text).play()
    return 1


def _report(
    contract_file: "ContractFile",
    settings: "Settings",
    verdicts: "Sequence[Verdict | Synthesis | Deadline]",
    refusals: "Sequence[Finding]" = (),
) -> int:
    """Print findings and verdicts; return the exit code."""
    from sysmlc.cli.contract_files import show_results

    show_results(contract_file, settings, (verdict.text() for verdict in verdicts), None, refusals)
    if refusals:
        return 2
    code = max((verdict.exit_code for verdict in verdicts), default=2)
    has_errors = any(finding.diagnostic.is_error for finding in contract_file.findings)
    return max(code, int(has_errors)) if contract_file.is_whole else 2
