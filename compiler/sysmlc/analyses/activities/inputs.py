"""Inputs of a token graph, and the scope in which guards, decisions and events read names.

Names and conditions are read with the common expression grammar.
"""

from collections.abc import Iterable, Mapping
from functools import partial

from msgspec.structs import replace

from sysmlc.analyses.activities import rules
from sysmlc.diagnostics import Sink
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.ir.expressions import (
    Expression,
    ExpressionError,
    name_of,
    walk_tree,
)
from sysmlc.ir.query import port_names, waits_for_change
from sysmlc.logic import formula as f
from sysmlc.logic.activities.token_nodes import Store
from sysmlc.logic.contract import (
    BooleanDomain,
    Domain,
    EnumerationDomain,
    IntegerDomain,
    Owner,
    Variable,
)
from sysmlc.logic.expressions.context import context_of, find_symbol, report_range
from sysmlc.logic.expressions.elaboration import (
    ELSEWHERE_ADVICE,
    EMPTY_ADVICE,
    FINITE_ADVICE,
    elaborate_condition,
    elaborate_value,
)
from sysmlc.logic.expressions.features import Feature, check_assignable
from sysmlc.logic.expressions.named_elements import describe_feature_elsewhere
from sysmlc.logic.expressions.parsing import (
    CanonicalCondition,
    explain_fault,
    tree_of,
)
from sysmlc.logic.expressions.symbols import ElaborationError, Fault, GuardedValue, Symbol
from sysmlc.logic.formula import Formula, var, variables
from sysmlc.logic.identifiers import Names, identifier, make_unique
from sysmlc.logic.machines.actions import OUT_OF_DOMAIN

_ALL_NUMBERS = IntegerDomain(-(2**31), 2**31 - 1)
_CLASSIFIERS = (Kind.CLASS, Kind.COMPONENT, Kind.DATA_TYPE, Kind.INTERFACE, Kind.ACTOR)


class UnreadableError(ValueError):
    """The text is not a condition over known properties; the message gives the reason.

    ``unknown`` is the first unknown name, or "" if the text has another fault. ``advice`` says how
    to correct the text; without it the advice of the rule applies. ``is_outside``: it compares a
    property with a number outside its declared range.
    """

    def __init__(
        self, message: str, unknown: str = "", advice: str = "", *, is_outside: bool = False
    ) -> None:
        super().__init__(message)
        self.unknown = unknown
        self.advice = advice
        self.is_outside = is_outside


