"""Resolves the names in a requirement to features of its subject or variables of a behaviour."""

import re
from collections.abc import Iterable, Mapping

from msgspec import Struct

from sysmlc.ir import Kind
from sysmlc.logic.contract import Contract, Domain, Owner, Variable
from sysmlc.logic.expressions.context import Context
from sysmlc.logic.expressions.elaboration import Symbol, find_literal
from sysmlc.logic.expressions.features import Feature
from sysmlc.logic.formula import Apply, Const, Formula, Literal, Var, var, variables
from sysmlc.logic.simplification import rebuild

_DOTTED_NAME = re.compile(r"[^\W\d]\w*(?:\.[^\W\d]\w*)+")


class Scope(Struct, frozen=True):
    """What the names in the formulas about a subject denote: its variables and constants."""

    context: Context
    variables: Mapping[str, Variable]
    constants: Mapping[str, Literal]

    @property
    def domains(self) -> dict[str, Domain]:
        """The domains of all names that a formula in temporal logic may use."""
        features = self.context.features.values()
        domains = {
            feature.variable: feature.domain for feature in features if feature.domain is not None
        }
        return domains | {name: variable.domain for name, variable in self.variables.items()}

    def find_symbol(self, name: str) -> Symbol | None:
        """Return what a dotted name in an expression denotes, or None.

        The name of the subject may precede the name of the feature.
        """
        feature = self.find_feature(name)
        if feature is not None:
            constant = self.constants.get(feature.variable)
            formula = var(feature.variable) if constant is None else Const(constant)
            return Symbol(formula, feature.domain)
        variable = self.variables.get(name)
        if variable is None:
            return find_literal(self.context, name)
        return Symbol(var(name), variable.domain)

    def find_feature(self, name: str) -> Feature | None:
        """Return the feature with this name, or with the name after the first dot."""
        features = self.context.features
        return features.get(name) or features.get(name.partition(".")[2])

    def replace_dotted_names(self, text: str) -> str:
        """Replace dotted names (``level.value``, ``tank.filling``) by variables.

        A variable is padded with blanks to the length of the name, so that columns in messages are
        those of *text*; they are not if a variable is longer than the name.
        """
        return _DOTTED_NAME.sub(self._pad_variable, text)

    def _pad_variable(self, match: re.Match[str]) -> str:
        feature = self.find_feature(match[0])
        return match[0] if feature is None else feature.variable.ljust(len(match[0]))

    def substitute_constants(self, formula: Formula) -> Formula:
        """Replace constants by their values, also where they are primed."""
        match formula:
            case Var(name) if name in self.constants:
                return Const(self.constants[name])
            case Apply(op, args):
                return rebuild(op, tuple(self.substitute_constants(arg) for arg in args))
            case _:
                return formula

    def select_variables(self, formulas: Iterable[Formula]) -> tuple[Variable, ...]:
        """Return the variables of the formulas, in the order in which the subject declares them."""
        names = {variable.name for formula in formulas for variable in variables(formula)}
        return tuple(variable for name, variable in self.variables.items() if name in names)

    def is_about_inputs(self, formula: Formula) -> bool:
        """Whether the formula has variables, and the environment decides all of them."""
        owners = {self.variables[variable.name].owner for variable in variables(formula)}
        return owners == {Owner.ENVIRONMENT}


def scope_of(context: Context, behaviour: Contract | None) -> Scope:
    """Return the scope of a subject; variables of its behaviour's contract hide its features."""
    constants: dict[str, Literal] = {}
    feature_variables: dict[str, Variable] = {}
    for feature in context.features.values():
        if feature.is_constant and feature.default is not None:
            constants[feature.variable] = feature.default
        elif feature.domain is not None:
            feature_variables[feature.variable] = Variable(
                feature.variable, _find_owner(feature), feature.domain, feature.element.id
            )
    variables_of_behaviour = () if behaviour is None else behaviour.variables
    by_name = {variable.name: variable for variable in variables_of_behaviour}
    return Scope(context, feature_variables | by_name, constants)


def _find_owner(feature: Feature) -> Owner:
    """Return the environment for inputs, else the system.

    A parameter without a direction is an input, which is the default of UML.
    """
    default_direction = "in" if feature.element.kind is Kind.PARAMETER else "out"
    is_input = (feature.direction or default_direction) == "in"
    return Owner.ENVIRONMENT if is_input else Owner.SYSTEM
