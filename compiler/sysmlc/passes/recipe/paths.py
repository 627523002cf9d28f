"""What dotted names in the expressions of an activity lead to."""

from collections.abc import Iterator

from sysmlc.ir import Element, Kind, query
from sysmlc.passes.recipe.context import Context
from sysmlc.passes.recipe.expressions import value_type
from sysmlc.recipe.expression import Apply, Call, Expr, Index, Lit, Var
from sysmlc.recipe.model import EnumType, Scalar

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


# -- literals ----------------------------------------------------------------------------------


def with_values(context: Context, activity: Element, expression: Expr) -> Expr:
    """The expression with the values of enumeration literals (SysML 2.0, 8.3.8).

    A literal beside something of its enumeration stays a name.
    """
    match expression:
        case Var(name) if "::" in name:
            literal = context.literal(name)
            return expression if literal is None else Lit(literal_value(literal))
        case Apply(op, args):
            kept = list(_of_enumerations(context, activity, args))
            return Apply(op, tuple(_inner(context, activity, one, kept) for one in args))
        case Index(base, index):
            return Index(base, with_values(context, activity, index))
        case Call(function, args):
            return Call(function, tuple(with_values(context, activity, one) for one in args))
        case _:
            return expression


def _inner(context: Context, activity: Element, one: Expr, kept: list[str]) -> Expr:
    literal = context.literal(one.name) if isinstance(one, Var) and "::" in one.name else None
    owner = None if literal is None else context.graph.owner(literal)
    is_kept = owner is not None and context.name(owner) in kept
    return one if is_kept else with_values(context, activity, one)


def _of_enumerations(context: Context, activity: Element, args: tuple[Expr, ...]) -> Iterator[str]:
    """Names of the enumerations that type what stands in an expression."""
    for one in args:
        found = feature_at(context, activity, one.name) if isinstance(one, Var) else None
        type_ = None if found is None else value_type(context, found)
        if isinstance(type_, EnumType):
            yield type_.name


def literal_value(literal: Element) -> Scalar:
    """The value of an enumeration literal; its name when it has none."""
    value = literal.attrs.get("value")
    return value if isinstance(value, bool | int | float | str) else literal.name
