"""``sysmlc contracts refine``, ``quotient``, ``merge``, ``conjoin`` and ``compose``: two contracts.

An operand is a file, or ``FILE#COMPONENT`` for one contract of a file with several.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click
from msgspec import Struct

from sysmlc.cli import options, terminal
from sysmlc.cli.limits import LIMITS

if TYPE_CHECKING:
    from sysmlc.cli.contract_files import ContractFile
    from sysmlc.cli.session import Settings
    from sysmlc.config import Config
    from sysmlc.diagnostics import Subject
    from sysmlc.diagnostics.renderers import Finding
    from sysmlc.logic.contract import Conjunct, Contract
    from sysmlc.synthesis.algebra.refinement import Comparison

_OPERANDS = """\b
An operand is a model or a contract in any format that sysmlc reads. If the
file has several contracts, append '#' and the name of a component."""


_NO_DETAILS: Mapping[str, object] = {}


class Operand(Struct, frozen=True):
    """A contract and the file that it is from."""

    contract: "Contract"
    file: "ContractFile"
    path: Path

    def find_subject(self, conjunct: "Conjunct | None" = None) -> "Subject":
        """Return the element, or else the file, of a conjunct or of the whole contract."""
        from sysmlc.diagnostics import Place, Subject
        from sysmlc.support.escapes import escape_undecodable

        subject = self.file.place(conjunct.origin if conjunct else self.contract.origin)
        if subject.place is not None:
            return subject
        place = Place(escape_undecodable(self.path.as_posix()))
        return Subject(self.contract.component, place=place)


def _read_operand(text: str, language: str, config: "Config", settings: "Settings") -> Operand:
    """Read one contract; exits with code 2 if there is none, or more than one."""
    from sysmlc.cli.contract_files import read_contracts, select_contracts, split_operand
    from sysmlc.cli.session import fail
    from sysmlc.logic.region_formulas import word_contract

    file, component = split_operand(text)
    contract_file = read_contracts((file,), language, config, settings)
    if not contract_file.contracts:
        _print_findings([contract_file], settings)
        fail(f"'{file}' has no contract that could be read")
    contracts = select_contracts(contract_file.contracts, component)
    if len(contracts) != 1:
        names = ", ".join(contract.component for contract in contracts)
        fail(f"'{file}' has {len(contracts)} contracts; append '#' and one of {names}")
    return Operand(word_contract(contracts[0]), contract_file, file)


def _print_findings(
    files: "list[ContractFile]",
    settings: "Settings",
    details: Mapping[str, object] = _NO_DETAILS,
    refusals: "Sequence[Finding]" = (),
) -> None:
    from sysmlc.cli import reports
    from sysmlc.cli.contract_files import list_findings

    unique = {id(file): file for file in files}.values()
    findings = [item for file in unique for item in list_findings(file)]
    reports.print_findings([*findings, *refusals], settings, details)


def _report_obstacle(problem: Exception, work: str, first: Operand, second: Operand) -> None:
    from sysmlc.synthesis import rules
    from sysmlc.synthesis.witnesses import describe_problem

    first.file.sink.report(
        rules.NOT_COMPARABLE,
        first.find_subject(),
        first=first.contract.component,
        second=second.contract.component,
        work=work,
        reason=describe_problem(problem),
    )


def _read_both(
    texts: tuple[str, str], language: str, settings: "Settings"
) -> tuple[Operand, Operand]:
    from sysmlc.cli import session
    from sysmlc.cli.contract_files import split_operand

    config = session.load_config(tuple(split_operand(text)[0] for text in texts), settings)
    first, second = (_read_operand(text, language, config, settings) for text in texts)
    return first, second


# -- refinement --------------------------------------------------------------------------------


@click.command(
    "refine",
    short_help="Decide whether a contract refines another one.",
    epilog="""\b
Examples:
  sysmlc contracts refine filler.gr1.json line.gr1.json
  sysmlc contracts refine plant.uml#Plant::Gate gate.contract.json

