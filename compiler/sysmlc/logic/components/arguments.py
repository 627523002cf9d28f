"""Arguments of calls: ``in`` values are taken at the start of an action, ``out`` values at its end.

An argument with ``:=`` is latched at the start; one with ``=`` is bound during the whole
performance (KerML distinguishes the initial value from the bound value).
"""

from collections.abc import Iterator
from dataclasses import dataclass, field

from msgspec.structs import replace

from sysmlc.ir import Element, Kind
from sysmlc.logic import formula as f
from sysmlc.logic.activities.step_formulas import PerformanceFormulas
from sysmlc.logic.components.objects import ComponentError, ComponentObject, ObjectTree, Slot
from sysmlc.logic.components.performances import Copy, Performances
from sysmlc.logic.contract import (
    BooleanDomain,
    Class,
    Conjunct,
    IntegerDomain,
    Owner,
    Source,
    Variable,
)
from sysmlc.logic.expressions.context import find_literal
from sysmlc.logic.expressions.elaboration import (
    ElaborationError,
    Symbol,
    elaborate_value,
)
from sysmlc.logic.expressions.expression import ExpressionError, name_of
from sysmlc.logic.expressions.parsing import parse_expression
from sysmlc.logic.feature_writes import find_bound_name
from sysmlc.logic.formula import Formula
from sysmlc.logic.machines.symbolic_path import split_by_range


@dataclass(slots=True)
class Argument:
    """An ``in`` parameter of a copy with the cases of its value."""

    variable: Variable
    copy: Copy
    cases: list[tuple[Formula, Formula]]
    is_bound: bool


@dataclass(slots=True)
class Arguments:
    """The values that pass between calls and the copies of what they call."""

    values: list[Argument] = field(default_factory=list)
    writes: list[tuple[Slot, str, Formula]] = field(default_factory=list)
    """Slots that ``out`` parameters write, each with the node of the call and the value."""
    origins: set[str] = field(default_factory=set)
    """Ids of the call actions whose writes are described."""
    gaps: dict[str, str] = field(default_factory=dict)

    @property
    def variables(self) -> list[Variable]:
        """The variables of the described parameters."""
        return [argument.variable for argument in self.values]

    def derive(self, formulas: PerformanceFormulas) -> Iterator[Conjunct]:
        """Yield when the parameters take their values."""
        for argument in self.values:
            origin, variable = argument.variable.origin, argument.variable
            starts = formulas.begin_formula(argument.copy.id)
            for case, value in argument.cases:
                if argument.is_bound:
                    formula = f.implies(case, equals(variable, value))
                else:
                    taken = equals(variable, value, is_next=True)
                    formula = f.implies(f.both(starts, case), taken)
                yield Conjunct(formula, Class.SAFETY, origin, source=Source.DERIVED)
            if not argument.is_bound:
                kept = equals(variable, f.var(variable.name), is_next=True)
                formula = f.implies(f.negate(starts), kept)
                yield Conjunct(formula, Class.SAFETY, origin, source=Source.DERIVED)


def equals(variable: Variable, value: Formula, *, is_next: bool = False) -> Formula:
    """Return the formula that a variable has a value, in this step or the next one."""
    name = f.prime(f.var(variable.name)) if is_next else f.var(variable.name)
    if not isinstance(variable.domain, BooleanDomain):
        return f.eq(name, value)
    return f.fold_iff(name, value)


def derive_arguments(tree: ObjectTree, performances: Performances) -> Arguments:
    """Return the arguments of all calls. Raises ComponentError."""
    arguments = Arguments()
    for copy in performances.copies.values():
        if copy.caller.call is None or copy.caller.parent is None:
            continue
        pins = {pin.name: pin for pin in tree.graph.owned(copy.caller.call) if pin.kind is Kind.PIN}
        for name, variable in copy.parameters.items():
            _read_parameter(tree, performances, arguments, copy, pins.get(name), variable)
        for name, pin in pins.items():
            if name not in copy.parameters and pin.attrs.get("direction") == "out":
                _write_unknown_value(tree, performances, arguments, copy, pin)
    return arguments


