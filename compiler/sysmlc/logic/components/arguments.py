"""Variables of called activities: arguments, outputs, and what the activities store themselves.

An ``in`` value is taken at the start of the call, an ``out`` value is written at its end. An
argument with ``:=`` is latched at the start; one with ``=`` is bound during the whole performance
(KerML distinguishes the initial value from the bound value). Each performance has variables of its
own, which have their default values when it starts.
"""

from collections.abc import Iterator

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.ir import Element, Kind
from sysmlc.ir.expressions import ExpressionError
from sysmlc.logic import formula as f
from sysmlc.logic.activities.step_formulas import PerformanceFormulas
from sysmlc.logic.activities.token_nodes import Store
from sysmlc.logic.components.objects import ComponentError, ComponentObject, ObjectTree, Slot
from sysmlc.logic.components.performances import Copy, Performances, element_of_copy
from sysmlc.logic.composition.structure import find_drawn_activity
from sysmlc.logic.contract import (
    BooleanDomain,
    Class,
    Conjunct,
    Domain,
    EnumerationDomain,
    IntegerDomain,
    Owner,
    Source,
    Variable,
    equals,
)
from sysmlc.logic.expressions.context import find_literal
from sysmlc.logic.expressions.elaboration import elaborate_value
from sysmlc.logic.expressions.parsing import tree_of
from sysmlc.logic.expressions.symbols import ElaborationError, Symbol
from sysmlc.logic.feature_writes import WriterIndex, find_bound_name
from sysmlc.logic.formula import Formula
from sysmlc.logic.machines.paths import split_by_range
from sysmlc.logic.simplification import substitute

Cases = list[tuple[Formula, Formula]]
"""Values with their conditions, one of which holds."""


class Argument(Struct, frozen=True):
    """An ``in`` parameter of the call with a node, and the cases of its value."""

    variable: Variable
    node: str
    cases: Cases
    is_bound: bool


class Output(Struct, frozen=True):
    """An ``out`` parameter of the call with a node, whose value is written when the call ends.

    ``target`` is a feature, or a variable of the calling activity. ``cases`` are the cases of the
    value, which is that of ``variable`` within the range of the target.
    """

    target: Slot | str
    node: str
    variable: str
    cases: Cases
    root: str


