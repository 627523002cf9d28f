"""The step relation of a component: all its behaviours, one relation for each feature, and names.

A step is one valuation; all behaviours react to the same step and their reactions are visible in
the next (synchronous composition). A feature has one next-state relation with all its writers:
it gets the value of one of those that write in the step, or else keeps its value.
"""

from collections import Counter
from collections.abc import Collection, Iterator, Mapping, Sequence

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.logic import formula as f
from sysmlc.logic.activities.assumptions import derive_assumptions
from sysmlc.logic.activities.derivation import derive_run_update, derive_token_updates
from sysmlc.logic.activities.step_formulas import PerformanceFormulas
from sysmlc.logic.activities.token_graph import TokenGraph
from sysmlc.logic.basis import Reads
from sysmlc.logic.cells import Cells, Fact, find_cells
from sysmlc.logic.components.component import Component
from sysmlc.logic.components.machines import MachineWrite, PlacedMachine, find_unread_features
from sysmlc.logic.components.names import Atom, finish_name, iter_atoms
from sysmlc.logic.components.objects import ComponentError, ObjectTree, Slot
from sysmlc.logic.components.places import PlaceInBehaviour, iter_places
from sysmlc.logic.components.signals import derive_events
from sysmlc.logic.composition.structure import join_path
from sysmlc.logic.contract import (
    BooleanDomain,
    Class,
    Conjunct,
    Contract,
    Owner,
    Source,
    Variable,
    equals,
)
from sysmlc.logic.feature_writes import find_label, iter_writes
from sysmlc.logic.formula import Const, Formula
from sysmlc.logic.machines.instant_activities import has_unknown_performer
from sysmlc.logic.simplification import substitute


class Writer(Struct, frozen=True):
    """A writer of a feature: when it writes, and which value."""

    condition: Formula
    value: Formula
    origin: str


class ComponentBehaviour(Struct, frozen=True):
    """The behaviour of a component with everything that it performs, calls and consists of.

    ``contract`` has its runs: guarantees that the compiler derives, and the assumptions that
    actions end. A variable in ``gaps`` is restricted by the model, but not here; the value is the
    reason in words. Variables in ``undescribed`` are gaps too: they tell whether an action runs and
    ends whose steps are not described. ``writers`` are the writers of the features with several.
    ``places`` are its states and actions, ``atoms`` what authors write about its steps.
    ``constituents`` are ids: of the types of its parts, and of the activities it performs.
    ``is_of_parts``: no contract describes a behaviour of its own.
    """

    contract: Contract
    gaps: Mapping[str, str] = {}
    undescribed: frozenset[str] = frozenset()
    writers: Mapping[str, tuple[Writer, ...]] = {}
    places: tuple[PlaceInBehaviour, ...] = ()
    atoms: tuple[Atom, ...] = ()
    constituents: frozenset[str] = frozenset()
    is_of_parts: bool = False
    clamps: tuple[tuple[str, Formula], ...] | None = None
    """Variables with assumed ranges, and when a value is stopped at a bound; None if not known."""
    reads: tuple[Reads, ...] = ()
    """Variables that machines decide, and those with assumed ranges that they read for them."""
    facts: tuple[Conjunct, ...] = ()
    """The conjuncts of the contract that are true of numbers, whatever the behaviour does."""
    limits: tuple[Fact, ...] = ()
    """The sums of features that constraints keep in an interval."""

    def list_reads(self) -> tuple[Reads, ...]:
        """Return ``reads``; if they are not known, each variable depends on all assumed ranges."""
        if self.clamps is not None:
            return self.reads
        assumed = (item.name for item in self.contract.variables if item.is_range_assumed)
        return ((frozenset(item.name for item in self.contract.variables), frozenset(assumed)),)


def describe_component(component: Component, name: str) -> ComponentBehaviour:
    """Return the behaviour with all features named so far. Raises ComponentError."""
    if component.obstacle:
        raise ComponentError(component.obstacle)
    return _Description(component).describe(name)


