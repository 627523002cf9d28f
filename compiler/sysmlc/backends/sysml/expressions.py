"""Expressions of our grammar over the names of the text; other text stays as it is."""

from sysmlc.backends.sysml.book import Book
from sysmlc.backends.sysml.entry import Entry, Plan
from sysmlc.backends.sysml.references import lookup, meant, reference
from sysmlc.backends.sysml.words import quoted, string
from sysmlc.ir import Kind
from sysmlc.logic.expressions.expression import (
    Binary,
    Call,
    Conditional,
    Expression,
    ExpressionError,
    Index,
    Literal,
    Member,
    Name,
    Unary,
)
from sysmlc.logic.expressions.parsing import parse_expression


class UnknownNameError(ValueError):
    """A name in an expression that no namespace of the text knows."""


def expression(book: Book, scope: Entry | None, text: str) -> str | None:
    """The text as an expression of SysML v2, or None when it is none over the model."""
    try:
        return written(book, scope, parse_expression(text))
    except (ExpressionError, UnknownNameError, RecursionError):
        return None


def written(book: Book, scope: Entry | None, tree: Expression) -> str:
    """An expression in SysML v2. Raises UnknownNameError."""
    return _Printer(book.plan, scope).text(tree, 0)


def resolved(book: Book, scope: Entry | None, tree: Expression) -> Entry | None:
    """The feature that a name, or a chain of names, denotes. Raises UnknownNameError."""
    return _Printer(book.plan, scope).chain(tree)[1]


_STRENGTH = {"implies": 2, "or": 3, "xor": 4, "and": 5, "==": 6, "!=": 6} | {
    **dict.fromkeys(("<", "<=", ">", ">="), 8),
    **dict.fromkeys("+-", 9),
    **dict.fromkeys("*/%", 10),
}
_UNARY, _POSTFIX = 12, 13


class _Printer:
    def __init__(self, plan: Plan, scope: Entry | None) -> None:
        self._plan = plan
        self._scope = scope

    def text(self, tree: Expression, strength: int) -> str:
        text, own = self._printed(tree)
        return f"({text})" if own < strength else text

    def _printed(self, tree: Expression) -> tuple[str, int]:  # noqa: PLR0911 - one a kind
        match tree:
            case Literal(value):
                return _literal(value), _POSTFIX
            case Name() | Member():
                return self.chain(tree)[0], _POSTFIX
            case Call(function, args):
                inside = ", ".join(self.text(arg, 0) for arg in args)
                return f"{self.text(function, _POSTFIX)}({inside})", _POSTFIX
            case Index(base, index):
                return f"{self.text(base, _POSTFIX)}#({self.text(index, 0)})", _POSTFIX
            case Unary(op, operand):
                return f"{op}{' ' * (op == 'not')}{self.text(operand, _UNARY)}", _UNARY
            case Binary():
                return self._binary(tree)
            case Conditional(condition, then, otherwise):
                parts = self.text(condition, 2), self.text(then, 1), self.text(otherwise, 1)
                return "if {} ? {} else {}".format(*parts), 0

    def _binary(self, tree: Binary) -> tuple[str, int]:
        own = _STRENGTH[tree.op]
        to_the_right = tree.op == "implies"
        left = self.text(tree.left, own + to_the_right)
        right = self.text(tree.right, own + (not to_the_right))
        return f"{left} {tree.op} {right}", own

    # -- names ---------------------------------------------------------------------------------

    def chain(self, tree: Expression) -> tuple[str, Entry | None]:
        """The text of a name or a chain of names, and what it denotes."""
        if isinstance(tree, Name):
            entry = self._head(tree.path)
            if entry is None:
                raise UnknownNameError("::".join(tree.path))
            text = reference(self._plan, self._scope, entry)
            if text is None:
                raise UnknownNameError(entry.name)
            return text, entry
        if isinstance(tree, Member):
            before, entry = (
                self.chain(tree.base)
                if isinstance(tree.base, Name | Member)
                else (self.text(tree.base, _POSTFIX), None)
            )
            found = None if entry is None else meant(self._plan, entry, tree.name)
            if found is None:
                raise UnknownNameError(tree.name)
            return f"{before}.{quoted(found.name)}", found
        return self.text(tree, _POSTFIX), None

    def _head(self, path: tuple[str, ...]) -> Entry | None:
        entry = self._first(path[0])
        for name in path[1:]:
            entry = None if entry is None else meant(self._plan, entry, name)
        if entry is None:
            return self._by_suffix(path)
        return entry

    def _first(self, name: str) -> Entry | None:
        scope = self._scope
        for space in () if scope is None else (scope, *scope.above):
            found = meant(self._plan, space, name)
            if found is not None and found.shape.keyword not in _NO_VALUES:
                return found
        return lookup(self._plan, None, name)

    def _by_suffix(self, path: tuple[str, ...]) -> Entry | None:
        """A literal that is named alone, or a name that starts in the middle of the path."""
        kinds = (Kind.ENUMERATION_LITERAL,) if len(path) == 1 else _QUALIFIED
        found = []
        for element in self._plan.graph.of_kind(*kinds):
            entry = self._plan.entry(element) if element.name == path[-1] else None
            if entry is None:
                continue
            names = [one.name for one in (entry, *entry.above)][: len(path)]
            if tuple(reversed(names)) == path:
                found.append(entry)
        return found[0] if len(found) == 1 else None


_NO_VALUES = frozenset({"transition", "succession", "flow", "comment", "dependency", "start"})
"""Keywords of members that no expression means."""
_QUALIFIED = (Kind.ENUMERATION_LITERAL, Kind.PROPERTY, Kind.PORT, Kind.OPERATION, Kind.INSTANCE)


def _literal(value: bool | float | str) -> str:
    if isinstance(value, str):
        return string(value)
    return str(value).lower()
