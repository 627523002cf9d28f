"""Symbolic execution of the transitions of a state machine.

A transition has several paths if it leads through choices, leaves inner states with different exit
behaviours, or assigns values that may saturate. The values of a path are formulas over the previous
step. Paths are executed transition by transition (decision 27).
"""

from collections.abc import Iterator, Mapping

from msgspec import Struct, field
from msgspec.structs import replace

from sysmlc.logic import formula as f
from sysmlc.logic.contract import Domain, IntegerDomain
from sysmlc.logic.expressions.elaboration import elaborate_condition, elaborate_value
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
from sysmlc.logic.simplification import is_satisfiable, rebuild, substitute


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


class PathExplorer(Struct, frozen=True):
    """Explores the paths of one machine."""

    machine: Machine
    domains: Mapping[str, Domain]

    def explore_transition(self, first: Transition) -> list[Path]:
        """Return the feasible paths of a transition that leaves a state."""
        configuration = self._known_configuration(first.sources)
        late = {name: f.var(variable) for name, variable in self.machine.late.items()}
        start = Path(config=configuration, before=configuration, late=late)
        paths = [
            after
            for path in self._split_by_end(start, first)
            for after in self._follow(path, first)
        ]
        return self._drop_infeasible(self._start_open_regions(paths))

    def _split_by_end(self, path: Path, first: Transition) -> list[Path]:
        """Return a path for a completion by the end of a do behaviour, and one for others.

        The end is the completion event (UML 2.5.1, 14.2.3.8.3): the guard sees what was assigned.
        """
        vertices = self.machine.vertices
        names = [vertices[source].ending for source in first.sources]
        ends = f.either(*(f.var(name) for name in names if name))
        if first.occurrences or ends == f.FALSE or not path.late:
            return [path]
        return [
            add_case(replace(path, guard_values=path.late), ends),
            add_case(path, f.negate(ends)),
        ]

    def explore_start(self, values: Mapping[str, Formula]) -> list[Path]:
        """Return the feasible paths into the initial states; properties start with *values*."""
        inactive = {region.variable: INACTIVE for region in self.machine.regions.values()}
        start = Path(values=values, config=inactive)
        paths = self._run_actions(start, self.machine.entry)
        for region in self.machine.top:
            paths = self._start_open_regions(
                [after for path in paths for after in self._start_region(path, region)]
            )
            check_path_count(paths)
        return list(self._drop_infeasible(paths))

    def _known_configuration(self, sources: tuple[str, ...]) -> dict[str, str]:
        """Return the literals of regions that follow from the fact that the sources are active."""
        states = [
            state
            for source in sources
            for state in (source, *self.machine.list_enclosing_states(source))
        ]
        vertices = [self.machine.vertices[state] for state in states]
        return {self.machine.regions[state.region].variable: state.literal for state in vertices}

    def _drop_infeasible(self, paths: list[Path]) -> list[Path]:
        return [path for path in paths if is_satisfiable(path.when, self.domains)]

    # -- along transitions -------------------------------------------------------------------

    def _follow(self, path: Path, transition: Transition) -> list[Path]:
        """Return the paths along a transition and through all pseudostates behind it."""
        # Paths are followed by recursion.
        if len(path.passed) > MAX_PATHS:
            raise TooManyPathsError
        guarded = self._pass_guard(path, transition)
        guarded = replace(guarded, passed=(*path.passed, transition.id))
        region = self.machine.find_main_region(transition)
        is_leaving = region and not self.machine.has_concurrent_exits(transition.source)
        paths = self._leave(guarded, region) if region and is_leaving else [guarded]
        for segment in (transition, *transition.join_partners):
            paths = [after for path in paths for after in self._run_actions(path, segment.effect)]
        if not region:
            return self._drop_infeasible(paths)
        opened = [
            after
            for path in paths
            for after in self._enter_outer_states(path, region, transition.target)
        ]
        arrived = [after for path in opened for after in self._arrive(path, transition.target)]
        check_path_count(arrived)
        return self._drop_infeasible(arrived)

    def _pass_guard(self, path: Path, transition: Transition) -> Path:
        """Return the path on which the guard of the transition is true."""
        source = self.machine.vertices[transition.source]
        # A choice is dynamic (UML 2.5.1, 14.2.3.7): guards behind it read the values reached there.
        if source.kind == "choice":
            path = replace(path, guard_values=path.current)
        if transition.guard is not None:
            truth = substitute(
                elaborate_condition(transition.guard, self.machine.scope), path.guard_values
            )
            path = replace(path, branch=f.both(path.branch, truth))
        if source.pick:
            path = replace(path, picked={**path.picked, source.pick: transition.literal})
        return path

    def _arrive(self, path: Path, id: str) -> list[Path]:
        """Return the paths after the vertex is reached.

        From a pseudostate, they continue along its outgoing transitions.
        """
        vertex, following = self.machine.vertices[id], self.machine.outgoing.get(id, ())
        if vertex.is_stable:
            return self._enter(path, vertex)
        if vertex.kind in HISTORIES:
            return self._restore(path, vertex)
        if not self.machine.has_concurrent_exits(id):
            return [after for transition in following for after in self._follow(path, transition)]
        paths = [path]
        for transition in following:
            paths = [after for branch in paths for after in self._follow(branch, transition)]
        return paths

    # -- effects -----------------------------------------------------------------------------

    def _run_actions(self, path: Path, actions: tuple[Action, ...]) -> list[Path]:
        if not actions:
            return [path]
        paths = [path]
        for action in actions:
            paths = [
                after for path_so_far in paths for after in self._run_action(path_so_far, action)
            ]
            # Infeasible cases are dropped after each action, else they double with each of them.
            paths = self._drop_infeasible(paths)
            check_path_count(paths)
        return paths

    def _run_action(self, path: Path, action: Action) -> list[Path]:
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
            for case, value, is_bound in self._split_assignment(path, action, domain)
        ]

    def _split_assignment(
        self, path: Path, action: Assign, domain: Domain
    ) -> Iterator[tuple[Formula, Formula, bool]]:
        """Yield the cases of an assignment: condition, value, and whether the value was clamped."""
        result = elaborate_value(action.value, self.machine.scope, domain)
        for guarded_case in result.cases:
            case = substitute(guarded_case.condition, path.current)
            value = substitute(guarded_case.value, path.current)
            if isinstance(domain, IntegerDomain) and isinstance(result.domain, IntegerDomain):
                yield from split_by_range(case, value, domain, result.domain)
            else:
                yield case, value, False

    # -- leaving and entering ----------------------------------------------------------------

    def _leave(self, path: Path, region: str) -> list[Path]:
        """Leave the active states of a region.

        A state with an exit behaviour in or below it gets a path of its own; one path covers all
        others.
        """
        variable = self.machine.regions[region].variable
        candidates = self._stable_vertices(region)
        literal = path.config.get(variable)
        if literal is not None:
            candidates = [state for state in candidates if state.literal == literal]
            return self._leave_state(path, region, candidates[0]) if candidates else [path]
        # States without exit behaviours share one path, because leaving them has the same effects.
        busy = [state for state in candidates if self._has_exit_behaviour(state)]
        paths: list[Path] = []
        for state in busy:
            case = f.both(path.case, f.eq(f.var(variable), Const(state.literal)))
            paths += self._leave_state(replace(path, case=case), region, state)
        conditions = [f.compare(Op.NE, f.var(variable), Const(state.literal)) for state in busy]
        other = replace(
            path,
            case=f.both(path.case, *conditions),
            left_states=self._states_left(path, candidates),
        )
        return [*paths, set_region(other, variable, INACTIVE, self._inner_variables(region))]

    def _leave_state(self, path: Path, region: str, state: Vertex) -> list[Path]:
        paths = [path]
        for inner in state.regions:
            paths = [after for inner_path in paths for after in self._leave(inner_path, inner)]
        paths = [
            after for inner_path in paths for after in self._run_actions(inner_path, state.exit)
        ]
        variable = self.machine.regions[region].variable
        return [
            set_region(leave_state(inner_path, state.id), variable, INACTIVE, [])
            for inner_path in paths
        ]

    def _has_exit_behaviour(self, state: Vertex) -> bool:
        """Whether the state, or a state inside it, has an exit behaviour."""
        inner = [
            vertex
            for vertex in self.machine.list_states()
            if self.machine.contains(state.id, vertex.id)
        ]
        return any(vertex.exit for vertex in [state, *inner])

    def _states_left(self, path: Path, states: list[Vertex]) -> tuple[str, ...]:
        """Return the states left so far, with *states* and all states inside them."""
        ids = [
            inner.id
            for state in states
            for inner in self.machine.list_states()
            if inner is state or self.machine.contains(state.id, inner.id)
        ]
        return (*path.left_states, *ids)

    def _inner_variables(self, region: str) -> list[str]:
        """List the variables of the regions below *region*."""
        states = [state.id for state in self.machine.list_states() if state.region == region]
        return [
            inner.variable
            for inner in self.machine.regions.values()
            if inner.state
            and (
                inner.state in states
                or any(self.machine.contains(outer, inner.state) for outer in states)
            )
        ]

    def _enter_outer_states(self, path: Path, region: str, target: str) -> list[Path]:
        """Enter the states in *region* that contain the target, outermost first."""
        paths = [path]
        for id in reversed(self.machine.list_enclosing_states(target)):
            if region in self.machine.list_enclosing_regions(id):
                state = self.machine.vertices[id]
                paths = [
                    after
                    for path_so_far in paths
                    for after in (
                        [path_so_far]
                        if path_so_far.config.get(self.machine.regions[state.region].variable)
                        == state.literal
                        else self._enter(path_so_far, state)
                    )
                ]
        return paths

    def _enter(self, path: Path, state: Vertex) -> list[Path]:
        variable = self.machine.regions[state.region].variable
        entered = set_region(path, variable, state.literal, [])
        if not state.regions:
            return self._run_actions(entered, state.entry)
        inner = {
            self.machine.regions[inner_region].variable: INACTIVE for inner_region in state.regions
        }
        opened = replace(
            entered, opened=(*path.opened, state.id), config={**entered.config, **inner}
        )
        return self._run_actions(opened, state.entry)

    def _start_open_regions(self, paths: list[Path]) -> list[Path]:
        """Start the inactive regions of the entered states, innermost states first."""
        filled: list[Path] = []
        for path in paths:
            region = self._find_open_region(path)
            filled += (
                self._start_open_regions(self._start_region(path, region)) if region else [path]
            )
        return filled

    def _find_open_region(self, path: Path) -> str:
        """Return a region of an entered state that no path has entered, or an empty text."""
        for id in reversed(path.opened):
            for region in self.machine.vertices[id].regions:
                if path.config[self.machine.regions[region].variable] == INACTIVE:
                    return region
        return ""

    def _start_region(self, path: Path, region: str) -> list[Path]:
        """Start a region with its initial transition.

        A region without one is never entered by default (``well_formedness``).
        """
        started = replace(path, guard_values=path.current)
        outgoing = self.machine.outgoing.get(self.machine.regions[region].initial, ())
        return [after for transition in outgoing for after in self._follow(started, transition)]

    # -- history -----------------------------------------------------------------------------

    def _restore(self, path: Path, history: Vertex) -> list[Path]:
        """Enter the state stored for a history pseudostate.

        There is one path for each state that may be stored. On one more path no state is stored: it
        takes the pseudostate's own transition, or starts the region.
        """
        is_deep = history.kind == "deep-history"
        states = [
            vertex for vertex in self._stable_vertices(history.region) if vertex.kind == "state"
        ]
        restored = [
            after
            for state in states
            for case in [self._was_last_active(path, history.region, state)]
            for after in self._reenter(add_case(path, case), state, is_deep)
            if case != f.FALSE
        ]
        # A region that ended in a final state starts again, so that only states are restored.
        conditions = (
            f.negate(self._was_last_active(path, history.region, state)) for state in states
        )
        other = add_case(path, f.both(*conditions))
        following = self.machine.outgoing.get(history.id, ())
        started = [after for vertex in following for after in self._follow(other, vertex)]
        return [*restored, *(started if following else self._start_region(other, history.region))]

    def _stable_vertices(self, region: str) -> list[Vertex]:
        return [v for v in self.machine.vertices.values() if v.region == region and v.is_stable]

    def _was_last_active(self, path: Path, region: str, state: Vertex) -> Formula:
        """Return the condition that the region is in *state*, or was when it was last active."""
        history_region = self.machine.regions[region]
        if path.before is None:
            return f.FALSE
        literal = path.before.get(history_region.variable)
        if literal is not None:
            return f.TRUE if literal == state.literal else f.FALSE
        is_now = f.eq(f.var(history_region.variable), Const(state.literal))
        if not history_region.memory:
            return is_now
        was = f.eq(f.var(history_region.memory), Const(state.literal))
        return f.either(is_now, f.both(f.eq(f.var(history_region.variable), Const(INACTIVE)), was))

    def _reenter(self, path: Path, state: Vertex, is_deep: bool) -> list[Path]:
        """Enter *state* again; deep history restores its inner regions too."""
        paths = self._enter(path, state)
        if is_deep:
            for region in state.regions:
                paths = [
                    after
                    for outer_path in paths
                    for after in self._reenter_region(outer_path, region)
                ]
        return self._drop_infeasible(paths)

    def _reenter_region(self, path: Path, region: str) -> list[Path]:
        cases = [
            (self._was_last_active(path, region, vertex), vertex)
            for vertex in self._stable_vertices(region)
        ]
        restored = [
            after
            for case, state in cases
            for after in self._reenter(add_case(path, case), state, True)
            if case != f.FALSE
        ]
        return [*restored, add_case(path, f.both(*(f.negate(case) for case, _ in cases)))]
