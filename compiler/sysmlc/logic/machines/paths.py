"""One way through a reaction of a state machine: what it changes, and when it is taken."""

from collections.abc import Iterator, Mapping

from msgspec import Struct, field
from msgspec.structs import replace

from sysmlc.logic import formula as f
from sysmlc.logic.contract import Domain, IntegerDomain
from sysmlc.logic.expressions.elaborate import condition, meaning
from sysmlc.logic.formula import Const, Formula, Op
from sysmlc.logic.machines.machine import (
    HISTORIES,
    INACTIVE,
    Action,
    Assign,
    Machine,
    Raise,
    Transition,
    Vertex,
)
from sysmlc.logic.simplify import is_satisfiable, rebuild, substitute


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


class Explorer(Struct, frozen=True):
    """Finds the paths of one machine."""

    machine: Machine
    domains: Mapping[str, Domain]

    def transition(self, first: Transition) -> list[Path]:
        """The feasible paths of a transition that leaves a state."""
        known = self._known(first.sources)
        found = self._follow(Path(config=known, before=known), first)
        return self._feasible(self._filled(found))

    def start(self, values: Mapping[str, Formula]) -> list[Path]:
        """The feasible paths into the initial states; ``values`` are the properties' values."""
        paths = [Path(values=values, config=self._resting())]
        for region in self.machine.top:
            paths = self._filled([after for path in paths for after in self._begin(path, region)])
            check_number(paths)
        return list(self._feasible(paths))

    def _resting(self) -> dict[str, str]:
        return {region.variable: INACTIVE for region in self.machine.regions.values()}

    def _known(self, sources: tuple[str, ...]) -> dict[str, str]:
        inside = [one for source in sources for one in (source, *self.machine.above(source))]
        vertices = [self.machine.vertices[one] for one in inside]
        return {self.machine.regions[one.region].variable: one.literal for one in vertices}

    def _feasible(self, paths: list[Path]) -> list[Path]:
        return [path for path in paths if is_satisfiable(path.when, self.domains)]

    # -- along transitions -------------------------------------------------------------------

    def _follow(self, path: Path, one: Transition) -> list[Path]:
        """The paths along a transition and all that it leads on to."""
        guarded = self._pass(path, one)
        region = self.machine.main_region(one)
        is_leaving = region and not self.machine.is_split(one.source)
        paths = self._leave(guarded, region) if region and is_leaving else [guarded]
        for each in (one, *one.also):
            paths = [after for path in paths for after in self._act(path, each.effect)]
        if not region:
            return self._feasible(paths)
        opened = [after for path in paths for after in self._open(path, region, one.target)]
        found = [after for path in opened for after in self._arrive(path, one.target)]
        check_number(found)
        return self._feasible(found)

    def _pass(self, path: Path, one: Transition) -> Path:
        """The path when the guard of a transition is true."""
        source = self.machine.vertices[one.source]
        if source.kind == "choice":
            path = replace(path, seen=path.values)
        if one.guard is not None:
            truth = substitute(condition(one.guard, self.machine.scope), path.seen)
            path = replace(path, branch=f.both(path.branch, truth))
        if source.pick:
            path = replace(path, picked={**path.picked, source.pick: one.literal})
        return path

    def _arrive(self, path: Path, id: str) -> list[Path]:
        vertex, following = self.machine.vertices[id], self.machine.outgoing.get(id, ())
        if vertex.is_stable:
            return self._enter(path, vertex)
        if vertex.kind in HISTORIES:
            return self._restore(path, vertex)
        if not self.machine.is_split(id):
            return [after for one in following for after in self._follow(path, one)]
        paths = [path]
        for one in following:
            paths = [after for each in paths for after in self._follow(each, one)]
        return paths

    # -- effects -----------------------------------------------------------------------------

    def _act(self, path: Path, actions: tuple[Action, ...]) -> list[Path]:
        if not actions:
            return [path]
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
                yield from saturated(case, value, domain, found.domain)
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
        return [*paths, with_region(rest, variable, INACTIVE, self._inner(region))]

    def _leave_state(self, path: Path, region: str, state: Vertex) -> list[Path]:
        paths = [path]
        for inner in state.regions:
            paths = [after for one in paths for after in self._leave(one, inner)]
        paths = [after for one in paths for after in self._act(one, state.exit)]
        variable = self.machine.regions[region].variable
        return [with_region(without(one, state.id), variable, INACTIVE, []) for one in paths]

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

    def _open(self, path: Path, region: str, target: str) -> list[Path]:
        """Enter the states of the region that contain the target, outermost first."""
        paths = [path]
        for id in reversed(self.machine.above(target)):
            if region in self.machine.around(id):
                state = self.machine.vertices[id]
                paths = [
                    after
                    for one in paths
                    for after in ([one] if self._is_in(one, state) else self._enter(one, state))
                ]
        return paths

    def _is_in(self, path: Path, state: Vertex) -> bool:
        return path.config.get(self.machine.regions[state.region].variable) == state.literal

    def _enter(self, path: Path, state: Vertex) -> list[Path]:
        variable = self.machine.regions[state.region].variable
        entered = with_region(path, variable, state.literal, [])
        if not state.regions:
            return self._act(entered, state.entry)
        inner = {self.machine.regions[one].variable: INACTIVE for one in state.regions}
        opened = replace(
            entered, opened=(*path.opened, state.id), config={**entered.config, **inner}
        )
        return self._act(opened, state.entry)

    def _filled(self, paths: list[Path]) -> list[Path]:
        """Start the regions of entered states to which no way led, those of inner ones first."""
        found: list[Path] = []
        for path in paths:
            region = self._unfilled(path)
            found += self._filled(self._begin(path, region)) if region else [path]
        return found

    def _unfilled(self, path: Path) -> str:
        for id in reversed(path.opened):
            for region in self.machine.vertices[id].regions:
                if path.config[self.machine.regions[region].variable] == INACTIVE:
                    return region
        return ""

    def _begin(self, path: Path, region: str) -> list[Path]:
        """Start a region with its initial transition."""
        begun = replace(path, seen=path.values)
        outgoing = self.machine.outgoing[self.machine.regions[region].initial]
        return [after for one in outgoing for after in self._follow(begun, one)]

    # -- history -----------------------------------------------------------------------------

    def _restore(self, path: Path, history: Vertex) -> list[Path]:
        """One path for each state that the region may have been in, one for none of them."""
        is_deep = history.kind == "deep-history"
        states = [one for one in self._inside(history.region) if one.kind == "state"]
        found = [
            after
            for state in states
            for case in [self._was(path, history.region, state)]
            for after in self._again(when(path, case), state, is_deep)
            if case != f.FALSE
        ]
        others = (f.negate(self._was(path, history.region, state)) for state in states)
        rest = when(path, f.both(*others))
        following = self.machine.outgoing.get(history.id, ())
        afresh = [after for one in following for after in self._follow(rest, one)]
        return [*found, *(afresh if following else self._begin(rest, history.region))]

    def _inside(self, region: str) -> list[Vertex]:
        return [v for v in self.machine.vertices.values() if v.region == region and v.is_stable]

    def _was(self, path: Path, region: str, state: Vertex) -> Formula:
        """The region is in the state before the reaction, or was when it was last active."""
        one = self.machine.regions[region]
        if path.before is None:
            return f.FALSE
        known = path.before.get(one.variable)
        if known is not None:
            return f.TRUE if known == state.literal else f.FALSE
        is_now = f.eq(f.var(one.variable), Const(state.literal))
        if not one.memory:
            return is_now
        was = f.eq(f.var(one.memory), Const(state.literal))
        return f.either(is_now, f.both(f.eq(f.var(one.variable), Const(INACTIVE)), was))

    def _again(self, path: Path, state: Vertex, is_deep: bool) -> list[Path]:
        paths = self._enter(path, state)
        for region in state.regions if is_deep else ():
            paths = [after for one in paths for after in self._again_in(one, region)]
        return self._feasible(paths)

    def _again_in(self, path: Path, region: str) -> list[Path]:
        cases = [(self._was(path, region, one), one) for one in self._inside(region)]
        found = [
            after
            for case, state in cases
            for after in self._again(when(path, case), state, True)
            if case != f.FALSE
        ]
        return [*found, when(path, f.both(*(f.negate(case) for case, _ in cases)))]
