"""``sysmlc contracts``: checks of contracts, by themselves and against one another."""

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click
from msgspec.structs import replace

from sysmlc.cli import options
from sysmlc.cli.contract_operations import COMMANDS
from sysmlc.cli.limits import LIMITS
from sysmlc.cli.recorded_runs import accept_command
from sysmlc.support.counts import count

if TYPE_CHECKING:
    from sysmlc.analyses.verdicts import ContractChecks
    from sysmlc.cli.contract_files import ContractFile
    from sysmlc.cli.session import Settings
    from sysmlc.diagnostics.renderers import Finding
    from sysmlc.logic.requirements.statements import StatedRequirement
    from sysmlc.recipe.recipe_times import LimitVerdict
    from sysmlc.synthesis.contract_checks import CheckedContract
    from sysmlc.synthesis.decision import Options
    from sysmlc.synthesis.requirement_verdicts import RequirementVerdict


@click.group("contracts", short_help="Check contracts, by themselves and against one another.")
def command() -> None:
    """Check contracts, and runs of components; compare and combine contracts."""


for _subcommand in (accept_command, *COMMANDS):
    command.add_command(_subcommand)


@command.command(
    "check",
    short_help="Decide whether contracts are realizable and behaviours satisfy them.",
    epilog="""\b
Examples:
  sysmlc contracts check plant.uml
  sysmlc contracts check cells.sysml -c Cells::Cell.turn
  sysmlc contracts check cells.sysml -o out   # draws the runs that break a contract
  sysmlc contracts check gate.contract.json
  sysmlc contracts check plant.uml --question-limit 60 --time-limit 1800
  sysmlc contracts check plant.uml --strict   # refuses undecided formulas

Exit codes: 0 nothing is violated (formulas may be undecided), 1 a contract is
unrealizable or violated, with --strict also after warnings and if the formula
of a requirement is not decided, 2 the work could not be done.""",
)
@click.argument(
    "files", nargs=-1, required=True, type=click.Path(path_type=Path), metavar="FILE..."
)
@click.option("-c", "--component", default="", metavar="NAME", help="Only this component.")
@options.folder("Draw the runs that break something there (PlantUML).")
@options.contract_formats
@options.question_limit(default=10.0)
@options.reporting
@options.reading
@click.pass_context
def check_command(
    ctx: click.Context,
    /,
    files: tuple[Path, ...],
    component: str,
    output: Path | None,
    language: str,
    seconds: float,
    **setting_values: Any,  # noqa: ANN401 - the fields of Settings
) -> None:
    """Check the contracts in FILE..., the models of one unit or a contract.

    Each contract is decided, and suspicious parts are reported: guarantees that hold trivially,
    assumptions that no environment satisfies, outputs without guarantees. A behaviour is checked
    against the requirements of its component, and the parts of a block against its contract. A run
    shows each violation; -o draws it.
    """
    from sysmlc.cli import session
    from sysmlc.cli.contract_files import read_contracts
    from sysmlc.cli.progress import Progress
    from sysmlc.synthesis import Limits
    from sysmlc.synthesis.decision import Options

    settings = session.Settings(**setting_values)
    config = session.load_config(files, settings)
    settings = replace(settings, strict=settings.strict or config.strict)
    progress = Progress(settings.verbose)
    contract_file = read_contracts(files, language, config, settings)
    limits = Limits(memory=LIMITS.memory, seconds=seconds)
    try:
        ctx.exit(
            _check(contract_file, component, settings, Options("", limits, progress.note), output)
        )
    except ImportError as problem:
        session.fail(f"the library of decision diagrams cannot be loaded: {problem}")
    finally:
        progress.clear()


