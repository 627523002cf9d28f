"""One way through a reaction of a state machine: what it changes, and when it is taken."""

from collections.abc import Iterator, Mapping

from msgspec import Struct, field
from msgspec.structs import replace

from sysmlc.logic import formula as f
from sysmlc.logic.contract import IntegerDomain
from sysmlc.logic.formula import Const, Formula, Op
from sysmlc.logic.machines.machine import INACTIVE
from sysmlc.logic.simplify import rebuild


class TooManyPaths(Exception):  # noqa: N818 - a limit, not a fault
    """A transition has more paths than a contract should show."""


LIMIT = 200
"""Most paths of one transition."""


class Path(Struct, frozen=True):
    """One way through a reaction; ``branch`` and ``case`` together say when it is taken.

    ``branch`` comes from guards (without one that is true the transition is not enabled),
    ``case`` from distinctions that are always decided. ``saturated`` names the assignments
    whose value stopped at a bound.
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


def when(path: Path, case: Formula) -> Path:
    """The path in one case of what is always decided."""
    return replace(path, case=f.both(path.case, case))


def without(path: Path, state: str) -> Path:
    """The path when a state was left."""
    opened = tuple(one for one in path.opened if one != state)
    return replace(path, left=(*path.left, state), opened=opened)


def with_region(path: Path, variable: str, literal: str, inner: list[str]) -> Path:
    """The path with a region in a state; ``inner`` regions become inactive."""
    changed = {**dict.fromkeys(inner, INACTIVE), variable: literal}
    return replace(path, config={**path.config, **changed}, entered={**path.entered, **changed})


def saturated(
    case: Formula, value: Formula, domain: IntegerDomain, spread: IntegerDomain
) -> Iterator[tuple[Formula, Formula, bool]]:
    """The values that an assignment gives within a range, each with its condition, and whether it
    stopped at a bound.
    """
    low, high = Const(domain.low), Const(domain.high)
    inside = case
    if spread.high > domain.high:
        inside = f.both(inside, rebuild(Op.LE, (value, high)))
        yield f.both(case, rebuild(Op.GT, (value, high))), high, True
    if spread.low < domain.low:
        inside = f.both(inside, rebuild(Op.GE, (value, low)))
        yield f.both(case, rebuild(Op.LT, (value, low))), low, True
    yield inside, value, False


def check_number(paths: list[Path]) -> None:
    """Raises TooManyPaths when there are more than a contract should show."""
    if len(paths) > LIMIT:
        raise TooManyPaths
