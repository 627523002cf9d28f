"""Guards and conditions, read with the one expression grammar in the context of the activity."""

from sysmlc.diagnostics import Sink
from sysmlc.ir import Element, Graph, Kind
from sysmlc.logic.contract import BooleanDomain, Domain, EnumerationDomain, Owner, Variable
from sysmlc.logic.expressions.context import Feature, context_of, note_range
from sysmlc.logic.expressions.elaborate import ElaborationError, Fault, Symbol, condition
from sysmlc.logic.expressions.expression import ExpressionError, parse_expression
from sysmlc.logic.formula import Formula, const, var, variables

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
        outer = context_of(graph, next(above, None))
        inner = context_of(graph, activity)
        self._features: dict[str, Feature] = {**outer.features, **inner.features}
        self._literals, self._numbers = outer.literals, outer.numbers
        self._extra: dict[str, Formula] = {}

    def names(self) -> list[str]:
        """Names that must not be given to other variables."""
        return [feature.variable for feature in self._features.values()]

    def feature(self, name: str) -> Element | None:
        """The property or parameter of a name."""
        found = self._features.get(name) or self._features.get(name.removeprefix("self."))
        return None if found is None else found.element

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
        feature = self._features.get(name)
        if feature is not None:
            return Symbol(_value(feature), feature.domain)
        return self._literal(name)

    def _literal(self, name: str) -> Symbol | None:
        found = self._literals.get(name)
        if found is None:
            return None
        enumeration, literal = found
        named = [made for owner, made in self._literals.values() if owner == enumeration]
        domain = EnumerationDomain(tuple(dict.fromkeys(named)))
        return Symbol(const(literal), domain, self._numbers.get(name))

    def _variable(self, name: str) -> Variable | None:
        for feature in self._features.values():
            if feature.variable == name and feature.domain is not None:
                domain: Domain = feature.domain
                note_range(self._graph, feature, self._sink)
                return Variable(name, Owner.ENVIRONMENT, domain, feature.element.id)
        return None


def _names(formula: Formula) -> list[str]:
    return list(dict.fromkeys(found.name for found in variables(formula)))


def _value(feature: Feature) -> Formula:
    if feature.constant and feature.default is not None:
        return const(feature.default)
    return var(feature.variable)