class Scope:
    """Symbol table of an activity: its own properties and those of the classifier around it.

    An Integer without a range gets *assumed_range*.
    """

    def __init__(
        self, graph: Graph, activity: Element, assumed_range: tuple[int, int], sink: Sink
    ) -> None:
        above = (a for a in graph.ancestors(activity) if a.kind in _CLASSIFIERS)
        self._graph, self._sink, self._activity = graph, sink, activity
        self._outer = context_of(graph, next(above, None), assumed_range)
        self._inner = context_of(graph, activity, assumed_range)
        self._variables = {**self._outer.variables, **self._inner.variables}
        self._declared: dict[str, Formula] = {}

    def names(self) -> list[str]:
        """Return the names of the variables, which new variables must not reuse."""
        return list(self._variables.values())

    def _feature(self, name: str) -> Feature | None:
        return self._inner.features.get(name) or self._outer.features.get(name)

    def find_feature(self, name: str) -> Feature | None:
        """Return the feature of a name, with its domain."""
        return self._feature(name)

    def belongs_to_another_object(self, variable: str) -> bool:
        """Whether the variable stands for a feature of a part or of a referenced object."""
        return all(
            "." in name for name, candidate in self._variables.items() if candidate == variable
        )

    def belongs_to_a_part(self, variable: str) -> bool:
        """Whether the variable stands for a feature of a part of the object around the activity."""
        heads = (
            name.partition(".")[0]
            for name, candidate in self._variables.items()
            if candidate == variable and "." in name
        )
        # A parameter or an attribute of the activity hides a part of the same name.
        parts = (self._outer.features.get(h) for h in heads if h not in self._inner.variables)
        return self.belongs_to_another_object(variable) and any(
            part is not None and part.element.role == "part" for part in parts
        )

    def domain_of(self, variable: str) -> Domain:
        """Return the domain of a variable; Boolean if the variable stands for no property."""
        features = (
            self._feature(name)
            for name, candidate in self._variables.items()
            if candidate == variable
        )
        domains = (
            feature.domain
            for feature in features
            if feature is not None and feature.domain is not None
        )
        return next(domains, BooleanDomain())

    def declare_input(self, name: str) -> Variable | None:
        """Return an input variable for the property with this variable name, or None.

        Reports a range that the compiler assumes.
        """
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
        """Declare that a name stands for the formula of a Boolean input."""
        self._declared[name] = formula

    def read(self, text: str, *, has_any_numbers: bool = False) -> tuple[Formula, list[Variable]]:
        """Return a condition and its variables. Raises UnreadableError.

        With *has_any_numbers* it may compare properties with numbers outside their ranges.
        """
        find_symbol = self._find_unbounded if has_any_numbers else self._find_symbol
        try:
            expression = tree_of(text)
            formula = elaborate_condition(expression, find_symbol)
        except ExpressionError as error:
            raise UnreadableError(str(error)) from None
        except ElaborationError as error:
            if error.fault is Fault.UNKNOWN:
                activity = self._activity
                owner = describe_feature_elsewhere(self._graph, error.element, error.name)
                element = f"'{activity.name}'" if activity.name else "the activity"
                message = owner or f"'{error.name}' is no feature of {element} or its owner"
                advice = ELSEWHERE_ADVICE if owner else ""
                raise UnreadableError(message, error.name, advice) from None
            advice = FINITE_ADVICE if error.fault is Fault.UNSUPPORTED else ""
            is_outside = error.fault is Fault.OUTSIDE and not self._reads_assumed(expression)
            reason = explain_fault(error, expression)
            raise UnreadableError(reason, advice=advice, is_outside=is_outside) from None
        return formula, [
            v for v in map(self._make_input, _variable_names(formula)) if v is not None
        ]

    def is_condition(self, text: str, unknown: str) -> bool:
        """Whether the text is a condition if the name *unknown* is a Boolean."""
        trial = {**self._declared, unknown: var(unknown)}
        try:
            elaborate_condition(tree_of(text), partial(self._find_symbol, extra=trial))
        except ElaborationError as error:
            # Another unknown name is replaced in the next round of `Inputs.read_condition`.
            return error.fault is Fault.UNKNOWN and error.name != unknown
        return True

    def _find_symbol(
        self, name: str, element: str, extra: dict[str, Formula] | None = None
    ) -> Symbol | None:
        declared = self._declared if extra is None else extra
        if name in declared:
            return Symbol(declared[name], BooleanDomain())
        is_outer = name in self._outer.variables and name not in self._inner.variables
        return find_symbol(self._outer if is_outer else self._inner, name, element)

    def _find_unbounded(self, name: str, element: str) -> Symbol | None:
        symbol = self._find_symbol(name, element)
        is_number = symbol is not None and isinstance(symbol.domain, IntegerDomain)
        return replace(symbol, domain=_ALL_NUMBERS) if symbol and is_number else symbol

    def _reads_assumed(self, expression: Expression) -> bool:
        """Whether an expression reads a property with an assumed range."""
        names = (name_of(part) for part in walk_tree(expression))
        features = (self._feature(name) for name in names if name)
        return any(feature is not None and feature.is_assumed for feature in features)

    def _make_input(self, name: str) -> Variable | None:
        for feature in (
            self._feature(label) for label, variable in self._variables.items() if variable == name
        ):
            if feature is not None and feature.domain is not None:
                report_range(self._graph, feature, self._sink)
                return feature.make_variable(Owner.ENVIRONMENT)
        return None


def _variable_names(formula: Formula) -> list[str]:
    return list(dict.fromkeys(variable.name for variable in variables(formula)))


# -- inputs ------------------------------------------------------------------------------------

OTHER = "other"
"""The value of a decision's input that stands for all values without a guard."""


