"""``sysmlc synth``: whether a contract can be kept."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from sysmlc.cli import options

if TYPE_CHECKING:
    from sysmlc.cli.contract_files import ContractFile
    from sysmlc.cli.session import Settings
    from sysmlc.synthesis.decide import Options

_GIBIBYTE = 1 << 30


@click.command(
    "synth",
    short_help="Say whether a contract can be kept.",
    epilog="""\b
Examples:
  sysmlc synth gate.contract.json --realizable
  sysmlc synth plant.uml -c Plant::Gate --realizable
  sysmlc synth amba.tlsf --realizable --time-limit 60

Exit codes: 0 realizable, 1 unrealizable, 2 outside GR(1), beyond a limit,
or the work could not be done.""",
)
@click.argument("file", type=click.Path(path_type=Path), metavar="FILE")
@click.option("-c", "--component", default="", metavar="NAME", help="Only this component.")
@click.option("--realizable", "is_decided_only", is_flag=True, help="Decide, write nothing.")
@click.option("--from", "language", default="", metavar="FORM", help="Form of the file.")
@click.option(
    "--engine",
    type=click.Choice(("cudd", "autoref")),
    help="Library of decision diagrams.  [default: cudd if it is there]",
)
@click.option("--time-limit", "seconds", type=float, default=0.0, metavar="S", help="CPU seconds.")
@click.option("--memory", type=float, default=0.0, metavar="GIB", help="GiB for the diagrams.")
@click.option("--nodes", type=int, default=0, metavar="N", help="Nodes of diagrams at once.")
@options.reporting
@options.reading
@click.pass_context
def command(
    ctx: click.Context,
    /,
    file: Path,
    component: str,
    is_decided_only: bool,
    language: str,
    engine: str | None,
    seconds: float,
    memory: float,
    nodes: int,
    **given: Any,  # noqa: ANN401 - the fields of Settings
) -> None:
    """Decide whether there is a system that keeps the contracts in FILE.

    FILE is a model or a contract, in one of the forms of docs/synthesis.md.
    """
    from sysmlc.cli import session
    from sysmlc.cli.contract_files import read_contracts
    from sysmlc.cli.progress import Progress
    from sysmlc.synthesis import Limits
    from sysmlc.synthesis.decide import Options

    if not is_decided_only:
        session.fail("controllers are not written yet; --realizable decides")
    settings = session.Settings(**given)
    config = session.load_config((file,), settings.config)
    progress = Progress(settings.verbose)
    limits = Limits(nodes, int(memory * _GIBIBYTE), seconds)
    read = read_contracts(file, language, config, settings)
    try:
        ctx.exit(_decided(read, component, settings, Options(engine or "", limits, progress.note)))
    except ImportError as problem:
        session.fail(f"the library of decision diagrams cannot be loaded: {problem}")
    finally:
        progress.clear()


def _decided(read: "ContractFile", component: str, settings: "Settings", options: "Options") -> int:
    from sysmlc.cli import session
    from sysmlc.cli.contract_files import chosen
    from sysmlc.diagnostics.render import make_report
    from sysmlc.synthesis.decide import decide

    contracts = chosen(read.contracts, component) if read.contracts else ()
    verdicts = [decide(one, read.place, read.sink, options) for one in contracts]
    found = session.named(read.root, make_report(read.sink, read.sources).findings)
    session.show([*read.findings, *found], settings)
    for verdict in verdicts:
        click.echo(verdict.text(), err=not session.says_more(settings))
    return max((verdict.exit_code for verdict in verdicts), default=2)
