"""Features as variables: the domain that the model declares, its values, and the initial one."""

from collections.abc import Mapping

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.ir import AttrValue, Element, Graph, Kind, query
from sysmlc.ir.expressions import (
    Expression,
    ExpressionError,
    Name,
    element_of,
    last_name,
    name_of,
    print_expression,
)
from sysmlc.ir.expressions import Literal as LiteralExpression
from sysmlc.logic.contract import (
    BooleanDomain,
    Domain,
    EnumerationDomain,
    IntegerDomain,
    Owner,
    Variable,
)
from sysmlc.logic.domains import contains, describe
from sysmlc.logic.expressions.elaboration import check_enumeration
from sysmlc.logic.expressions.linear import Number
from sysmlc.logic.expressions.named_elements import (
    VALUE_KINDS,
    constant_value,
    find_enumeration_domain,
    literals_of,
)
from sysmlc.logic.expressions.parsing import tree_of
from sysmlc.logic.expressions.ranges import (
    Access,
    Bounds,
    evaluate_integer,
    find_bounds,
    list_type_names,
    parse_integer,
)
from sysmlc.logic.expressions.symbols import ElaborationError, Fault
from sysmlc.logic.formula import Literal
from sysmlc.logic.regions import Term

_BOOLEAN = frozenset(["boolean", "bool", "eboolean"])
_INTEGER = frozenset(
    ["integer", "int", "natural", "positive", "unlimitednatural", "eint", "short", "long", "byte"]
)
_STRING = frozenset(["string", "estring", "java.lang.string"])
NUMBER_KINDS = (*VALUE_KINDS, Kind.PIN)
"""Kinds of the elements that may have a number: features, and the outputs of actions."""


class Feature(Struct, frozen=True):
    """A feature as a variable; ``domain`` is None if its values are not finite."""

    element: Element
    variable: str
    domain: Domain | None
    default: Literal | None = None
    is_constant: bool = False
    is_assumed: bool = False
    """Whether the range is assumed; ``report_range`` reports this when the feature is used."""
    invalid_default: str = ""
    """A default value that is not in the domain."""
    direction: str = ""
    """``in``, ``out`` or ``inout`` as the owner sees it; empty if the feature has none."""
    number: Number | None = None
    """What the feature stands for in a comparison of numbers; None if its values are none."""
    has_several_values: bool = False
    """Whether the multiplicity allows other than one value; such a feature has no domain."""
    wording: str = ""
    """The dotted name by which expressions reach a feature of a part; empty for others."""
    is_bound: bool = False
    """Whether ``=`` binds a number that conditions compare, as if it could change."""
    term: Term = ()
    """The variables of the numbers in a compared sum, or of the number; empty for others."""
    constants: tuple[str, ...] = ()
    """The variables in the term that never change."""
    restriction: str = ""
    """A constraint that restricts the number in a way that the regions do not show."""

    def make_variable(self, owner: Owner) -> Variable:
        """Return the variable of a feature with a finite domain."""
        assert self.domain is not None, f"'{self.variable}' has no finite domain"
        return Variable(
            self.variable,
            owner,
            self.domain,
            self.element.id,
            is_range_assumed=self.is_assumed,
            wording=self.wording,
            term=self.term,
            constants=self.constants,
            condition=self.restriction,
        )


def make_feature(
    graph: Graph,
    element: Element,
    variable: str,
    assumed_range: tuple[int, int],
    constants: Mapping[str, int],
    access: Access | None = None,
) -> Feature:
    """Return the feature of an element.

    An Integer without a range gets *assumed_range*. *constants* are the Integers that never change,
    by name or by id; the bounds of ranges may name them. *access* is given if the name is dotted.
    """
    multiplicity = query.bounds(element.attrs.get("multiplicity"))
    if multiplicity is not None and multiplicity[1] != 1:
        # One variable cannot stand for several values.
        return Feature(element, variable, None, has_several_values=True)
    type_ = query.type_of(graph, element)
    family = [] if type_ is None else [type_, *query.generals(graph, type_)]
    type_names = list_type_names(family)
    is_integer = bool(type_names & _INTEGER) or _has_untyped_default(element, type_, int)
    domain = _find_literals(graph, element, family, type_names)
    value = _evaluate_default(graph, element, constants)
    is_assumed = False
    if domain is None and is_integer:
        bounds = find_bounds(graph, element, family, constants, access)
        is_assumed = None in bounds
        domain = _make_range(bounds, value, assumed_range)
    default = _find_default(graph, element, value, domain)
    is_constant = element.attrs.get("readonly") is True and default is not None
    is_range = ".." in str(value)
    is_unknown = value is None or (isinstance(value, str) and _is_computed(graph, element))
    # The unlimited natural number is the greatest; an assumed range has it as little as others.
    is_unchecked = is_range or is_unknown or (is_assumed and value == "*")
    is_invalid = default is None and not is_unchecked
    invalid_default = _describe_default(graph, element) if is_invalid else ""
    return Feature(element, variable, domain, default, is_constant, is_assumed, invalid_default)


