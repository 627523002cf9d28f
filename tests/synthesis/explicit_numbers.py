"""An explicit checker of machines whose guards compare numbers.

It evaluates conditions with numbers of its own, on a grid, and reads no contract. The comparisons
of a machine meet in multiples of half a unit at most. Therefore a grid that divides this distance
by one more than the number of features has points in all regions (a simplex with corners on a
lattice, enlarged by more than its dimension, contains a point of the lattice).
"""

from collections.abc import Iterable, Iterator, Mapping
from fractions import Fraction
from itertools import product

from msgspec import Struct
from numeric_machines import (
    RESOLUTION,
    Condition,
    Feature,
    InState,
    Literal,
    Machine,
    Move,
    Not,
    Pair,
    Requirement,
    list_literals,
    list_machine_literals,
)

Letter = frozenset[Literal]
"""The literals that are true in a step."""
Values = tuple[tuple[str, int], ...]
MARGIN = 6
"""Units between the largest number of a machine and the largest value of an attribute.

A value beyond is not assigned. Sums that effects assign are smaller, so that this changes no
comparison."""


def is_true(condition: Condition | None, state: str, letter: Letter) -> bool:
    """Whether a condition holds in a state where these literals are true."""
    match condition:
        case Literal():
            return condition in letter
        case InState(name):
            return state == name
        case Not(operand):
            return not is_true(operand, state, letter)
        case Pair(word, left, right):
            sides = is_true(left, state, letter), is_true(right, state, letter)
            return all(sides) if word == "and" else any(sides)
    return True


class Grid:
    """The values at which the literals are evaluated, in parts of a unit."""

    def __init__(self, machine: Machine, literals: Iterable[Literal]) -> None:
        """Prepare a grid for the literals, which include those of the machine."""
        self._machine, self.literals = machine, tuple(literals)
        self._features = {feature.name: feature for feature in machine.features}
        numbers = [literal.bound for literal in self.literals]
        numbers += [feature.value or 0 for feature in machine.features]
        self._widest = max(map(abs, numbers))
        self.limit = (self._widest + MARGIN) * RESOLUTION
        self._groups = self._group_features()
        self._letters: dict[tuple[tuple[str, ...], Values], list[Letter]] = {}

    def _group_features(self) -> list[tuple[str, ...]]:
        """Return the sets of features that literals compare with each other."""
        groups = [frozenset([name]) for name in self._features]
        for literal in self.literals:
            names = {name for name, _ in literal.terms}
            merged = frozenset().union(*(group for group in groups if group & names))
            groups = [merged, *(group for group in groups if not group & names)]
        return sorted(tuple(sorted(group)) for group in groups)

    def list_fixed_values(self) -> Iterator[Values]:
        """Yield the values of constants to be tried."""
        names = [n for n, feature in self._features.items() if feature.is_constant]
        for row in product(*map(self._list_points, names)):
            yield tuple(zip(names, row, strict=True))

    def list_letters(self, fixed: Values) -> list[Letter]:
        """Return the possible letters, given the values of constants and attributes."""
        parts = []
        for group in self._groups:
            key = group, tuple(item for item in fixed if item[0] in group)
            if key not in self._letters:
                self._letters[key] = list(self._find_letters(*key))
            parts.append(self._letters[key])
        return [frozenset[Literal]().union(*row) for row in product(*parts)]

    def _find_letters(self, group: tuple[str, ...], fixed: Values) -> Iterator[Letter]:
        literals = [literal for literal in self.literals if literal.terms[0][0] in group]
        constraints = [
            condition
            for condition in self._machine.constraints
            if set(list_literals([condition])) & set(literals)
        ]
        free = [name for name in group if self._features[name].kind == "input"]
        rows = product(*map(self._list_points, free))
        valuations = (dict((*fixed, *zip(free, row, strict=True))) for row in rows)
        signs = {tuple(literal.is_true(values) for literal in literals) for values in valuations}
        for row in sorted(signs):
            letter = frozenset(literal for literal, sign in zip(literals, row, strict=True) if sign)
            if all(is_true(condition, "", letter) for condition in constraints):
                yield letter

    def _list_points(self, name: str) -> list[int]:
        """Return the values of an input or constant that are tried."""
        feature = self._features[name]
        if feature.value is not None:
            return [feature.value * RESOLUTION]
        (group,) = (group for group in self._groups if name in group)
        members = [self._features[member] for member in group]
        widest = self._widest + any(f.kind == "attribute" for f in members) * MARGIN
        reach = widest * len(group) + 1
        if feature.is_integer:
            step = int(1 / self._machine.unit)
            return [n * step * RESOLUTION for n in range(-reach - 1, reach + 2)]
        step = RESOLUTION // self._count_points(feature, members)
        return list(range(-reach * RESOLUTION, reach * RESOLUTION + 1, step))

    def _count_points(self, feature: Feature, members: list[Feature]) -> int:
        """Return the number of grid points in a unit."""
        names = {member.name for member in members}
        factors = [
            sorted(factor for _, factor in literal.terms)
            for literal in self.literals
            if literal.terms[0][0] in names
        ]
        count = 1 if all(row in ([1], [-1, 1]) for row in factors) else 2
        count *= sum(f.is_constant and not f.is_known for f in members) + 1
        if feature.kind == "input":
            count *= sum(f.kind == "input" for f in members) + 1
        assert RESOLUTION % count == 0
        return count