class Inputs:
    """The variables of the environment that one activity reads."""

    def __init__(self, graph: Graph, scope: Scope, sink: Sink) -> None:
        self.graph = graph
        self.names = Names(*scope.names())
        self.variables: dict[str, Variable] = {}
        self.pulses: list[str] = []
        self.receivers: dict[str, list[Element]] = {}
        """The accept actions that wait for an event, by the name of the event."""
        self._scope = scope
        self._sink = sink
        self._by_condition: dict[str, str] = {}
        self.memories: dict[Formula, Store] = {}
        """The variables that tell whether conditions held in the step before."""

    def declare_pulse(self, prefix: str, origin: Element) -> Formula:
        """Declare an event and return its formula: an input that holds in single steps."""
        name = self._declare(prefix, BooleanDomain(), origin)
        self.pulses.append(name)
        return f.var(name)

    def share_event(self, wanted: str, origin: Element) -> Formula:
        """Return the formula of an event that several actions may await; declare a new event."""
        if wanted not in self.variables:
            return self.declare_pulse(wanted, origin)
        return f.var(wanted)

    def remember_condition(self, condition: Formula, text: str, origin: Element) -> Formula:
        """Return the formula that a condition held in the step before.

        Nothing becomes true in the first step: its values were there before.
        """
        if condition not in self.memories:
            name = self.names.new(f"was_{identifier(text, 'condition')}")
            facts = name, Owner.SYSTEM, BooleanDomain(), origin.id
            variable = Variable(*facts, is_auxiliary=True)
            self.memories[condition] = Store(variable, (), True, follows=condition)
        return f.var(self.memories[condition].variable.name)

    def read_condition(self, text: str, origin: Element, what: str) -> Formula:
        """Return the formula of a text. Unknown names in it become Boolean inputs.

        A text that is not a condition becomes a Boolean input as a whole; an empty one becomes an
        input of *origin* alone.
        """
        if not text:
            error = UnreadableError("it has no text that can be read", advice=EMPTY_ADVICE)
            return self._declare_unreadable("", origin, what, error)
        is_outside = False
        # The loop ends because each round declares one more name of the text.
        while True:
            try:
                formula, variables = self._scope.read(text, has_any_numbers=is_outside)
            except UnreadableError as error:
                if error.is_outside and not is_outside:
                    is_outside = True
                    subject, reason = self.graph.subject(origin), str(error)
                    self._sink.report(OUT_OF_DOMAIN, subject, what=what, text=text, reason=reason)
                    continue
                if not error.unknown or not self._scope.is_condition(text, error.unknown):
                    return self._declare_unreadable(text, origin, what, error)
                replacement = self._declare_unreadable(error.unknown, origin, what, error)
                self._scope.declare(error.unknown, replacement)
                continue
            for variable in variables:
                self.variables.setdefault(variable.name, variable)
            return formula

    def _declare_unreadable(
        self, text: str, origin: Element, what: str, error: "UnreadableError"
    ) -> Formula:
        """Report a condition without formula and return the input for it, or its negation.

        The spellings of a condition and of its opposite share an input.
        """
        condition = CanonicalCondition.read(text, origin.id)
        name, is_negated = condition.find_input(self._by_condition)
        if not name:
            is_negated = condition.is_negated
            name = self._declare(identifier(condition.text, "condition"), BooleanDomain(), origin)
            self.variables[name] = replace(
                self.variables[name], condition=condition.text or what, reason=str(error)
            )
            self._by_condition[condition.key] = name
        self._sink.report(
            rules.UNREADABLE,
            self.graph.subject(origin),
            help=error.advice,
            condition=f"{what} '{text}'" if text else what,
            reason=str(error),
            treatment=f"the {'negation of the ' * is_negated}input '{name}'",
        )
        return f.negate(f.var(name)) if is_negated else f.var(name)

    def declare_decision_input(
        self, prefix: str, literals: Iterable[str], origin: Element
    ) -> "DecisionInput":
        """Declare the input that a decision compares with the literals on its branches.

        A literal can be any text, such as ``0``. Formulas refer to it by an identifier.
        """
        texts = list(dict.fromkeys(literals))
        if set(texts) <= {"true", "false"}:
            return DecisionInput(f.var(self._declare(prefix, BooleanDomain(), origin)), None)
        other, *values = make_unique([OTHER, *texts], "value")
        variable = f.var(self._declare(prefix, EnumerationDomain((*values, other)), origin))
        return DecisionInput(variable, dict(zip(texts, values, strict=True)))

    def _declare(self, prefix: str, domain: Domain, origin: Element) -> str:
        name = self.names.new(prefix)
        self.variables[name] = Variable(name, Owner.ENVIRONMENT, domain, origin.id)
        return name


