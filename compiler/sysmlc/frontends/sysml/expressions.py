"""Expressions and statements of KerML in the grammar of the compiler (grammars/expression.lark)."""

from collections.abc import Callable, Sequence
from itertools import zip_longest

from sysmlc.frontends.sysml import nodes
from sysmlc.ir.expressions import (
    Assignment,
    Binary,
    Call,
    Conditional,
    EffectText,
    Expression,
    ExpressionText,
    Index,
    Invocation,
    Literal,
    Member,
    Name,
    Send,
    Statement,
    Unary,
    is_nested_too_deeply,
    print_effect,
    print_expression,
)
from sysmlc.language import notation
from sysmlc.language.tree import Node, Reference

_BINARY = {
    "implies": "implies",
    "or": "or",
    "|": "or",
    "xor": "xor",
    "and": "and",
    "&": "and",
    "==": "==",
    "===": "==",
    "!=": "!=",
    "!==": "!=",
    **{operator: operator for operator in ("<", "<=", ">", ">=", "+", "-", "*", "/", "%")},
}
_UNARY = {"not": "not", "-": "-", "+": "+"}
_GLOBAL_SCOPE = "$"
_SENDABLE = frozenset(
    {"ConstructorExpression", "InvocationExpression", "FeatureReferenceExpression"}
)


class NotExpressibleError(ValueError):
    """An expression that the grammar of the compiler cannot express."""


ElementIds = Callable[[Node], str]
"""Finds the id of the element of a node; empty if there is none, or none yet."""


def _find_no_id(_node: Node) -> str:
    return ""


# -- expressions -------------------------------------------------------------------------------


def write_expression(node: Node, source: str = "", ids: ElementIds = _find_no_id) -> str:
    """Return an expression as text of our grammar, else its text in the document (*source*).

    A document in XMI has no such text: *source* is empty, and the expression is printed in KerML.
    """
    expression = read_expression(node, ids)
    text = None if expression is None else _print(expression)
    if text is not None:
        return text
    return nodes.quote_source(node, source) if source else notation.write_expression(node)


def _print(expression: Expression) -> str | None:
    """Return the text of an expression with its tree, which a deeply nested one does not have.

    The result is None if the expression is nested too deeply to be printed.
    """
    try:
        text = print_expression(expression)
    except RecursionError:
        return None
    return text if is_nested_too_deeply(expression) else ExpressionText(text, expression)


def read_expression(node: Node, ids: ElementIds) -> Expression | None:
    """Return the expression as a syntax tree; None if it has none."""
    try:
        return _read(node, ids)
    except (NotExpressibleError, RecursionError):
        return None


def _read(node: Node, ids: ElementIds) -> Expression:
    reader = _EXPRESSION_READERS.get(node.kind)
    if reader is None:
        raise NotExpressibleError(node.kind)
    return reader(node, ids)


def _read_literal(node: Node, _ids: ElementIds) -> Expression:
    value = node.attributes.get("value")
    if value is None:
        raise NotExpressibleError(node.kind)
    return Literal(value)


def _read_operation(node: Node, ids: ElementIds) -> Expression:
    operator = str(node.attributes.get("operator", ""))
    arguments = nodes.list_arguments(node)
    if len(arguments) == 1 and operator in _UNARY:
        return Unary(_UNARY[operator], _read(arguments[0], ids))
    if len(arguments) == 2 and operator in _BINARY:
        return Binary(_BINARY[operator], _read(arguments[0], ids), _read(arguments[1], ids))
    if len(arguments) == 3 and operator == "if":
        condition, then, otherwise = (_read(argument, ids) for argument in arguments)
        return Conditional(condition, then, otherwise)
    if len(arguments) == 2 and operator in ("#", "index"):
        return Index(_read(arguments[0], ids), _read(arguments[1], ids))
    if len(arguments) == 2 and operator == "[" and _is_in_assignment(node):
        return Index(_read(arguments[0], ids), _read(arguments[1], ids))
    raise NotExpressibleError(operator)


def _is_in_assignment(node: Node) -> bool:
    """Whether a quantity is part of an assigned value; conditions with units are read as texts."""
    owner = node.owner
    while owner is not None and owner.kind != "AssignmentActionUsage":
        owner = owner.owner
    return owner is not None


def _read_index(node: Node, ids: ElementIds) -> Expression:
    base, index = nodes.list_arguments(node)
    return Index(_read(base, ids), _read(index, ids))


