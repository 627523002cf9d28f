"""Instantaneous dependencies: inputs that outputs of a component read in the same step."""

from collections.abc import Iterable, Iterator, Sequence, Set

from msgspec import Struct

from sysmlc.logic import formula as f
from sysmlc.logic.contract import Class, Composite, Conjunct, Contract, Owner, Part
from sysmlc.synthesis.algebra.fair_systems import Runs, Universe
from sysmlc.synthesis.bdd.manager import Node


class Dependency(Struct, frozen=True):
    """Outputs that are chosen together, and the inputs of the same step that they depend on."""

    is_first: bool
    """Whether the dependency exists in the first step, or in all later ones."""
    outputs: frozenset[str]
    inputs: frozenset[str]


def find_dependencies(contract: Contract, universe: Universe) -> tuple[Dependency, ...]:
    """Return the instantaneous dependencies of a component.

    Outputs belong together if one guarantee is about both of them in its step, or if the condition
    for infinite runs restricts both. Raises OutsideGr1Error, LimitError.
    """
    outputs = {variable.name for variable in contract.variables if variable.owner is Owner.SYSTEM}
    names = {variable.name for variable in contract.variables}
    restricted = _restricted_together(contract, universe)
    return tuple(
        Dependency(is_first, frozenset(group & outputs), frozenset(group & names - outputs))
        for is_first in (True, False)
        for group in _merge_groups(
            (*_variables_of_guarantees(contract, is_first), restricted), outputs
        )
    )


def _variables_of_guarantees(contract: Contract, is_first: bool) -> Iterator[frozenset[str]]:
    """Yield the variables of each guarantee in the step that it is about."""
    for conjunct in contract.guarantees:
        if (conjunct.class_ is Class.INIT) == is_first:
            variables = f.variables(conjunct.formula)
            yield frozenset(variable.name for variable in variables if is_first or variable.primed)


def _merge_groups(groups: Iterable[frozenset[str]], outputs: Set[str]) -> list[frozenset[str]]:
    """Merge groups that share an output; groups without outputs are dropped."""
    merged: list[frozenset[str]] = []
    for group in groups:
        if group & outputs:
            overlapping = [other for other in merged if other & group & outputs]
            merged = [other for other in merged if other not in overlapping]
            merged.append(group.union(*overlapping))
    return merged


def _restricted_together(contract: Contract, universe: Universe) -> frozenset[str]:
    """Return the variables restricted in states from which the guarantees allow infinite runs."""
    safety_guarantees = [
        guarantee for guarantee in contract.guarantees if guarantee.class_ is Class.SAFETY
    ]
    live_states = Runs(universe.system(safety_guarantees)).states_with_infinite_runs
    names = (guarantee.name for guarantee in contract.variables)
    return frozenset(name for name in names if _is_restricted(name, live_states, universe))


def _is_restricted(name: str, states: Node, universe: Universe) -> bool:
    """Return whether the states do not allow every value of the variable."""
    symbols = universe.symbols
    any_value = universe.manager.exist(symbols.bits(name), states) & symbols.domain(name)
    return any_value != states


class DependencyGraph(Struct, frozen=True):
    """The dependencies of all parts of a composition."""

    dependencies: tuple[tuple[Part, Dependency], ...]
    wires: tuple[frozenset[str], ...]

    def guarantees_after_inputs(self, part: Part) -> list[Conjunct]:
        """Return the guarantees of a part about outputs that depend on inputs of the same step."""
        own_dependencies = [
            dependency
            for owner, dependency in self.dependencies
            if owner == part and dependency.inputs
        ]
        return [
            owner
            for owner in part.contract.guarantees
            if any(_is_about_outputs(owner, dependency) for dependency in own_dependencies)
        ]

    def circular_parts(self, parts: Sequence[Part]) -> list[Part]:
        """Return the parts whose outputs depend on themselves in the same step, through other
        parts.
        """
        nodes = [(part, dependency) for part, dependency in self.dependencies if part in parts]
        return [
            part
            for part in parts
            if any(self._reaches_itself(node, nodes) for node in nodes if node[0] == part)
        ]

    def _reaches_itself(
        self, start: tuple[Part, Dependency], nodes: Sequence[tuple[Part, Dependency]]
    ) -> bool:
        visited: list[tuple[Part, Dependency]] = []
        stack = [node for node in nodes if self._reads(start, node)]
        while stack:
            node = stack.pop()
            if node == start:
                return True
            if node not in visited:
                visited.append(node)
                stack += [successor for successor in nodes if self._reads(node, successor)]
        return False

    def _reads(
        self, reader_node: tuple[Part, Dependency], giver_node: tuple[Part, Dependency]
    ) -> bool:
        inputs = reader_node[1].inputs
        read_names = inputs.union(*(wire for wire in self.wires if wire & inputs))
        is_same_time = reader_node[1].is_first == giver_node[1].is_first
        return (
            is_same_time
            and reader_node[0] != giver_node[0]
            and bool(read_names & giver_node[1].outputs)
        )


def _is_about_outputs(conjunct: Conjunct, dependency: Dependency) -> bool:
    """Return whether the conjunct is about the outputs of a dependency in the step of its
    inputs.
    """
    variables = f.variables(conjunct.formula)
    is_alone = not any(variable.primed for variable in variables)
    names = {variable.name for variable in variables if variable.primed or is_alone}
    is_first = conjunct.class_ is Class.INIT
    is_same_step = is_first == dependency.is_first or (is_alone and not is_first)
    return is_same_step and not names.isdisjoint(dependency.outputs)


def build_dependency_graph(composite: Composite, universe: Universe) -> DependencyGraph:
    """Collect the dependencies of all parts. Raises OutsideGr1Error, LimitError."""
    dependencies = tuple(
        (part, dependency)
        for part in composite.parts
        for dependency in find_dependencies(part.contract, universe)
    )
    wires = tuple(
        frozenset(variable.name for variable in f.variables(wire.formula))
        for wire in composite.wiring
    )
    return DependencyGraph(dependencies, wires)