class DecisionInput:
    """The input that a decision compares with its literal guards.

    *value_names* maps literals to values of the enumeration; it is None for a Boolean input.
    """

    def __init__(self, variable: Formula, value_names: Mapping[str, str] | None) -> None:
        self._variable = variable
        self._value_names = value_names

    def equals(self, literal: str) -> Formula:
        """Return the condition that the input equals the literal."""
        if self._value_names is None:
            return self._variable if literal == "true" else f.negate(self._variable)
        return f.eq(self._variable, f.const(self._value_names[literal]))

    def is_covered(self, literals: list[str]) -> bool:
        """Whether the input equals one of the literals in every step."""
        return self._value_names is None and {"true", "false"} <= set(literals)


def read_events(inputs: Inputs, action: Element) -> Formula:
    """Return the condition that ends an accept action, and record the action for its events."""
    triggers = _list_triggers(inputs.graph, action)
    if not triggers:
        name = f"receive_{identifier(action.name, 'event')}"
        inputs.receivers.setdefault(name, []).append(action)
        return inputs.declare_pulse(name, action)
    return f.either(*[_read_event(inputs, trigger, action) for trigger in triggers])


def describe_events(graph: Graph, action: Element) -> str:
    """Return in words what ends an accept action, such as "Go comes or 'level > 2' holds".

    The result is empty if time ends the action, because time passes by itself.
    """
    triggers = _list_triggers(graph, action)
    if any(trigger.subkind == "time" for trigger in triggers):
        return ""
    events = dict.fromkeys(_describe_event(graph, trigger) for trigger in triggers)
    return " or ".join(events) or "an event comes"


def _describe_event(graph: Graph, trigger: Element) -> str:
    condition = trigger.attrs.get("condition")
    if trigger.subkind == "change" and condition:
        verb = "becomes true" if waits_for_change(trigger) else "holds"
        return f"'{condition}' {verb}"
    type_ = graph.target(trigger, Edge.TYPED_BY)
    name = (type_.name if type_ else "") or trigger.name
    if not name:
        return "an event comes"
    return f"{name} comes" if name.isidentifier() else f"'{name}' comes"


def _list_triggers(graph: Graph, action: Element) -> list[Element]:
    owned = (element for element in graph.owned(action) if element.kind == "Trigger")
    return list(dict.fromkeys([*graph.targets(action, Edge.TRIGGER), *owned]))


def _read_event(inputs: Inputs, trigger: Element, action: Element) -> Formula:
    if trigger.subkind == "change" and trigger.attrs.get("condition"):
        text = str(trigger.attrs["condition"])
        condition = inputs.read_condition(text, action, "the change condition")
        if waits_for_change(trigger):
            was_true = inputs.remember_condition(condition, text, trigger)
            return f.both(condition, f.negate(was_true))
        return condition
    name = _name_event(inputs.graph, trigger, action)
    inputs.receivers.setdefault(name, []).append(action)
    return inputs.share_event(name, trigger)


def _name_event(graph: Graph, trigger: Element, action: Element) -> str:
    """Return the name of the input for an event; it names the port if it comes at several."""
    type_ = graph.target(trigger, Edge.TYPED_BY)
    prefix = {"call": "call", "time": "time", "change": "change"}.get(trigger.subkind, "receive")
    subject = (type_.name if type_ else "") or trigger.name or str(trigger.attrs.get("when", ""))
    name = f"{prefix}_{identifier(subject, 'event')}"
    path = port_names(graph, trigger)
    if not path or type_ is None:
        return name
    activity = next(above for above in graph.ancestors(action) if above.kind is Kind.ACTIVITY)
    paths = {
        port_names(graph, sibling)
        for sibling in graph.sources(type_, Edge.TYPED_BY)
        if sibling.kind is Kind.TRIGGER and activity in graph.ancestors(sibling)
    }
    port_name = identifier("_".join(path), "port")
    return f"{name}_via_{port_name}" if len(paths) > 1 else name