def _read_feature_reference(node: Node, ids: ElementIds) -> Expression:
    reference = nodes.find_reference(node, "Membership")
    if reference is None:
        raise NotExpressibleError(node.kind)
    target = reference.targets[0] if reference.targets else None
    if target is not None and len(reference.chain) == 1 and _is_hidden(target, node):
        names = nodes.qualified_name_of(target).split("::")
        return Name(tuple(names), element=_find_first_id(reference, ids))
    return _read_reference(reference, ids)


def _is_hidden(target: Node, node: Node) -> bool:
    """Whether a package around a node has another feature with the name of an imported one.

    Readers of the text alone would take that feature.
    """
    if _is_feature(target):
        return False
    scope = node.owner
    while scope is not None and scope is not target.owner:
        same_name = (member for member in scope.members if member.name == target.name)
        if any(member.kind.endswith("Usage") for member in same_name):
            return True
        scope = scope.owner
    return False


def _read_reference(reference: Reference, ids: ElementIds) -> Expression:
    """Return the expression for a reference to a feature or to a chain of features."""
    return _append_members(_read_first_link(reference, ids), reference, ids, 1)


def _append_members(
    base: Expression, reference: Reference, ids: ElementIds, start: int
) -> Expression:
    """Return the feature of *base* to which the links of a chain from *start* on lead."""
    targets = (reference.targets or [])[start:]
    for link, target in zip_longest(reference.chain[start:], targets):
        base = Member(base, link[-1], "" if target is None else ids(target))
    return base


def _read_first_link(reference: Reference, ids: ElementIds) -> Expression:
    """Return the name of the first feature of a chain.

    A feature of an action is often qualified by the name of the action (``Task::pallet``); the
    qualifier is dropped. A literal keeps the name of its enumeration.
    """
    names = reference.chain[0]
    target = reference.targets[0] if reference.targets else None
    element = _find_first_id(reference, ids)
    if target is not None and target.kind == "EnumerationUsage" and len(names) > 1:
        return Name(names[-2:], element=element)
    if target is not None and _is_feature(target) and len(names) > 1:
        return Name(names[-1:], element=element)
    return Name(tuple(name for name in names if name != _GLOBAL_SCOPE), element=element)


def _find_first_id(reference: Reference, ids: ElementIds) -> str:
    """Return the id of the element that the first link of a chain denotes."""
    target = reference.targets[0] if reference.targets else None
    return "" if target is None else ids(target)


def _is_feature(node: Node) -> bool:
    """Whether a definition or a behaviour owns the node, so that its own name is sufficient."""
    owner = node.owner
    return owner is not None and not owner.kind.endswith(("Package", "Namespace"))


def _read_feature_chain(node: Node, ids: ElementIds) -> Expression:
    reference = nodes.find_reference(node, "Membership")
    arguments = nodes.list_arguments(node)
    if reference is None or not arguments:
        raise NotExpressibleError(node.kind)
    return _append_members(_read(arguments[0], ids), reference, ids, 0)


def _read_call(node: Node, ids: ElementIds) -> Expression:
    reference = nodes.find_reference(node, "Membership", "FeatureTyping")
    if reference is None:
        raise NotExpressibleError(node.kind)
    arguments = (nodes.value_of(argument) or argument for argument in _order_arguments(node))
    first = Name(reference.chain[0], element=_find_first_id(reference, ids))
    function = _append_members(first, reference, ids, 1)
    return Call(function, tuple(_read(argument, ids) for argument in arguments))


def list_arguments_by_parameter(node: Node) -> list[Node]:
    """Return the arguments of a call in the order of the parameters if it is known."""
    try:
        return _order_arguments(node)
    except NotExpressibleError:
        return nodes.list_arguments(node)


def _order_arguments(node: Node) -> list[Node]:
    """Return the arguments in the order of the parameters; the text may name them in any order.

    Raises NotExpressibleError if only some are named, or if a parameter before them has none.
    """
    arguments = nodes.list_arguments(node)
    if not any(nodes.find_reference(argument, "Redefinition") for argument in arguments):
        return arguments
    parameters = [
        nodes.find_target(argument, "Redefinition")
        for argument in arguments
        if argument.kind == "Feature"
    ]
    owner = parameters[0].owner if parameters and parameters[0] is not None else None
    is_constructor = node.kind == "ConstructorExpression"
    declared = [] if owner is None else _list_parameters(owner, is_constructor)
    positions = [
        next((index for index, declaration in enumerate(declared) if declaration is parameter), -1)
        for parameter in parameters
    ]
    if len(positions) != len(arguments) or sorted(positions) != list(range(len(arguments))):
        raise NotExpressibleError(node.kind)
    return [arguments[positions.index(position)] for position in range(len(arguments))]


