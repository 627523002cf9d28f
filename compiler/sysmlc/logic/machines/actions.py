"""Features that a state machine writes and others write, too: its contract does not follow them."""

from dataclasses import dataclass, field

from msgspec import Struct

from sysmlc.diagnostics import Rule, Severity, Sink, rule
from sysmlc.ir import Edge, Element, Graph
from sysmlc.logic import formula as f
from sysmlc.logic.contract import BooleanDomain, Domain, EnumerationDomain, Owner, Variable
from sysmlc.logic.domains import describe
from sysmlc.logic.expressions.context import Context, note_range
from sysmlc.logic.expressions.declared import Feature
from sysmlc.logic.expressions.elaborate import (
    ElaborationError,
    Fault,
    Symbol,
    condition,
    literal_of,
    meaning,
)
from sysmlc.logic.expressions.expression import (
    Assignment,
    Expression,
    ExpressionError,
    Invocation,
    Name,
    Send,
    Statement,
    dotted,
    name_of,
    parse_effect,
    parse_expression,
    print_expression,
    print_statement,
)
from sysmlc.logic.machines.machine import Action, Assign, Raise
from sysmlc.logic.names import Names
from sysmlc.logic.writers import Writers, called

SHARED = rule(
    "SM546",
    "others-write-it-too",
    Severity.INFO,
    "the contract of '{machine}' leaves '{name}' to the environment and shows '{text}' as output "
    "'{variable}': '{writer}' writes it too",
    help="let one behaviour alone write it, or say in a requirement what becomes of it",
)


class Sharing(Struct, frozen=True):
    """Who else writes what a state machine writes."""

    graph: Graph
    machine: Element
    writers: Writers | None = None
    """None: it alone is looked at."""

    def other(self, feature: Element) -> Element | None:
        """What writes the feature beside the machine."""
        return None if self.writers is None else self.writers.beside(feature, self.machine)


NOT_UNDERSTOOD = rule(
    "SM411",
    "opaque-condition",
    Severity.WARNING,
    "{what} '{text}' is not understood: {reason}; the environment decides it as '{variable}'",
    help="write an expression over the properties of the owner",
)
UNKNOWN_NAME = rule(
    "SM412",
    "unknown-name",
    Severity.ERROR,
    "{what} '{text}' names '{name}', which is no property of {context}",
    help="correct the name or add the property",
)
TYPE_MISMATCH = rule(
    "SM413",
    "type-mismatch",
    Severity.ERROR,
    "{what} '{text}': {reason}",
)
OUT_OF_DOMAIN = rule(
    "SM414",
    "value-out-of-domain",
    Severity.ERROR,
    "{what} '{text}': {reason}",
    help="correct the value or the range of the property",
)
NOT_ASSIGNABLE = rule(
    "SM415",
    "not-assignable",
    Severity.ERROR,
    "'{text}' assigns to '{name}', which is no changeable property with finite values of {context}",
    help="correct the name, give the property a finite type, or make it changeable",
)
OPAQUE_EFFECT = rule(
    "SM416",
    "opaque-effect",
    Severity.INFO,
    "'{text}' is no assignment, call or send; the contract shows it as output '{variable}'",
)
RULE_OF = {
    Fault.UNKNOWN: UNKNOWN_NAME,
    Fault.TYPE: TYPE_MISMATCH,
    Fault.OUTSIDE: OUT_OF_DOMAIN,
    Fault.UNSUPPORTED: NOT_UNDERSTOOD,
}


