"""What the names in a requirement mean: features of its subject, variables of its behaviour."""

import re
from collections.abc import Iterable, Mapping

from msgspec import Struct

from sysmlc.ir import Kind
from sysmlc.logic.contract import Contract, Domain, Owner, Variable
from sysmlc.logic.expressions.context import Context
from sysmlc.logic.expressions.declared import Feature
from sysmlc.logic.expressions.elaborate import Symbol, literal_of
from sysmlc.logic.formula import Apply, Const, Formula, Literal, Var, var, variables
from sysmlc.logic.simplify import rebuild

_DOTTED = re.compile(r"[^\W\d]\w*(?:\.[^\W\d]\w*)+")


class Scope(Struct, frozen=True):
    """Variables and constants by the names that formulas have for them."""

    context: Context
    variables: Mapping[str, Variable]
    constants: Mapping[str, Literal]

    @property
    def domains(self) -> dict[str, Domain]:
        """Domains of all that a formula in temporal logic may name."""
        features = self.context.features.values()
        known = {one.variable: one.domain for one in features if one.domain is not None}
        return known | {name: one.domain for name, one in self.variables.items()}

    def symbol(self, name: str) -> Symbol | None:
        """What a dotted name of an expression stands for; the subject may stand before it."""
        feature = self.feature(name)
        if feature is not None:
            fixed = self.constants.get(feature.variable)
            formula = var(feature.variable) if fixed is None else Const(fixed)
            return Symbol(formula, feature.domain)
        known = self.variables.get(name)
        return literal_of(self.context, name) if known is None else Symbol(var(name), known.domain)

    def feature(self, name: str) -> Feature | None:
        """The feature of the subject that a dotted name leads to."""
        known = self.context.features
        return known.get(name) or known.get(name.partition(".")[2])

    def undotted(self, text: str) -> str:
        """A formula with variables for dotted names (``level.value``, ``tank.filling``).

        What follows stays in its column, where there is room.
        """
        return _DOTTED.sub(self._variable, text)

    def _variable(self, found: re.Match[str]) -> str:
        feature = self.feature(found[0])
        return found[0] if feature is None else feature.variable.ljust(len(found[0]))

    def settled(self, formula: Formula) -> Formula:
        """The formula with the values of constants in their places, in this step and the next."""
        match formula:
            case Var(name) if name in self.constants:
                return Const(self.constants[name])
            case Apply(op, args):
                return rebuild(op, tuple(self.settled(arg) for arg in args))
            case _:
                return formula

    def used(self, formulas: Iterable[Formula]) -> tuple[Variable, ...]:
        """The variables of the formulas, in the order in which the subject declares them."""
        names = {one.name for formula in formulas for one in variables(formula)}
        return tuple(one for name, one in self.variables.items() if name in names)

    def is_input(self, formula: Formula) -> bool:
        """Whether it speaks of what the environment decides, and of nothing else."""
        owners = {self.variables[one.name].owner for one in variables(formula)}
        return owners == {Owner.ENVIRONMENT}


def scope_of(context: Context, behaviour: Contract | None) -> Scope:
    """The scope that a subject gives; variables of its behaviour's contract go before."""
    fixed: dict[str, Literal] = {}
    own: dict[str, Variable] = {}
    for one in context.features.values():
        if one.constant and one.default is not None:
            fixed[one.variable] = one.default
        elif one.domain is not None:
            own[one.variable] = Variable(one.variable, _owner(one), one.domain, one.element.id)
    known = () if behaviour is None else behaviour.variables
    return Scope(context, own | {one.name: one for one in known}, fixed)


def _owner(feature: Feature) -> Owner:
    """Inputs are the environment's; outputs and what the subject has itself are its own."""
    usual = "in" if feature.element.kind is Kind.PARAMETER else "out"
    is_input = (feature.direction or usual) == "in"
    return Owner.ENVIRONMENT if is_input else Owner.SYSTEM
