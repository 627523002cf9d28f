"""A symbolic path of a transition: its case, its values and the states it leaves and enters."""

from collections.abc import Iterator, Mapping

from msgspec import Struct, field
from msgspec.structs import replace

from sysmlc.logic import formula as f
from sysmlc.logic.contract import IntegerDomain
from sysmlc.logic.formula import Const, Formula, Op
from sysmlc.logic.machines.machine import (
    INACTIVE,
)
from sysmlc.logic.simplify import rebuild


class TooManyPathsError(Exception):
    """A transition has more paths than a readable contract can show."""


MAX_PATHS = 200
"""Most paths of one transition."""


class Path(Struct, frozen=True):
    """One path through a reaction, taken when both ``branch`` and ``case`` hold.

    ``branch`` comes from guards: if no branch is true, the transition is not enabled. ``case``
    comes from distinctions of which exactly one always holds. ``saturated`` lists the assignments
    whose value was clamped to a bound, as pairs of variable and origin.
    """

    branch: Formula = f.TRUE
    case: Formula = f.TRUE
    values: Mapping[str, Formula] = field(default_factory=dict)
    seen: Mapping[str, Formula] = field(default_factory=dict)
    """The values that guards read: those before the transition, or at the last choice."""
    config: Mapping[str, str] = field(default_factory=dict)
    """Literal of each region whose state is known."""
    entered: Mapping[str, str] = field(default_factory=dict)
    """Literals of the regions that the path changes."""
    raised: tuple[str, ...] = ()
    picked: Mapping[str, str] = field(default_factory=dict)
    left: tuple[str, ...] = ()
    saturated: tuple[tuple[str, str], ...] = ()
    """(variable, origin) of each."""
    before: Mapping[str, str] | None = None
    """Literals of regions that are known before the reaction; None at the start of the machine."""
    opened: tuple[str, ...] = ()
    """States that were entered and may have regions that nothing has started yet."""

    @property
    def when(self) -> Formula:
        """The condition under which the path is taken."""
        return f.both(self.branch, self.case)


def add_case(path: Path, case: Formula) -> Path:
    """Return the path restricted to *case*."""
    return replace(path, case=f.both(path.case, case))


def leave_state(path: Path, state: str) -> Path:
    """Return the path after leaving *state*."""
    opened = tuple(id for id in path.opened if id != state)
    return replace(path, left=(*path.left, state), opened=opened)


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