@dataclass(slots=True)
class Reading:
    """What is collected while a state machine is read."""

    graph: Graph
    sink: Sink
    context: Context
    names: Names
    tick_seconds: float
    sharing: Sharing
    made: dict[str, Variable] = field(default_factory=dict)
    """Variables beside the properties, by what they stand for."""
    used: dict[str, None] = field(default_factory=dict)
    assigned: dict[str, None] = field(default_factory=dict)
    outputs: dict[str, None] = field(default_factory=dict)

    def scope(self, name: str) -> Symbol | None:
        """What a name in an expression stands for."""
        feature = self.context.features.get(name)
        if feature is not None:
            if feature.constant and feature.default is not None:
                return Symbol(f.const(feature.default), feature.domain)
            return Symbol(f.var(feature.variable), feature.domain)
        for variable in self.made.values():
            if variable.name == name:
                return Symbol(f.var(name), variable.domain)
        return literal_of(self.context, name)

    def make(self, key: str, name: str, owner: Owner, domain: Domain, origin: str) -> str:
        """The name of the variable that stands for ``key``, made when it is asked for first."""
        if key not in self.made:
            self.made[key] = Variable(self.names.new(name), owner, domain, origin)
        return self.made[key].name

    def told(self, key: str, name: str, origin: str) -> str:
        """A Boolean that the environment decides."""
        return self.make(key, name, Owner.ENVIRONMENT, BooleanDomain(), origin)

    def output(self, key: str, name: str, origin: str) -> str:
        """A Boolean output."""
        made = self.make(key, name, Owner.SYSTEM, BooleanDomain(), origin)
        self.outputs[made] = None
        return made

    def note_use(self, expression: Expression) -> None:
        """Remember the variables of the context that the expression reads."""
        for part in walk(expression):
            name = name_of(part)
            feature = self.context.features.get(name) if name else None
            if feature is not None:
                self.used[feature.variable] = None
                note_range(self.graph, feature, self.sink)


def walk(expression: Expression) -> list[Expression]:
    """The expression and all parts of it."""
    found = [expression]
    for slot in (
        "base",
        "function",
        "operand",
        "left",
        "right",
        "condition",
        "then",
        "otherwise",
        "index",
    ):
        part = getattr(expression, slot, None)
        if part is not None and not isinstance(part, str):
            found += walk(part)
    for arg in getattr(expression, "args", ()):
        found += walk(arg)
    return found


def read_condition(reading: Reading, text: str, what: str, element: Element) -> Expression:
    """A condition; what has no meaning becomes the name of a Boolean of the environment."""
    try:
        expression = parse_expression(text)
        condition(expression, reading.scope)
    except ExpressionError as error:
        return _give_up(reading, NOT_UNDERSTOOD, text, what, element, str(error), "")
    except ElaborationError as error:
        broken = RULE_OF[error.fault]
        return _give_up(reading, broken, text, what, element, str(error), error.name)
    reading.note_use(expression)
    return expression


def _give_up(
    reading: Reading, broken: Rule, text: str, what: str, element: Element, reason: str, name: str
) -> Expression:
    variable = reading.told(f"condition {text}", text or what, element.id)
    reading.sink.report(
        broken,
        reading.graph.subject(element),
        what=what,
        text=text,
        reason=reason,
        variable=variable,
        name=name,
        context=reading.context.name or "the context",
    )
    return Name((variable,))


# -- effects -----------------------------------------------------------------------------------


def read_behaviours(reading: Reading, element: Element, edge: Edge) -> tuple[Action, ...]:
    """What the behaviours at the end of these edges do, in order."""
    found: list[Action] = []
    for behaviour in reading.graph.targets(element, edge):
        found += _behaviour(reading, behaviour, edge)
    return tuple(found)


def _behaviour(reading: Reading, behaviour: Element, edge: Edge) -> list[Action]:
    body = behaviour.attrs.get("body")
    if not isinstance(body, str) or not body.strip():
        name = behaviour.name or f"{edge}_{(reading.graph.owner(behaviour) or behaviour).name}"
        return [
            Raise(reading.output(f"behaviour {behaviour.id}", name, behaviour.id), behaviour.id)
        ]
    try:
        statements = parse_effect(body)
    except ExpressionError:
        return [_opaque(reading, body, behaviour)]
    texts = [body] if len(statements) == 1 else map(print_statement, statements)
    both = zip(statements, texts, strict=True)
    return [_action(reading, statement, text, behaviour) for statement, text in both]