def _check(
    contract_file: "ContractFile",
    component: str,
    settings: "Settings",
    options: "Options",
    output: Path | None,
) -> int:
    """Decide the contracts, show the verdicts, and return the exit code."""
    from sysmlc.cli.contract_files import show_results
    from sysmlc.ir.query.libraries import find_unused_library_elements
    from sysmlc.logic.requirements.statements import list_stated_requirements
    from sysmlc.recipe.model import Model
    from sysmlc.recipe.recipe_times import decide_limits

    graph = contract_file.graph
    unused = find_unused_library_elements(graph)
    checks = _decide_contracts(contract_file, component, unused, options)
    time_verdicts = decide_limits(graph.derived(Model))
    stated = list_stated_requirements(graph, contract_file.contracts, contract_file.reasons, unused)
    requirements = [item for item in stated if component in ("", item.component)]
    verdicts = list_verdicts(requirements, checks.contracts, time_verdicts)
    refusals = _draw_runs(checks, output, contract_file, settings) if output is not None else ()
    show_results(
        contract_file,
        settings,
        (
            *(line for item in checks.contracts for line in _format_result(item, settings.verbose)),
            *(result.text() for result in checks.compositions),
            *describe_omitted(requirements, checks.contracts, time_verdicts),
            *describe_texts(requirements, time_verdicts, settings.verbose),
        ),
        {"requirements": verdicts, "behaviours": list_behaviours(checks.contracts)},
        refusals,
    )
    is_checked = contract_file.is_whole and bool(checks.contracts or checks.compositions)
    if refusals or not is_checked:
        return 2
    formal = [requirement for requirement in requirements if requirement.is_formal]
    formal_verdicts = list_verdicts(formal, checks.contracts, time_verdicts)
    if settings.strict and any(entry["verdict"] == "not-decided" for entry in formal_verdicts):
        return 1
    return _find_exit_code(contract_file, checks, settings)


def _decide_contracts(
    contract_file: "ContractFile", component: str, unused: Collection[str], options: "Options"
) -> "ContractChecks":
    """Return the verdicts on the contracts, and report their findings to the sink of the file.

    *unused* are the elements of libraries that the model does not use. Exits with code 2 if the
    component is unknown, or if none is named and all contracts are about such elements.
    """
    from sysmlc.analyses.verdicts import ContractChecks, UnknownComponentError, Verdicts
    from sysmlc.cli.session import fail

    graph, contracts = contract_file.graph, contract_file.contracts
    if contracts and not component and all(item.origin in unused for item in contracts):
        fail("all contracts are about libraries that the model does not use; name one with -c")
    try:
        # A model that could not be read has no components to select.
        Verdicts(options, component if contracts else "").run(graph, contract_file.sink)
    except UnknownComponentError as problem:
        fail(str(problem))
    (checks,) = graph.derived(ContractChecks)
    contract_file.sink.extend(checks.diagnostics)
    return checks


def _draw_runs(
    checks: "ContractChecks", output: Path, contract_file: "ContractFile", settings: "Settings"
) -> "Sequence[Finding]":
    """Draw the runs that violate something; return the reasons if nothing was written."""
    from sysmlc.cli.reports import publish_results
    from sysmlc.synthesis.witnesses import witness_files

    runs = [run for result in checks.contracts for run in result.witnesses]
    runs += (run for result in checks.compositions for run in result.witnesses)
    return publish_results("contracts", witness_files(runs), output, [contract_file], settings)


def _find_exit_code(
    contract_file: "ContractFile", checks: "ContractChecks", settings: "Settings"
) -> int:
    """Return 1 if something is violated, else 2 if something is not decided, else 1 after errors.

    With ``--strict`` warnings count as errors. Undecided requirements do not count.
    """
    from sysmlc.cli.contract_files import list_findings
    from sysmlc.cli.reports import is_reported
    from sysmlc.driver.faults import compute_exit_code

    answers = [result.is_satisfied for result in checks.compositions]
    answers += [result.is_implemented is not False for result in checks.contracts]
    answers += [
        result.verdict.is_realizable
        for result in checks.contracts
        if not (result.is_checked_by_behaviour and result.verdict.is_realizable is None)
    ]
    if False in answers:
        return 1
    if None in answers:
        return 2
    diagnostics = (finding.diagnostic for finding in list_findings(contract_file))
    reported = (item for item in diagnostics if is_reported(item, settings))
    return compute_exit_code(reported, settings.strict)


