"""``sysmlc contracts accept``: a recorded run against a contract."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from sysmlc.cli import options
from sysmlc.support.counts import count
from sysmlc.support.escapes import escape_undecodable

if TYPE_CHECKING:
    from sysmlc.cli.contract_files import ContractFile
    from sysmlc.controllers.monitor import Monitor, Violation
    from sysmlc.diagnostics import Place
    from sysmlc.logic.contract import Contract


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
    summary, is_checked = _accept_run(contract_file, contracts[0], run_file)
    show_results(contract_file, settings, [summary] if summary else [])
    is_strict = settings.strict or config.strict
    ctx.exit(compute_exit_code(contract_file.sink, is_strict) if is_checked else 2)


def _accept_run(
    contract_file: "ContractFile", contract: "Contract", path: Path
) -> tuple[str, bool]:
    """Report the first violation in a run; return a summary, and whether anything was checked.

    The summary of an unreadable run is empty.
    """
    from sysmlc.cli.session import fail
    from sysmlc.controllers.monitor import build_monitor, find_first_violation
    from sysmlc.diagnostics import Place
    from sysmlc.logic.contract import Owner
    from sysmlc.logic.formats.recorded_runs import read_run
    from sysmlc.sources import Source, SourceError
    from sysmlc.sources.files import read_whole
    from sysmlc.sources.source import DOCUMENT_LIMITS

    name = escape_undecodable(path.as_posix())
    try:
        source = Source(name, read_whole(path, name, DOCUMENT_LIMITS))
    except SourceError as problem:
        fail(f"cannot read '{problem.file}': {problem.message}")
    monitor = build_monitor(contract)
    run = read_run(source, monitor.contract, contract_file.sink)
    if run is None:
        return "", False
    skipped = _count_skipped_checks(monitor, run.missing)
    _report_missing_variables(contract_file, monitor, run.missing, skipped, name)
    if skipped == len(monitor.checks):
        reason = (
            f"each check needs variables without values in '{name}'"
            if skipped
            else "no finite run breaks this contract"
        )
        return f"{contract.component}: nothing was checked: {reason}", False
    violation = find_first_violation(monitor, run.steps, run.missing)
    if violation is None:
        steps = count(len(run.steps), "step")
        skipping = f"{skipped} of {count(len(monitor.checks), 'check')} skipped"
        rest = f"; {skipping}" if skipped else ""
        return f"{contract.component}: {steps}, no check is broken{rest}", True
    place = Place(name, line=run.lines[violation.step], column=1)
    _report_violation(contract_file, contract, violation, place)
    is_assumption = violation.check.owner is Owner.ENVIRONMENT
    culprit = "the environment breaks an assumption" if is_assumption else "it breaks a guarantee"
    return f"{contract.component}: {culprit} in step {violation.step + 1}", True


def _count_skipped_checks(monitor: "Monitor", missing: frozenset[str]) -> int:
    return sum(
        not missing.isdisjoint(monitor.find_needed_variables(check.conjunct.formula))
        for check in monitor.checks
    )


def _report_missing_variables(
    contract_file: "ContractFile",
    monitor: "Monitor",
    missing: frozenset[str],
    skipped: int,
    name: str,
) -> None:
    from sysmlc.logic.formats.rules import VARIABLES_NOT_RECORDED

    if skipped:
        contract_file.sink.report(
            VARIABLES_NOT_RECORDED,
            contract_file.place(monitor.contract.origin),
            file=name,
            names=", ".join(f"'{variable}'" for variable in sorted(missing)),
            skipped=skipped,
            total=count(len(monitor.checks), "check"),
            component=monitor.contract.component,
        )


def _report_violation(
    contract_file: "ContractFile", contract: "Contract", violation: "Violation", step: "Place"
) -> None:
    """Report a violation about the element from which the broken conjunct is derived.

    The contract of a file has no elements; then the subject is the *step* in the recorded run.
    """
    from msgspec.structs import replace

    from sysmlc.diagnostics import Subject
    from sysmlc.diagnostics.diagnostic import format_position
    from sysmlc.logic.contract import Owner
    from sysmlc.logic.formats import rules
    from sysmlc.logic.formula import rename_variables
    from sysmlc.synthesis.witnesses import print_temporal

    conjunct = violation.check.conjunct
    formula = rename_variables(conjunct.formula, contract.wordings)
    conjunct = replace(conjunct, formula=formula)
    subject = contract_file.place(conjunct.origin or contract.origin)
    is_assumption = violation.check.owner is Owner.ENVIRONMENT
    contract_file.sink.report(
        rules.ASSUMPTION_BROKEN_BY_RUN if is_assumption else rules.GUARANTEE_BROKEN_BY_RUN,
        subject if subject.place else Subject(contract.component, place=step),
        step=violation.step + 1,
        location=format_position(step.file, step.line, 0),
        component=contract.component,
        text=conjunct.text or print_temporal(conjunct),
        formula=print_temporal(conjunct),
    )
