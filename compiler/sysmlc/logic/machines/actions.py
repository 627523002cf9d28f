"""Guards, effects and change conditions of a state machine, read in the context of its owner."""

from dataclasses import dataclass, field
from typing import NamedTuple

from msgspec.structs import replace

from sysmlc.diagnostics import Rule, Severity, Sink, rule
from sysmlc.ir import Edge, Element, Graph
from sysmlc.ir.expressions import (
    Assignment,
    Expression,
    ExpressionError,
    Invocation,
    Name,
    Send,
    Statement,
    Unary,
    dotted_name,
    element_of,
    name_of,
    print_expression,
    print_statement,
    walk_tree,
)
from sysmlc.logic import formula as f
from sysmlc.logic.contract import BooleanDomain, Domain, Owner, Variable
from sysmlc.logic.expressions.context import Context, find_symbol, report_range
from sysmlc.logic.expressions.elaboration import (
    ELSEWHERE_ADVICE,
    EMPTY_ADVICE,
    FINITE_ADVICE,
    elaborate_condition,
    elaborate_value,
    list_read,
)
from sysmlc.logic.expressions.features import Feature, check_assignable
from sysmlc.logic.expressions.named_elements import describe_feature_elsewhere
from sysmlc.logic.expressions.number_formulas import CHOICE
from sysmlc.logic.expressions.parsing import (
    CanonicalCondition,
    explain_fault,
    statements_of,
    tree_of,
)
from sysmlc.logic.expressions.symbols import ElaborationError, Fault, Symbol
from sysmlc.logic.feature_writes import SHARED, Sharing, find_label, read_assignments
from sysmlc.logic.identifiers import Names
from sysmlc.logic.machines.instant_activities import find_instant_steps, find_target
from sysmlc.logic.machines.machine import Action, Assign, Raise
from sysmlc.logic.machines.supported_constructs import list_behaviours
from sysmlc.support.suggestions import find_similar

NOT_UNDERSTOOD = rule(
    "SM411",
    "opaque-condition",
    Severity.WARNING,
    "{condition} has no formula: {reason}; the contract treats it as {treatment}",
    help=FINITE_ADVICE,
)
_SYNTAX_ADVICE = "write an expression over features of the owner"
UNKNOWN_NAME = rule(
    "SM412",
    "unknown-name",
    Severity.ERROR,
    "{what} '{text}' names '{name}', which is not a property of {context}",
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
    "'{text}' assigns to '{name}', which {reason}{consequence}",
    help="{advice}",
)


class TargetFault(NamedTuple):
    """Why no formula describes an assignment to a target, and what the modeller can do."""

    reason: str
    advice: str


IS_CONSTANT = TargetFault("is constant", "make the property changeable, or assign another one")
MISSING_TARGET_ADVICE = "correct the name, or let its owner assign it"
OPAQUE_EFFECT = rule(
    "SM416",
    "opaque-effect",
    Severity.INFO,
    "effect '{text}' is not understood: {reason}; the contract shows it as output '{variable}'",
)
_CHECKED_LANGUAGES = frozenset({"ocl", "ocl2.0", "kerml", "sysml", "sysmlv2", "alf"})
RULE_OF_FAULT = {
    Fault.UNKNOWN: UNKNOWN_NAME,
    Fault.TYPE: TYPE_MISMATCH,
    Fault.OUTSIDE: OUT_OF_DOMAIN,
    Fault.UNSUPPORTED: NOT_UNDERSTOOD,
}


