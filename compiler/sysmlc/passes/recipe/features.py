"""Features of recipes: what dotted names mean, and types, units and values of typed elements."""

from sysmlc.ir import Element, Kind, query
from sysmlc.passes.recipe.context import Context
from sysmlc.recipe.model import EnumType, ListType, Parameter, ReferenceType, Scalar, ValueType

_PRIMITIVES: dict[str, ValueType] = {
    "Boolean": "boolean",
    "Integer": "integer",
    "UnlimitedNatural": "integer",
    "Natural": "integer",
    "Real": "real",
    "String": "string",
}
_HEADS = (Kind.PARAMETER, Kind.PROPERTY)


def find_feature(context: Context, activity: Element, name: str) -> Element | None:
    """Return the parameter, variable or feature of a dotted name in an activity, or None."""
    head, *rest = name.split(".")
    elements = context.contents(activity)
    feature = next(
        (element for element in elements if element.kind in _HEADS and element.name == head), None
    )
    for part in rest:
        type_ = None if feature is None else query.type_of(context.graph, feature)
        feature = None if type_ is None else find_member(context, type_, part)
    return feature


def find_member(context: Context, type_: Element, name: str) -> Element | None:
    """Return the feature with this name of a type or of one of its generals."""
    by_name = context.members.get(type_.id)
    if by_name is None:
        # In reverse, so that the first of several features with one name remains.
        features = reversed(query.features(context.graph, type_))
        by_name = context.members[type_.id] = {feature.name: feature for feature in features}
    return by_name.get(name)


def build_parameter(context: Context, element: Element) -> Parameter:
    """Return a parameter, pin or property as a recipe's parameter."""
    parameter = context.parameters.get(element.id)
    if parameter is None:
        type_, measure = value_type(context, element), unit_name(context, element)
        parameter = Parameter(context.label(element), type_, measure, default_value(element))
        context.parameters[element.id] = parameter
    return parameter


def is_data(context: Context, element: Element) -> bool:
    """Whether the element holds a value, and is no machine or material."""
    return context.level(query.type_of(context.graph, element)) not in ("machine", "material")


def is_input(context: Context, element: Element) -> bool:
    """Whether the element holds a value, or a machine that is required."""
    if is_data(context, element):
        return True
    limits = query.bounds(element.attrs.get("multiplicity"))
    is_machine = context.level(query.type_of(context.graph, element)) == "machine"
    return is_machine and (limits is None or limits[0] > 0)


def value_type(context: Context, element: Element) -> ValueType | None:
    """Return the type of a typed element; a list if its multiplicity allows several, None if
    untyped.
    """
    type_ = query.type_of(context.graph, element)
    if type_ is None:
        return None
    single = context.types.get(type_.id)
    if single is None:
        single = context.types[type_.id] = _build_type(context, type_)
    limits = query.bounds(element.attrs.get("multiplicity"))
    many = limits is not None and (limits[1] is None or limits[1] > 1)
    return ListType(single) if many else single


def _build_type(context: Context, type_: Element) -> ValueType:
    family = [type_, *query.generals(context.graph, type_)]
    for candidate in family:
        if candidate.kind is Kind.ENUMERATION:
            return _build_enumeration(context, candidate)
        primitive = _PRIMITIVES.get(_local_name(candidate))
        if primitive is not None:
            return primitive
    if type_.attrs.get("property_specific"):
        type_ = next(iter(query.generals(context.graph, type_)), type_)
    level = context.level(type_)
    if level == "machine":
        return ReferenceType("machine", context.name(type_))
    return ReferenceType("material" if level == "material" else "element", context.name(type_))


def _build_enumeration(context: Context, enumeration: Element) -> EnumType:
    owned = context.graph.owned(enumeration)
    literals = [literal for literal in owned if literal.kind is Kind.ENUMERATION_LITERAL]
    values = [literal.attrs.get("value") for literal in literals]
    plain = tuple(value for value in values if isinstance(value, bool | int | float | str))
    is_whole = len(plain) == len(literals)
    names = tuple(literal.name for literal in literals)
    return EnumType(context.name(enumeration), names, plain if is_whole else ())


def _local_name(element: Element) -> str:
    text = element.name or str(element.attrs.get("href", ""))
    return text.replace("::", "#").rpartition("#")[2]


def unit_name(context: Context, element: Element) -> str:
    """Return the name of the unit of the element's value type, or the empty string."""
    type_ = query.type_of(context.graph, element)
    tagged = None if type_ is None else query.tag(context.graph, type_, "unit")
    unit_element = context.graph.get(tagged) if isinstance(tagged, str) else None
    return unit_element.name if unit_element is not None else str(tagged or "")


def literal_default(element: Element) -> Scalar | None:
    """Return the default value if it is a literal."""
    default = default_value(element)
    return default if isinstance(default, bool | int | float | str) else None


def default_value(element: Element) -> Scalar | tuple[Scalar, ...] | None:
    """Return the default value if it is a literal or a list of literals."""
    default = element.attrs.get("default")
    if element.attrs.get("default_language") is not None:
        return None
    if isinstance(default, tuple):
        items = tuple(item for item in default if isinstance(item, bool | int | float | str))
        return items if len(items) == len(default) else None
    return default if isinstance(default, bool | int | float | str) else None


def literal_value(literal: Element) -> Scalar:
    """Return the value of an enumeration literal; its name if it has none."""
    value = literal.attrs.get("value")
    return value if isinstance(value, bool | int | float | str) else literal.name
