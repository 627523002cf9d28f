"""Expressions and effects as modellers write them: values, reader and printer.

The grammar is grammars/expression.lark. Printing and reading again gives the same value.
"""

from dataclasses import dataclass, field

from msgspec import Struct

_WORDS = "if else implies or OR xor XOR and AND not NOT true TRUE false FALSE send to"
KEYWORDS = frozenset(_WORDS.split(" "))


class ExpressionError(ValueError):
    """Text that is no expression; ``offset`` counts its characters from 0."""

    def __init__(self, message: str, offset: int) -> None:
        super().__init__(message)
        self.offset = offset


class Literal(Struct, frozen=True, eq=False):
    """A Boolean, an integer, a real number, or a string; 1 is neither ``true`` nor 1.0."""

    value: bool | int | float | str
    offset: int = 0

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Literal) and self._typed() == other._typed()

    def __hash__(self) -> int:
        return hash(self.value)

    def _typed(self) -> tuple[type, bool | int | float | str]:
        return type(self.value), self.value


@dataclass(frozen=True, slots=True)
class Name:
    """A name with the namespaces that qualify it, outermost first (``A::B``)."""

    path: tuple[str, ...]
    offset: int = field(default=0, compare=False)


@dataclass(frozen=True, slots=True)
class Member:
    """A feature of what the base denotes (``a.b``)."""

    base: "Expression"
    name: str
    offset: int = field(default=0, compare=False)


@dataclass(frozen=True, slots=True)
class Unary:
    """``not``, ``-`` or ``+`` before its operand."""

    op: str
    operand: "Expression"
    offset: int = field(default=0, compare=False)


@dataclass(frozen=True, slots=True)
class Binary:
    """Operators: implies or xor and == != < <= > >= + - * / %."""

    op: str
    left: "Expression"
    right: "Expression"
    offset: int = field(default=0, compare=False)


@dataclass(frozen=True, slots=True)
class Conditional:
    """``if condition ? then else otherwise``."""

    condition: "Expression"
    then: "Expression"
    otherwise: "Expression"
    offset: int = field(default=0, compare=False)


@dataclass(frozen=True, slots=True)
class Call:
    """A function or an operation applied to arguments."""

    function: "Expression"
    args: tuple["Expression", ...]
    offset: int = field(default=0, compare=False)


@dataclass(frozen=True, slots=True)
class Index:
    """One value of a sequence (``xs#(i)``, ``xs[i]``)."""

    base: "Expression"
    index: "Expression"
    offset: int = field(default=0, compare=False)


Expression = Literal | Name | Member | Unary | Binary | Conditional | Call | Index


@dataclass(frozen=True, slots=True)
class Assignment:
    """``target := value``."""

    target: Expression
    value: Expression
    offset: int = field(default=0, compare=False)


@dataclass(frozen=True, slots=True)
class Send:
    """``send signal(args) to receiver``."""

    signal: Name
    args: tuple[Expression, ...] = ()
    receiver: Expression | None = None
    offset: int = field(default=0, compare=False)


@dataclass(frozen=True, slots=True)
class Invocation:
    """A call, or the name of something that is done."""

    call: Expression
    offset: int = field(default=0, compare=False)


Statement = Assignment | Send | Invocation

# -- printing ----------------------------------------------------------------------------------

STRENGTH: dict[str, int] = {"implies": 2, "or": 3, "xor": 4, "and": 5, "==": 6, "!=": 6} | {
    **dict.fromkeys(("<", "<=", ">", ">="), 7),
    **dict.fromkeys("+-", 8),
    **dict.fromkeys("*/%", 9),
}
"""How strongly operators bind."""
_UNARY, _POSTFIX = 10, 11


def print_expression(expression: Expression) -> str:
    """The expression in KerML's spelling, with the parentheses that it needs."""
    return _print(expression, 0)


def print_statement(statement: Statement) -> str:
    """One statement of an effect."""
    match statement:
        case Assignment(target, value):
            return f"{_print(target, _POSTFIX)} := {_print(value, 0)}"
        case Send(signal, args, receiver):
            arguments = f"({_commas(args)})" if args else ""
            end = "" if receiver is None else f" to {_print(receiver, _POSTFIX)}"
            return f"send {_print(signal, _POSTFIX)}{arguments}{end}"
        case Invocation(call):
            return _print(call, _POSTFIX)


def print_effect(statements: tuple[Statement, ...]) -> str:
    """Statements separated by semicolons."""
    return "; ".join(print_statement(statement) for statement in statements)


def dotted(expression: Expression) -> str | None:
    """The name that a chain of features is (``a.b``, ``A::B``), or None for anything else."""
    match expression:
        case Name(path):
            return "::".join(path)
        case Member(base, name):
            before = dotted(base)
            return None if before is None else f"{before}.{name}"
        case _:
            return None


def name_of(expression: Expression) -> str | None:
    """The name of a feature of the context: ``x`` and ``self.x`` are the same."""
    name = dotted(expression)
    if name is None or isinstance(expression, Name):
        return name
    head, _, rest = name.partition(".")
    return rest if head in ("self", "this") else name


def _print(expression: Expression, strength: int) -> str:
    text, own = _printed(expression)
    return f"({text})" if own < strength else text


def _printed(expression: Expression) -> tuple[str, int]:  # noqa: PLR0911 - one a kind
    match expression:
        case Literal(value):
            return print_literal(value), _POSTFIX
        case Name(path):
            return "::".join(map(_print_name, path)), _POSTFIX
        case Member(base, name):
            return f"{_print(base, _POSTFIX)}.{_print_name(name)}", _POSTFIX
        case Call(function, args):
            return f"{_print(function, _POSTFIX)}({_commas(args)})", _POSTFIX
        case Index(base, index):
            return f"{_print(base, _POSTFIX)}#({_print(index, 0)})", _POSTFIX
        case Unary(op, operand):
            return f"{op}{' ' * (op == 'not')}{_print(operand, _UNARY)}", _UNARY
        case Binary():
            return _print_binary(expression)
        case Conditional(condition, then, otherwise):
            parts = _print(condition, 2), _print(then, 0), _print(otherwise, 0)
            return "if {} ? {} else {}".format(*parts), 0


def _print_binary(expression: Binary) -> tuple[str, int]:
    own = STRENGTH[expression.op]
    to_the_right = expression.op == "implies"
    left = _print(expression.left, own + to_the_right)
    right = _print(expression.right, own + (not to_the_right))
    return f"{left} {expression.op} {right}", own


def _commas(args: tuple[Expression, ...]) -> str:
    return ", ".join(_print(arg, 0) for arg in args)


def _print_name(name: str) -> str:
    plain = name.isidentifier() and name not in KEYWORDS
    return name if plain else _quoted(name, "'")


def print_literal(value: bool | float | str) -> str:
    """A literal as expressions write it."""
    if isinstance(value, str):
        return _quoted(value, '"')
    return str(value).lower()


def _quoted(text: str, quote: str) -> str:
    escaped = text.replace("\\", "\\\\").replace("\n", "\\n").replace(quote, f"\\{quote}")
    return f"{quote}{escaped}{quote}"
