"""Symbolic execution of the transitions of a state machine.

A path is one way that a transition can take through choices, saturation and the inner states
that it leaves; its values are formulas over the step before.
"""

from collections.abc import Iterator, Mapping
from dataclasses import field

from sysmlc.logic import formula as f
from sysmlc.logic.contract import Domain, IntegerDomain
from sysmlc.logic.expressions.elaborate import condition, meaning
from sysmlc.logic.formula import Const, Formula, Op
from sysmlc.logic.machines.machine import (
    INACTIVE,
    Action,
    Assign,
    Machine,
    Raise,
    Transition,
    Vertex,
)
from sysmlc.logic.simplify import is_satisfiable, rebuild, substitute
from sysmlc.values import dataclass, replace


class TooManyPaths(Exception):  # noqa: N818 - a limit, not a fault
    """A transition has more paths than a contract should show."""


LIMIT = 200
"""Most paths of one transition."""


@dataclass(frozen=True, slots=True)
class Path:
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

    @property
    def when(self) -> Formula:
        """The condition under which the path is taken."""
        return f.both(self.branch, self.case)


@dataclass(frozen=True, slots=True)
class Explorer:
    """Finds the paths of one machine."""

    machine: Machine
    domains: Mapping[str, Domain]

    def transition(self, first: Transition) -> list[Path]:
        """The feasible paths of a transition that leaves a state."""
        start = Path(config=self._known(first.source))
        found: list[Path] = []
        for number, trail in enumerate(self.trails(first)):
            found += self._feasible(self._trail(start, first, trail))
            if number >= LIMIT:
                raise TooManyPaths
            _limit(found)
        return found

    def start(self, values: Mapping[str, Formula]) -> list[Path]:
        """The feasible paths into the initial states; ``values`` are the properties' values."""
        paths = [Path(values=values)]
        for region in self.machine.top:
            paths = [after for path in paths for after in self._enter_default(path, region)]
            _limit(paths)
        return list(self._feasible(paths))

    def trails(self, first: Transition) -> Iterator[tuple[Transition, ...]]:
        """The transition continued through pseudostates to states, in every way."""
        if first.kind == "internal" or self.machine.vertices[first.target].is_stable:
            yield (first,)
            return
        for following in self.machine.outgoing[first.target]:
            yield from ((first, *rest) for rest in self.trails(following))

    def _known(self, source: str) -> dict[str, str]:
        inside = [source, *self.machine.above(source)]
        vertices = [self.machine.vertices[one] for one in inside]
        return {self.machine.regions[one.region].variable: one.literal for one in vertices}

    def _feasible(self, paths: list[Path]) -> list[Path]:
        return [path for path in paths if is_satisfiable(path.when, self.domains)]

    def _trail(self, start: Path, first: Transition, trail: tuple[Transition, ...]) -> list[Path]:
        end = trail[-1].target
        region = self.machine.main_region(first.source, end, first.kind)
        paths = self._leave(start, region) if region else [start]
        paths = self._pass_all(paths, trail)
        if not region:
            return paths
        return [after for path in paths for after in self._enter(path, region, end)]

    # -- guards and effects ------------------------------------------------------------------

    def _pass_all(self, paths: list[Path], trail: tuple[Transition, ...]) -> list[Path]:
        for one in trail:
            paths = [after for path in paths for after in self._pass(path, one)]
            _limit(paths)
        return paths

    def _pass(self, path: Path, one: Transition) -> list[Path]:
        source = self.machine.vertices[one.source]
        if source.kind == "choice":
            path = replace(path, seen=path.values)
        if one.guard is not None:
            truth = substitute(condition(one.guard, self.machine.scope), path.seen)
            path = replace(path, branch=f.both(path.branch, truth))
        if source.pick:
            path = replace(path, picked={**path.picked, source.pick: one.literal})
        return self._act(path, one.effect)

    def _act(self, path: Path, actions: tuple[Action, ...]) -> list[Path]:
        paths = [path]
        for action in actions:
            paths = [after for one in paths for after in self._do(one, action)]
        return self._feasible(paths)

    def _do(self, path: Path, action: Action) -> list[Path]:
        if isinstance(action, Raise):
            raised = tuple(dict.fromkeys([*path.raised, action.output]))
            return [replace(path, raised=raised)]
        domain = self.domains[action.variable]
        return [
            replace(
                path,
                case=f.both(path.case, case),
                values={**path.values, action.variable: value},
                saturated=path.saturated + ((action.variable, action.origin),) * is_bound,
            )
            for case, value, is_bound in self._cases(path, action, domain)
        ]

    def _cases(
        self, path: Path, action: Assign, domain: Domain
    ) -> Iterator[tuple[Formula, Formula, bool]]:
        """The values that an assignment can give, each with its condition."""
        found = meaning(action.value, self.machine.scope, domain)
        for term in found.terms:
            case = substitute(term.condition, path.values)
            value = substitute(term.value, path.values)
            if isinstance(domain, IntegerDomain) and isinstance(found.domain, IntegerDomain):
                yield from _saturate(case, value, domain, found.domain)
            else:
                yield case, value, False

    # -- leaving and entering ----------------------------------------------------------------

    def _leave(self, path: Path, region: str) -> list[Path]:
        """Leave what is active in the region: one path for each state that does something."""
        variable = self.machine.regions[region].variable
        inside = [v for v in self.machine.vertices.values() if v.region == region and v.is_stable]
        known = path.config.get(variable)
        if known is not None:
            inside = [one for one in inside if one.literal == known]
            return self._leave_state(path, region, inside[0]) if inside else [path]
        busy = [one for one in inside if self._does_on_exit(one)]
        paths: list[Path] = []
        for one in busy:
            case = f.both(path.case, f.eq(f.var(variable), Const(one.literal)))
            paths += self._leave_state(replace(path, case=case), region, one)
        others = [f.compare(Op.NE, f.var(variable), Const(one.literal)) for one in busy]
        rest = replace(path, case=f.both(path.case, *others), left=self._all_left(path, inside))
        return [*paths, _with_region(rest, variable, INACTIVE, self._inner(region))]

    def _leave_state(self, path: Path, region: str, state: Vertex) -> list[Path]:
        paths = [path]
        for inner in state.regions:
            paths = [after for one in paths for after in self._leave(one, inner)]
        paths = [after for one in paths for after in self._act(one, state.exit)]
        variable = self.machine.regions[region].variable
        return [
            _with_region(replace(one, left=(*one.left, state.id)), variable, INACTIVE, [])
            for one in paths
        ]

    def _does_on_exit(self, state: Vertex) -> bool:
        inside = [one for one in self.machine.states() if self.machine.contains(state.id, one.id)]
        return any(one.exit for one in [state, *inside])

    def _all_left(self, path: Path, states: list[Vertex]) -> tuple[str, ...]:
        inside = [
            one.id
            for state in states
            for one in self.machine.states()
            if one is state or self.machine.contains(state.id, one.id)
        ]
        return (*path.left, *inside)

    def _inner(self, region: str) -> list[str]:
        """Variables of the regions below this one."""
        owners = [one.id for one in self.machine.states() if one.region == region]
        return [
            inner.variable
            for inner in self.machine.regions.values()
            if inner.state
            and (
                inner.state in owners or any(self.machine.contains(o, inner.state) for o in owners)
            )
        ]

    def _enter(self, path: Path, region: str, target: str) -> list[Path]:
        chain = [target, *self.machine.above(target)]
        id = next(one for one in chain if self.machine.vertices[one].region == region)
        state = self.machine.vertices[id]
        entered = _with_region(path, self.machine.regions[region].variable, state.literal, [])
        paths = self._act(entered, state.entry)
        for inner in state.regions:
            holds_target = any(self.machine.vertices[one].region == inner for one in chain)
            paths = [
                after
                for one in paths
                for after in (
                    self._enter(one, inner, target)
                    if holds_target
                    else self._enter_default(one, inner)
                )
            ]
        return paths

    def _enter_default(self, path: Path, region: str) -> list[Path]:
        found: list[Path] = []
        for first in self.machine.outgoing[self.machine.regions[region].initial]:
            for trail in self.trails(first):
                begun = replace(path, seen=path.values)
                for passed in self._pass_all([begun], trail):
                    found += self._enter(passed, region, trail[-1].target)
        return found


def _with_region(path: Path, variable: str, literal: str, inner: list[str]) -> Path:
    """The path with a region in a state; ``inner`` regions become inactive."""
    changed = {**dict.fromkeys(inner, INACTIVE), variable: literal}
    return replace(path, config={**path.config, **changed}, entered={**path.entered, **changed})


def _saturate(
    case: Formula, value: Formula, domain: IntegerDomain, spread: IntegerDomain
) -> Iterator[tuple[Formula, Formula, bool]]:
    low, high = Const(domain.low), Const(domain.high)
    inside = case
    if spread.high > domain.high:
        inside = f.both(inside, rebuild(Op.LE, (value, high)))
        yield f.both(case, rebuild(Op.GT, (value, high))), high, True
    if spread.low < domain.low:
        inside = f.both(inside, rebuild(Op.GE, (value, low)))
        yield f.both(case, rebuild(Op.LT, (value, low))), low, True
    yield inside, value, False


def _limit(paths: list[Path]) -> None:
    if len(paths) > LIMIT:
        raise TooManyPaths