@dataclass(slots=True)
class ReadingContext:
    """State of reading one state machine.

    It collects auxiliary variables, and the features that the machine reads and assigns.
    """

    graph: Graph
    sink: Sink
    context: Context
    names: Names
    tick_seconds: float
    sharing: Sharing
    auxiliary: dict[str, Variable] = field(default_factory=dict)
    """Variables that are not properties, such as inputs and timers, by a unique key."""
    conditions: dict[str, dict[str, str]] = field(default_factory=dict)
    """The inputs for conditions without formula, by keys of canonical forms, for each choice."""
    read_variables: dict[str, None] = field(default_factory=dict)
    reads: dict[str, dict[str, None]] = field(default_factory=dict)
    """The features that the values of each feature read; those that conditions read, by ""."""
    assigned_variables: dict[str, None] = field(default_factory=dict)
    output_names: dict[str, None] = field(default_factory=dict)

    def find_symbol(self, name: str, element: str = "") -> Symbol | None:
        """Return the symbol for *name*: a property, an auxiliary variable or a literal."""
        if name.startswith(CHOICE):
            return Symbol(f.var(self._choice_for(name.removeprefix(CHOICE))), BooleanDomain())
        # A condition without meaning is replaced by the name of an input, which is resolved here.
        for variable in self.auxiliary.values():
            if variable.name == name:
                return Symbol(f.var(name), variable.domain)
        return find_symbol(self.context, name, element)

    def variable_for(self, key: str, name: str, owner: Owner, domain: Domain, origin: str) -> str:
        """Return the name of the auxiliary variable with this key; create it on first use."""
        if key not in self.auxiliary:
            self.auxiliary[key] = Variable(self.names.new(name), owner, domain, origin)
        return self.auxiliary[key].name

    def memory_for(self, key: str, name: str, domain: Domain, origin: str) -> str:
        """Return the name of the output with this key that stores the past, as ``variable_for``."""
        if key not in self.auxiliary:
            facts = self.names.new(name), Owner.SYSTEM, domain, origin
            self.auxiliary[key] = Variable(*facts, is_auxiliary=True)
        return self.auxiliary[key].name

    def remove_auxiliary(self, name: str) -> None:
        """Remove the auxiliary variable of this name, which nothing reads."""
        self.auxiliary = {k: v for k, v in self.auxiliary.items() if v.name != name}

    def input_for(self, key: str, name: str, origin: str) -> str:
        """Return the name of the Boolean input with this key; create the input on first use."""
        return self.variable_for(key, name, Owner.ENVIRONMENT, BooleanDomain(), origin)

    def replace_condition(self, text: str, what: str, element: Element, reason: str) -> Expression:
        """Return the input for a condition without formula, or its negation; create a new input.

        The spellings of a condition and of its opposite share an input; a condition without text
        has its own. *reason* is why it has no formula.
        """
        source = self.graph.target(element, Edge.FLOW_SOURCE)
        # The effects before a choice may change what a condition reads.
        choice = source.id if source is not None and source.subkind == "choice" else ""
        inputs = self.conditions.setdefault(choice, {})
        condition = CanonicalCondition.read(text, element.id)
        name, is_negated = condition.find_input(inputs)
        if not name:
            key, is_negated = f"condition {choice} {condition.key}", condition.is_negated
            shown_text = condition.text or what
            name = inputs[condition.key] = self.input_for(key, shown_text, element.id)
            variable = self.auxiliary[key]
            self.auxiliary[key] = replace(variable, condition=shown_text, reason=reason)
        return Unary("not", Name((name,))) if is_negated else Name((name,))

    def _choice_for(self, text: str) -> str:
        """Return the input that decides in which of two regions an assigned sum is."""
        key = f"region of {text}"
        name = self.input_for(key, f"{text} stays below", self.sharing.machine.id)
        reason = "the regions of its features do not tell in which of two regions it is"
        condition = f"the value of {text}"
        self.auxiliary[key] = replace(self.auxiliary[key], condition=condition, reason=reason)
        return name

    def output_for(self, key: str, name: str, origin: str) -> str:
        """Return the name of the Boolean output with this key; create the output on first use."""
        output = self.variable_for(key, name, Owner.SYSTEM, BooleanDomain(), origin)
        self.output_names[output] = None
        return output

    def record_reads(self, expression: Expression, target: str = "") -> None:
        """Record the features that a condition reads, or the value of a variable *target*."""
        for name, _ in list_read(expression, self.find_symbol):
            feature = self.context.features.get(name)
            if feature is not None:
                self.read_variables[feature.variable] = None
                self.reads.setdefault(target, {})[feature.variable] = None
                report_range(self.graph, feature, self.sink)


def read_condition(reading: ReadingContext, text: str, what: str, element: Element) -> Expression:
    """Return the expression in *text*.

    A text that is no valid condition is reported and replaced by a Boolean input, which is an input
    of its own if the text is empty.
    """
    if not text:
        return _replace_empty(reading, what, element)
    try:
        expression = tree_of(text)
        elaborate_condition(expression, reading.find_symbol)
    except ExpressionError as error:
        return _replace_by_input(reading, text, what, element, error)
    except ElaborationError as error:
        return _replace_by_input(reading, text, what, element, error, expression)
    reading.record_reads(expression)
    return expression


def _replace_empty(reading: ReadingContext, what: str, element: Element) -> Expression:
    """Report a condition without text and return the Boolean input for it."""
    reason = "it has no text that can be read"
    replacement = reading.replace_condition("", what, element, reason)
    reading.sink.report(
        NOT_UNDERSTOOD,
        reading.graph.subject(element),
        help=EMPTY_ADVICE,
        condition=what,
        reason=reason,
        treatment=describe_input(replacement),
    )
    return replacement


def describe_input(replacement: Expression) -> str:
    """Return in words what replaces a condition: an input, or the negation of one."""
    match replacement:
        case Unary("not", operand):
            return f"the negation of {describe_input(operand)}"
    return f"the input '{print_expression(replacement)}'"


