"""Instantaneous dependencies: outputs of a component that depend on inputs of the same step.

Proofs by induction over steps are unsound for an output that depends on itself within a step, so
``discharge`` searches these dependencies for cycles.
"""

from collections.abc import Iterable, Iterator, Sequence, Set

from msgspec import Struct

from sysmlc.ir.algorithms import strongly_connected_components
from sysmlc.logic import formula as f
from sysmlc.logic.contract import (
    Class,
    Composite,
    Conjunct,
    Contract,
    Owner,
    Part,
    select_classes,
)
from sysmlc.synthesis.algebra.fair_systems import Runs, Universe


class Dependency(Struct, frozen=True):
    """Outputs that guarantees relate, and the inputs of the same step that they depend on."""

    is_first: bool
    """Whether the dependency exists in the first step, or in all later ones."""
    outputs: frozenset[str]
    inputs: frozenset[str]


def find_dependencies(contract: Contract, universe: Universe) -> tuple[Dependency, ...]:
    """Return the instantaneous dependencies of a component.

    Two outputs are in one dependency if a guarantee relates their values of one step, or if both
    are restricted in the states from which the guarantees allow an infinite run. Raises
    OutsideGr1Error, LimitError.
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
    """Yield for each guarantee the variables whose values it relates within one step.

    These are all variables of an initial guarantee (*is_first*), and the primed variables of other
    guarantees.
    """
    for conjunct in contract.guarantees:
        if (conjunct.class_ is Class.INIT) == is_first:
            variables = f.variables(conjunct.formula)
            yield frozenset(variable.name for variable in variables if is_first or variable.primed)


def _merge_groups(groups: Iterable[frozenset[str]], outputs: Set[str]) -> list[frozenset[str]]:
    """Merge groups that share an output; drop groups without outputs."""
    merged: list[frozenset[str]] = []
    for group in groups:
        if group & outputs:
            overlapping = [other for other in merged if other & group & outputs]
            merged = [other for other in merged if other not in overlapping]
            merged.append(group.union(*overlapping))
    return merged


def _restricted_together(contract: Contract, universe: Universe) -> frozenset[str]:
    """Return the variables that the states restrict from which an infinite run is possible.

    A component has to avoid all other states, which relates its outputs to inputs even if no single
    guarantee does.
    """
    system = universe.system(select_classes(contract.guarantees, Class.SAFETY))
    live_states = Runs(system).states_with_infinite_runs
    symbols, manager = universe.symbols, universe.manager
    # The states allow every value of a variable that they do not restrict.
    names = (variable.name for variable in contract.variables)
    return frozenset(
        name
        for name in names
        if manager.exist(symbols.bits(name), live_states) & symbols.domain(name) != live_states
    )


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
            guarantee
            for guarantee in part.contract.guarantees
            if any(_is_about_outputs(guarantee, dependency) for dependency in own_dependencies)
        ]

    def circular_parts(self, parts: Sequence[Part]) -> list[Part]:
        """Return the parts with an output that depends on itself within a step, via other parts."""
        nodes = [(part, dependency) for part, dependency in self.dependencies if part in parts]
        successors = {
            str(index): [str(i) for i, writer in enumerate(nodes) if self._reads(reader, writer)]
            for index, reader in enumerate(nodes)
        }
        circular = [
            nodes[int(index)][0]
            for component in strongly_connected_components(successors)
            if len(component) > 1
            for index in component
        ]
        return [part for part in parts if part in circular]

    def _reads(self, reader: tuple[Part, Dependency], writer: tuple[Part, Dependency]) -> bool:
        """Whether *reader* reads an output of *writer* in the same step, also by wires."""
        (reading_part, reading), (writing_part, writing) = reader, writer
        read_names = reading.inputs.union(*(wire for wire in self.wires if wire & reading.inputs))
        return (
            reading.is_first == writing.is_first
            and reading_part != writing_part
            and bool(read_names & writing.outputs)
        )


def _is_about_outputs(conjunct: Conjunct, dependency: Dependency) -> bool:
    """Whether the conjunct reads an output of the dependency in the same step."""
    variables = f.variables(conjunct.formula)
    is_state_predicate = not any(variable.primed for variable in variables)
    names = {variable.name for variable in variables if variable.primed or is_state_predicate}
    is_first = conjunct.class_ is Class.INIT
    # A safety guarantee without primes holds in the first step and in all later ones.
    is_same_step = is_first == dependency.is_first or (is_state_predicate and not is_first)
    return is_same_step and not names.isdisjoint(dependency.outputs)


def build_dependency_graph(composite: Composite, universe: Universe) -> DependencyGraph:
    """Collect the dependencies of all parts. Raises OutsideGr1Error, LimitError."""
    dependencies = tuple(
        (part, dependency)
        for part in composite.parts
        for dependency in find_dependencies(part.contract, universe)
    )
    wires = tuple(frozenset(f.variable_names(wire.formula)) for wire in composite.wiring)
    return DependencyGraph(dependencies, wires)