def _write_unknown_value(
    tree: ObjectTree, performances: Performances, arguments: Arguments, copy: Copy, pin: Element
) -> None:
    """Write the value of an ``out`` parameter that the called action never assigns."""
    call = copy.caller.call
    assert call is not None
    path = find_bound_name(tree.graph, call, pin)
    slot = None if path is None else _find_slot(tree, copy, path)
    if slot is None:
        return
    name = performances.name_variable(pin.name, copy.caller.prefix)
    value = replace(tree.read_slot(slot).variable, name=name, owner=Owner.ENVIRONMENT)
    performances.inputs[name] = value
    arguments.writes.append((slot, copy.id, f.var(name)))
    arguments.origins.add(call.id)


def _read_parameter(
    tree: ObjectTree,
    performances: Performances,
    arguments: Arguments,
    copy: Copy,
    pin: Element | None,
    variable: Variable,
) -> None:
    element = tree.graph[variable.origin]
    direction = str(element.attrs.get("direction", "in"))
    text = None if pin is None else pin.attrs.get("value")
    call = copy.caller.call
    assert call is not None
    if direction == "out":
        path = None if pin is None else find_bound_name(tree.graph, call, pin)
        slot = None if path is None else _find_slot(tree, copy, path)
        if slot is not None:
            arguments.writes.append((slot, copy.id, f.var(variable.name)))
            arguments.origins.add(call.id)
        return
    if variable.owner is Owner.SYSTEM:
        return
    cases = None if text is None else _evaluate(tree, copy, str(text), variable)
    if pin is None or cases is None or direction != "in":
        arguments.gaps[variable.name] = f"the check does not follow the value of '{element.name}'"
        return
    performances.inputs.pop(variable.name, None)
    variable = replace(variable, owner=Owner.SYSTEM)
    is_bound = pin.attrs.get("value_kind") != "initial"
    arguments.values.append(Argument(variable, copy, cases, is_bound))


def _find_slot(tree: ObjectTree, copy: Copy, text: str) -> Slot | None:
    assert copy.caller.parent is not None
    object_: ComponentObject | None = copy.caller.parent.caller.owner
    try:
        name = name_of(parse_expression(text)) or ""
    except ExpressionError:
        return None
    if name in copy.caller.parent.parameters:
        return None
    type_name, _, own_name = name.rpartition("::")
    while object_ is not None:
        is_of_object = not type_name or object_.type_.name == type_name.rpartition("::")[2]
        if is_of_object and own_name in tree.context(object_).features:
            return tree.slot_of(object_.path, own_name)
        object_ = object_.owner
    return None


def _evaluate(
    tree: ObjectTree, copy: Copy, text: str, variable: Variable
) -> list[tuple[Formula, Formula]] | None:
    """Return the cases of the value of an argument; None if it is unknown."""
    parent = copy.caller.parent
    assert parent is not None

    def find_symbol(name: str) -> Symbol | None:
        own = parent.parameters.get(name)
        if own is not None:
            return Symbol(f.var(own.name), own.domain)
        object_: ComponentObject | None = parent.caller.owner
        while object_ is not None:
            feature = tree.context(object_).features.get(name)
            if feature is not None and feature.is_constant and feature.default is not None:
                return Symbol(f.const(feature.default), feature.domain)
            if feature is not None:
                shared = tree.read_slot(tree.slot_of(object_.path, name)).variable
                return Symbol(f.var(shared.name), shared.domain)
            object_ = object_.owner
        return find_literal(tree.context(tree.root), name)

    try:
        result = elaborate_value(parse_expression(text), find_symbol, variable.domain)
    except (ElaborationError, ExpressionError, ComponentError):
        return None
    if type(result.domain) is not type(variable.domain):
        return None
    if not isinstance(variable.domain, IntegerDomain) or not isinstance(
        result.domain, IntegerDomain
    ):
        return [(case.condition, case.value) for case in result.cases]
    return [
        (when, value)
        for case in result.cases
        for when, value, _ in split_by_range(
            case.condition, case.value, variable.domain, result.domain
        )
    ]
