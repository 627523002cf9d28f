"""Conditions and arithmetic of recipes as typed trees, the form of the JSON schema."""

from collections.abc import Iterator

from msgspec import Struct


class Lit(Struct, frozen=True):
    """A literal value."""

    value: bool | int | float | str


class Var(Struct, frozen=True):
    """A parameter or variable, or a feature of one by a dotted path."""

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
    """A function that the executor knows by name, applied to arguments."""

    function: str
    args: tuple["Expr", ...]


class Opaque(Struct, frozen=True):
    """Text outside the expression grammar, for people; executors cannot evaluate it."""

    text: str


Expr = Lit | Var | Apply | Index | Call | Opaque


def negation(expression: Expr) -> Expr:
    """Return the negation of a condition."""
    match expression:
        case Apply("not", (operand,)):
            return operand
        case Lit(bool(value)):
            return Lit(not value)
        case _:
            return Apply("not", (expression,))


def disjunction(expressions: tuple[Expr, ...]) -> Expr:
    """Return the disjunction of conditions; false for none."""
    if not expressions:
        return Lit(False)
    result = expressions[0]
    for expression in expressions[1:]:
        result = Apply("or", (result, expression))
    return result


def operands(expression: Expr) -> tuple[Expr, ...]:
    """Return the operands of an operator, an index or a call; none for other expressions."""
    match expression:
        case Apply(_, args) | Call(_, args):
            return args
        case Index(base, index):
            return (base, index)
        case _:
            return ()


def iter_variables(expression: Expr) -> Iterator[str]:
    """Iterate over the names of the variables, with repetitions, from left to right."""
    if isinstance(expression, Var):
        yield expression.name
    for operand in operands(expression):
        yield from iter_variables(operand)


def iter_opaque_texts(expression: Expr) -> Iterator[str]:
    """Iterate over the texts in an expression that the grammar does not cover."""
    if isinstance(expression, Opaque):
        yield expression.text
    for operand in operands(expression):
        yield from iter_opaque_texts(operand)