def _opaque(reading: Reading, text: str, behaviour: Element) -> Raise:
    output = _shown(reading, text, behaviour)
    subject = reading.graph.subject(behaviour)
    reading.sink.report(OPAQUE_EFFECT, subject, text=text.strip(), variable=output)
    return Raise(output, behaviour.id)


def _shown(reading: Reading, text: str, behaviour: Element) -> str:
    """The output that tells that something was done."""
    return reading.output(f"done {text.strip()}", text, behaviour.id)


def _is_shared(reading: Reading, feature: Feature, text: str, behaviour: Element) -> bool:
    """Whether others write a feature, too; that is reported."""
    other = reading.sharing.other(feature.element)
    if other is not None:
        reading.sink.report(
            SHARED,
            reading.graph.subject(behaviour),
            machine=reading.sharing.machine.name,
            name=feature.element.name,
            text=text.strip(),
            variable=_shown(reading, text, behaviour),
            writer=called(reading.graph, other),
        )
    return other is not None


def _action(reading: Reading, statement: Statement, text: str, behaviour: Element) -> Action:
    match statement:
        case Assignment():
            return _assignment(reading, statement, text, behaviour)
        case Send(signal):
            name = signal.path[-1]
            return Raise(reading.output(f"send {name}", f"send_{name}", behaviour.id), behaviour.id)
        case Invocation(call):
            name = dotted(getattr(call, "function", call)) or print_expression(call)
            return Raise(reading.output(f"done {name}", name, behaviour.id), behaviour.id)


def _assignment(reading: Reading, statement: Assignment, text: str, behaviour: Element) -> Action:
    name = name_of(statement.target) or print_expression(statement.target)
    feature = reading.context.features.get(name)
    subject = reading.graph.subject(behaviour)
    context = reading.context.name or "the context"
    if feature is None or feature.domain is None or feature.constant:
        reading.sink.report(NOT_ASSIGNABLE, subject, text=text, name=name, context=context)
        return _opaque(reading, text, behaviour)
    if _is_shared(reading, feature, text, behaviour):
        return Raise(_shown(reading, text, behaviour), behaviour.id)
    try:
        value = meaning(statement.value, reading.scope, feature.domain)
        check_assignable(value.domain, feature.domain, statement.value)
    except ElaborationError as error:
        if error.fault is Fault.UNSUPPORTED:
            return _opaque(reading, text, behaviour)
        reading.sink.report(
            RULE_OF[error.fault],
            subject,
            what="effect",
            text=text,
            reason=str(error),
            name=error.name,
            context=context,
        )
        return _opaque(reading, text, behaviour)
    reading.note_use(statement.value)
    reading.assigned[feature.variable] = None
    note_range(reading.graph, feature, reading.sink)
    return Assign(feature.variable, statement.value, behaviour.id)


def check_assignable(found: Domain, wanted: Domain, value: Expression) -> None:
    """Raises ElaborationError when no value of the one domain is one of the other."""
    text = print_expression(value)
    if type(found) is not type(wanted):
        message = f"'{text}' is {describe(found)}, not {describe(wanted)}"
        raise ElaborationError(Fault.TYPE, message, text, value.offset)
    if isinstance(found, EnumerationDomain) and found != wanted:
        message = f"'{text}' is one of {describe(found)}, not of {describe(wanted)}"
        raise ElaborationError(Fault.TYPE, message, text, value.offset)
    lows = getattr(found, "low", 0), getattr(wanted, "low", 0)
    highs = getattr(found, "high", 0), getattr(wanted, "high", 0)
    if lows[0] > highs[1] or highs[0] < lows[1]:
        message = f"{text} is outside {describe(wanted)}"
        raise ElaborationError(Fault.OUTSIDE, message, text, value.offset)
