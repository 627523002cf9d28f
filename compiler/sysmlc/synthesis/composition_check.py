"""Checks of blocks with parts: whether the parts fit together, and keep what the block promises."""

from collections.abc import Iterable, Iterator

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.diagnostics import Sink
from sysmlc.logic import formula as f
from sysmlc.logic.contract import Composite, Conjunct, Contract
from sysmlc.logic.printing import print_formula
from sysmlc.support.disjoint_sets import DisjointSets
from sysmlc.synthesis.algebra.composition import Composition, DriverError, compose_parts
from sysmlc.synthesis.algebra.discharge import OpenAssumption
from sysmlc.synthesis.algebra.fair_systems import DomainError
from sysmlc.synthesis.algebra.traces import Trace
from sysmlc.synthesis.bdd.limits import LimitError
from sysmlc.synthesis.composition_rules import BREAK, CIRCLE, CONTRADICT, LOST, NOT_COMPOSED, OPEN
from sysmlc.synthesis.decision import Options, Place
from sysmlc.synthesis.games.game import OutsideGr1Error
from sysmlc.synthesis.witnesses import (
    Party,
    Witness,
    describe_problem,
    describe_run,
    manager_factory,
    report_failure,
    text_in_parentheses,
)


class CompositionVerdict(Struct, frozen=True):
    """What was found out about a block with parts."""

    component: str
    parts: int
    has_whole: bool
    """Whether the block itself promises something."""
    is_joined: bool
    """Whether any of the parts has to do with another, or with the block."""
    is_kept: bool | None
    """Whether the parts fit together and keep what the block promises; None when undecided."""
    witnesses: tuple[Witness, ...] = ()

    def text(self) -> str:
        """The verdict on one line."""
        return f"{self.component}: {self._verdict()}"

    def _verdict(self) -> str:
        if self.is_kept is None:
            return "its parts are not put together"
        if self.has_whole and self.is_joined:
            verb = "keep" if self.is_kept else "break"
            return f"its {self.parts} parts together {verb} its contract"
        if self.is_kept and not self.is_joined:
            return f"nothing joins its {self.parts} parts"
        return f"its {self.parts} parts {'fit' if self.is_kept else 'do not fit'} together"


def check_compositions(
    composites: Iterable[Composite], place: Place, sink: Sink, options: Options
) -> Iterator[CompositionVerdict]:
    """Compose the parts of each block; what is open and what is broken is reported."""
    for one in composites:
        found = [(group, _compose(group, place, sink, options)) for group in _list_questions(one)]
        made = [(group, each) for group, each in found if each is not None]
        is_broken = any(each.open or each.failures or each.conflict for _, each in made)
        kept = None if len(made) < len(found) and not is_broken else not is_broken
        witnesses = tuple(w for group, each in made for w in _witnesses(group, each))
        has_whole, joined = one.whole is not None, has_shared_variables(one)
        yield CompositionVerdict(one.component, len(one.parts), has_whole, joined, kept, witnesses)


def _list_questions(composite: Composite) -> list[Composite]:
    """What has to be composed: a part alone fits, where the block promises nothing."""
    groups = split_composite(composite)
    return [one for one in groups if len(one.parts) > 1 or one.whole is not None]


def _compose(
    composite: Composite, place: Place, sink: Sink, options: Options
) -> Composition | None:
    try:
        found = compose_parts(composite, manager_factory(options)())
    except (OutsideGr1Error, DomainError, DriverError, LimitError) as problem:
        subject, reason = place(composite.origin), describe_problem(problem)
        sink.report(NOT_COMPOSED, subject, component=composite.component, reason=reason)
        return None
    if found.conflict:
        _report_conflict(composite, found, place, sink)
    for one in found.open:
        _report_open(composite, one, place, sink)
    for failure in found.failures:
        subject = place(failure.conjunct.origin or composite.origin)
        report_failure(BREAK, failure, composite.component, subject, sink, _unreliable(found))
    for loss in found.losses:
        report_failure(LOST, loss, composite.component, place(composite.origin), sink)
    return found


