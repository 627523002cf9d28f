"""Model-level evaluation of expressions about metadata (KerML 7.2.5.4, 8.4.4.13).

The conditions of filtered imports are evaluated for each member. An element with semantic metadata
specialises the base type that the metadata names.
"""

import operator as op
from collections.abc import Callable

from sysmlc.language.metaclasses import FEATURES, USAGES, is_a, is_composite
from sysmlc.language.names.expression_results import find_named_element
from sysmlc.language.names.queries import LookupQueries
from sysmlc.language.tree import Node, list_arguments

Value = str | bool | int | float | None
"""Values of expressions; None is the empty sequence."""
METADATA = frozenset({"MetadataUsage", "MetadataFeature"})
"""Members that may define what their owner specialises."""
_BOOLEAN_ATTRIBUTES = frozenset(
    {"isAbstract", "isConstant", "isDerived", "isEnd", "isIndividual", "isNegated", "isOrdered"}
    | {"isParallel", "isPortion", "isSufficient", "isVariable", "isVariation"}
)
"""Attributes that are false unless the text states them."""


class UndecidedError(Exception):
    """The expression is not constant, or not understood."""


def passes_filter(condition: Node, hit: Node, lookup: LookupQueries) -> bool:
    """Whether a member may be imported; an undecided condition lets it pass."""
    element = lookup.resolve_alias(hit)
    # An unresolved alias is reported elsewhere.
    if element is None:
        return True
    try:
        return evaluate(condition, element, lookup) is True
    except UndecidedError:
        return True


def evaluate(expression: Node, element: Node, lookup: LookupQueries) -> Value:
    """Return the value of an expression for an annotated element. Raises UndecidedError."""
    if "value" in expression.attributes:
        return expression.attributes["value"]
    operator = expression.attributes.get("operator")
    if operator is None:
        return _evaluate_reference(expression, element, lookup)
    if operator in ("@", "hastype", "istype"):
        return _is_classified(expression, element, lookup)
    return _apply_operator(str(operator), list_arguments(expression), element, lookup)


def _apply_operator(
    operator: str, operands: list[Node], element: Node, lookup: LookupQueries
) -> Value:
    values = [evaluate(operand, element, lookup) for operand in operands]
    if operator in ("and", "&"):
        return all(value is True for value in values)
    if operator in ("or", "|"):
        return any(value is True for value in values)
    if operator == "not":
        return values[0] is not True
    if len(values) == 2 and operator in _COMPARISONS:
        return _COMPARISONS[operator](values[0], values[1])
    raise UndecidedError(operator)


def _compare_numbers(compare: Callable[[float, float], bool]) -> Callable[[Value, Value], bool]:
    def compare_ordered(left: Value, right: Value) -> bool:
        numbers = [value for value in (left, right) if isinstance(value, int | float)]
        return len(numbers) == 2 and compare(numbers[0], numbers[1])

    return compare_ordered


_COMPARISONS: dict[str, Callable[[Value, Value], bool]] = {
    "==": op.eq,
    "===": op.eq,
    "!=": op.ne,
    "!==": op.ne,
    "xor": lambda one, other: (one is True) != (other is True),
    "<": _compare_numbers(op.lt),
    "<=": _compare_numbers(op.le),
    ">": _compare_numbers(op.gt),
    ">=": _compare_numbers(op.ge),
}


def _is_classified(expression: Node, element: Node, lookup: LookupQueries) -> bool:
    """Evaluate ``@M``: the element has metadata of that type, or that metaclass."""
    for member in expression.members:
        relation = member.find_relation("FeatureTyping")
        wanted = lookup.target(member, relation) if relation else None
        if wanted is not None:
            return _has_classifier(element, wanted, lookup)
    raise UndecidedError("type")


def _has_classifier(element: Node, wanted: Node, lookup: LookupQueries) -> bool:
    if _is_reflective(wanted):
        return is_a(element.kind, wanted.name or "")
    return any(lookup.conforms(usage, wanted) for usage in _find_metadata(element))