class Configuration(Struct, frozen=True):
    """The memory of a machine between steps.

    ``remembered`` are the change conditions that were true in the previous step, which did not
    enter the present state.
    """

    state: str
    attributes: Values
    remembered: frozenset[Condition] = frozenset()


class Step(Struct, frozen=True):
    """A step of a run; values are in parts of a unit."""

    state: str
    event: str
    values: Mapping[str, Fraction]


class ExploredMachine:
    """The steps of a machine for all values of its constants."""

    def __init__(self, machine: Machine, requirements: Iterable[Requirement] = ()) -> None:
        """Explore the machine; the letters tell the literals of the requirements, too."""
        conditions = [c for requirement in requirements for c in (requirement.p, requirement.q)]
        literals = dict.fromkeys([*list_machine_literals(machine), *list_literals(conditions)])
        self._machine, self._grid = machine, Grid(machine, literals)
        self.taken: set[Move] = set()
        self.entered: set[str] = set()
        self._graphs: list[Graph] = []
        known = set()
        for fixed in self._grid.list_fixed_values():
            letters = self._grid.list_letters((*fixed, *self._initial.attributes))
            # Constants with the same letters in all steps have the same runs.
            key = frozenset(letters), fixed if self.has_attributes else ()
            if letters and key not in known:
                known.add(key)
                self._graphs.append(self._explore(fixed))

    @property
    def has_runs(self) -> bool:
        """Whether the constraints can be satisfied."""
        return bool(self._graphs)

    @property
    def has_attributes(self) -> bool:
        """Whether transitions assign numbers."""
        return bool(self._initial.attributes)

    @property
    def _initial(self) -> Configuration:
        attributes = tuple(
            (feature.name, (feature.value or 0) * RESOLUTION)
            for feature in self._machine.features
            if feature.kind == "attribute"
        )
        return Configuration(self._machine.states[0], attributes)

    def _explore(self, constants: Values) -> "Graph":
        graph: Graph = {}
        worklist = [self._initial]
        while worklist:
            configuration = worklist.pop()
            if configuration in graph:
                continue
            self.entered.add(configuration.state)
            steps = graph[configuration] = {}
            for letter in self._grid.list_letters((*constants, *configuration.attributes)):
                reactions = list(self._list_reactions(configuration, letter))
                self.taken.update(move for move, _ in reactions if move is not None)
                steps[letter] = {successor for _, successor in reactions}
                worklist += steps[letter]
        return graph

    def _list_reactions(
        self, configuration: Configuration, letter: Letter, *events: str
    ) -> Iterator[tuple[Move | None, Configuration]]:
        """Yield the reactions to each of the events, and the configurations after them.

        Without *events* these are all events, also the absence of an event.
        """
        state = configuration.state
        own = [move for move in self._machine.moves if move.source == state]
        for event in events or {"", *(move.event for move in own)}:
            enabled = [
                move
                for move in own
                if move.event in ("", event)
                and is_true(move.guard, state, letter)
                and is_true(move.when, state, letter)
                and move.when not in configuration.remembered
            ]
            # Completion transitions have priority.
            completions = [move for move in enabled if not move.event and move.when is None]
            for move in completions or enabled:
                attributes = self._assign(configuration.attributes, move)
                yield move, Configuration(move.target, attributes)
            if not enabled:
                changes = {move.when for move in own if move.when is not None}
                remembered = frozenset(c for c in changes if is_true(c, state, letter))
                yield None, Configuration(state, configuration.attributes, remembered)

    def _assign(self, attributes: Values, move: Move) -> Values:
        if move.effect is None:
            return attributes
        name, number = move.effect
        values = dict(attributes)
        value = number * RESOLUTION + (values[name] if move.is_sum else 0)
        if abs(value) <= self._grid.limit:
            values[name] = value
        return tuple(values.items())

    def replay(self, requirement: Requirement, steps: list[Step], loop: int) -> bool:
        """Whether a run is one of the machine and violates a requirement.

        After the last step it continues with the step *loop*.
        """
        graph: Graph = {}
        nodes = [Configuration(step.state, (("step", n),)) for n, step in enumerate(steps)]
        followers = [*range(1, len(steps)), loop]
        present = {self._initial}
        for number, step in enumerate(steps):
            letter = frozenset(item for item in self._grid.literals if item.is_true(step.values))
            reactions = [
                successor
                for configuration in present
                if self._agrees(configuration, step) and self._is_possible(step, letter, steps[0])
                for _, successor in self._list_reactions(configuration, letter, step.event)
            ]
            following = followers[number]
            present = {s for s in reactions if self._agrees(s, steps[following])}
            graph[nodes[number]] = {letter: {nodes[following]}}
        return bool(present) and _violates(graph, requirement)

    def _agrees(self, configuration: Configuration, step: Step) -> bool:
        """Whether a step shows the state and the attributes of a configuration."""
        has_values = all(step.values[name] == value for name, value in configuration.attributes)
        return has_values and configuration.state == step.state

    def _is_possible(self, step: Step, letter: Letter, first: Step) -> bool:
        """Whether the values satisfy the constraints, and constants are as in the first step."""
        features = self._machine.features
        return (
            all(is_true(condition, "", letter) for condition in self._machine.constraints)
            and all(step.values[f.name] == first.values[f.name] for f in features if f.is_constant)
            and all(step.values[f.name] == f.value * RESOLUTION for f in features if f.is_known)
        )

    def list_unreachable(self) -> list[str]:
        """Return the states that no run enters."""
        return [state for state in self._machine.states if state not in self.entered]

    def count_never_taken(self) -> int:
        """Return the number of transitions from reachable states that no run takes."""
        return sum(
            move.source in self.entered and move not in self.taken for move in self._machine.moves
        )

    def decide(self, requirement: Requirement) -> str:
        """Return the verdict about a requirement, in the words of ``contracts check``."""
        is_violated = any(_violates(graph, requirement) for graph in self._graphs)
        return "broken" if is_violated else "holds"