def _find_literals(
    graph: Graph, element: Element, family: list[Element], type_names: set[str]
) -> Domain | None:
    """Return the domain of an enumeration or a Boolean; None for other elements."""
    type_ = family[0] if family else None
    if type_ is not None and type_.kind is Kind.ENUMERATION:
        return find_enumeration_domain(graph, type_)
    if type_names & _BOOLEAN or _has_untyped_default(element, type_, bool):
        return BooleanDomain()
    return None


def _has_untyped_default(element: Element, type_: Element | None, kind: type) -> bool:
    return type_ is None and type(element.attrs.get("default")) is kind


def _make_range(
    bounds: Bounds, default: AttrValue, assumed_range: tuple[int, int]
) -> IntegerDomain:
    """Return the range between two bounds, of which open ones are assumed.

    An assumed bound leaves room for the default value.
    """
    low, high = assumed_range
    if isinstance(default, int) and not isinstance(default, bool):
        low, high = min(low, default), max(high, default)
    lower, upper = bounds
    if lower is not None and upper is not None:
        return IntegerDomain(lower, upper)
    if lower is not None:
        return IntegerDomain(lower, high if high > lower else lower + high - low)
    if upper is not None:
        return IntegerDomain(low if low < upper else upper - (high - low), upper)
    return IntegerDomain(low, high)


def check_assignable(value_domain: Domain, target_domain: Domain, value: Expression) -> None:
    """Raise ElaborationError if no value of the first domain belongs to the second."""
    text = print_expression(value)
    if type(value_domain) is not type(target_domain):
        message = f"'{text}' is {describe(value_domain)}, not {describe(target_domain)}"
        raise ElaborationError(Fault.TYPE, message, text)
    check_enumeration(value, value_domain, target_domain)
    lower_bounds = getattr(value_domain, "low", 0), getattr(target_domain, "low", 0)
    upper_bounds = getattr(value_domain, "high", 0), getattr(target_domain, "high", 0)
    if lower_bounds[0] > upper_bounds[1] or upper_bounds[0] < lower_bounds[1]:
        message = f"{text} is outside {describe(target_domain)}"
        raise ElaborationError(Fault.OUTSIDE, message, text)


# -- numbers -----------------------------------------------------------------------------------


def find_number_type(graph: Graph, element: Element) -> str:
    """Return ``integer`` or ``real``; empty for a feature whose value is no single number.

    A feature without a type, or of a type without features of its own, may be a number.
    """
    multiplicity = query.bounds(element.attrs.get("multiplicity"))
    if multiplicity is not None and multiplicity[1] != 1:
        return ""
    type_ = query.type_of(graph, element)
    family = [] if type_ is None else [type_, *query.generals(graph, type_)]
    type_names = list_type_names(family)
    if type_names & _INTEGER or _has_untyped_default(element, type_, int):
        return "integer"
    default = element.attrs.get("default")
    if type_ is None:
        return "real" if isinstance(default, float | None) else ""
    is_plain = type_.kind is Kind.DATA_TYPE and not query.features(graph, type_)
    return "real" if is_plain and not type_names & (_BOOLEAN | _STRING) else ""


# -- strings -----------------------------------------------------------------------------------


def is_string(graph: Graph, feature: Feature) -> bool:
    """Whether the feature is a String whose values are not declared."""
    type_ = query.type_of(graph, feature.element)
    family = [] if type_ is None else [type_, *query.generals(graph, type_)]
    is_undeclared = feature.domain is None and not feature.has_several_values
    return is_undeclared and bool(list_type_names(family) & _STRING)