def _format_result(result: "CheckedContract", is_verbose: bool) -> "Iterator[str]":
    """Yield the line of a contract, and the lines of its requirements that do not simply hold."""
    words = {None: "not decided", True: "realizable", False: "unrealizable"}
    verdict = result.verdict
    text = words[verdict.is_realizable]
    if result.is_checked_by_behaviour and verdict.is_realizable is None:
        text = "checked one by one"
    within = "" if verdict.is_realizable is None else verdict.basis.range_text
    yield f"{verdict.component}: {text}{within}{_summarise_requirements(result)}"
    yield from describe_verdicts(result, is_verbose)


def _summarise_requirements(result: "CheckedContract") -> str:
    from sysmlc.logic.basis import Basis
    from sysmlc.synthesis.requirement_verdicts import describe_needs

    answers = [str(requirement.answer) for requirement in result.requirements]
    if result.is_implemented is False:
        return ", violates its requirements"
    if "not-decided" in answers:
        undecided = answers.count("not-decided")
        return f", {undecided} of {count(len(answers), 'requirement')} not decided"
    ranges = dict.fromkeys(text for item in result.requirements for text in item.basis.ranges)
    within = Basis(tuple(ranges)).range_text
    needed = (ending for requirement in result.requirements for ending in requirement.needed)
    condition = describe_needs(needed)
    if condition:
        return f", satisfies its requirements if {condition}{within}"
    return f", satisfies its requirements{within}" if answers else ""


# -- verdicts on requirements ----------------------------------------------------------------------

_WORDS = {
    "holds": "holds",
    "holds-within-assumed-ranges": "holds",
    "holds-if-actions-end": "holds if its actions end",
    "broken": "broken",
    "not-decided": "not decided",
}
_MAX_NAMES = 8
_NO_BEHAVIOUR = "'{component}' has no behaviour to check"


def describe_verdicts(result: "CheckedContract", is_verbose: bool) -> Iterator[str]:
    """Yield a line for each requirement of a component that does not simply hold.

    With *is_verbose* those that hold are shown, too.
    """
    from sysmlc.logic.basis import Basis
    from sysmlc.synthesis.witnesses import print_temporal

    for verdict in result.requirements:
        if is_verbose or verdict.answer != "holds":
            name = f"{verdict.conjunct.viewpoint}: " if verdict.conjunct.viewpoint else ""
            words = f"holds if {verdict.condition}" if verdict.condition else _WORDS[verdict.answer]
            if verdict.answer == "not-decided" and verdict.basis != Basis():
                words = f"not decided: {verdict.reason}"
            else:
                words += verdict.basis.range_text
            yield f"  {name}{words}: {print_temporal(verdict.conjunct)}"


def describe_omitted(
    requirements: "Iterable[StatedRequirement]",
    results: "Iterable[CheckedContract]",
    time_verdicts: "Mapping[str, LimitVerdict]",
) -> Iterator[str]:
    """Yield a line for each formal requirement that is in no contract, with the reason."""
    decided = {verdict.conjunct.origin for result in results for verdict in result.requirements}
    for requirement in requirements:
        is_omitted = requirement.is_formal and requirement.constraint not in decided
        if is_omitted and requirement.reason and requirement.constraint not in time_verdicts:
            yield f"{requirement.name}: not decided: {requirement.reason}"


