"""``sysmlc contracts accept``: a recorded run against a contract."""

from pathlib import Path
from typing import Any

import click

from sysmlc.cli import options
from sysmlc.support.escapes import escape_undecodable


@click.command(
    "accept",
    short_help="Decide whether a recorded run satisfies a contract.",
    epilog="""\b
Examples:
  sysmlc contracts accept gate.contract.json monday.csv
  sysmlc contracts accept plant.uml#Plant::Gate monday.csv
  sysmlc contracts accept plant.sysml run.json -c Plant::Cell --strict

Exit codes: 0 no step breaks a guarantee, 1 a step does, 2 the run could not be read
or nothing in it could be checked.""",
)
@click.argument("operand", metavar="CONTRACT")
@click.argument("run_file", type=click.Path(path_type=Path), metavar="RUN")
@click.option("-c", "--component", default="", metavar="NAME", help="The component of the run.")
@options.contract_formats
@options.reporting
@options.reading
@click.pass_context
def accept_command(
    ctx: click.Context,
    /,
    operand: str,
    run_file: Path,
    component: str,
    language: str,
    **setting_values: Any,  # noqa: ANN401 - the fields of Settings
) -> None:
    """Check the logged steps in RUN against a contract in CONTRACT, a contract file or a model.

    RUN is a CSV file with the names of variables in its first line, or a JSON list of objects. The
    first step that breaks the contract is reported, with the element whose rule is broken. Checks
    of variables that RUN does not contain are skipped; so are promises that something happens
    sooner or later, which no finite run breaks.
    """
    from sysmlc.cli import session
    from sysmlc.cli.contract_files import (
        read_contracts,
        select_contracts,
        show_results,
        split_operand,
    )
    from sysmlc.driver.faults import compute_exit_code
    from sysmlc.sources import Source, SourceError
    from sysmlc.sources.files import read_whole
    from sysmlc.sources.source import DOCUMENT_LIMITS
    from sysmlc.synthesis.run_acceptance import accept_run

    settings = session.Settings(**setting_values)
    file, operand_component = split_operand(operand)
    config = session.load_config((file,), settings)
    contract_file = read_contracts((file,), language, config, settings)
    contracts = select_contracts(contract_file.contracts, component or operand_component)
    if len(contracts) != 1:
        names = ", ".join(contract.component for contract in contracts)
        session.fail(
            f"name the component of the run, by -c or FILE#COMPONENT: {names or 'there is none'}"
        )
    name = escape_undecodable(run_file.as_posix())
    try:
        source = Source(name, read_whole(run_file, name, DOCUMENT_LIMITS))
    except SourceError as problem:
        session.fail(f"cannot read '{problem.file}': {problem.message}")
    verdict = accept_run(contracts[0], source, contract_file.place, contract_file.sink)
    show_results(contract_file, settings, [verdict.text()] if verdict else [])
    is_checked = verdict is not None and verdict.is_checked
    is_strict = settings.strict or config.strict
    ctx.exit(compute_exit_code(contract_file.sink, is_strict) if is_checked else 2)