class _Description:
    """The step relation of a component in progress."""

    def __init__(self, component: Component) -> None:
        self.component = component
        self.graph = component.graph
        self.tree = component.tree
        self.performances = component.performances
        self.machines = component.machines
        self._roots = component.roots
        self._conjuncts = list(component.conjuncts)
        self._machine_writes = [
            (machine, write) for machine in self.machines for write in machine.iter_writes()
        ]
        self._writes_in_states: dict[tuple[str, str], list[MachineWrite]] = {}
        """What the entry, do and exit behaviours of the states of each machine write."""
        self._arguments = component.arguments
        self._written = {write.slot for _, write in self._machine_writes}
        self._written |= {write.slot for write in self.performances.writes}
        self._written |= {
            output.target for output in self._arguments.outputs if isinstance(output.target, tuple)
        }

    def _add(self, formula: Formula, class_: Class, origin: str, text: str = "") -> None:
        if formula != f.TRUE:
            self._conjuncts.append(Conjunct(formula, class_, origin, text, source=Source.DERIVED))

    def describe(self, name: str) -> ComponentBehaviour:
        """Return the behaviour with all features that were named so far. Raises ComponentError."""
        formulas = self._make_formulas(name)
        first = self._find_first_conditions(formulas.graph)
        self._derive_performances(formulas, first)
        cells = self._find_cells()
        facts = cells.describe(self.component.subject.id)
        self._conjuncts += facts
        for machine in self.machines:
            self._conjuncts += machine.iter_steps()
        self._conjuncts += self._arguments.derive(formulas, first)
        gaps = dict(self.performances.gaps) | self._arguments.gaps
        writers = self._list_writers(formulas)
        assigned = [(join_path(*slot), self.tree.read_slot(slot).variable) for slot in writers]
        self._reset_own_features(writers)
        gaps |= self._derive_updates(writers)
        gaps |= self._derive_starts(gaps)
        late = LateValues(self.tree, gaps)
        for machine in self.machines:
            late.add(machine, self._writes_in_states.get(machine.key, []))
        self._conjuncts += late.conjuncts
        wiring = derive_events(self.component)
        self._conjuncts += wiring.conjuncts
        gaps |= wiring.gaps
        ends = {**self._define_ends(formulas), **late.unassigned}
        contract = Contract(
            name,
            self.component.subject.id,
            cells.mark_unrelated(
                (
                    *self._list_variables(formulas, wiring.variables).values(),
                    *late.variables,
                    *cells.orders,
                )
            ),
            tuple(
                replace(assumption, source=Source.DERIVED)
                for assumption in derive_assumptions(formulas, {*gaps, *wiring.list_internal()})
            ),
            tuple(
                replace(conjunct, formula=substitute(conjunct.formula, ends), source=Source.DERIVED)
                for conjunct in self._conjuncts
            ),
        )
        shared = self._list_shared_writers(writers, ends)
        places = tuple(
            place.replace_variables(ends)
            for place in iter_places(self.component, formulas, assigned)
        )
        undescribed = self.performances.undescribed
        atoms = tuple(
            replace(atom, meaning=substitute(atom.meaning, ends))
            for atom in iter_atoms(self.component, formulas, contract.variables, wiring.accepted)
        )
        clamps = tuple(
            (name, substitute(condition, ends))
            for machine in self.machines
            for name, condition in machine.iter_clamps()
        )
        return ComponentBehaviour(
            contract,
            gaps | undescribed,
            frozenset(undescribed),
            shared,
            places,
            atoms,
            self.component.list_constituents(),
            clamps=clamps,
            reads=tuple(reads for machine in self.machines for reads in machine.iter_reads()),
            facts=facts,
            limits=tuple(self.tree.iter_facts()),
        )

    def _find_cells(self) -> Cells:
        """Return which regions the numbers of the component can be in at once."""
        slots = self.tree.used_slots.items()
        inputs = (item.variable for slot, item in slots if not self._is_decided(slot))
        decided = (item.variable for slot, item in slots if self._is_decided(slot))
        return find_cells(
            [*(replace(item, owner=Owner.ENVIRONMENT) for item in inputs), *decided],
            list(self.tree.iter_facts()),
        )

    def _list_shared_writers(
        self, writers: Mapping[Slot, list[Writer]], ends: Mapping[str, Formula]
    ) -> dict[str, tuple[Writer, ...]]:
        """Return the writers of the features with several; *ends* replaces placeholders."""
        return {
            self.tree.read_slot(slot).variable.name: tuple(
                replace(
                    writer,
                    condition=substitute(writer.condition, ends),
                    value=substitute(writer.value, ends),
                )
                for writer in group
            )
            for slot, group in writers.items()
            if len(group) > 1
        }

    def _make_formulas(self, name: str) -> PerformanceFormulas:
        """Return the formulas about the steps of all performances."""
        slots = self.tree.used_slots
        decided = [slots[slot].variable for slot in slots if self._is_decided(slot)]
        decided += self._arguments.variables
        given = [slots[slot].variable for slot in slots if not self._is_decided(slot)]
        tokens = self.performances.build(name, self.component.subject.id, decided, given)
        starts = {root.id: root.start for root in self._roots}
        return PerformanceFormulas(tokens, starts, {root.id: root.stop for root in self._roots})

    def _define_ends(self, formulas: PerformanceFormulas) -> dict[str, Formula]:
        """Return for each placeholder of the end of a performance the formula that replaces it."""
        nodes = {root.id: formulas.graph.node(root.id) for root in self._roots}
        finishes = {
            finish_name(id): f.both(f.var(node.run), formulas.done_formula(node))
            for id, node in nodes.items()
        }
        ends = {name: substitute(end, finishes) for name, end in self.component.ends.items()}
        return {**finishes, **ends}

    def _is_decided(self, slot: Slot) -> bool:
        """Whether the component decides the value of a feature."""
        return slot in self._written or not self.tree.used_slots[slot].is_input

    def _find_first_conditions(self, graph: TokenGraph) -> dict[str, Formula]:
        """Return under which condition edges and nodes have tokens in the first step, by id."""
        starts = ((root, graph.start_all(root.id)) for root in self._roots)
        return {
            id: root.first
            for root, start in starts
            for id in (root.id, *start.tokens, *start.running)
        }

    def _derive_performances(
        self, formulas: PerformanceFormulas, first: Mapping[str, Formula]
    ) -> None:
        graph, roots = formulas.graph, {root.id for root in self._roots}
        self._conjuncts += derive_token_updates(formulas)
        for edge in filter(graph.can_hold, graph.edges):
            is_first = first.get(edge.id, f.FALSE)
            self._add(f.fold_iff(f.var(edge.variable), is_first), Class.INIT, edge.origin)
        for node in graph.workers():
            self._add(
                f.fold_iff(f.var(node.run), first.get(node.id, f.FALSE)), Class.INIT, node.origin
            )
            if node.id in roots:
                runs = f.fold_iff(f.prime(f.var(node.run)), formulas.run_formula(node))
                self._add(runs, Class.SAFETY, node.origin)
            else:
                self._conjuncts.append(derive_run_update(formulas, node))

    def _list_writers(self, formulas: PerformanceFormulas) -> dict[Slot, list[Writer]]:
        """Return the writers of each slot. A machine overrides the do behaviours of its states."""
        writers: dict[Slot, list[Writer]] = {}
        machine_of_root = {root.id: root.machine for root in self._roots}
        for slot, writer, root in self._iter_performed_writes(formulas):
            machine = machine_of_root.get(root)
            when = writer.condition
            if machine is not None:
                write = MachineWrite(slot, when, writer.value)
                self._writes_in_states.setdefault(machine.key, []).append(write)
                overriding = [
                    other.condition
                    for owner, other in self._machine_writes
                    if owner is machine and other.slot == slot
                ]
                when = f.both(when, f.negate(f.either(*overriding)))
            writers.setdefault(slot, []).append(replace(writer, condition=when))
        for machine, machine_write in self._machine_writes:
            condition, value = machine_write.condition, machine_write.value
            writer = Writer(condition, value, machine.element.id)
            writers.setdefault(machine_write.slot, []).append(writer)
        return writers

    def _iter_performed_writes(
        self, formulas: PerformanceFormulas
    ) -> Iterator[tuple[Slot, Writer, str]]:
        """Yield each write of a feature by a performance, and the node of the performance."""
        for write in self.performances.writes:
            finishes = formulas.finish_formula(formulas.graph.node(write.node))
            for condition, value in write.values:
                writer = Writer(f.both(finishes, condition), value, write.origin)
                yield write.slot, writer, write.root
        for output in self._arguments.outputs:
            if isinstance(output.target, tuple):
                origin = formulas.graph.node(output.node).origin
                for condition, value in self._arguments.iter_results(formulas, output):
                    yield output.target, Writer(condition, value, origin), output.root

    def _reset_own_features(self, writers: dict[Slot, list[Writer]]) -> None:
        """Add the initial values of an activity that is checked by itself, for each of its starts.

        Each execution is an object with features of its own (UML 2.5.1, 16.2.3). A feature without
        initial value may have any value. Results keep their values until they are read.
        """
        activity = self.tree.root.type_
        for root in self._roots:
            copy = self.performances.copies.get(root.id)
            if not root.service or copy is None or copy.activity != activity:
                continue
            for slot, feature in self.tree.used_slots.items():
                has_direction = any(member.direction for _, member in self.tree.find_features(slot))
                if feature.is_input or has_direction:
                    continue
                first = f.prime(f.var(feature.variable.name))
                value = first if feature.default is None else Const(feature.default)
                writers[slot] = [
                    replace(writer, condition=f.both(writer.condition, f.negate(root.start)))
                    for writer in writers.get(slot, [])
                ] + [Writer(root.start, value, activity.id)]

    def _derive_starts(self, gaps: Mapping[str, str]) -> dict[str, str]:
        """Add the initial values of features without gaps.

        Return the features that two machines set at their start.
        """
        clashes: dict[str, str] = {}
        decided: set[str] = set()
        for machine in self.machines:
            names = [machine.variables[name] for name in machine.list_start_writes()]
            clash = [name for name in names if name in decided]
            decided.update(names)
            for conjunct in machine.iter_starts():
                read = {variable.name for variable in f.variables(conjunct.formula)}
                if read.isdisjoint((*clash, *gaps)):
                    self._conjuncts.append(conjunct)
            for name in clash:
                clashes[name] = f"several behaviours set '{name}' at their start"
        for feature in self.tree.used_slots.values():
            name = feature.variable.name
            is_free = feature.is_input or name in decided or name in gaps
            if feature.default is not None and not is_free:
                initial = equals(feature.variable, Const(feature.default))
                self._add(initial, Class.INIT, feature.variable.origin)
        for store, _ in self.performances.locals:
            if store.first is not None and store.variable.name not in gaps:
                self._add(
                    equals(store.variable, Const(store.first)), Class.INIT, store.variable.origin
                )
        return clashes

    def _derive_updates(self, writers: Mapping[Slot, list[Writer]]) -> dict[str, str]:
        """Add the next-state relation of each feature; return those with other writers."""
        index = self.component.writers
        described = self._arguments.origins | {write.origin for write in self.performances.writes}
        described |= {id for machine in self.machines for id in machine.written}
        described -= self.component.released.union(*self._iter_open_steps())
        gaps = find_unread_features(self.tree, self.machines, self.component.writers)
        for slot, feature in self.tree.used_slots.items():
            name = feature.variable.name
            others = (
                writer
                for element in feature.elements
                for writer in (
                    *index.iter_writers(element),
                    *index.iter_unclear_writers(element),
                )
                if writer.id not in described
            )
            other = next(others, None)
            if other is not None:
                reason = "which the check does not combine with it"
                if feature.variable.is_range_assumed:
                    reason = f"whose values need a declared range of '{name}'"
                gaps[name] = f"'{name}' is assigned by '{find_label(self.graph, other)}', {reason}"
                continue
            if feature.is_computed:
                gaps[name] = f"'{name}' has a computed value, which the check does not follow"
                continue
            group = writers.get(slot, [])
            if group or not feature.is_input:
                when = f.either(*(writer.condition for writer in group))
                values = (
                    f.both(writer.condition, equals(feature.variable, writer.value, is_next=True))
                    for writer in group
                )
                keeps = f.both(f.negate(when), equals(feature.variable, f.var(name), is_next=True))
                text = f"'{name}' keeps its value unless it is assigned."
                self._add(f.either(*values, keeps), Class.SAFETY, feature.variable.origin, text)
        return gaps

    def _iter_open_steps(self) -> Iterator[set[str]]:
        """Yield the ids of steps within a machine's step that something else may perform, too.

        A performance of the same activity is known if it writes all that the steps assign.
        """
        machines = {e.id for m in self.machines for e in m.iter_elements(self.graph)}
        counts = Counter((write.root, write.origin) for write in self.performances.writes)
        for id, steps in self.component.instant.items():
            copies = [c.root for c in self.performances.copies.values() if c.activity.id == id]
            is_written = all(
                counts[root, step.id] >= len({w.name for w in iter_writes(self.graph, step)})
                for root in copies
                for step in steps
            )
            activity = self.graph[id]
            is_written = is_written and self.performances.find_tokens(activity) is not None
            if not is_written or has_unknown_performer(self.graph, activity, machines):
                yield {step.id for step in steps}

    def _list_variables(
        self, formulas: PerformanceFormulas, events: list[Variable]
    ) -> dict[str, Variable]:
        variables = [*events, *self.component.variables, *self._arguments.variables]
        for slot, feature in self.tree.used_slots.items():
            owner = Owner.SYSTEM if self._is_decided(slot) else Owner.ENVIRONMENT
            variables.append(replace(feature.variable, owner=owner))
        for machine in self.machines:
            variables += (
                variable
                for variable in machine.list_variables()
                if variable.name not in self.component.ends
            )
        graph = formulas.graph
        variables += graph.inputs
        variables += (store.variable for store, _ in self.performances.locals)
        for name, origin, is_auxiliary in (
            *((node.run, node.origin, False) for node in graph.workers()),
            *((edge.variable, edge.origin, True) for edge in graph.edges if graph.can_hold(edge)),
            *((name, graph.activity, True) for _, name in graph.named_conditions),
        ):
            variables.append(Variable(name, Owner.SYSTEM, BooleanDomain(), origin, is_auxiliary))
        by_name: dict[str, Variable] = {}
        for variable in variables:
            by_name.setdefault(variable.name, variable)
        return by_name


