"""Conditions and arithmetic of recipes as typed trees."""

from collections.abc import Iterator

from sysmlc.values import dataclass


@dataclass(frozen=True, slots=True)
class Lit:
    """A literal value."""

    value: bool | int | float | str


@dataclass(frozen=True, slots=True)
class Var:
    """A parameter or variable, with dots for what belongs to it."""

    name: str


@dataclass(frozen=True, slots=True)
class Apply:
    """An operator: + - * / mod == != < <= > >= and or not."""

    op: str
    args: tuple["Expr", ...]


@dataclass(frozen=True, slots=True)
class Index:
    """One value of a list."""

    base: "Expr"
    index: "Expr"


@dataclass(frozen=True, slots=True)
class Call:
    """A function known to the executor by name, applied to arguments."""

    function: str
    args: tuple["Expr", ...]


@dataclass(frozen=True, slots=True)
class Opaque:
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
