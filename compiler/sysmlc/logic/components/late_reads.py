"""Values that a machine reads after its do behaviours have assigned them in the same step.

What actions assign when they end is visible to the effects of the transitions that are taken, to
the guards behind a choice, and to the guards of the completion transition that the end triggers
(UML 2.5.1, 14.2.3.7 and 14.2.3.8.3). Other guards read the values before the step.
"""

from collections.abc import Collection, Sequence

from sysmlc.logic import formula as f
from sysmlc.logic.components.machines import MachineWrite, PlacedMachine
from sysmlc.logic.components.objects import ComponentError, ObjectTree
from sysmlc.logic.composition.structure import join_path
from sysmlc.logic.contract import Class, Conjunct, Owner, Source, Variable, equals
from sysmlc.logic.formula import Formula


class LateValues:
    """Variables for the values of features that are read late in a step, and their definitions.

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
