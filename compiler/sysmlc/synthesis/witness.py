"""Runs for people: what changes in each step, as lines and as a sequence diagram in PlantUML."""

from collections.abc import Iterable, Iterator, Mapping, Sequence

from sysmlc.logic.contract import Class, Conjunct, Contract, Owner
from sysmlc.logic.formula import Literal
from sysmlc.logic.printing import print_formula, print_literal
from sysmlc.naming import file_names
from sysmlc.plantuml import label, plain
from sysmlc.synthesis.algebra.traces import Trace
from sysmlc.values import dataclass

_SHOWN = 12
"""Steps of a run that a message shows."""
_ENVIRONMENT = "environment"

Values = Mapping[str, Literal]
Parties = tuple[tuple[str, Contract], ...]
"""Names of those who act, with the contracts that say what each of them decides."""


@dataclass(frozen=True, slots=True)
class Witness:
    """A run in which a conjunct, which ``component`` relies on or should keep, is broken."""

    component: str
    broken: Conjunct
    trace: Trace
    parties: Parties


def changes(trace: Trace) -> Iterator[Values]:
    """What has other values in a step than in the one before; in the first one, everything."""
    before: Values = {}
    for values in trace.steps:
        yield {name: value for name, value in values.items() if before.get(name) != value}
        before = values


def lines(trace: Trace) -> Iterator[str]:
    """The steps of a run, a line each, with what has changed."""
    for number, changed in enumerate(changes(trace), 1):
        if number > _SHOWN:
            yield f"and {len(trace.steps) - _SHOWN} more"
            break
        yield f"step {number}: {_pairs(changed, changed) or 'nothing changes'}"
    yield f"then again from step {trace.loop + 1}"


def files(witnesses: Iterable[Witness]) -> Iterator[tuple[str, str]]:
    """Name and text of a diagram for each run, numbered within its component."""
    found: dict[str, list[Witness]] = {}
    for one in witnesses:
        found.setdefault(one.component, []).append(one)
    for component, name in file_names(found).items():
        for number, one in enumerate(found[component], 1):
            yield f"{name}.run{number}.puml", diagram(one)


def diagram(witness: Witness) -> str:
    """The run as a sequence diagram: inputs are messages, what nobody reads is an invariant."""
    parties = witness.parties
    head = [
        "@startuml",
        f"title {label(witness.component)}\\nnot kept: {label(_formula(witness.broken))}",
        "hide footbox",
        f"participant {_ENVIRONMENT} as p0",
        *(f'participant "{plain(name)}" as p{at}' for at, (name, _) in enumerate(parties, 1)),
    ]
    return "\n".join((*head, *_steps(witness), "@enduml", ""))


_ALWAYS = {Class.INIT: "", Class.SAFETY: "G ", Class.LIVENESS: "G F ", Class.OTHER: ""}


def _formula(conjunct: Conjunct) -> str:
    """The conjunct with the temporal operators that its class implies."""
    formula, operators = print_formula(conjunct.formula), _ALWAYS[conjunct.class_]
    return f"{operators}({formula})" if operators else formula


def _steps(witness: Witness) -> Iterator[str]:
    loop = witness.trace.loop
    for number, changed in enumerate(changes(witness.trace)):
        if number == loop:
            yield "group again and again"
        yield f"== step {number + 1} =="
        yield from _told(changed, [contract for _, contract in witness.parties])
    yield "end"


def _told(changed: Values, contracts: Sequence[Contract]) -> Iterator[str]:
    """Who tells whom what, in one step."""
    told: dict[tuple[int, int], list[str]] = {}
    for name in changed:
        sender = _sender(name, contracts)
        for receiver in _readers(name, contracts) or [sender]:
            told.setdefault((sender, receiver), []).append(name)
    for (sender, receiver), names in sorted(told.items()):
        said = _pairs(changed, names)
        if sender == receiver:
            yield f"hnote over p{sender} : {label(said)}"
        else:
            yield f"p{sender} -> p{receiver} : {label(said)}"


def _sender(name: str, contracts: Sequence[Contract]) -> int:
    """Place of who decides the variable; 0 is the environment."""
    return next(iter(_places(name, contracts, Owner.SYSTEM)), 0)


def _readers(name: str, contracts: Sequence[Contract]) -> list[int]:
    return list(_places(name, contracts, Owner.ENVIRONMENT))


def _places(name: str, contracts: Sequence[Contract], owner: Owner) -> Iterator[int]:
    for place, contract in enumerate(contracts, 1):
        if any(one.name == name and one.owner is owner for one in contract.variables):
            yield place


def _pairs(values: Values, names: Iterable[str]) -> str:
    return ", ".join(f"{name}={print_literal(values[name])}" for name in names)