# -- late reads ------------------------------------------------------------------------------------


class LateValues:
    """Variables for the values of features that are read late in a step, and their definitions.

    What actions assign when they end is visible to the effects of the transitions that are taken,
    to the guards behind a choice, and to the guards of the completion transition that the end
    triggers (UML 2.5.1, 14.2.3.7 and 14.2.3.8.3). Other guards read the values before the step.

    In a step in which no do behaviour assigns a feature, the variable has the feature's value. If
    several actions assign it, the variable has one of their values, so that all that read it in the
    step read the same. It has any value if not all assignments of the feature are described.
    """

    def __init__(self, tree: ObjectTree, gaps: Collection[str]) -> None:
        """Start without variables; *gaps* are the features that may have any value."""
        self._tree = tree
        self._gaps = gaps
        self.variables: list[Variable] = []
        self.conjuncts: list[Conjunct] = []
        self.unassigned: dict[str, Formula] = {}
        """The values of the variables for features that no do behaviour of the machine assigns."""

    def add(self, machine: PlacedMachine, writes: Sequence[MachineWrite]) -> None:
        """Add the variables of a machine; *writes* are those of the behaviours of its states.

        Raises ComponentError for a write that the machine would not see.
        """
        late_variables = machine.late_variables
        unseen = {write.slot for write in writes} - set(late_variables.values())
        for slot in unseen.intersection(machine.slots.values()):
            raise ComponentError(f"the behaviour that assigns '{join_path(*slot)}' is unknown")
        for name, slot in late_variables.items():
            feature = self._tree.read_slot(slot).variable
            before = f.var(feature.name)
            group = [write for write in writes if write.slot == slot]
            late = Variable(name, Owner.SYSTEM, feature.domain, feature.origin, is_auxiliary=True)
            if feature.name in self._gaps:
                self.variables.append(late)
                continue
            if not group:
                self.unassigned[name] = before
                continue
            written = [f.both(write.condition, equals(late, write.value)) for write in group]
            is_kept = f.negate(f.either(*(write.condition for write in group)))
            formula = f.either(*written, f.both(is_kept, equals(late, before)))
            self.variables.append(late)
            self.conjuncts.append(
                Conjunct(formula, Class.SAFETY, feature.origin, source=Source.DERIVED)
            )
