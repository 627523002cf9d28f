"""Inputs of a token graph: the variables that guards, decisions and events read."""

from collections.abc import Iterable, Mapping

from sysmlc.diagnostics import Sink
from sysmlc.ir import Edge, Element, Graph
from sysmlc.logic import formula as f
from sysmlc.logic.contract import BooleanDomain, Domain, EnumerationDomain, Owner, Variable
from sysmlc.logic.formula import Formula
from sysmlc.logic.names import Names, identifier, unique
from sysmlc.passes.activities import rules
from sysmlc.passes.activities.scope import Scope, UnreadableError

OTHER = "other"
"""The value of a decision's input that none of its guards names."""


class Inputs:
    """The variables of the environment that one activity reads."""

    def __init__(self, graph: Graph, scope: Scope, sink: Sink) -> None:
        self.graph = graph
        self.names = Names(*scope.names())
        self.variables: dict[str, Variable] = {}
        self.pulses: list[str] = []
        self._scope = scope
        self._sink = sink
        self._by_text: dict[str, str] = {}

    def declare_pulse(self, prefix: str, origin: Element) -> Formula:
        """Declare an event that nothing else waits for."""
        name = self._declare(prefix, BooleanDomain(), origin)
        self.pulses.append(name)
        return f.var(name)

    def share_event(self, wanted: str, origin: Element) -> Formula:
        """Return an event that several actions may wait for, declared at the first request."""
        if wanted not in self.variables:
            return self.declare_pulse(wanted, origin)
        return f.var(wanted)

    def read_condition(self, text: str, origin: Element, what: str) -> Formula:
        """Return the formula of a text. A part that cannot be read becomes a Boolean input."""
        while True:
            try:
                formula, variables = self._scope.read(text)
            except UnreadableError as error:
                if not error.unknown or not self._scope.is_condition(text, error.unknown):
                    return self._declare_unreadable(text, origin, what, str(error))
                replacement = self._declare_unreadable(error.unknown, origin, what, str(error))
                self._scope.declare(error.unknown, replacement)
                continue
            for variable in variables:
                self.variables.setdefault(variable.name, variable)
            return formula

    def _declare_unreadable(self, text: str, origin: Element, what: str, reason: str) -> Formula:
        name = self._by_text.get(text)
        if name is None:
            name = self._declare(identifier(text, "condition"), BooleanDomain(), origin)
            self._by_text[text] = name
        subject = self.graph.subject(origin)
        self._sink.report(
            rules.UNREADABLE, subject, what=what, text=text, reason=reason, variable=name
        )
        return f.var(name)

    def declare_answer(self, prefix: str, literals: Iterable[str], origin: Element) -> "Answer":
        """Declare the input that a decision compares with the literals on its branches.

        A literal can be any text, such as ``0``. Formulas refer to it by an identifier.
        """
        texts = list(dict.fromkeys(literals))
        if set(texts) <= {"true", "false"}:
            return Answer(f.var(self._declare(prefix, BooleanDomain(), origin)), None)
        other, *values = unique([OTHER, *texts], "value")
        variable = f.var(self._declare(prefix, EnumerationDomain((*values, other)), origin))
        return Answer(variable, dict(zip(texts, values, strict=True)))

    def _declare(self, prefix: str, domain: Domain, origin: Element) -> str:
        name = self.names.new(prefix)
        self.variables[name] = Variable(name, Owner.ENVIRONMENT, domain, origin.id)
        return name


class Answer:
    """The input of a decision. It is Boolean if its values have no names."""

    def __init__(self, variable: Formula, value_names: Mapping[str, str] | None) -> None:
        self._variable = variable
        self._value_names = value_names

    def equals(self, literal: str) -> Formula:
        """Return the condition that the input equals the literal."""
        if self._value_names is None:
            return self._variable if literal == "true" else f.negate(self._variable)
        return f.eq(self._variable, f.const(self._value_names[literal]))

    def is_covered(self, literals: list[str]) -> bool:
        """Whether the input always equals one of the literals."""
        return self._value_names is None and {"true", "false"} <= set(literals)


def read_events(inputs: Inputs, action: Element) -> tuple[Formula, list[str]]:
    """Return the condition that ends an accept action, and the names of its events."""
    graph = inputs.graph
    triggers = dict.fromkeys(
        [*graph.targets(action, Edge.TRIGGER), *_owned_triggers(graph, action)]
    )
    if not triggers:
        name = f"receive_{identifier(action.name, 'event')}"
        return inputs.declare_pulse(name, action), [name]
    events = [_read_event(inputs, trigger, action) for trigger in triggers]
    return f.either(*(formula for formula, _ in events)), [name for _, name in events if name]


def _owned_triggers(graph: Graph, action: Element) -> list[Element]:
    return [element for element in graph.owned(action) if element.kind == "Trigger"]


def _read_event(inputs: Inputs, trigger: Element, action: Element) -> tuple[Formula, str]:
    if trigger.subkind == "change" and trigger.attrs.get("condition"):
        text = str(trigger.attrs["condition"])
        return inputs.read_condition(text, action, "the change condition"), ""
    name = _name_event(inputs.graph, trigger)
    return inputs.share_event(name, trigger), name


def _name_event(graph: Graph, trigger: Element) -> str:
    type_ = graph.target(trigger, Edge.TYPED_BY)
    prefix = {"call": "call", "time": "time", "change": "change"}.get(trigger.subkind, "receive")
    subject = (type_.name if type_ else "") or trigger.name or str(trigger.attrs.get("when", ""))
    return f"{prefix}_{identifier(subject, 'event')}"