class Arguments:
    """The values that pass between calls and the copies of what they call."""

    def __init__(self, tree: ObjectTree, performances: Performances, writers: WriterIndex) -> None:
        """Read the arguments of all calls. Raises ComponentError."""
        self._tree = tree
        self._performances = performances
        self.values: list[Argument] = []
        """Arguments in the order in which bound values depend on one another."""
        self.outputs: list[Output] = []
        self.origins: set[str] = set()
        """Ids of the call actions whose writes are described."""
        self.gaps: dict[str, str] = {}
        for copy in performances.copies.values():
            for name, variable in tuple(copy.parameters.items()):
                self._read_parameter(copy, name, variable)
        # Inner calls first: what they write may be an output of the activity around them.
        for copy in reversed(performances.copies.values()):
            for name, pin in self._list_pins(copy).items():
                if name not in copy.parameters and pin.attrs.get("direction") == "out":
                    self._read_unassigned_output(copy, pin)
        self._find_unread_writers(writers)

    @property
    def variables(self) -> list[Variable]:
        """The variables of the described ``in`` parameters."""
        return [argument.variable for argument in self.values]

    @property
    def locals(self) -> list[tuple[Store, str]]:
        """The variables that performances store, each with the node that starts them."""
        return self._performances.locals

    # -- reading -----------------------------------------------------------------------------------

    def _list_pins(self, copy: Copy) -> dict[str, Element]:
        call = copy.caller.call
        members = () if call is None else self._tree.graph.owned(call)
        return {pin.name: pin for pin in members if pin.kind is Kind.PIN}

    def _read_parameter(self, copy: Copy, name: str, variable: Variable) -> None:
        if copy.caller.call is None:
            return
        element = self._tree.graph[variable.origin]
        direction = element.attrs.get("direction", "in")
        pin = self._list_pins(copy).get(name)
        if element.kind is not Kind.PARAMETER:
            if self._make_local(copy, name, variable) is None:
                self.gaps[variable.name] = f"the check does not follow the value of '{name}'"
        elif direction != "out":
            self._add_argument(copy, pin, variable, is_input=direction == "in")
        else:
            self._make_local(copy, name, variable)
            if pin is not None:
                self._add_output(copy, pin, variable)

    def _add_argument(
        self, copy: Copy, pin: Element | None, variable: Variable, *, is_input: bool
    ) -> None:
        text = None if pin is None else pin.attrs.get("value")
        # The graph has Booleans and numbers as values, in Python's words.
        text = str(text).lower() if isinstance(text, bool) else text
        cases = None if text is None else self._evaluate(copy, str(text), variable)
        is_bound = pin is not None and pin.attrs.get("value_kind") != "initial"
        if cases is None or not is_input or (is_bound and variable.owner is Owner.SYSTEM):
            name = self._tree.graph[variable.origin].name
            self.gaps[variable.name] = f"the check does not follow the value of '{name}'"
            return
        self._performances.inputs.pop(variable.name, None)
        parameter = replace(variable, owner=Owner.SYSTEM)
        self.values.append(Argument(parameter, copy.id, cases, is_bound))

    def _read_unassigned_output(self, copy: Copy, pin: Element) -> None:
        """Read an ``out`` parameter that the called action never assigns.

        It has its default value, or any value, also if the parameter is not found.
        """
        try:
            is_declared = self._find_own(copy, pin.name) is not None
        except ComponentError:
            is_declared = False
        target = None if is_declared else self._find_target(copy, pin)
        if target is None:
            return
        name = self._performances.name_variable(pin.name, copy.caller.prefix)
        written = self._read_target(target)
        value = replace(written, name=name, owner=Owner.ENVIRONMENT)
        self._performances.inputs[name] = value
        self._add_output(copy, pin, value)

    def _add_output(self, copy: Copy, pin: Element, variable: Variable) -> None:
        target = self._find_target(copy, pin)
        if target is None:
            return
        cases = _fit_value(f.var(variable.name), variable.domain, self._read_target(target).domain)
        if cases is not None:
            assert copy.caller.call is not None
            self.outputs.append(Output(target, copy.id, variable.name, cases, copy.root))
            self.origins.add(copy.caller.call.id)

    def _find_target(self, copy: Copy, pin: Element) -> Slot | str | None:
        """Return what an output sets: a feature or a variable of the calling activity.

        The result is None if its values are not finite, too: then nothing reads it.
        """
        try:
            target = self._resolve_target(copy, pin)
            if isinstance(target, tuple):
                self._tree.read_slot(target)
        except ComponentError:
            return None
        return target

    def _resolve_target(self, copy: Copy, pin: Element) -> Slot | str | None:
        call, parent = copy.caller.call, copy.caller.parent
        assert call is not None
        assert parent is not None
        name = find_bound_name(self._tree.graph, call, pin)
        if name is None:
            return None
        variable = self._find_own(parent, name)
        if variable is not None:
            return self._make_local(parent, name, variable)
        type_name, _, own_name = name.rpartition("::")
        for object_ in self._iter_holders(parent, own_name):
            if not type_name or object_.type_.name == type_name.rpartition("::")[2]:
                return self._tree.slot_of(object_.path, own_name)
        return None

    def _iter_holders(self, copy: Copy, name: str) -> Iterator[ComponentObject]:
        """Yield the objects that have a feature, themselves or in a part (``cell.full``).

        They are the object that performs *copy* and those around it, nearest first.
        """
        head, dot, _ = name.partition(".")
        object_: ComponentObject | None = copy.caller.owner
        if dot and head in self._tree.context_in(copy.caller.owner, copy.activity).variables:
            # A parameter or an attribute of the activity hides the part of its name.
            return
        while object_ is not None:
            if self._tree.has_feature(object_, name):
                yield object_
            object_ = object_.owner

    def _read_target(self, target: Slot | str) -> Variable:
        if isinstance(target, tuple):
            return self._tree.read_slot(target).variable
        return next(store.variable for store, _ in self.locals if store.variable.name == target)

    def _find_own(self, copy: Copy, name: str) -> Variable | None:
        """Return the variable of a parameter or another attribute of an activity itself, or None.

        An attribute that only arguments of inner calls name gets its variable here. Raises
        ComponentError for one that has no finite values.
        """
        if name in copy.parameters:
            return copy.parameters[name]
        feature = self._tree.context_in(copy.caller.owner, copy.activity).features.get(name)
        drawn = find_drawn_activity(self._tree.graph, copy.activity)
        owner = None if feature is None else self._tree.graph.owner(feature.element)
        if feature is None or owner not in (copy.activity, drawn):
            return None
        if self._performances.find_slot(copy, feature.element, feature.variable) is not None:
            return None
        if feature.domain is None or feature.is_assumed:
            raise ComponentError(f"'{name}' has no finite type")
        own_name = self._performances.name_variable(feature.variable, copy.caller.prefix)
        variable = Variable(own_name, Owner.ENVIRONMENT, feature.domain, feature.element.id)
        self._performances.inputs[own_name] = copy.parameters[name] = variable
        self._read_parameter(copy, name, variable)
        return copy.parameters[name]

    def _make_local(self, copy: Copy, name: str, variable: Variable) -> str | None:
        """Let an activity store one of its attributes; return the variable, or None for inputs."""
        if variable.owner is Owner.SYSTEM:
            return variable.name
        feature = self._tree.context_in(copy.caller.owner, copy.activity).features.get(name)
        if feature is None or feature.direction in ("in", "inout") or feature.is_constant:
            return None
        self._performances.inputs.pop(variable.name, None)
        stored = replace(variable, owner=Owner.SYSTEM)
        copy.parameters[name] = stored
        self.locals.append((Store(stored, (), feature.default, local=True), copy.id))
        return stored.name

    def _find_unread_writers(self, writers: WriterIndex) -> None:
        """Record the variables of activities that something assigns in a way that is not read.

        They may have any value in any step.
        """
        described = self.origins | {
            element_of_copy(write.node) for store, _ in self.locals for write in store.writes
        }
        for copy in self._performances.copies.values():
            for name, variable in copy.parameters.items():
                element = self._tree.graph[variable.origin]
                ids = {
                    writer.id
                    for writer in (
                        *writers.iter_writers(element),
                        *writers.iter_unclear_writers(element),
                    )
                }
                if not ids <= described:
                    reason = f"the check does not follow what is assigned to '{name}'"
                    self.gaps.setdefault(variable.name, reason)

    def _evaluate(self, copy: Copy, text: str, variable: Variable) -> Cases | None:
        """Return the cases of the value of an argument; None if it is unknown."""
        parent = copy.caller.parent
        assert parent is not None
        tree = self._tree
        root = tree.context(tree.root)

        def find_symbol(name: str, element: str) -> Symbol | None:
            if element in root.enumerations.constants_by_id:
                return find_literal(root, name, element)
            attribute = self._find_own(parent, name)
            if attribute is not None:
                return Symbol(f.var(attribute.name), attribute.domain)
            for object_ in self._iter_holders(parent, name):
                feature = tree.context(object_).features.get(name)
                if feature is not None and feature.is_constant and feature.default is not None:
                    return Symbol(f.const(feature.default), feature.domain)
                shared = tree.read_slot(tree.slot_of(object_.path, name)).variable
                return Symbol(f.var(shared.name), shared.domain)
            return find_literal(root, name, element)

        try:
            result = elaborate_value(tree_of(text), find_symbol, variable.domain)
        except (ElaborationError, ExpressionError, ComponentError):
            return None
        fitted: Cases = []
        for case in result.cases:
            cases = _fit_value(case.value, result.domain, variable.domain)
            if cases is None:
                return None
            fitted += [(f.both(case.condition, when), value) for when, value in cases]
        return fitted

    def derive(self, steps: PerformanceFormulas, first: dict[str, Formula]) -> Iterator[Conjunct]:
        """Yield when parameters take their values, and the steps of stored variables.

        An argument is taken in the first step of its call, after the writes of the step before.
        *first* are the conditions under which nodes run in the first step of all.
        """
        for store, node in self.locals:
            if store.variable.name not in self.gaps:
                yield from self._derive_local(steps, store, node)
        stored = {store.variable.name for store, _ in self.locals}
        for argument in self.values:
            variable = argument.variable
            if variable.name in self.gaps:
                continue
            cases = (f.implies(case, equals(variable, value)) for case, value in argument.cases)
            taken, starts = f.both(*cases), steps.begin_formula(argument.node)
            relations = [taken]
            if not argument.is_bound:
                relations = [f.implies(starts, f.prime(taken))]
                begins = f.implies(first.get(argument.node, f.FALSE), taken)
                yield Conjunct(begins, Class.INIT, variable.origin, source=Source.DERIVED)
            if not argument.is_bound and variable.name not in stored:
                kept = equals(variable, f.var(variable.name), is_next=True)
                relations.append(f.implies(f.negate(starts), kept))
            for formula in relations:
                yield Conjunct(formula, Class.SAFETY, variable.origin, source=Source.DERIVED)

    def _derive_local(
        self, formulas: PerformanceFormulas, store: Store, node: str
    ) -> Iterator[Conjunct]:
        """Yield the steps of a variable, which has its default value when its activity starts."""
        if store.follows is not None:
            formula = f.fold_iff(f.prime(f.var(store.variable.name)), store.follows)
            yield Conjunct(formula, Class.SAFETY, store.variable.origin, source=Source.DERIVED)
            return
        variable, starts = store.variable, formulas.begin_formula(node)
        writes = list(self._iter_writes(formulas, variable.name))
        values = (f.both(when, equals(variable, value, is_next=True)) for when, value in writes)
        is_kept = f.negate(f.either(*(when for when, _ in writes)))
        keeps = f.both(is_kept, equals(variable, f.var(variable.name), is_next=True))
        step = f.either(starts, *values, keeps)
        yield Conjunct(step, Class.SAFETY, variable.origin, source=Source.DERIVED)
        if store.first is not None and variable not in self.variables:
            reset = equals(variable, f.const(store.first), is_next=True)
            formula = f.implies(starts, reset)
            yield Conjunct(formula, Class.SAFETY, variable.origin, source=Source.DERIVED)

    def _iter_writes(
        self, formulas: PerformanceFormulas, variable: str
    ) -> Iterator[tuple[Formula, Formula]]:
        """Yield the writes of a variable of an activity in this step, with their conditions."""
        if variable in self.gaps:
            return
        for store, _ in self.locals:
            for write in store.writes if store.variable.name == variable else ():
                finishes = formulas.finish_formula(formulas.graph.node(write.node))
                yield from ((f.both(finishes, when), value) for when, value in write.values)
        for output in self.outputs:
            if output.target == variable:
                yield from self.iter_results(formulas, output)

    def iter_results(
        self, formulas: PerformanceFormulas, output: Output
    ) -> Iterator[tuple[Formula, Formula]]:
        """Yield what an output writes in this step, with the conditions.

        The end of a call may be the end of an action inside that assigns the output: then its
        value counts.
        """
        finishes = formulas.finish_formula(formulas.graph.node(output.node))
        writes = list(self._iter_writes(formulas, output.variable))
        is_kept = f.negate(f.either(*(when for when, _ in writes)))
        for written, result in (*writes, (is_kept, f.var(output.variable))):
            for when, value in output.cases:
                substitution = {output.variable: result}
                yield (
                    f.both(finishes, written, substitute(when, substitution)),
                    substitute(value, substitution),
                )


def _fit_value(value: Formula, domain: Domain, target: Domain) -> Cases | None:
    """Return the cases of a value within the range of what gets it; None for other types."""
    match domain, target:
        case IntegerDomain(), IntegerDomain():
            return [
                (when, fitted) for when, fitted, _ in split_by_range(f.TRUE, value, target, domain)
            ]
        case EnumerationDomain(literals), EnumerationDomain(others):
            return [(f.TRUE, value)] if set(literals) <= set(others) else None
        case BooleanDomain(), BooleanDomain():
            return [(f.TRUE, value)]
        case _:
            return None
