"""Checks of blocks with parts: whether the parts fit together, and keep what the block promises."""

from collections.abc import Iterable, Iterator

from msgspec import Struct

from sysmlc.diagnostics import Sink
from sysmlc.logic.contract import Composite, Conjunct
from sysmlc.logic.printing import print_formula
from sysmlc.synthesis.algebra.apart import apart, is_joined
from sysmlc.synthesis.algebra.composition import Composition, DriverError, composition
from sysmlc.synthesis.algebra.discharge import Open
from sysmlc.synthesis.algebra.systems import DomainError
from sysmlc.synthesis.algebra.traces import Trace
from sysmlc.synthesis.bdd.limits import LimitError
from sysmlc.synthesis.decide import Options, Place
from sysmlc.synthesis.games.game import OutsideGr1Error
from sysmlc.synthesis.together_rules import BREAK, CIRCLE, CONTRADICT, LOST, NOT_COMPOSED, OPEN
from sysmlc.synthesis.told import new_manager, report_failure, said, why_not
from sysmlc.synthesis.witness import Party, Witness, lines


class Together(Struct, frozen=True):
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


def check_together(
    composites: Iterable[Composite], place: Place, sink: Sink, options: Options
) -> Iterator[Together]:
    """Compose the parts of each block; what is open and what is broken is reported."""
    for one in composites:
        found = [(group, _composed(group, place, sink, options)) for group in _questions(one)]
        made = [(group, each) for group, each in found if each is not None]
        is_broken = any(each.open or each.failures or each.conflict for _, each in made)
        kept = None if len(made) < len(found) and not is_broken else not is_broken
        witnesses = tuple(w for group, each in made for w in _witnesses(group, each))
        has_whole, joined = one.whole is not None, is_joined(one)
        yield Together(one.component, len(one.parts), has_whole, joined, kept, witnesses)


def _questions(composite: Composite) -> list[Composite]:
    """What has to be composed: a part alone fits, where the block promises nothing."""
    groups = apart(composite)
    return [one for one in groups if len(one.parts) > 1 or one.whole is not None]


def _composed(
    composite: Composite, place: Place, sink: Sink, options: Options
) -> Composition | None:
    try:
        found = composition(composite, new_manager(options)())
    except (OutsideGr1Error, DomainError, DriverError, LimitError) as problem:
        subject, reason = place(composite.origin), why_not(problem)
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
        f"{names.get(one, composite.component)}: '{print_formula(one.formula)}'{said(one)}"
        for one in found.conflict
    )
    subject = place(composite.origin)
    sink.report(CONTRADICT, subject, notes=tuple(notes), component=composite.component)


def _report_open(composite: Composite, one: Open, place: Place, sink: Sink) -> None:
    sink.report(
        CIRCLE if one.is_circular else OPEN,
        place(one.conjunct.origin or one.part.origin),
        notes=() if one.trace is None else tuple(lines(one.trace, one.conjunct)),
        part=one.part.name,
        component=composite.component,
        formula=print_formula(one.conjunct.formula),
        said=said(one.conjunct),
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
