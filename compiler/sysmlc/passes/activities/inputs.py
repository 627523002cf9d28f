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
    """Collects the environment's variables of one activity."""

    def __init__(self, graph: Graph, scope: Scope, sink: Sink) -> None:
        self.graph = graph
        self.names = Names(*scope.names())
        self.variables: dict[str, Variable] = {}
        self.pulses: list[str] = []
        self._scope = scope
        self._sink = sink
        self._by_text: dict[str, str] = {}

    def pulse(self, wanted: str, origin: Element) -> Formula:
        """An event of its own."""
        name = self._declare(wanted, BooleanDomain(), origin)
        self.pulses.append(name)
        return f.var(name)

    def event(self, wanted: str, origin: Element) -> Formula:
        """An event that others may wait for, too."""
        if wanted not in self.variables:
            return self.pulse(wanted, origin)
        return f.var(wanted)

    def condition(self, text: str, origin: Element, what: str) -> Formula:
        """What the text says; what is not known in it becomes a Boolean input."""
        while True:
            try:
                formula, variables = self._scope.read(text)
            except UnreadableError as error:
                if not error.unknown or not self._scope.is_condition(text, error.unknown):
                    return self._in_plain_words(text, origin, what, str(error))
                known = self._in_plain_words(error.unknown, origin, what, str(error))
                self._scope.declare(error.unknown, known)
                continue
            for variable in variables:
                self.variables.setdefault(variable.name, variable)
            return formula

    def _in_plain_words(self, text: str, origin: Element, what: str, reason: str) -> Formula:
        name = self._by_text.get(text)
        if name is None:
            name = self._declare(identifier(text, "condition"), BooleanDomain(), origin)
            self._by_text[text] = name
        subject = self.graph.subject(origin)
        self._sink.report(
            rules.UNREADABLE, subject, what=what, text=text, reason=reason, variable=name
        )
        return f.var(name)

    def answer(self, wanted: str, literals: Iterable[str], origin: Element) -> "Answer":
        """Declare the input that a decision compares with the literals on its branches.

        A literal can be any text, such as ``0``. Formulas know it by an identifier.
        """
        texts = list(dict.fromkeys(literals))
        if set(texts) <= {"true", "false"}:
            return Answer(f.var(self._declare(wanted, BooleanDomain(), origin)), None)
        other, *values = unique([OTHER, *texts], "value")
        variable = f.var(self._declare(wanted, EnumerationDomain((*values, other)), origin))
        return Answer(variable, dict(zip(texts, values, strict=True)))

    def _declare(self, wanted: str, domain: Domain, origin: Element) -> str:
        name = self.names.new(wanted)
        self.variables[name] = Variable(name, Owner.ENVIRONMENT, domain, origin.id)
        return name


class Answer:
    """The input of a decision; without names of its values it is Boolean."""

    def __init__(self, variable: Formula, value_names: Mapping[str, str] | None) -> None:
        self._variable = variable
        self._value_names = value_names

    def equals(self, literal: str) -> Formula:
        """Return the condition that the input equals the literal."""
        if self._value_names is None:
            return self._variable if literal == "true" else f.negate(self._variable)
        return f.eq(self._variable, f.const(self._value_names[literal]))

    def is_covered(self, literals: list[str]) -> bool:
        """Tell whether the input always equals one of the literals."""
        return self._value_names is None and {"true", "false"} <= set(literals)


def events(inputs: Inputs, action: Element) -> tuple[Formula, list[str]]:
    """What ends an accept action, and the names of the events."""
    graph = inputs.graph
    triggers = dict.fromkeys(
        [*graph.targets(action, Edge.TRIGGER), *_owned_triggers(graph, action)]
    )
    if not triggers:
        name = f"receive_{identifier(action.name, 'event')}"
        return inputs.pulse(name, action), [name]
    found = [_event(inputs, trigger, action) for trigger in triggers]
    return f.either(*(formula for formula, _ in found)), [name for _, name in found if name]


def _owned_triggers(graph: Graph, action: Element) -> list[Element]:
    return [element for element in graph.owned(action) if element.kind == "Trigger"]


def _event(inputs: Inputs, trigger: Element, action: Element) -> tuple[Formula, str]:
    if trigger.subkind == "change" and trigger.attrs.get("condition"):
        text = str(trigger.attrs["condition"])
        return inputs.condition(text, action, "the change condition"), ""
    name = _event_name(inputs.graph, trigger)
    return inputs.event(name, trigger), name


def _event_name(graph: Graph, trigger: Element) -> str:
    type_ = graph.target(trigger, Edge.TYPED_BY)
    prefix = {"call": "call", "time": "time", "change": "change"}.get(trigger.subkind, "receive")
    what = (type_.name if type_ else "") or trigger.name or str(trigger.attrs.get("when", ""))
    return f"{prefix}_{identifier(what, 'event')}"