Exit codes: 0 CONCRETE refines ABSTRACT, 1 it does not, 2 that is not decided.""",
)
@click.argument("abstract", metavar="ABSTRACT")
@click.argument("concrete", metavar="CONCRETE")
@options.folder("Draw the runs that show why it does not there (PlantUML).")
@options.contract_formats
@options.question_limit(default=10.0)
@options.reporting
@options.reading
@click.pass_context
def refine_command(
    ctx: click.Context,
    /,
    abstract: str,
    concrete: str,
    output: Path | None,
    language: str,
    seconds: float,
    **setting_values: Any,  # noqa: ANN401 - the fields of Settings
) -> None:
    """Decide whether the contract CONCRETE refines the contract ABSTRACT.

    It does if it assumes no more and guarantees no less, so that it may be used in its place. Each
    assumption and each guarantee that prevents this is shown with a run.
    """
    from sysmlc.cli import reports, session
    from sysmlc.synthesis.witnesses import Party, Witness, witness_files

    settings = session.Settings(**setting_values)
    whole, part = _read_both((abstract, concrete), language, settings)
    comparisons, obstacle = _compare(whole, part, seconds)
    runs = [
        (item.conjunct, item.trace)
        for item in comparisons
        if item.trace is not None and item.is_decided
    ]
    is_decided = not obstacle and all(item.is_decided for item in comparisons)
    refusals: list[Finding] = []
    if output is not None:
        parties = (Party(part.contract.component, part.contract),)
        name = part.contract.component
        witnesses = (Witness(name, conjunct, trace, parties) for conjunct, trace in runs)
        refusals = reports.publish_results(
            "contracts", witness_files(witnesses), output, [whole.file, part.file], settings
        )
    entries = [*_list_verdicts(whole, part, comparisons, obstacle)]
    _print_findings([whole.file, part.file], settings, {"requirements": entries}, refusals)
    if is_decided or runs:
        verb = "does not refine" if runs else "refines"
        within = comparisons[0].basis.range_text if comparisons else ""
        line = f"{part.contract.component} {verb} {whole.contract.component}{within}"
        terminal.echo(line, err=not reports.allows_sentences(settings))
    ctx.exit(2 if refusals else 1 if runs else 0 if is_decided else 2)


def _compare(
    abstract: Operand, concrete: Operand, seconds: float
) -> "tuple[list[Comparison], str]":
    """Report the reasons against refinement.

    Return the conjuncts that were compared, and why the others are not decided, if there are any.
    """
    from sysmlc.synthesis import Limits, Manager, rules
    from sysmlc.synthesis.algebra.operations import OBSTACLES, align_domains, check_owners
    from sysmlc.synthesis.algebra.refinement import compare_conjuncts
    from sysmlc.synthesis.witnesses import (
        describe_problem,
        describe_run,
        print_temporal,
        text_in_parentheses,
    )

    comparisons: list[Comparison] = []
    try:
        check_owners(concrete.contract, abstract.contract)
        pair = align_domains(concrete.contract, abstract.contract)
        for compared in compare_conjuncts(
            *pair, lambda: Manager(limits=Limits(0, LIMITS.memory, seconds))
        ):
            comparisons.append(compared)
            if compared.trace is None:
                continue
            owner = concrete if compared.is_assumption else abstract
            if not compared.is_decided:
                verb = "assumes no more than" if compared.is_assumption else "guarantees"
                owner.file.sink.report(
                    rules.DEPENDS,
                    owner.find_subject(compared.conjunct),
                    question=f"'{concrete.contract.component}' {verb} "
                    f"'{print_temporal(compared.conjunct)}'",
                    reason=compared.basis.reason,
                )
                continue
            owner.file.sink.report(
                rules.ASSUMES_MORE if compared.is_assumption else rules.GUARANTEES_LESS,
                owner.find_subject(compared.conjunct),
                notes=tuple(describe_run(compared.trace, compared.conjunct)),
                concrete=concrete.contract.component,
                abstract=abstract.contract.component,
                formula=print_temporal(compared.conjunct),
                context=text_in_parentheses(compared.conjunct),
            )
    except OBSTACLES as problem:
        _report_obstacle(problem, "compared", abstract, concrete)
        return comparisons, describe_problem(problem)
    return comparisons, ""


def _list_verdicts(
    abstract: Operand, concrete: Operand, comparisons: "list[Comparison]", obstacle: str
) -> "Iterator[dict[str, object]]":
    """Yield an entry for each conjunct; those after an obstacle are not decided."""
    from sysmlc.logic.basis import Basis
    from sysmlc.synthesis.witnesses import export_numbers, print_temporal

    sides = [(concrete, conjunct) for conjunct in concrete.contract.assumptions]
    sides += ((abstract, conjunct) for conjunct in abstract.contract.guarantees)
    for number, (owner, conjunct) in enumerate(sides):
        is_decided = number < len(comparisons)
        trace = comparisons[number].trace if is_decided else None
        basis = comparisons[number].basis if is_decided else Basis()
        verdict = "holds-within-assumed-ranges" if basis.ranges else "holds"
        reason = None
        if not is_decided:
            verdict, reason = "not-decided", obstacle
        elif not comparisons[number].is_decided:
            verdict, reason, trace = "not-decided", basis.reason, None
        elif trace is not None:
            verdict = "broken"
            reason = (
                f"the assumptions of '{abstract.contract.component}' do not imply it"
                if owner is concrete
                else f"'{concrete.contract.component}' does not guarantee it"
            )
        yield {
            "requirement": conjunct.viewpoint or owner.contract.component,
            "component": concrete.contract.component,
            "formula": print_temporal(conjunct),
            "verdict": verdict,
            "vacuous": False,
            "needs": [],
            "witness": trace
            and {"steps": [*map(dict, trace.steps)], "loop": trace.loop, **export_numbers(trace)},
            "reason": reason,
            "assumed_ranges": list(basis.ranges),
            "unread_conditions": list(basis.conditions) if verdict == "not-decided" else [],
        }


# -- operations --------------------------------------------------------------------------------


def _add_operation(
    name: str, operands: tuple[str, str], participle: str, summary: str, help: str
) -> click.Command:
    """Return the command of an operation whose result is a contract."""

    @click.command(name, short_help=summary, help=f"{help}\n\n{_OPERANDS}")
    @click.argument("first", metavar=operands[0])
    @click.argument("second", metavar=operands[1])
    @click.option(
        "-o",
        "--output",
        type=click.Path(path_type=Path, dir_okay=False),
        metavar="FILE",
        help="Write the contract there, in the format of the ending.  [default: print JSON]",
    )
    @options.force
    @options.contract_formats
    @options.question_limit(default=10.0)
    @options.reporting
    @options.reading
    @click.pass_context
    def operation_command(
        ctx: click.Context,
        /,
        first: str,
        second: str,
        output: Path | None,
        language: str,
        seconds: float,
        **setting_values: Any,  # noqa: ANN401 - the fields of Settings
    ) -> None:
        from sysmlc.cli import reports, session

        format_name = _choose_format(output)
        settings = session.Settings(**setting_values)
        if output is None and not reports.allows_sentences(settings):
            session.fail(f"with --format {settings.form}, give the contract a file with -o")
        operands = _read_both((first, second), language, settings)
        contract = _operate(_load_operation(name), operands, participle, seconds)
        files = [operand.file for operand in operands]
        if contract is None:
            _print_findings(files, settings)
            ctx.exit(2)
        if not _write_result(contract, output, format_name, files, settings):
            ctx.exit(2)

    return operation_command


def _load_operation(name: str) -> "Callable[..., Contract]":
    from sysmlc.synthesis.algebra import operations

    return {
        "quotient": operations.divide,
        "merge": operations.merge,
        "conjoin": operations.conjoin,
        "compose": operations.compose,
    }[name]


def _operate(
    operation: "Callable[..., Contract]",
    operands: tuple[Operand, Operand],
    participle: str,
    seconds: float,
) -> "Contract | None":
    """Return the result of the operation; report why there is none."""
    from sysmlc.synthesis import Limits, Manager
    from sysmlc.synthesis.algebra.operations import OBSTACLES

    contracts = (operand.contract for operand in operands)
    try:
        return operation(*contracts, lambda: Manager(limits=Limits(0, LIMITS.memory, seconds)))
    except OBSTACLES as problem:
        _report_obstacle(problem, participle, *operands)
        return None


def _choose_format(output: Path | None) -> str:
    """Return the format with the ending of a file; exits with code 2 if there is none."""
    from sysmlc.cli.session import fail
    from sysmlc.logic.formats import FORMATS

    is_json = output is None or output.suffix.lower() == ".json"
    written = {name: form.endings for name, form in FORMATS.items() if form.is_written}
    name = output.name.lower() if output else ""
    matches = [form for form, endings in written.items() if endings and name.endswith(endings)]
    if not matches and not is_json:
        known_endings = ", ".join(ending for endings in written.values() for ending in endings)
        fail(f"'{output}' has no ending of a contract format; these are {known_endings}")
    return next(iter(matches), "contract")


def _write_result(
    contract: "Contract",
    output: Path | None,
    format_name: str,
    operands: "list[ContractFile]",
    settings: "Settings",
) -> bool:
    """Print the findings and write the contract; return whether it was written."""
    from sysmlc.cli.reports import publish_results
    from sysmlc.cli.session import fail
    from sysmlc.logic import formats
    from sysmlc.logic.printing import print_formula

    try:
        text = formats.write(contract, format_name)
    except formats.NotExpressibleError as problem:
        _print_findings(operands, settings)
        formula = f"'{print_formula(problem.conjunct.formula)}'" if problem.conjunct else "it"
        fail(f"the contract cannot be written for {format_name}: {formula}: {problem.reason}")
    if output is None:
        _print_findings(operands, settings)
        terminal.echo_text(text.removesuffix("\n"))
        return True
    files = [(output.name, text)]
    refusals = publish_results("contracts", files, output.parent, operands, settings)
    _print_findings(operands, settings, refusals=refusals)
    if refusals:
        return False
    counts = (len(contract.assumptions), "assumptions"), (len(contract.guarantees), "guarantees")
    summary = ", ".join(
        f"{count} {word if count != 1 else word.removesuffix('s')}" for count, word in counts
    )
    terminal.echo(f"{contract.component}: {summary}")
    return True


COMMANDS = (
    refine_command,
    _add_operation(
        "quotient",
        ("SYSTEM", "PART"),
        "divided",
        "Write what is missing besides a part.",
        "Write the weakest contract of a component that completes PART to SYSTEM.",
    ),
    _add_operation(
        "merge",
        ("FIRST", "SECOND"),
        "merged",
        "Write the contract of two viewpoints.",
        "Write the contract of a component with both viewpoints, where both assumptions hold.",
    ),
    _add_operation(
        "conjoin",
        ("FIRST", "SECOND"),
        "conjoined",
        "Write the weakest contract that refines two.",
        "Write the weakest contract that refines FIRST and SECOND.",
    ),
    _add_operation(
        "compose",
        ("FIRST", "SECOND"),
        "composed",
        "Write the contract of two components together.",
        "Write the contract of two components that run together.",
    ),
)