def _unreliable(found: Composition) -> tuple[str, ...]:
    """That runs do not count on parts whose assumptions are open."""
    names = " and ".join(dict.fromkeys(f"'{one.part.name}'" for one in found.open))
    if not names:
        return ()
    return (f"what {names} may promise is not counted on: what it takes for granted is open",)


def _report_conflict(composite: Composite, found: Composition, place: Place, sink: Sink) -> None:
    names = {one: part.name for part in composite.parts for one in part.contract.guarantees}
    notes = (
        f"{names.get(conjunct, composite.component)}: "
        f"'{print_formula(conjunct.formula)}'{text_in_parentheses(conjunct)}"
        for conjunct in found.conflict
    )
    subject = place(composite.origin)
    sink.report(CONTRADICT, subject, notes=tuple(notes), component=composite.component)


def _report_open(composite: Composite, one: OpenAssumption, place: Place, sink: Sink) -> None:
    sink.report(
        CIRCLE if one.is_circular else OPEN,
        place(one.conjunct.origin or one.part.origin),
        notes=() if one.trace is None else tuple(describe_run(one.trace, one.conjunct)),
        part=one.part.name,
        component=composite.component,
        formula=print_formula(one.conjunct.formula),
        said=text_in_parentheses(one.conjunct),
    )


def _witnesses(composite: Composite, found: Composition) -> Iterator[Witness]:
    parties = tuple(Party(one.name, one.contract) for one in composite.parts)
    for one in found.open:
        if one.trace is not None:
            yield _witness(composite, one.conjunct, one.trace, parties)
    for failure in (*found.failures, *found.losses):
        yield _witness(composite, failure.conjunct, failure.trace, parties)


def _witness(
    composite: Composite, broken: Conjunct, trace: Trace, parties: tuple[Party, ...]
) -> Witness:
    return Witness(composite.component, broken, trace, parties)


def split_composite(composite: Composite) -> list[Composite]:
    """The sets of parts that share something, in the order of the first of each.

    The whole is with those that it speaks of; beside the others stands one that promises nothing
    and assumes nothing.
    """
    shared: DisjointSets[str] = DisjointSets()
    for names in _shared_variable_groups(composite):
        for other in names[1:]:
            shared.union(names[0], other)
    groups: dict[str, list[int]] = {}
    for number, part in enumerate(composite.parts):
        first = next((one.name for one in part.contract.variables), f"#{number}")
        groups.setdefault(shared.find(first), []).append(number)
    if composite.whole is not None and composite.whole.variables:
        groups.setdefault(shared.find(composite.whole.variables[0].name), [])
    return [_restrict_composite(composite, group, shared, key) for key, group in groups.items()]


def has_shared_variables(composite: Composite) -> bool:
    """Whether any two of the parts, or a part and the whole, share anything."""
    return any(
        len(one.parts) > 1 or _has_variables(one.whole) for one in split_composite(composite)
    )


def _has_variables(whole: Contract | None) -> bool:
    return whole is not None and bool(whole.variables)


def _shared_variable_groups(composite: Composite) -> Iterator[list[str]]:
    """The variables that each contract and each wire brings together."""
    for part in composite.parts:
        yield [one.name for one in part.contract.variables]
    for wire in composite.wiring:
        yield _variable_names(wire)
    if composite.whole is not None:
        yield [one.name for one in composite.whole.variables]


def _variable_names(conjunct: Conjunct) -> list[str]:
    return list(dict.fromkeys(one.name for one in f.variables(conjunct.formula)))


def _restrict_composite(
    composite: Composite, group: list[int], shared: DisjointSets[str], key: str
) -> Composite:
    def ours(conjuncts: tuple[Conjunct, ...]) -> tuple[Conjunct, ...]:
        return tuple(one for one in conjuncts if shared.find(_variable_names(one)[0]) == key)

    return replace(
        composite,
        parts=tuple(composite.parts[number] for number in group),
        wiring=ours(composite.wiring),
        crowding=ours(composite.crowding),
        whole=_restrict_whole(composite.whole, shared, key),
    )


def _restrict_whole(whole: Contract | None, shared: DisjointSets[str], key: str) -> Contract | None:
    if whole is None or not whole.variables:
        return whole
    if shared.find(whole.variables[0].name) == key:
        return whole
    return replace(whole, variables=(), assumptions=(), guarantees=())
