"""What a constraint of a requirement says: a formula over the variables of its subject."""

from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.ir import Element, Graph
from sysmlc.logic.expressions.context import note_range
from sysmlc.logic.expressions.elaborate import ElaborationError, Fault, condition
from sysmlc.logic.expressions.expression import ExpressionError
from sysmlc.logic.expressions.parsing import parse_expression
from sysmlc.logic.formula import Formula, variables
from sysmlc.logic.requirements.scope import Scope
from sysmlc.logic.requirements.statements import Statement
from sysmlc.logic.texts.formal import is_formal, read_formal, told

NOT_A_FORMULA = rule(
    "SM522",
    "requirement-not-understood",
    Severity.ERROR,
    "the formula of '{constraint}' in requirement '{requirement}' is not understood: {reason}",
    help="write LTL (G F X U or [] <> X U) over the features of '{about}': {variables}",
)
NOT_FORMAL = rule(
    "SM523",
    "requirement-not-formal",
    Severity.INFO,
    "'{constraint}' of requirement '{requirement}' is in no contract: {reason}",
)
_EXPRESSIONS = ("", "kerml", "sysml", "ocl", "alf")


def is_temporal(constraint: Element) -> bool:
    """Whether the constraint is written in temporal logic, or as a sentence of a pattern."""
    return is_formal(_language(constraint), str(constraint.attrs.get("body", "")))


def meaning(graph: Graph, scope: Scope, statement: Statement, sink: Sink) -> Formula | None:
    """The formula of a statement, or None when it has none, which is reported."""
    constraint = statement.constraint
    if is_temporal(constraint):
        formula = _temporal(graph, scope, statement, sink)
    elif _language(constraint).rstrip("0123456789. ") in _EXPRESSIONS:
        formula = _condition(graph, scope, statement, sink)
    else:
        formula = None
        reason = f"it is written in {constraint.attrs['language']}"
        _tell(graph, statement, sink, reason)
    if formula is not None:
        _note_ranges(graph, scope, formula, sink)
    return formula


def _language(constraint: Element) -> str:
    return str(constraint.attrs.get("language", "")).lower()


def _temporal(graph: Graph, scope: Scope, statement: Statement, sink: Sink) -> Formula | None:
    from sysmlc.logic.spelling import FormulaError

    body = str(statement.constraint.attrs["body"])
    try:
        read = read_formal(scope.undotted(body), _language(statement.constraint), scope.domains)
    except FormulaError as error:
        sink.report(
            NOT_A_FORMULA,
            graph.subject(statement.constraint),
            constraint=_name(statement),
            requirement=statement.requirement.name,
            about=scope.context.name,
            variables=", ".join(scope.domains),
            reason=told(error, body),
        )
        return None
    return scope.settled(read)


def _condition(graph: Graph, scope: Scope, statement: Statement, sink: Sink) -> Formula | None:
    try:
        return condition(parse_expression(str(statement.constraint.attrs["body"])), scope.symbol)
    except (ExpressionError, ElaborationError) as error:
        _tell(graph, statement, sink, _reason(scope, error))
        return None


def _reason(scope: Scope, error: Exception) -> str:
    if isinstance(error, ElaborationError) and error.fault is Fault.UNKNOWN:
        return f"'{error.name}' is no feature of '{scope.context.name}' with finitely many values"
    return str(error)


def _tell(graph: Graph, statement: Statement, sink: Sink, reason: str) -> None:
    name, requirement = _name(statement), statement.requirement.name
    subject = graph.subject(statement.constraint)
    sink.report(NOT_FORMAL, subject, constraint=name, requirement=requirement, reason=reason)


def _name(statement: Statement) -> str:
    return statement.constraint.name or "the constraint"


def _note_ranges(graph: Graph, scope: Scope, formula: Formula, sink: Sink) -> None:
    used = {one.name for one in variables(formula)}
    for feature in scope.context.features.values():
        if feature.variable in used:
            note_range(graph, feature, sink)