Graph = dict[Configuration, dict[Letter, set[Configuration]]]
"""The steps of each configuration: the configurations after each letter."""


def _violates(graph: Graph, requirement: Requirement) -> bool:
    """Whether a run of the graph, which starts in its first node, violates a requirement."""
    p, q = requirement.p, requirement.q
    match requirement.shape:
        case "G p":
            return any(True for _ in _list_steps(graph, Not(p)))
        case "G (p -> X q)":
            starts = {node for _, node in _list_steps(graph, Not(q))}
            return any(graph[n][letter] & starts for letter, n in _list_steps(graph, p))
        case "F p":
            return next(iter(graph)) in _find_endless(graph, Not(p))
        case "G F p":
            return bool(_find_endless(graph, Not(p)))
        case "G (p -> F q)":
            endless = _find_endless(graph, Not(q))
            violations = _list_steps(graph, Pair("and", p, Not(q)))
            return any(graph[node][letter] & endless for letter, node in violations)
    raise ValueError(requirement.shape)


def _list_steps(graph: Graph, condition: Condition) -> Iterator[tuple[Letter, Configuration]]:
    for node, steps in graph.items():
        for letter in steps:
            if is_true(condition, node.state, letter):
                yield letter, node


def _find_endless(graph: Graph, condition: Condition) -> set[Configuration]:
    """Return the configurations from which the condition can hold for ever."""
    endless = set(graph)
    steps = list(_list_steps(graph, condition))
    while True:
        staying = {node for letter, node in steps if graph[node][letter] & endless}
        if staying == endless:
            return endless
        endless = staying