def restrict_string(feature: Feature, domain: EnumerationDomain) -> Feature:
    """Return a String feature with the texts of *domain* as its values."""
    text = default_text(feature.element)
    default = None if text is None else domain.literals[domain.texts.index(text)]
    is_constant = feature.element.attrs.get("readonly") is True and default is not None
    return replace(
        feature, domain=domain, default=default, is_constant=is_constant, invalid_default=""
    )


def default_text(element: Element) -> str | None:
    """Return the initial value of a String; None if it is computed or absent."""
    text = element.attrs.get("default")
    return text if isinstance(text, str) and "default_language" not in element.attrs else None


# -- default values ----------------------------------------------------------------------------


def read_constant(element: Element) -> int | None:
    """Return the value of a read-only Integer, or None for any other element."""
    return parse_integer(element.attrs.get("default")) if element.attrs.get("readonly") else None


def _evaluate_default(graph: Graph, element: Element, constants: Mapping[str, int]) -> AttrValue:
    """Return the default value of an element; that of the constant if it names or computes one."""
    instance = graph.get(str(element.attrs.get("default_instance")))
    if instance is not None and instance.kind is Kind.INSTANCE:
        return constant_value(instance)
    default = element.attrs.get("default")
    expression = _parse_default(element)
    number = None if expression is None else evaluate_integer(expression, constants)
    return default if number is None else number


def _parse_default(element: Element) -> Expression | None:
    """Return the expression that computes the default value; None if there is none."""
    text = element.attrs.get("default")
    if not isinstance(text, str) or "default_language" not in element.attrs:
        return None
    try:
        return tree_of(text)
    except ExpressionError:
        return None


def _describe_default(graph: Graph, element: Element) -> str:
    """Return the default value as text; a literal has its qualified name."""
    literal = _find_default_literal(graph, element)
    return str(element.attrs["default"]) if literal is None else graph.qualified_name(literal)


def _is_computed(graph: Graph, element: Element) -> bool:
    """Whether an expression computes the default value, such as the name of another feature.

    An expression outside the supported grammar, such as ``(1, 2)#(1)``, computes one too.
    """
    expression = _parse_default(element)
    if expression is None:
        return "default_language" in element.attrs
    if not isinstance(expression, Name):
        return expression is not None and not isinstance(expression, LiteralExpression)
    owner = graph.owner(element)
    features = [] if owner is None else query.features(graph, owner)
    return name_of(expression) in [feature.name for feature in features]


def _find_default(
    graph: Graph, element: Element, default: AttrValue, domain: Domain | None
) -> Literal | None:
    if domain is None or default is None:
        return None
    value = _parse_value(graph, element, str(default), domain)
    return value if value is not None and contains(domain, value) else None


def _parse_value(graph: Graph, element: Element, text: str, domain: Domain) -> Literal | None:
    match domain:
        case BooleanDomain():
            return {"true": True, "false": False}.get(text.lower())
        case IntegerDomain():
            return parse_integer(text)
        case EnumerationDomain():
            type_ = query.type_of(graph, element)
            return None if type_ is None else _find_identifier(graph, element, text, type_)


def _find_identifier(
    graph: Graph, element: Element, text: str, enumeration: Element
) -> Literal | None:
    """Return the identifier of the literal that the default value of an element names, or None.

    *text* is the value as an id, a name or a qualified name. A literal of another enumeration is
    no value.
    """
    literal = _find_default_literal(graph, element) or graph.get(text)
    if literal is not None and graph.owner(literal) != enumeration:
        return None
    name = last_name(text) if literal is None else literal.name
    return literals_of(graph, enumeration).get(name)


def _find_default_literal(graph: Graph, element: Element) -> Element | None:
    """Return the literal that the default value names, itself or by a constant; None if unknown."""
    expression = _parse_default(element)
    id = "" if expression is None else element_of(expression)
    named = graph.get(id or str(element.attrs.get("default_instance")))
    if named is not None and named.kind is Kind.INSTANCE:
        named = graph.get(str(named.attrs.get("value_instance")))
    return named if named is not None and named.kind is Kind.ENUMERATION_LITERAL else None
