"""A symbolic path of a transition: its condition, its values, and the states left and entered."""

from collections.abc import Iterator, Mapping

from msgspec import Struct, field
from msgspec.structs import replace

from sysmlc.logic import formula as f
from sysmlc.logic.contract import IntegerDomain
from sysmlc.logic.formula import Const, Formula, Op
from sysmlc.logic.machines.machine import (
    INACTIVE,
)
from sysmlc.logic.simplification import rebuild


class TooManyPathsError(Exception):
    """A transition has more paths than a readable contract can show."""


MAX_PATHS = 200
"""The largest number of paths of one transition, and of transitions on one path."""


class Path(Struct, frozen=True):
    """One path through a reaction, taken when both ``branch`` and ``case`` hold.

    ``branch`` is the conjunction of guards: if it is false on every path, the transition is not
    enabled. ``case`` is one of several cases that cover everything and exclude one another, such as
    the active inner state. ``saturated`` lists the assignments whose value was clamped to a bound.
    """

    branch: Formula = f.TRUE
    case: Formula = f.TRUE
    values: Mapping[str, Formula] = field(default_factory=dict)
    late: Mapping[str, Formula] = field(default_factory=dict)
    """The values of properties that do behaviours may assign in the step, after they have."""
    guard_values: Mapping[str, Formula] = field(default_factory=dict)
    """The values that guards read: those before the transition, or at the last choice vertex.

    The guard of a completion transition reads the late values if the do behaviour has just ended.
    """
    config: Mapping[str, str] = field(default_factory=dict)
    """The literal of each region variable that is known at this point of the path."""
    entered: Mapping[str, str] = field(default_factory=dict)
    """The literals of the regions that the path changes."""
    raised: tuple[str, ...] = ()
    picked: Mapping[str, str] = field(default_factory=dict)
    passed: tuple[str, ...] = ()
    """Ids of the transitions on the path, those behind pseudostates included."""
    left_states: tuple[str, ...] = ()
    saturated: tuple[tuple[str, str], ...] = ()
    """The variable and the origin of each clamped assignment."""
    before: Mapping[str, str] | None = None
    """The literals of regions known before the reaction; None at the start of the machine."""
    opened: tuple[str, ...] = ()
    """Entered states, outermost first; some of their regions may not have started yet."""

    @property
    def when(self) -> Formula:
        """The condition under which the path is taken."""
        return f.both(self.branch, self.case)

    @property
    def current(self) -> Mapping[str, Formula]:
        """The values that effects read, and guards behind a choice."""
        return {**self.late, **self.values}


def add_case(path: Path, case: Formula) -> Path:
    """Return the path restricted to *case*."""
    return replace(path, case=f.both(path.case, case))


def leave_state(path: Path, state: str) -> Path:
    """Return the path after leaving *state*."""
    opened = tuple(id for id in path.opened if id != state)
    return replace(path, left_states=(*path.left_states, state), opened=opened)


def set_region(path: Path, variable: str, literal: str, inner: list[str]) -> Path:
    """Return the path with *variable* set to *literal* and the *inner* regions inactive."""
    literals = {**dict.fromkeys(inner, INACTIVE), variable: literal}
    return replace(path, config={**path.config, **literals}, entered={**path.entered, **literals})


def split_by_range(
    case: Formula, value: Formula, domain: IntegerDomain, value_range: IntegerDomain
) -> Iterator[tuple[Formula, Formula, bool]]:
    """Yield the results of assigning *value* to a variable of *domain*, clamped to its range.

    Each result is the condition, the value, and whether the value was clamped. *value_range* is
    the range of the expression.
    """
    low, high = Const(domain.low), Const(domain.high)
    in_range = case
    if value_range.high > domain.high:
        in_range = f.both(in_range, rebuild(Op.LE, (value, high)))
        yield f.both(case, rebuild(Op.GT, (value, high))), high, True
    if value_range.low < domain.low:
        in_range = f.both(in_range, rebuild(Op.GE, (value, low)))
        yield f.both(case, rebuild(Op.LT, (value, low))), low, True
    yield in_range, value, False


def check_path_count(paths: list[Path]) -> None:
    """Raise TooManyPathsError if the list is longer than ``MAX_PATHS``."""
    if len(paths) > MAX_PATHS:
        raise TooManyPathsError