def _is_reflective(wanted: Node) -> bool:
    """Whether a metaclass is in the libraries that describe KerML and SysML themselves."""
    namespace: Node | None = wanted
    while namespace is not None:
        if namespace.kind == "LibraryPackage" and namespace.name in ("KerML", "SysML"):
            return True
        namespace = namespace.owner
    return False


def _find_metadata(element: Node) -> list[Node]:
    """Return the metadata that an element owns."""
    return [member for member in element.members if member.kind in METADATA]


def _evaluate_reference(expression: Node, element: Node, lookup: LookupQueries) -> Value:
    """Evaluate ``M::x`` or ``(as M).x``: the value of a feature in the metadata of the element."""
    feature = find_named_element(expression, lookup)
    if feature is not None and feature.kind in FEATURES:
        return _evaluate_feature(feature, element, lookup)
    raise UndecidedError("reference")


def _evaluate_feature(feature: Node, element: Node, lookup: LookupQueries) -> Value:
    if feature.owner is not None and _is_reflective(feature.owner):
        return _read_metaclass_attribute(feature, element)
    for usage in _find_metadata(element):
        for member in usage.members:
            if feature in lookup.redefined_features(member):
                return _evaluate_bound_value(member, element, lookup)
        if feature.owner is not None and lookup.conforms(usage, feature.owner):
            return _evaluate_bound_value(feature, element, lookup)
    return None


def _read_metaclass_attribute(feature: Node, element: Node) -> Value:
    """Return the value of ``Element::name``, ``Type::isAbstract`` and the like."""
    name, metaclass = feature.name or "", feature.owner and feature.owner.name
    if not is_a(element.kind, metaclass or ""):
        return None
    # `name` is the effective name, which is known here only if it is declared.
    if name == "declaredName" or (name == "name" and element.name is not None):
        return element.name
    if name in ("shortName", "declaredShortName"):
        return element.short_name
    if name == "isComposite" and element.kind in USAGES:
        return is_composite(element)
    if name in _BOOLEAN_ATTRIBUTES or name == "isComposite":
        return element.attributes.get(name, False)
    raise UndecidedError(name)


def _evaluate_bound_value(feature: Node, element: Node, lookup: LookupQueries) -> Value:
    value = feature.find_member("FeatureValue")
    return evaluate(value, element, lookup) if value else None


def find_semantic_bases(node: Node, lookup: LookupQueries) -> list[tuple[str, Node]]:
    """Return relation and target of each base type of ``node`` that its metadata names."""
    relations: list[tuple[str, Node]] = []
    for metadata in _find_metadata(node):
        base = _find_base_type(metadata, lookup)
        if base is not None:
            relations += _make_base_relations(node, base, lookup)
    return relations


def _find_base_type(metadata: Node, lookup: LookupQueries) -> Node | None:
    """Return the element that the ``baseType`` of a metadata usage names."""
    for feature in lookup.iter_visible_inside(metadata, "baseType"):
        if value := feature.find_member("FeatureValue"):
            return _choose_named_element(value, metadata, lookup)
    return None


def _choose_named_element(value: Node, metadata: Node, lookup: LookupQueries) -> Node | None:
    """Return the element that ``x meta M`` names; a conditional chooses by its condition."""
    while value.kind == "OperatorExpression" and value.members:
        branch = 0
        if value.attributes.get("operator") == "if":
            branch = 1 if _is_true(value.members[0], metadata, lookup) else 2
        if branch >= len(value.members):
            return None
        value = value.members[branch]
    return find_named_element(value, lookup)


def _is_true(condition: Node, metadata: Node, lookup: LookupQueries) -> bool:
    try:
        return metadata.owner is not None and evaluate(condition, metadata.owner, lookup) is True
    except UndecidedError:
        return False


def _make_base_relations(node: Node, base: Node, lookup: LookupQueries) -> list[tuple[str, Node]]:
    if node.kind in FEATURES:
        return [("Subsetting" if base.kind in FEATURES else "FeatureTyping", base)]
    if base.kind not in FEATURES:
        return [("Subclassification", base)]
    types = (general for general in lookup.generals(base) if general.kind not in FEATURES)
    return [("Subclassification", general) for general in types]
