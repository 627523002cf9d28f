"""Syntax trees of expressions and effects, and their printer.

The grammar is ``grammars/expression.lark``. Printing a tree and parsing the text gives an equal
tree.
"""

import re
from dataclasses import dataclass, field
from typing import Generic, Self, TypeVar

_WORDS = "if else implies or OR xor XOR and AND not NOT true TRUE false FALSE send to"
_KEYWORDS = frozenset(_WORDS.split(" "))
"""Names that are spelled with quotes."""
_WORD = re.compile(r"[^\W\d]\w*")


class ExpressionError(ValueError):
    """The text is not an expression; ``offset`` counts characters from 0."""

    def __init__(self, message: str, offset: int) -> None:
        super().__init__(message)
        self.offset = offset


@dataclass(frozen=True, slots=True, eq=False)
class Literal:
    """A Boolean, an integer, a real number, or a string; 1 equals neither ``true`` nor 1.0."""

    value: bool | int | float | str

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Literal) and self._key() == other._key()

    def __hash__(self) -> int:
        return hash(self.value)

    def _key(self) -> tuple[type, bool | int | float | str]:
        # Python compares 1, 1.0 and True as equal.
        return type(self.value), self.value


@dataclass(frozen=True, slots=True)
class Name:
    """A name with the namespaces that qualify it, outermost first (``A::B``).

    ``element`` is the id of the element that the name denotes, or empty.
    """

    path: tuple[str, ...]
    element: str = field(default="", compare=False)


@dataclass(frozen=True, slots=True)
class Member:
    """A feature of the object that the base denotes (``a.b``); ``element`` is that of a name."""

    base: "Expression"
    name: str
    element: str = field(default="", compare=False)


@dataclass(frozen=True, slots=True)
class Unary:
    """``not``, ``-`` or ``+`` before its operand."""

    op: str
    operand: "Expression"


@dataclass(frozen=True, slots=True)
class Binary:
    """An operator (implies or xor and == != < <= > >= + - * / %) and its two operands."""

    op: str
    left: "Expression"
    right: "Expression"


@dataclass(frozen=True, slots=True)
class Conditional:
    """``if condition ? then else otherwise``."""

    condition: "Expression"
    then: "Expression"
    otherwise: "Expression"


@dataclass(frozen=True, slots=True)
class Call:
    """A function or an operation applied to arguments."""

    function: "Expression"
    args: tuple["Expression", ...]


@dataclass(frozen=True, slots=True)
class Index:
    """One value of a sequence (``xs#(i)``, ``xs[i]``)."""

    base: "Expression"
    index: "Expression"


Expression = Literal | Name | Member | Unary | Binary | Conditional | Call | Index


@dataclass(frozen=True, slots=True)
class Assignment:
    """``target := value``."""

    target: Expression
    value: Expression


@dataclass(frozen=True, slots=True)
class Send:
    """``send signal(args) to receiver``."""

    signal: Name
    args: tuple[Expression, ...] = ()
    receiver: Expression | None = None


@dataclass(frozen=True, slots=True)
class Invocation:
    """A call, or the name of an operation or a behaviour to perform."""

    call: Expression


Statement = Assignment | Send | Invocation


# -- values of attributes ----------------------------------------------------------------------


_Tree = TypeVar("_Tree")


class ParsedText(str, Generic[_Tree]):
    """A text as the value of an attribute, with its syntax tree.

    The value is compared, printed and stored like any text. Only ``str`` and ``strip`` return it
    with its tree.
    """

    __slots__ = ("tree",)
    tree: _Tree

    def __new__(cls, text: str, tree: _Tree) -> Self:
        value = super().__new__(cls, text)
        value.tree = tree
        return value

    def __str__(self) -> str:
        return self

    def strip(self, chars: str | None = None, /) -> str:
        text = super().strip(chars)
        return type(self)(text, self.tree) if chars is None else text

    def __reduce__(self) -> tuple[type[Self], tuple[str, _Tree]]:
        return type(self), (self[:], self.tree)


class ExpressionText(ParsedText[Expression]):
    """The text of an expression."""

    __slots__ = ()


class EffectText(ParsedText[tuple[Statement, ...]]):
    """The text of an effect."""

    __slots__ = ()


_MAX_NESTING = 150
"""Deepest nesting of expressions; a tuple of arguments counts as one level."""


def is_nested_too_deeply(tree: Expression | tuple[Statement, ...]) -> bool:
    """Whether the tree is so deep that functions cannot recurse over it."""
    level: list[object] = [tree]
    for _ in range(_MAX_NESTING):
        level = [child for node in level for child in list_children(node)]
        if not level:
            return False
    return True


def list_children(node: object) -> list[object]:
    """Return the nodes and the tuples below a node of a tree, or in a tuple."""
    names = getattr(type(node), "__match_args__", ())
    parts = node if isinstance(node, tuple) else [getattr(node, name) for name in names]
    return [part for part in parts if not isinstance(part, str | int | float | None)]


# -- printing ----------------------------------------------------------------------------------

PRECEDENCE: dict[str, int] = {"implies": 2, "or": 3, "xor": 4, "and": 5, "==": 6, "!=": 6} | {
    **dict.fromkeys(("<", "<=", ">", ">="), 7),
    **dict.fromkeys("+-", 8),
    **dict.fromkeys("*/%", 9),
}
"""Precedence of the binary operators, weakest first; a conditional has 0."""
UNARY, POSTFIX = 10, 11
"""Precedence of a unary operator, and of a name, literal, call or index."""


