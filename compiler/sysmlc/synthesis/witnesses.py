"""Runs for people: what changes in each step, as lines and as a sequence diagram in PlantUML."""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence

from msgspec import Struct

from sysmlc.diagnostics import Rule, Sink, Subject
from sysmlc.logic import formula as f
from sysmlc.logic.contract import Class, Conjunct, Contract, Owner
from sysmlc.logic.formula import Literal
from sysmlc.logic.printing import print_formula, print_literal
from sysmlc.support.file_names import assign_file_names
from sysmlc.support.plantuml_text import label, plain
from sysmlc.synthesis.algebra.refinement import Failure
from sysmlc.synthesis.algebra.traces import Trace
from sysmlc.synthesis.bdd.manager import Manager
from sysmlc.synthesis.decision import Options
from sysmlc.synthesis.games.game import OutsideGr1Error

_MAX_SHOWN_STEPS = 12
"""Steps of a run that a message shows."""
_ENVIRONMENT = "environment"

Values = Mapping[str, Literal]


class Party(Struct, frozen=True):
    """Who acts in a run: a name, and the contract that says what it decides."""

    name: str
    contract: Contract


class Witness(Struct, frozen=True):
    """A run in which a conjunct, which ``component`` relies on or should keep, is broken."""

    component: str
    broken: Conjunct
    trace: Trace
    parties: tuple[Party, ...]


def iter_changes(trace: Trace) -> Iterator[Values]:
    """What has other values in a step than in the one before; in the first one, everything."""
    before: Values = {}
    for values in trace.steps:
        yield {name: value for name, value in values.items() if before.get(name) != value}
        before = values


def describe_run(trace: Trace, broken: Conjunct | None = None) -> Iterator[str]:
    """The steps of a run, a line each, with what has changed.

    Where ``broken`` is given, other variables that never change are not told.
    """
    hidden = _constant_variables(trace, broken) if broken else set()
    for number, changed in enumerate(iter_changes(trace), 1):
        if number > _MAX_SHOWN_STEPS:
            yield f"and {len(trace.steps) - _MAX_SHOWN_STEPS} more"
            break
        told = [name for name in changed if name not in hidden]
        yield f"step {number}: {_print_values(changed, told) or 'nothing changes'}"
    is_ended = trace.loop == len(trace.steps)
    yield "then there is no answer" if is_ended else f"then again from step {trace.loop + 1}"


def _constant_variables(trace: Trace, broken: Conjunct) -> set[str]:
    """The variables that keep their value through the run and are not spoken of."""
    moving = {name for changed in list(iter_changes(trace))[1:] for name in changed}
    said = {one.name for one in f.variables(broken.formula)}
    return set(trace.steps[0]) - moving - said


def witness_files(witnesses: Iterable[Witness]) -> Iterator[tuple[str, str]]:
    """Name and text of a diagram for each run, numbered within its component."""
    found: dict[str, list[Witness]] = {}
    for one in witnesses:
        found.setdefault(one.component, []).append(one)
    for component, name in assign_file_names(found).items():
        for number, one in enumerate(found[component], 1):
            yield f"{name}.run{number}.puml", witness_diagram(one)


def witness_diagram(witness: Witness) -> str:
    """The run as a sequence diagram, with what is broken as its title."""
    broken = label(print_temporal(witness.broken))
    title = f"{label(witness.component)}\\nnot kept: {broken}"
    hidden = _constant_variables(witness.trace, witness.broken)
    steps = tuple(
        {name: value for name, value in values.items() if name not in hidden}
        for values in witness.trace.steps
    )
    return run_diagram(title, Trace(steps, witness.trace.loop), witness.parties)


def run_diagram(title: str, trace: Trace, parties: Sequence[Party]) -> str:
    """A run as a sequence diagram: inputs are messages, what nobody reads is an invariant."""
    head = [
        "@startuml",
        f"title {title}",
        "hide footbox",
        f"participant {_ENVIRONMENT} as p0",
        *(f'participant "{plain(one.name)}" as p{at}' for at, one in enumerate(parties, 1)),
    ]
    contracts = [one.contract for one in parties]
    return "\n".join((*head, *_diagram_steps(trace, contracts), "@enduml", ""))


_TEMPORAL_PREFIXES = {Class.INIT: "", Class.SAFETY: "G ", Class.LIVENESS: "G F ", Class.OTHER: ""}


def print_temporal(conjunct: Conjunct) -> str:
    """The conjunct with the temporal operators that its class implies."""
    formula, operators = print_formula(conjunct.formula), _TEMPORAL_PREFIXES[conjunct.class_]
    return f"{operators}({formula})" if operators else formula


def _diagram_steps(trace: Trace, contracts: Sequence[Contract]) -> Iterator[str]:
    for number, changed in enumerate(iter_changes(trace)):
        if number == trace.loop:
            yield "group again and again"
        yield f"== step {number + 1} =="
        yield from _diagram_messages(changed, contracts)
    is_ended = trace.loop == len(trace.steps)
    yield "note over p1 : no answer is left" if is_ended else "end"


def _diagram_messages(changed: Values, contracts: Sequence[Contract]) -> Iterator[str]:
    """Who tells whom what, in one step."""
    told: dict[tuple[int, int], list[str]] = {}
    for name in changed:
        sender = _find_sender(name, contracts)
        for receiver in _find_receivers(name, contracts) or [sender]:
            told.setdefault((sender, receiver), []).append(name)
    for (sender, receiver), names in sorted(told.items()):
        said = _print_values(changed, names)
        if sender == receiver:
            yield f"hnote over p{sender} : {label(said)}"
        else:
            yield f"p{sender} -> p{receiver} : {label(said)}"


def _find_sender(name: str, contracts: Sequence[Contract]) -> int:
    """Place of who decides the variable; 0 is the environment."""
    return next(iter(_find_parties(name, contracts, Owner.SYSTEM)), 0)


def _find_receivers(name: str, contracts: Sequence[Contract]) -> list[int]:
    return list(_find_parties(name, contracts, Owner.ENVIRONMENT))


def _find_parties(name: str, contracts: Sequence[Contract], owner: Owner) -> Iterator[int]:
    for place, contract in enumerate(contracts, 1):
        if any(one.name == name and one.owner is owner for one in contract.variables):
            yield place


def _print_values(values: Values, names: Iterable[str]) -> str:
    return ", ".join(f"{name}={print_literal(values[name])}" for name in names)


def manager_factory(options: Options) -> Callable[[], Manager]:
    """A manager within the limits for each question."""
    return lambda: Manager(options.engine, options.limits, options.progress)


def describe_problem(problem: Exception) -> str:
    """Why something was not decided, with the formula that stands in the way."""
    if isinstance(problem, OutsideGr1Error):
        return f"'{print_formula(problem.conjunct.formula)}': {problem}"
    return str(problem)


def text_in_parentheses(conjunct: Conjunct) -> str:
    """What a conjunct says in words, in brackets."""
    return f" ({conjunct.text.removesuffix('.')})" if conjunct.text else ""


def report_failure(
    rule: Rule,
    failure: Failure,
    component: str,
    subject: Subject,
    sink: Sink,
    notes: tuple[str, ...] = (),
) -> None:
    """Report a conjunct that is not kept, with the run that shows it, then what else is noted."""
    conjunct = failure.conjunct
    sink.report(
        rule,
        subject,
        notes=(*describe_run(failure.trace, conjunct), *notes),
        component=component,
        formula=print_formula(conjunct.formula),
        said=text_in_parentheses(conjunct),
    )
