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


def feature_at(context: Context, activity: Element, name: str) -> Element | None:
    """The parameter, variable or feature that a dotted name of an activity means; None if none."""
    head, *rest = name.split(".")
    inside = context.contents(activity)
    found = next((one for one in inside if one.kind in _HEADS and one.name == head), None)
    for part in rest:
        type_ = None if found is None else query.type_of(context.graph, found)
        found = None if type_ is None else member(context, type_, part)
    return found


def member(context: Context, type_: Element, name: str) -> Element | None:
    """The feature of a type, or of a general, that has the name."""
    found = context.members.get(type_.id)
    if found is None:
        # The first of several that have one name.
        features = reversed(query.features(context.graph, type_))
        found = context.members[type_.id] = {one.name: one for one in features}
    return found.get(name)


def parameter(context: Context, element: Element) -> Parameter:
    """A parameter, pin or property as a recipe's parameter."""
    found = context.parameters.get(element.id)
    if found is None:
        type_, measure = value_type(context, element), unit(context, element)
        found = Parameter(context.label(element), type_, measure, given(element))
        context.parameters[element.id] = found
    return found


def is_data(context: Context, element: Element) -> bool:
    """Whether it holds a value, and is not a machine or a material that goes through."""
    return context.level(query.type_of(context.graph, element)) not in ("machine", "material")


def is_input(context: Context, element: Element) -> bool:
    """Whether it holds a value, or a machine without which nothing can be done."""
    if is_data(context, element):
        return True
    limits = query.bounds(element.attrs.get("multiplicity"))
    is_machine = context.level(query.type_of(context.graph, element)) == "machine"
    return is_machine and (limits is None or limits[0] > 0)


def value_type(context: Context, element: Element) -> ValueType | None:
    """Type of a typed element, a list when its multiplicity allows many; None when untyped."""
    type_ = query.type_of(context.graph, element)
    if type_ is None:
        return None
    single = context.types.get(type_.id)
    if single is None:
        single = context.types[type_.id] = _single(context, type_)
    limits = query.bounds(element.attrs.get("multiplicity"))
    many = limits is not None and (limits[1] is None or limits[1] > 1)
    return ListType(single) if many else single


def _single(context: Context, type_: Element) -> ValueType:
    family = [type_, *query.generals(context.graph, type_)]
    for one in family:
        if one.kind is Kind.ENUMERATION:
            return _enumeration(context, one)
        known = _PRIMITIVES.get(_local_name(one))
        if known is not None:
            return known
    if type_.attrs.get("property_specific"):
        type_ = next(iter(query.generals(context.graph, type_)), type_)
    level = context.level(type_)
    if level == "machine":
        return ReferenceType("machine", context.name(type_))
    return ReferenceType("material" if level == "material" else "element", context.name(type_))


def _enumeration(context: Context, enumeration: Element) -> EnumType:
    owned = context.graph.owned(enumeration)
    literals = [one for one in owned if one.kind is Kind.ENUMERATION_LITERAL]
    values = [one.attrs.get("value") for one in literals]
    known = tuple(value for value in values if isinstance(value, bool | int | float | str))
    is_whole = len(known) == len(literals)
    names = tuple(one.name for one in literals)
    return EnumType(context.name(enumeration), names, known if is_whole else ())


def _local_name(element: Element) -> str:
    text = element.name or str(element.attrs.get("href", ""))
    return text.replace("::", "#").rpartition("#")[2]


def unit(context: Context, element: Element) -> str:
    """Name of the unit of the element's value type, or the empty string."""
    type_ = query.type_of(context.graph, element)
    found = None if type_ is None else query.tag(context.graph, type_, "unit")
    named = context.graph.get(found) if isinstance(found, str) else None
    return named.name if named is not None else str(found or "")


def value(element: Element) -> Scalar | None:
    """Default value, when it is a literal."""
    found = given(element)
    return found if isinstance(found, bool | int | float | str) else None


def given(element: Element) -> Scalar | tuple[Scalar, ...] | None:
    """Default value, when it is a literal or a list of literals."""
    found = element.attrs.get("default")
    if element.attrs.get("default_language") is not None:
        return None
    if isinstance(found, tuple):
        listed = tuple(one for one in found if isinstance(one, bool | int | float | str))
        return listed if len(listed) == len(found) else None
    return found if isinstance(found, bool | int | float | str) else None


def literal_value(literal: Element) -> Scalar:
    """The value of an enumeration literal; its name when it has none."""
    value = literal.attrs.get("value")
    return value if isinstance(value, bool | int | float | str) else literal.name
