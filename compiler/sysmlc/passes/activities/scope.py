"""Guards and conditions, read with the one expression grammar in the context of the activity."""

from sysmlc.diagnostics import Sink
from sysmlc.ir import Element, Graph, Kind
from sysmlc.logic.contract import BooleanDomain, Domain, IntegerDomain, Owner, Variable
from sysmlc.logic.expressions.context import context_of, note_range
from sysmlc.logic.expressions.declared import Feature
from sysmlc.logic.expressions.elaborate import (
    ElaborationError,
    Fault,
    Meaning,
    Symbol,
    condition,
    meaning,
)
from sysmlc.logic.expressions.expression import (
    Expression,
    ExpressionError,
    parse_expression,
)
from sysmlc.logic.formula import Formula, const, var, variables
from sysmlc.logic.machines.actions import check_assignable

_CLASSIFIERS = (Kind.CLASS, Kind.COMPONENT, Kind.DATA_TYPE, Kind.INTERFACE, Kind.ACTOR)


class UnreadableError(ValueError):
    """The text is no condition over known properties; the message says why.

    ``unknown`` is the name that isn't known, when the rest of the text could be read.
    """

    def __init__(self, message: str, unknown: str = "") -> None:
        super().__init__(message)
        self.unknown = unknown


class Scope:
    """The names that an activity knows: properties of its own and of its context."""

    def __init__(self, graph: Graph, activity: Element, sink: Sink) -> None:
        above = (a for a in graph.ancestors(activity) if a.kind in _CLASSIFIERS)
        self._graph, self._sink = graph, sink
        self._outer = context_of(graph, next(above, None))
        self._inner = context_of(graph, activity)
        self._variables = {**self._outer.variables, **self._inner.variables}
        self._extra: dict[str, Formula] = {}

    def names(self) -> list[str]:
        """Names that must not be given to other variables."""
        return list(self._variables.values())

    def feature(self, name: str) -> Element | None:
        """The property or parameter of a name."""
        found = self._feature(name) or self._feature(name.removeprefix("self."))
        return None if found is None else found.element

    def _feature(self, name: str) -> Feature | None:
        return self._inner.features.get(name) or self._outer.features.get(name)

    def named(self, name: str) -> Feature | None:
        """The feature of a name, with the values that it may have."""
        return self._feature(name)

    def is_of_another(self, variable: str) -> bool:
        """Whether the variable stands for a feature of a part or of what a reference leads to."""
        return all("." in name for name, one in self._variables.items() if one == variable)

    def domain(self, variable: str) -> Domain:
        """The values that a variable may have; what stands for no property is Boolean."""
        known = (self._feature(name) for name, one in self._variables.items() if one == variable)
        found = (one.domain for one in known if one is not None and one.domain is not None)
        return next(found, BooleanDomain())

    def variable(self, name: str) -> Variable | None:
        """The variable of a property as an input; reports the range that it is given."""
        return self._variable(name)

    def value(self, expression: Expression, domain: Domain) -> Meaning:
        """The values that an expression has. Raises ElaborationError when it has none of the
        domain's kind; numbers may lie outside.
        """
        found = meaning(expression, self._symbol, domain)
        if not isinstance(found.domain, IntegerDomain) or not isinstance(domain, IntegerDomain):
            check_assignable(found.domain, domain, expression)
        return found

    def declare(self, name: str, formula: Formula) -> None:
        """Let a name stand for a Boolean input from now on."""
        self._extra[name] = formula

    def read(self, text: str) -> tuple[Formula, list[Variable]]:
        """The condition and its variables. Raises UnreadableError."""
        try:
            expression = parse_expression(text)
            formula = condition(expression, self._symbol)
        except ExpressionError as error:
            raise UnreadableError(str(error)) from None
        except ElaborationError as error:
            unknown = error.name if error.fault is Fault.UNKNOWN else ""
            raise UnreadableError(str(error), unknown) from None
        return formula, [v for v in map(self._variable, _names(formula)) if v is not None]

    def is_condition(self, text: str, unknown: str) -> bool:
        """Whether the text could be read if ``unknown`` were a Boolean."""
        trial = {**self._extra, unknown: var(unknown)}
        try:
            condition(parse_expression(text), lambda name: self._symbol(name, trial))
        except ElaborationError as error:
            return error.fault is Fault.UNKNOWN and error.name != unknown
        return True

    def _symbol(self, name: str, extra: dict[str, Formula] | None = None) -> Symbol | None:
        known = self._extra if extra is None else extra
        if name in known:
            return Symbol(known[name], BooleanDomain())
        feature = self._feature(name)
        if feature is not None:
            return Symbol(_value(feature), feature.domain)
        return self._literal(name)

    def _literal(self, name: str) -> Symbol | None:
        literals = self._outer.literals
        found = literals.get(name)
        if found is None:
            return None
        enumeration, literal = found
        domain = self._outer.enumerations.domains[enumeration]
        return Symbol(const(literal), domain, self._outer.number(name))

    def _variable(self, name: str) -> Variable | None:
        for feature in (
            self._feature(known) for known, one in self._variables.items() if one == name
        ):
            if feature is not None and feature.domain is not None:
                note_range(self._graph, feature, self._sink)
                return Variable(name, Owner.ENVIRONMENT, feature.domain, feature.element.id)
        return None


def _names(formula: Formula) -> list[str]:
    return list(dict.fromkeys(found.name for found in variables(formula)))


def _value(feature: Feature) -> Formula:
    if feature.constant and feature.default is not None:
        return const(feature.default)
    return var(feature.variable)
