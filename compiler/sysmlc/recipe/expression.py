"""Conditions and arithmetic of recipes as typed trees."""

from collections.abc import Iterator

from msgspec import Struct


class Lit(Struct, frozen=True):
    """A literal value."""

    value: bool | int | float | str


class Var(Struct, frozen=True):
    """A parameter or variable, with dots for what belongs to it."""

    name: str


class Apply(Struct, frozen=True):
    """An operator: + - * / mod == != < <= > >= and or not."""

    op: str
    args: tuple["Expr", ...]


class Index(Struct, frozen=True):
    """One value of a list."""

    base: "Expr"
    index: "Expr"


class Call(Struct, frozen=True):
    """A function known to the executor by name, applied to arguments."""

    function: str
    args: tuple["Expr", ...]


class Opaque(Struct, frozen=True):
    """Text that the expression grammar does not cover; people read it, executors cannot."""

    text: str


Expr = Lit | Var | Apply | Index | Call | Opaque


def negated(expression: Expr) -> Expr:
    """The opposite condition."""
    match expression:
        case Apply("not", (inner,)):
            return inner
        case Lit(bool(value)):
            return Lit(not value)
        case _:
            return Apply("not", (expression,))


def either(expressions: tuple[Expr, ...]) -> Expr:
    """Disjunction; false of nothing."""
    if not expressions:
        return Lit(False)
    result = expressions[0]
    for one in expressions[1:]:
        result = Apply("or", (result, one))
    return result


def variables(expression: Expr) -> Iterator[str]:
    """Names of the variables, with repetitions, from left to right."""
    match expression:
        case Var(name):
            yield name
        case Apply(_, args) | Call(_, args):
            for arg in args:
                yield from variables(arg)
        case Index(base, index):
            yield from variables(base)
            yield from variables(index)


def unreadable(expression: Expr) -> Iterator[str]:
    """Parts that are mere text."""
    match expression:
        case Opaque(text):
            yield text
        case Apply(_, args) | Call(_, args):
            for arg in args:
                yield from unreadable(arg)
        case Index(base, index):
            yield from unreadable(base)
            yield from unreadable(index)