def describe_texts(
    requirements: "Sequence[StatedRequirement]",
    time_verdicts: "Mapping[str, LimitVerdict]",
    is_verbose: bool,
) -> Iterator[str]:
    """Yield a line that counts the requirements that are only text.

    With *is_verbose* there is a line for each. A line shows a requirement on times that the recipe
    breaks.
    """
    texts = [requirement for requirement in requirements if not requirement.is_formal]
    for requirement in texts:
        decided = time_verdicts.get(requirement.constraint)
        if decided is not None and (is_verbose or decided.verdict == "broken"):
            verdict = f"{_WORDS[decided.verdict]} by the times of the recipe"
            yield f"{requirement.name}: only text, {verdict}: {decided.reason}"
        elif decided is None and is_verbose:
            yield f"{requirement.name}: only text, not formalised"
    open_texts = [item for item in texts if item.constraint not in time_verdicts]
    if open_texts and not is_verbose:
        names = [requirement.name.rpartition("::")[2] for requirement in open_texts]
        shown = ", ".join(names[:_MAX_NAMES]) + (", ..." if len(names) > _MAX_NAMES else "")
        yield f"{count(len(names), 'requirement')} not formalised: {shown}"


def list_verdicts(
    requirements: "Sequence[StatedRequirement]",
    results: "Iterable[CheckedContract]",
    time_verdicts: "Mapping[str, LimitVerdict]",
) -> list[dict[str, object]]:
    """Return an entry for each conjunct of each requirement, in the order of the model.

    A requirement that is only text may state a time that the recipe decides.
    """
    verdicts: dict[tuple[str, str], list[RequirementVerdict]] = {}
    for result in results:
        for verdict in result.requirements:
            key = result.verdict.component, verdict.conjunct.origin
            verdicts.setdefault(key, []).append(verdict)
    return [
        entry
        for requirement in requirements
        for entry in _list_entries(
            requirement,
            verdicts.get((requirement.component, requirement.constraint), ()),
            time_verdicts.get(requirement.constraint),
        )
    ]


def list_behaviours(results: "Iterable[CheckedContract]") -> list[dict[str, object]]:
    """Return an entry for each behaviour that was checked against requirements."""
    from sysmlc.logic.components.places import PlaceKind

    return [
        {
            "component": result.verdict.component,
            "unreachable": result.findings.list_unreachable(PlaceKind.ACTIVITY),
            "never_taken": result.findings.list_unreachable(PlaceKind.TRANSITION),
            "never_accepted": result.findings.list_unreachable(PlaceKind.EVENT),
            "never_true": result.findings.list_unreachable(PlaceKind.GUARD),
            "never_changed": result.findings.list_unreachable(PlaceKind.FEATURE),
            "write_conflicts": list(result.findings.conflicts),
            "assumed_ranges": list(result.findings.assumed_ranges),
        }
        for result in results
        if result.findings is not None
    ]


def _list_entries(
    requirement: "StatedRequirement",
    verdicts: "Sequence[RequirementVerdict]",
    decided: "LimitVerdict | None",
) -> Iterator[dict[str, object]]:
    from sysmlc.synthesis.witnesses import export_run, print_temporal

    for verdict in verdicts:
        trace = verdict.trace
        yield {
            "requirement": requirement.name,
            "component": requirement.component,
            "formula": print_temporal(verdict.conjunct),
            "verdict": str(verdict.answer),
            "vacuous": bool(verdict.vacuity),
            "needs": [ending.text for ending in verdict.needed],
            "witness": trace and export_run(trace),
            "reason": verdict.reason or verdict.vacuity or None,
            "assumed_ranges": list(verdict.basis.ranges),
            "unread_conditions": list(verdict.basis.conditions),
        }
    if not verdicts:
        reason = requirement.reason or _NO_BEHAVIOUR.format(component=requirement.component)
        yield {
            "requirement": requirement.name,
            "component": requirement.component or None,
            "formula": requirement.text,
            "verdict": decided.verdict if decided else "not-decided",
            "vacuous": False,
            "needs": [],
            "witness": None,
            "reason": f"{reason}; the recipe decides it: {decided.reason}" if decided else reason,
            "assumed_ranges": [],
            "unread_conditions": [],
        }