def _list_parameters(owner: Node, is_constructor: bool) -> list[Node]:
    """Return the inputs of a function, or the features that a constructor of a type sets."""
    features = [
        member for member in owner.members if member.membership.endswith("FeatureMembership")
    ]
    features += nodes.iter_by_membership(owner, "ParameterMembership")
    return [
        feature
        for feature in features
        if is_constructor or feature.attributes.get("direction") in ("in", "inout")
    ]


_EXPRESSION_READERS = {
    "LiteralBoolean": _read_literal,
    "LiteralString": _read_literal,
    "LiteralInteger": _read_literal,
    "LiteralRational": _read_literal,
    "OperatorExpression": _read_operation,
    "IndexExpression": _read_index,
    "FeatureReferenceExpression": _read_feature_reference,
    "FeatureChainExpression": _read_feature_chain,
    "InvocationExpression": _read_call,
    "ConstructorExpression": _read_call,
}


# -- statements --------------------------------------------------------------------------------


def write_effect(actions: Sequence[Node], ids: ElementIds = _find_no_id) -> str | None:
    """Return consecutive actions as the text of one effect; None if one is not expressible."""
    readings = (read_statement(action, ids) for action in actions)
    statements = tuple(statement for statement in readings if statement is not None)
    if not statements or len(statements) < len(actions):
        return None
    text = print_effect(statements)
    return text if is_nested_too_deeply(statements) else EffectText(text, statements)


def read_statement(node: Node, ids: ElementIds = _find_no_id) -> Statement | None:
    """Return an assignment, sending or performance as a statement; None if not expressible."""
    reader = _STATEMENT_READERS.get(node.kind)
    return None if reader is None else reader(node, ids)


def _read_assignment(node: Node, ids: ElementIds) -> Statement | None:
    reference = nodes.find_reference(node, "Membership")
    inputs = [expression for expression in list_inputs(node) if expression is not None]
    if reference is None or not inputs:
        return None
    value = read_expression(inputs[-1], ids)
    target = _read_reference(reference, ids)
    for expression in inputs[:-1]:
        base = read_expression(expression, ids)
        target = target if base is None else _prepend_base(base, target)
    return None if value is None else Assignment(target, value)


def _prepend_base(base: Expression, target: Expression) -> Expression:
    """Return ``base.target``: the feature *target* of the occurrence *base*."""
    match target:
        case Member(inner, name, element):
            return Member(_prepend_base(base, inner), name, element)
        case Name(path, element):
            return Member(base, path[-1], element)
        case _:
            return target


def _read_send(node: Node, ids: ElementIds) -> Statement | None:
    payload, *ends = [*list_inputs(node), None, None, None][:3]
    if payload is None or payload.kind not in _SENDABLE:
        return None
    call = read_expression(payload, ids)
    signal = call.function if isinstance(call, Call) else call
    arguments = call.args if isinstance(call, Call) else ()
    receiver = next((end for end in ends if end is not None), None)
    target = None if receiver is None else read_expression(receiver, ids)
    return Send(signal, arguments, target) if isinstance(signal, Name) else None


def _read_performance(node: Node, ids: ElementIds) -> Statement | None:
    reference = nodes.find_reference(node, "ReferenceSubsetting")
    if reference is None or node.name or node.members:
        return None
    return Invocation(_read_reference(reference, ids))


_STATEMENT_READERS = {
    "AssignmentActionUsage": _read_assignment,
    "SendActionUsage": _read_send,
    "PerformActionUsage": _read_performance,
}


def list_inputs(node: Node) -> list[Node | None]:
    """Return the expressions bound to an action's parameters, in order; None for an unbound one."""
    inputs: list[Node | None] = []
    for parameter in nodes.iter_by_membership(node, "ParameterMembership"):
        own_expression = parameter if parameter.kind in nodes.EXPRESSIONS else None
        inputs.append(nodes.value_of(parameter) or own_expression)
    return inputs


def list_statements(body: Sequence[Node]) -> list[Node] | None:
    """Return the actions of a body if all are consecutive statements without names, else None."""
    actions = []
    for node in body:
        if node.kind in _STATEMENT_READERS and not node.name:
            actions.append(node)
        elif node.kind == "SuccessionAsUsage" and not _names_end(node):
            continue
        elif not nodes.is_annotation(node) and "direction" not in node.attributes:
            return None
    return actions or None


def _names_end(succession: Node) -> bool:
    return any(end.relations for end in nodes.ends_of(succession))
