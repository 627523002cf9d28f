"""Decide whether a recorded run of a component satisfies its contract."""

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.controllers.monitor import Monitor, Violation, build_monitor, find_first_violation
from sysmlc.diagnostics import Place as FilePlace
from sysmlc.diagnostics import Sink, Subject
from sysmlc.diagnostics.diagnostic import format_position
from sysmlc.logic.contract import Contract, Owner
from sysmlc.logic.formats import rules
from sysmlc.logic.formats.recorded_runs import read_run
from sysmlc.logic.formula import rename_variables
from sysmlc.sources import Source
from sysmlc.support.counts import count
from sysmlc.synthesis.decision import Place
from sysmlc.synthesis.witnesses import print_temporal


class RunVerdict(Struct, frozen=True):
    """Whether a recorded run satisfies a contract, as far as its variables can show."""

    component: str
    file: str
    steps: int
    """Number of steps in the run."""
    checks: int
    """Number of checks of single steps that the contract gives."""
    skipped: int
    """Number of checks that read variables which the run does not contain."""
    violation: Violation | None = None
    """The first step that breaks a check."""

    @property
    def is_checked(self) -> bool:
        """Whether at least one check could be made."""
        return self.skipped < self.checks

    def text(self) -> str:
        """Return the verdict in one line."""
        if not self.is_checked:
            reason = (
                f"each check needs variables without values in '{self.file}'"
                if self.skipped
                else "no finite run breaks this contract"
            )
            return f"{self.component}: nothing was checked: {reason}"
        if self.violation is None:
            skipping = f"; {self.skipped} of {count(self.checks, 'check')} skipped"
            rest = skipping if self.skipped else ""
            return f"{self.component}: {count(self.steps, 'step')}, no check is broken{rest}"
        culprit = (
            "the environment breaks an assumption"
            if self.violation.check.owner is Owner.ENVIRONMENT
            else "it breaks a guarantee"
        )
        return f"{self.component}: {culprit} in step {self.violation.step + 1}"


def accept_run(contract: Contract, source: Source, place: Place, sink: Sink) -> RunVerdict | None:
    """Return the verdict on a recorded run, in CSV or JSON; None if the run cannot be read.

    Faults of the file, variables that it lacks, and the first violation are reported.
    """
    monitor = build_monitor(contract)
    run = read_run(source, monitor.contract, sink)
    if run is None:
        return None
    skipped = sum(
        not run.missing.isdisjoint(monitor.find_needed_variables(check.conjunct.formula))
        for check in monitor.checks
    )
    if skipped:
        _report_missing_variables(monitor, run.missing_columns, skipped, source.name, place, sink)
    violation = None
    if skipped < len(monitor.checks):
        violation = find_first_violation(monitor, run.steps, run.missing)
    if violation is not None:
        step = FilePlace(source.name, line=run.lines[violation.step], column=1)
        _report_violation(contract, violation, step, place, sink)
    return RunVerdict(
        contract.component, source.name, len(run.steps), len(monitor.checks), skipped, violation
    )


def _report_missing_variables(
    monitor: Monitor, missing: frozenset[str], skipped: int, file: str, place: Place, sink: Sink
) -> None:
    sink.report(
        rules.VARIABLES_NOT_RECORDED,
        place(monitor.contract.origin),
        file=file,
        names=", ".join(f"'{variable}'" for variable in sorted(missing)),
        skipped=skipped,
        total=count(len(monitor.checks), "check"),
        component=monitor.contract.component,
    )


def _report_violation(
    contract: Contract, violation: Violation, step: FilePlace, place: Place, sink: Sink
) -> None:
    """Report a violation about the element from which the broken conjunct is derived.

    The contract of a file has no elements; then the subject is the *step* in the recorded run.
    """
    conjunct = violation.check.conjunct
    formula = rename_variables(conjunct.formula, contract.wordings)
    conjunct = replace(conjunct, formula=formula)
    subject = place(conjunct.origin or contract.origin)
    is_assumption = violation.check.owner is Owner.ENVIRONMENT
    sink.report(
        rules.ASSUMPTION_BROKEN_BY_RUN if is_assumption else rules.GUARANTEE_BROKEN_BY_RUN,
        subject if subject.place else Subject(contract.component, place=step),
        step=violation.step + 1,
        location=format_position(step.file, step.line, 0),
        component=contract.component,
        text=conjunct.text or print_temporal(conjunct),
        formula=print_temporal(conjunct),
    )