def print_expression(expression: Expression) -> str:
    """Return the expression in the spelling of KerML, with the fewest parentheses."""
    return _print(expression, 0)


def print_statement(statement: Statement) -> str:
    """Return one statement of an effect as text."""
    match statement:
        case Assignment(target, value):
            return f"{_print(target, POSTFIX)} := {_print(value, 0)}"
        case Send(signal, args, receiver):
            arguments = f"({_print_arguments(args)})" if args else ""
            end = "" if receiver is None else f" to {_print(receiver, POSTFIX)}"
            return f"send {_print(signal, POSTFIX)}{arguments}{end}"
        case Invocation(call):
            return _print(call, POSTFIX)


def print_effect(statements: tuple[Statement, ...]) -> str:
    """Return the statements separated by semicolons."""
    return "; ".join(print_statement(statement) for statement in statements)


def print_literal(value: bool | float | str) -> str:
    """Return a literal as expressions spell it."""
    if isinstance(value, str):
        return _quote(value, '"')
    return str(value).lower()


def dotted_name(expression: Expression | Statement) -> str | None:
    """Return a name or a chain of features as text (``a.b``, ``A::B``), or None."""
    match expression:
        case Name(path):
            return "::".join(path)
        case Member(base, name):
            base_name = dotted_name(base)
            return None if base_name is None else f"{base_name}.{name}"
        case _:
            return None


def name_of(expression: Expression | Statement) -> str | None:
    """Return ``dotted_name`` without a leading ``self`` or ``this``: ``x`` equals ``self.x``."""
    name = dotted_name(expression)
    if name is None or isinstance(expression, Name):
        return name
    head, _, rest = name.partition(".")
    return rest if head in ("self", "this") else name


def element_of(expression: Expression | Statement) -> str:
    """Return the id of the element that a name or a chain of features denotes, or empty."""
    return expression.element if isinstance(expression, Name | Member) else ""


def last_name(path: str) -> str:
    """Return the last name of a path: ``load`` of ``arm.load``, ``open`` of ``Door::open``."""
    return path.replace(".", "::").rpartition("::")[2]


def _print(expression: Expression, context_precedence: int) -> str:
    text, precedence = _print_with_precedence(expression)
    return f"({text})" if precedence < context_precedence else text


def _print_with_precedence(expression: Expression) -> tuple[str, int]:  # noqa: PLR0911 - by kind
    """Return the text without parentheses around it, and the precedence of its operator."""
    match expression:
        case Literal(value):
            return print_literal(value), POSTFIX
        case Name(path):
            return "::".join(map(_print_name, path)), POSTFIX
        case Member(base, name):
            return f"{_print(base, POSTFIX)}.{_print_name(name)}", POSTFIX
        case Call(function, args):
            return f"{_print(function, POSTFIX)}({_print_arguments(args)})", POSTFIX
        case Index(Literal() as number, unit):
            return f"{_print(number, POSTFIX)} [{_print(unit, 0)}]", POSTFIX
        case Index(base, index):
            return f"{_print(base, POSTFIX)}#({_print(index, 0)})", POSTFIX
        case Unary(op, operand):
            return f"{op}{' ' * (op == 'not')}{_print(operand, UNARY)}", UNARY
        case Binary():
            return _print_binary(expression)
        case Conditional(condition, then, otherwise):
            parts = _print(condition, 2), _print(then, 0), _print(otherwise, 0)
            return "if {} ? {} else {}".format(*parts), 0


def _print_binary(expression: Binary) -> tuple[str, int]:
    precedence = PRECEDENCE[expression.op]
    is_right_associative = expression.op == "implies"
    left = _print(expression.left, precedence + is_right_associative)
    right = _print(expression.right, precedence + (not is_right_associative))
    return f"{left} {expression.op} {right}", precedence


def _print_arguments(args: tuple[Expression, ...]) -> str:
    return ", ".join(_print(arg, 0) for arg in args)


def _print_name(name: str) -> str:
    is_plain = name.isidentifier() and name not in _KEYWORDS
    return name if is_plain else _quote(name, "'")


def _quote(text: str, quote: str) -> str:
    escaped = text.replace("\\", "\\\\").replace("\n", "\\n").replace(quote, f"\\{quote}")
    return f"{quote}{escaped}{quote}"


def walk_tree(tree: Expression | tuple[Statement, ...]) -> list[Expression | Statement]:
    """Return an expression and all its subexpressions, or an effect's statements with theirs."""
    nodes: list[Expression | Statement] = []
    worklist: list[object] = [tree]
    while worklist:
        node = worklist.pop()
        if isinstance(node, Expression | Statement):
            nodes.append(node)
        worklist += reversed(list_children(node))
    return nodes


def list_names(text: str) -> list[str]:
    """Return all names in an expression or an effect; the words of a text without a tree."""
    if not isinstance(text, ParsedText):
        return _WORD.findall(text)
    names: list[str] = []
    for node in walk_tree(text.tree):
        if isinstance(node, Name):
            names += node.path
        elif isinstance(node, Member):
            names.append(node.name)
    return names


def describe_unsupported(expression: Expression) -> str:
    """Return why an expression has no finite value."""
    text = print_expression(expression)
    if isinstance(expression, Call):
        return f"calls such as '{text}' are not evaluated"
    is_quantity = isinstance(expression, Index) and isinstance(expression.base, Literal)
    return f"'{text}' is {'a quantity with a unit' if is_quantity else 'not a finite value'}"