def _classify_fault(
    reading: ReadingContext, error: ElaborationError, element: Element, text: str, *read: Expression
) -> tuple[Rule, str]:
    """Return the rule of a fault in a text of *element*, and the reason.

    A text that only a contract cannot express is no error. *read* are the expressions at fault.
    """
    reason = explain_fault(error, *read)
    if error.fault is Fault.UNKNOWN:
        reason = _explain_name(reading, element, text, error.name, error.element)
        return (NOT_UNDERSTOOD, reason) if reason else (UNKNOWN_NAME, str(error))
    if error.fault is Fault.OUTSIDE:
        names = (name_of(part) for expression in read for part in walk_tree(expression))
        features = reading.context.features
        if any(features[name].is_assumed for name in names if name and name in features):
            return NOT_UNDERSTOOD, f"{reason}, a range that is assumed"
    return RULE_OF_FAULT[error.fault], reason


def _explain_name(reading: ReadingContext, element: Element, text: str, name: str, id: str) -> str:
    """Return why a name that is no property of the context is no error, or an empty text."""
    owner = describe_feature_elsewhere(reading.graph, id, name)
    if owner:
        return owner
    named = _find_named_after_text(reading.graph, element, text)
    if named:
        return f"'{name}' is not known, and only the name of the {named} has this text"
    language = str(element.attrs.get("guard_language", element.attrs.get("language", "")))
    if not language and text.strip() == name and not find_similar(name, reading.context.features):
        return f"the word '{name}' is no feature of '{reading.context.name}'"
    if language and language.lower() not in _CHECKED_LANGUAGES:
        return f"'{name}' is not known, and names in {language} are not checked"
    return f"'{name}' in single quotes is not a text here" if f"'{name}'" in text else ""


def _find_named_after_text(graph: Graph, element: Element, text: str) -> str:
    """Return what has *text* only as a name, a guard or a transition, or an empty text."""
    constraint = graph.target(element, Edge.GUARD)
    if constraint is not None and constraint.name == text and "body" not in constraint.attrs:
        return "guard"
    return "transition" if f"[{text}]" in element.name else ""


def _replace_by_input(
    reading: ReadingContext,
    text: str,
    what: str,
    element: Element,
    error: ExpressionError | ElaborationError,
    *read: Expression,
) -> Expression:
    """Report an invalid condition and return what replaces it: an input or its negation."""
    rule, reason, name, advice = NOT_UNDERSTOOD, str(error), "", _SYNTAX_ADVICE
    if isinstance(error, ElaborationError):
        rule, reason = _classify_fault(reading, error, element, text, *read)
        name = error.name
        is_elsewhere = rule is NOT_UNDERSTOOD and error.fault is Fault.UNKNOWN
        advice = ELSEWHERE_ADVICE if is_elsewhere else ""
    replacement = reading.replace_condition(text, what, element, reason)
    reading.sink.report(
        rule,
        reading.graph.subject(element),
        help=advice,
        what=what,
        text=text,
        condition=f"{what} '{text}'",
        reason=reason,
        treatment=describe_input(replacement),
        name=name,
        context=reading.context.name or "the context",
    )
    return replacement


# -- effects -----------------------------------------------------------------------------------


def read_behaviours(reading: ReadingContext, element: Element, edge: Edge) -> tuple[Action, ...]:
    """Return the actions of the behaviours at the targets of *edge*, in order."""
    actions: list[Action] = []
    for behaviour in list_behaviours(reading.graph, element, edge):
        actions += _read_behaviour(reading, behaviour, edge)
    return tuple(actions)


def _read_behaviour(reading: ReadingContext, behaviour: Element, edge: Edge) -> list[Action]:
    body = behaviour.attrs.get("body")
    if not isinstance(body, str) or not body.strip():
        name = behaviour.name or f"{edge}_{(reading.graph.owner(behaviour) or behaviour).name}"
        output = reading.output_for(f"behaviour {behaviour.id}", name, behaviour.id)
        return [Raise(output, behaviour.id), *_read_steps(reading, behaviour)]
    try:
        statements = statements_of(body)
    except ExpressionError:
        reason = "it is not an assignment, call or send"
        return [_read_opaque_effect(reading, body, behaviour, reason)]
    texts = [body] if len(statements) == 1 else map(print_statement, statements)
    actions = [
        _read_statement(reading, *pair, behaviour) for pair in zip(statements, texts, strict=True)
    ]
    return [*actions, *_read_steps(reading, behaviour)]


