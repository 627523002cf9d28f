"""Values of features as attributes: literals, enumeration values, quantities, expressions."""

from sysmlc.frontends.sysml import expressions, nodes, quantities
from sysmlc.frontends.sysml.library_edges import LibraryEdges
from sysmlc.frontends.sysml.lowering import Lowering
from sysmlc.frontends.sysml.trees import Trees
from sysmlc.ir import AttrValue, Edge, Element, Graph, Kind
from sysmlc.language.tree import Node

_LITERALS = frozenset({"LiteralBoolean", "LiteralString", "LiteralInteger", "LiteralRational"})


def set_value(lowering: Lowering, element: Element, key: str, expression: Node) -> None:
    """Set the attribute *key* to the value of an expression.

    The name of a literal or an instance also sets ``<key>_instance``, any other expression that
    must be computed ``<key>_language``. A quantity sets ``<key>_unit``, and ``:=`` sets
    ``<key>_kind``.
    """
    quantities.set_kind(lowering.graph, element, key, expression)
    constant = constant_of(expression)
    if constant is not None:
        lowering.graph.set(element, **{key: constant})
        if quantities.has_unit(expression):
            lowering.queue.defer_until_edges(
                lambda: quantities.set_unit(lowering, element, key, expression)
            )
        return
    lowering.queue.defer_until_edges(lambda: _set_computed(lowering, element, key, expression))


def _set_computed(lowering: Lowering, element: Element, key: str, expression: Node) -> None:
    target = _referenced_feature(expression)
    literal = lowering.elements.find(target)
    if target is not None and target.kind == "EnumerationUsage" and literal is not None:
        _set_literal(lowering.graph, lowering.library, element, key, literal)
        return
    if literal is not None and literal.kind is Kind.INSTANCE:
        lowering.graph.set(element, **{key: literal.name, f"{key}_instance": literal.id})
        return
    text = _write(expression, lowering)
    lowering.graph.set(element, **{key: text, f"{key}_language": ""})


def _set_literal(
    graph: Graph, library: LibraryEdges, element: Element, key: str, literal: Element
) -> None:
    """Set a literal of an enumeration; a feature of another type gets the value of the literal."""
    types = graph.targets(element, Edge.TYPED_BY)
    has_other_type = library.has_scalar_type(element) or (
        types and graph.owner(literal) not in types
    )
    value = literal.attrs.get("value") if has_other_type else None
    written = literal.name if value is None else value
    graph.set(element, **{key: written, f"{key}_instance": literal.id})


def defer_expression(
    lowering: Lowering, element: Element, key: str, expression: Node | str | None
) -> None:
    """Set the attribute *key* to a condition or another expression, once all elements exist.

    A text such as ``else`` is set at once.
    """
    if isinstance(expression, str):
        lowering.set_attributes(element, **{key: expression})
    elif expression is not None:
        lowering.queue.defer_until_elements(
            lambda: lowering.set_attributes(element, **{key: expression_text(expression, lowering)})
        )


def expression_text(expression: Node | None, lowering: Lowering) -> str:
    """Return an expression as text of our grammar.

    The back end ``sysml`` marks features that stand for a condition in words: the text is their
    name, or the name that metadata states.
    """
    if expression is None:
        return ""
    target = _referenced_feature(expression)
    if target is not None and target.name:
        metadata = nodes.shipped_metadata_of(target)
        if "InWords" in metadata:
            # A condition without text must not vanish: its name stands for it.
            text = _read_text(metadata["Named"]) if "Named" in metadata else ""
            return text or target.name
    return _write(expression, lowering)


def _read_text(named: Node) -> str:
    """Return the value of the only attribute of metadata."""
    expressions = (nodes.value_of(member) for member in named.members)
    return next((str(constant_of(value)) for value in expressions if value is not None), "")


def _write(expression: Node, lowering: Lowering) -> str:
    document = lowering.trees.document_of(expression)
    text = "" if document is None else document.text
    return expressions.write_expression(expression, text, lowering.elements.id_of)


def set_effect(lowering: Lowering, element: Element, actions: list[Node]) -> None:
    """Set the body of an element to the effect of actions, which may name elements to come."""
    lowering.set_attributes(element, body=expressions.write_effect(actions))
    lowering.queue.defer_until_elements(
        lambda: lowering.set_attributes(
            element, body=expressions.write_effect(actions, lowering.elements.id_of)
        )
    )


def _referenced_feature(expression: Node) -> Node | None:
    if expression.kind != "FeatureReferenceExpression":
        return None
    return nodes.find_target(expression, "Membership")


# -- constants ---------------------------------------------------------------------------------


def constant_of(expression: Node) -> AttrValue:
    """Return the value of a literal, a quantity or a sequence; None if it must be computed.

    The value of a quantity is its number. Its unit is read by ``quantities``.
    """
    if expression.kind in _LITERALS:
        return expression.attributes.get("value")
    if expression.kind == "OperatorExpression":
        return _constant_of_operation(expression)
    return () if expression.kind == "NullExpression" else None


def _constant_of_operation(expression: Node) -> AttrValue:
    operator, arguments = expression.attributes.get("operator"), nodes.list_arguments(expression)
    if operator == "-" and len(arguments) == 1:
        number = constant_of(arguments[0])
        is_number = isinstance(number, int | float) and not isinstance(number, bool)
        return -number if is_number and isinstance(number, int | float) else None
    if operator == "[" and len(arguments) == 2:
        return constant_of(arguments[0])
    if operator == "," and len(arguments) == 2:
        return _constant_of_sequence(arguments)
    return None


def _constant_of_sequence(arguments: list[Node]) -> AttrValue:
    """Return the values of ``(a, b, c)``, which is parsed as ``(a, (b, c))``."""
    sequence: list[AttrValue] = []
    while len(arguments) == 2:
        first, rest = arguments
        if not _append(constant_of(first), sequence):
            return None
        is_longer = rest.attributes.get("operator") == ","
        arguments = nodes.list_arguments(rest) if is_longer else [rest]
    is_constant = all(_append(constant_of(argument), sequence) for argument in arguments)
    return tuple(sequence) if is_constant else None


def _append(value: AttrValue, sequence: list[AttrValue]) -> bool:
    """Append a value, or the values of a nested sequence; return False if there is none."""
    if value is None:
        return False
    sequence += value if isinstance(value, tuple) else [value]
    return True


# -- multiplicities ----------------------------------------------------------------------------


def multiplicity_of(trees: Trees, node: Node) -> str:
    """Return the multiplicity of a feature in the notation of UML; '' if it is exactly one."""
    if not node.members:
        return ""
    for member in node.members:
        if member.kind == "MultiplicityRange":
            return _write_range(trees, member)
    cross = nodes.cross_feature_of(node)
    return "" if cross is None else multiplicity_of(trees, cross)


def _write_range(trees: Trees, range_: Node) -> str:
    document = trees.document_of(range_)
    source = "" if document is None else document.text
    bounds = [
        _write_bound(bound, source) for bound in range_.members if bound.kind in nodes.EXPRESSIONS
    ]
    if not bounds:
        return ""
    if len(bounds) == 1 or bounds[0] == bounds[1]:
        return "" if bounds[0] == "1" else bounds[0]
    return "*" if bounds == ["0", "*"] else "..".join(bounds)


def _write_bound(bound: Node, source: str) -> str:
    is_infinite = bound.kind == "LiteralInfinity"
    return "*" if is_infinite else expressions.write_expression(bound, source)
