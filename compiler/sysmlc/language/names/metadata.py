"""Model-level evaluation for metadata: filter conditions and semantic metadata (KerML 7.2.5.4)."""

import operator as op
from collections.abc import Callable

from sysmlc.language.metaclasses import USAGES, is_a, is_composite
from sysmlc.language.names.expression_results import named
from sysmlc.language.names.queries import LookupQueries
from sysmlc.language.names.symbols import FEATURES
from sysmlc.language.tree import Node

Value = str | bool | int | float | None
"""What an expression gives; None is the empty sequence."""
_METADATA = frozenset({"MetadataUsage", "MetadataFeature"})
_STATED = frozenset(
    {"isAbstract", "isConstant", "isDerived", "isEnd", "isIndividual", "isNegated", "isOrdered"}
    | {"isParallel", "isPortion", "isSufficient", "isVariable", "isVariation"}
)
"""Attributes of metaclasses that are false unless the text states them."""


class UndecidedError(Exception):
    """An expression that is not constant, or not understood: nothing is kept out because of it."""


def passes(condition: Node, hit: Node, lookup: LookupQueries) -> bool:
    """Whether a member may be imported; one that is not decided may."""
    element = lookup.element(hit)
    if element is None:
        return True
    try:
        return evaluate(condition, element, lookup) is True
    except UndecidedError:
        return True


def evaluate(expression: Node, element: Node, lookup: LookupQueries) -> Value:
    """The value of a model-level expression for an annotated element. Raises UndecidedError."""
    if "value" in expression.attributes:
        return expression.attributes["value"]
    operator = expression.attributes.get("operator")
    if operator is None:
        return _referred(expression, element, lookup)
    if operator in ("@", "hastype", "istype"):
        return _classified(expression, element, lookup)
    operands = [m for m in expression.members if m.membership == "ParameterMembership"]
    return _operated(str(operator), operands, element, lookup)


def _operated(operator: str, operands: list[Node], element: Node, lookup: LookupQueries) -> Value:
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


def _order(compare: Callable[[float, float], bool]) -> Callable[[Value, Value], bool]:
    def ordered(one: Value, other: Value) -> bool:
        numbers = [value for value in (one, other) if isinstance(value, int | float)]
        return len(numbers) == 2 and compare(numbers[0], numbers[1])

    return ordered


_COMPARISONS: dict[str, Callable[[Value, Value], bool]] = {
    "==": op.eq,
    "===": op.eq,
    "!=": op.ne,
    "!==": op.ne,
    "xor": lambda one, other: (one is True) != (other is True),
    "<": _order(op.lt),
    "<=": _order(op.le),
    ">": _order(op.gt),
    ">=": _order(op.ge),
}


def _classified(expression: Node, element: Node, lookup: LookupQueries) -> bool:
    """``@M``: the element has metadata of that type, or its metaclass is that one."""
    for member in expression.members:
        for relation in member.relations:
            if relation.kind == "FeatureTyping":
                wanted = lookup.target(member, relation)
                if wanted is not None:
                    return _has(element, wanted, lookup)
    raise UndecidedError("type")


def _has(element: Node, wanted: Node, lookup: LookupQueries) -> bool:
    if _is_reflective(wanted):
        return is_a(element.kind, wanted.name or "")
    return any(lookup.conforms(one, wanted) for one in metadata(element))


def _is_reflective(wanted: Node) -> bool:
    """Whether a metaclass is of the packages that describe KerML and SysML themselves."""
    at: Node | None = wanted
    while at is not None:
        if at.kind == "LibraryPackage" and at.name in ("KerML", "SysML"):
            return True
        at = at.owner
    return False


def metadata(element: Node) -> list[Node]:
    """The metadata that an element owns."""
    return [member for member in element.members if member.kind in _METADATA]


def _referred(expression: Node, element: Node, lookup: LookupQueries) -> Value:
    """``M::x`` or ``(as M).x``: what the metadata of the element gives for a feature."""
    for relation in expression.relations:
        if relation.kind == "Membership":
            feature = lookup.target(expression, relation)
            if feature is not None and feature.kind in FEATURES:
                return _given(feature, element, lookup)
    raise UndecidedError("reference")


def _given(feature: Node, element: Node, lookup: LookupQueries) -> Value:
    if feature.owner is not None and _is_reflective(feature.owner):
        return _of_metaclass(feature, element)
    for usage in metadata(element):
        for member in usage.members:
            if feature in lookup.redefined(member):
                return _bound(member, element, lookup)
        if feature.owner is not None and lookup.conforms(usage, feature.owner):
            return _bound(feature, element, lookup)
    return None


def _of_metaclass(feature: Node, element: Node) -> Value:
    """What an element itself says for ``Element::name``, ``Type::isAbstract`` and alike."""
    name, metaclass = feature.name or "", feature.owner and feature.owner.name
    if not is_a(element.kind, metaclass or ""):
        return None
    if name == "declaredName" or (name == "name" and element.name is not None):
        return element.name
    if name in ("shortName", "declaredShortName"):
        return element.short_name
    if name == "isComposite" and element.kind in USAGES:
        return is_composite(element)
    if name in _STATED or name == "isComposite":
        return element.attributes.get(name, False)
    raise UndecidedError(name)


def _bound(feature: Node, element: Node, lookup: LookupQueries) -> Value:
    for member in feature.members:
        if member.membership == "FeatureValue":
            return evaluate(member, element, lookup)
    return None


METADATA = frozenset({"MetadataUsage", "MetadataFeature"})
"""Members that may say what their owner specialises."""


def bases(node: Node, lookup: LookupQueries) -> list[tuple[str, Node]]:
    """Kind of relation and target of what ``node`` specialises because of its metadata."""
    found: list[tuple[str, Node]] = []
    for member in node.members:
        if member.kind in METADATA:
            base = _base(member, lookup)
            if base is not None:
                found += _relations(node, base, lookup)
    return found


def _base(metadata: Node, lookup: LookupQueries) -> Node | None:
    """The element that the ``baseType`` of a metadata usage names."""
    for feature in lookup.inside(metadata, "baseType"):
        for value in feature.members:
            if value.membership == "FeatureValue":
                return _named(value, metadata, lookup)
    return None


def _named(value: Node, metadata: Node, lookup: LookupQueries) -> Node | None:
    """``x meta M`` names x; a conditional names what its condition about the element chooses."""
    while value.kind == "OperatorExpression" and value.members:
        chosen = 0
        if value.attributes.get("operator") == "if":
            chosen = 1 if _holds(value.members[0], metadata, lookup) else 2
        if chosen >= len(value.members):
            return None
        value = value.members[chosen]
    return named(value, lookup)


def _holds(condition: Node, metadata: Node, lookup: LookupQueries) -> bool:
    try:
        return metadata.owner is not None and evaluate(condition, metadata.owner, lookup) is True
    except UndecidedError:
        return False


def _relations(node: Node, base: Node, lookup: LookupQueries) -> list[tuple[str, Node]]:
    if node.kind in FEATURES:
        return [("Subsetting" if base.kind in FEATURES else "FeatureTyping", base)]
    if base.kind not in FEATURES:
        return [("Subclassification", base)]
    types = (general for general in lookup.generals(base) if general.kind not in FEATURES)
    return [("Subclassification", general) for general in types]
