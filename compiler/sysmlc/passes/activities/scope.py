"""Names and conditions in an activity, read with the common expression grammar."""

from sysmlc.diagnostics import Sink
from sysmlc.ir import Element, Graph, Kind
from sysmlc.logic.contract import BooleanDomain, Domain, IntegerDomain, Owner, Variable
from sysmlc.logic.expressions.context import context_of, report_range
from sysmlc.logic.expressions.elaboration import (
    ElaborationError,
    Fault,
    GuardedValue,
    Symbol,
    elaborate_condition,
    elaborate_value,
)
from sysmlc.logic.expressions.expression import Expression, ExpressionError
from sysmlc.logic.expressions.features import Feature
from sysmlc.logic.expressions.parsing import parse_expression
from sysmlc.logic.formula import Formula, const, var, variables
from sysmlc.logic.machines.actions import check_assignable

_CLASSIFIERS = (Kind.CLASS, Kind.COMPONENT, Kind.DATA_TYPE, Kind.INTERFACE, Kind.ACTOR)


class UnreadableError(ValueError):
    """The text is no condition over known properties; the message gives the reason.

    ``unknown`` is the unknown name, if the rest of the text could be read.
    """

    def __init__(self, message: str, unknown: str = "") -> None:
        super().__init__(message)
        self.unknown = unknown


class Scope:
    """The names that an activity knows: its own properties and those of its context."""

    def __init__(self, graph: Graph, activity: Element, sink: Sink) -> None:
        above = (a for a in graph.ancestors(activity) if a.kind in _CLASSIFIERS)
        self._graph, self._sink = graph, sink
        self._outer = context_of(graph, next(above, None))
        self._inner = context_of(graph, activity)
        self._variables = {**self._outer.variables, **self._inner.variables}
        self._extra: dict[str, Formula] = {}

    def names(self) -> list[str]:
        """Return the names of variables, which no other variable may have."""
        return list(self._variables.values())

    def find_element(self, name: str) -> Element | None:
        """Return the property or parameter of a name."""
        feature = self._feature(name) or self._feature(name.removeprefix("self."))
        return None if feature is None else feature.element

    def _feature(self, name: str) -> Feature | None:
        return self._inner.features.get(name) or self._outer.features.get(name)

    def find_feature(self, name: str) -> Feature | None:
        """Return the feature of a name, with its domain."""
        return self._feature(name)

    def belongs_to_another_object(self, variable: str) -> bool:
        """Whether the variable stands for a feature of a part or of a referenced object."""
        return all("." in name for name, known in self._variables.items() if known == variable)

    def domain_of(self, variable: str) -> Domain:
        """Return the domain of a variable; Boolean if the variable stands for no property."""
        features = (
            self._feature(name) for name, known in self._variables.items() if known == variable
        )
        domains = (
            feature.domain
            for feature in features
            if feature is not None and feature.domain is not None
        )
        return next(domains, BooleanDomain())

    def declare_input(self, name: str) -> Variable | None:
        """Return the variable of a property as an input. Reports an assumed range."""
        return self._make_input(name)

    def evaluate(self, expression: Expression, domain: Domain) -> GuardedValue:
        """Return the values of an expression. Numbers may lie outside *domain*.

        Raises ElaborationError if the expression has no value of the domain's type.
        """
        result = elaborate_value(expression, self._find_symbol, domain)
        if not isinstance(result.domain, IntegerDomain) or not isinstance(domain, IntegerDomain):
            check_assignable(result.domain, domain, expression)
        return result

    def declare(self, name: str, formula: Formula) -> None:
        """Let a name stand for a Boolean input from now on."""
        self._extra[name] = formula

    def read(self, text: str) -> tuple[Formula, list[Variable]]:
        """Return a condition and its variables. Raises UnreadableError."""
        try:
            expression = parse_expression(text)
            formula = elaborate_condition(expression, self._find_symbol)
        except ExpressionError as error:
            raise UnreadableError(str(error)) from None
        except ElaborationError as error:
            unknown = error.name if error.fault is Fault.UNKNOWN else ""
            raise UnreadableError(str(error), unknown) from None
        return formula, [
            v for v in map(self._make_input, _variable_names(formula)) if v is not None
        ]

    def is_condition(self, text: str, unknown: str) -> bool:
        """Whether the text could be read if *unknown* were a Boolean."""
        trial = {**self._extra, unknown: var(unknown)}
        try:
            elaborate_condition(parse_expression(text), lambda name: self._find_symbol(name, trial))
        except ElaborationError as error:
            return error.fault is Fault.UNKNOWN and error.name != unknown
        return True

    def _find_symbol(self, name: str, extra: dict[str, Formula] | None = None) -> Symbol | None:
        declared = self._extra if extra is None else extra
        if name in declared:
            return Symbol(declared[name], BooleanDomain())
        feature = self._feature(name)
        if feature is not None:
            return Symbol(_feature_value(feature), feature.domain)
        return self._find_literal(name)

    def _find_literal(self, name: str) -> Symbol | None:
        literals = self._outer.literals
        entry = literals.get(name)
        if entry is None:
            return None
        enumeration, literal = entry
        domain = self._outer.enumerations.domains[enumeration]
        return Symbol(const(literal), domain, self._outer.number(name))

    def _make_input(self, name: str) -> Variable | None:
        for feature in (
            self._feature(label) for label, variable in self._variables.items() if variable == name
        ):
            if feature is not None and feature.domain is not None:
                report_range(self._graph, feature, self._sink)
                return Variable(name, Owner.ENVIRONMENT, feature.domain, feature.element.id)
        return None


def _variable_names(formula: Formula) -> list[str]:
    return list(dict.fromkeys(variable.name for variable in variables(formula)))


def _feature_value(feature: Feature) -> Formula:
    if feature.is_constant and feature.default is not None:
        return const(feature.default)
    return var(feature.variable)
