"""Behaviours as definitions, as members of classifiers, and as actions of states and transitions.

The body of an opaque behaviour in sysmlc's own grammar of effects becomes assignments, send actions
and performed actions; in all other languages it stays text.
"""

from sysmlc.backends.sysml.comments import write_opaque_bodies
from sysmlc.backends.sysml.declarations import is_referential_owner, make_definition_head
from sysmlc.backends.sysml.definitions import write_contents
from sysmlc.backends.sysml.expressions import UnknownNameError, print_expression, resolve_name
from sysmlc.backends.sysml.plan import Member
from sysmlc.backends.sysml.printing import Line, quote_name
from sysmlc.backends.sysml.writer import Writer
from sysmlc.ir import Edge, Element, Kind
from sysmlc.ir.expressions import (
    Assignment,
    Call,
    Expression,
    ExpressionError,
    Invocation,
    Send,
    Statement,
)
from sysmlc.logic.expressions.parsing import statements_of

_RUN_BY_CLASSIFIER = {"action": "perform", "state": "exhibit"}
_SUBACTIONS = (Edge.ENTRY, Edge.DO, Edge.EXIT, Edge.EFFECT)


# -- members of packages and classifiers ---------------------------------------------------------


def write_behaviour(writer: Writer, member: Member) -> list[Line]:
    """Write a behaviour that is a member of a package or a classifier.

    The classifier performs or exhibits its classifier behaviour. The behaviours of states and
    transitions have no lines of their own: ``write_subaction`` writes them.
    """
    element = member.require_element()
    owner = writer.graph.owner(element)
    if owner is not None and _is_subaction(writer, owner, element):
        return []
    head = make_definition_head(writer, member)
    if owner is not None and element in writer.graph.targets(owner, Edge.CLASSIFIER_BEHAVIOR):
        word = _RUN_BY_CLASSIFIER.get(member.shape.keyword)
        head.prefixes += [word] if word else []
    elif is_referential_owner(member.parent):
        head.prefixes.append("ref")
    is_method = bool(writer.graph.sources(element, Edge.METHOD))
    regions = [child for child in writer.graph.owned(element) if child.kind is Kind.REGION]
    if not is_method and element.kind is Kind.STATE_MACHINE and len(regions) > 1:
        head.value = " parallel"
    return [Line(head.format(), _write_body(writer, member, element))]


def _is_subaction(writer: Writer, owner: Element, behaviour: Element) -> bool:
    return any(behaviour in writer.graph.targets(owner, edge) for edge in _SUBACTIONS)


def _write_body(writer: Writer, member: Member, element: Element) -> list[Line]:
    body = write_contents(writer, member)
    if member.objective_lines:
        body.insert(0, Line("objective", member.objective_lines))
    statements = format_statements(writer, member, element)
    if statements is None:
        return body + write_opaque_bodies(writer, element)
    return body + chain_statements(statements)


# -- actions of states and transitions -----------------------------------------------------------


def write_subaction(writer: Writer, scope: Member, word: str, behaviour: Element) -> Line:
    """Write the entry, do or exit action of a state, or the effect of a transition.

    *word* is ``entry``, ``do`` or ``exit``; *scope* is the state or the transition.
    """
    member = writer.plan.find(behaviour)
    owner = scope.element
    if member is None or owner is None or behaviour.owner != owner.id:
        return _write_reference(writer, scope, word, behaviour)
    writer.expressed.add(behaviour.id)
    name = quote_name(member.name) if member.name else ""
    statements = None if member.members else format_statements(writer, member, behaviour)
    if statements is not None and len(statements) == 1:
        statement = statements[0]
        if not statement.startswith("perform"):
            start = f"action {name} " if name else ""
            return Line(f"{word} {start}{statement}")
        if not name:
            return Line(f"{word} {statement.removeprefix('perform ')}")
    body = _write_body(writer, member, behaviour)
    keyword = member.shape.usage_keyword
    if keyword == "action":
        return Line(f"{word} action {name}".rstrip(), body)
    return Line(f"{word} action", [Line(f"{keyword} {name}".rstrip(), body)])


def _write_reference(writer: Writer, scope: Member, word: str, behaviour: Element) -> Line:
    """Write a subaction that refers to a behaviour with another owner."""
    name = writer.refer_to(scope, behaviour, Edge.CALLS, behaviour)
    member = writer.plan.find(behaviour)
    if name is None or member is None:
        return Line(f"{word} action")
    is_definition = member.shape.is_definition
    return Line(f"{word} action : {name}" if is_definition else f"{word} {name}")


# -- statements ----------------------------------------------------------------------------------


def chain_statements(statements: list[str]) -> list[Line]:
    """Return the statements as actions that run one after the other."""
    first, *rest = statements
    return [Line(first), *(Line(f"then {statement}") for statement in rest)]


def format_statements(writer: Writer, scope: Member | None, element: Element) -> list[str] | None:
    """Return the body of an opaque behaviour as actions; None if it is in another language."""
    text = element.attrs.get("body")
    if not isinstance(text, str) or "bodies" in element.attrs:
        return None
    try:
        statements = [_format_statement(writer, scope, tree) for tree in statements_of(text)]
    except (ExpressionError, UnknownNameError, RecursionError):
        return None
    return statements or None


def _format_statement(writer: Writer, scope: Member | None, statement: Statement) -> str:
    match statement:
        case Assignment(target, value):
            feature = _format_target(writer, scope, target)
            return f"assign {feature} := {print_expression(writer, scope, value)}"
        case Send(signal, args, receiver):
            arguments = ", ".join(print_expression(writer, scope, arg) for arg in args)
            end = "" if receiver is None else _format_receiver(writer, scope, receiver)
            return f"send new {print_expression(writer, scope, signal)}({arguments}){end}"
        case Invocation(call):
            return _format_performance(writer, scope, call)


def _format_target(writer: Writer, scope: Member | None, target: Expression) -> str:
    feature = resolve_name(writer, scope, target)
    if feature is None or not feature.shape.is_usage:
        raise UnknownNameError("target")
    return print_expression(writer, scope, target)


def _format_receiver(writer: Writer, scope: Member | None, receiver: Expression) -> str:
    feature = resolve_name(writer, scope, receiver)
    word = "via" if feature is not None and feature.shape.keyword == "port" else "to"
    return f" {word} {print_expression(writer, scope, receiver)}"


def _format_performance(writer: Writer, scope: Member | None, call: Expression) -> str:
    """Return a performed action. Raises UnknownNameError for arguments, which have no notation."""
    function = call.function if isinstance(call, Call) else call
    if isinstance(call, Call) and call.args:
        raise UnknownNameError("arguments")
    action = resolve_name(writer, scope, function)
    if action is None or action.shape.keyword != "action":
        raise UnknownNameError("action")
    return f"perform {print_expression(writer, scope, function)}"