def _read_steps(reading: ReadingContext, behaviour: Element) -> list[Action]:
    """Return the assignments of an activity within the step, if formulas describe all of them."""
    graph, context, sharing = reading.graph, reading.context, reading.sharing
    steps = find_instant_steps(graph, behaviour, sharing.classifier)
    pairs = [(assignment, step) for step in steps for assignment in read_assignments(step)]
    for assignment, _ in pairs:
        name = find_target(graph, assignment, context)
        if not name or sharing.find_other_writer(context.features[name].element):
            return []
    return [
        _read_assignment(reading, assignment, print_statement(assignment), step)
        for assignment, step in pairs
    ]


def _read_opaque_effect(
    reading: ReadingContext, text: str, behaviour: Element, reason: str
) -> Raise:
    """Report an effect that no formula can describe, and return its output."""
    output = _effect_output(reading, text, behaviour)
    subject = reading.graph.subject(behaviour)
    reading.sink.report(OPAQUE_EFFECT, subject, text=text.strip(), reason=reason, variable=output)
    return Raise(output, behaviour.id)


def _effect_output(reading: ReadingContext, text: str, behaviour: Element) -> str:
    """Return the output that reports the effect."""
    return reading.output_for(f"done {text.strip()}", text, behaviour.id)


def _has_other_writer(
    reading: ReadingContext, feature: Feature, text: str, behaviour: Element
) -> bool:
    """Whether another behaviour writes *feature*; report it."""
    writer = reading.sharing.find_other_writer(feature.element)
    if writer is not None:
        reading.sink.report(
            SHARED,
            reading.graph.subject(behaviour),
            machine=reading.sharing.machine.name,
            name=feature.element.name,
            text=text.strip(),
            variable=_effect_output(reading, text, behaviour),
            writer=find_label(reading.graph, writer, reading.sharing.machine.name),
        )
    return writer is not None


def _read_statement(
    reading: ReadingContext, statement: Statement, text: str, behaviour: Element
) -> Action:
    match statement:
        case Assignment():
            return _read_assignment(reading, statement, text, behaviour)
        case Send(signal):
            name = signal.path[-1]
            return Raise(
                reading.output_for(f"send {name}", f"send_{name}", behaviour.id), behaviour.id
            )
        case Invocation(call):
            name = dotted_name(getattr(call, "function", call)) or print_expression(call)
            return Raise(reading.output_for(f"done {name}", name, behaviour.id), behaviour.id)


def _read_assignment(
    reading: ReadingContext, statement: Assignment, text: str, behaviour: Element
) -> Action:
    """Return the action of an assignment; an output replaces one that no formula can describe.

    The reason is reported once: where the target is at fault, the value is not read.
    """
    name = name_of(statement.target) or print_expression(statement.target)
    feature = reading.context.features.get(name)
    reason = ""
    if feature is None:
        reason = _explain_name(reading, behaviour, text, name, element_of(statement.target))
    if feature is not None and feature.domain is None and not feature.is_constant:
        obstacle = "several values" if feature.has_several_values else "no finite type"
        reason = f"'{name}' has {obstacle}"
    if reason:
        return _read_opaque_effect(reading, text, behaviour, reason)
    if feature is None or feature.domain is None or feature.is_constant:
        return _report_target(reading, text, name, feature, behaviour)
    if _has_other_writer(reading, feature, text, behaviour):
        return Raise(_effect_output(reading, text, behaviour), behaviour.id)
    try:
        value = elaborate_value(statement.value, reading.find_symbol, feature.domain)
        check_assignable(value.domain, feature.domain, statement.value)
    except ElaborationError as error:
        rule, reason = _classify_fault(
            reading, error, behaviour, text, statement.target, statement.value
        )
        if rule is NOT_UNDERSTOOD:
            return _read_opaque_effect(reading, text, behaviour, reason)
        reading.sink.report(
            rule,
            reading.graph.subject(behaviour),
            what="effect",
            text=text,
            reason=reason,
            name=error.name,
            context=reading.context.name or "the context",
        )
        return Raise(_effect_output(reading, text, behaviour), behaviour.id)
    reading.record_reads(statement.value, feature.variable)
    reading.assigned_variables[feature.variable] = None
    report_range(reading.graph, feature, reading.sink)
    return Assign(feature.variable, statement.value, behaviour.id)


def _report_target(
    reading: ReadingContext, text: str, name: str, feature: Feature | None, behaviour: Element
) -> Raise:
    """Report why the target of an assignment has no formula, and return the effect's output."""
    fault = IS_CONSTANT
    if feature is None:
        context = reading.context.name or "the context"
        fault = TargetFault(f"is no feature of {context} itself", MISSING_TARGET_ADVICE)
    output = _effect_output(reading, text, behaviour)
    reading.sink.report(
        NOT_ASSIGNABLE,
        reading.graph.subject(behaviour),
        text=text,
        name=name,
        consequence=f"; the contract shows the assignment as output '{output}'",
        reason=fault.reason,
        advice=fault.advice,
    )
    return Raise(output, behaviour.id)
