"""Expressions of TLSF: a parser to syntax trees, and their evaluation to numbers and formulas.

A definition is evaluated each time it is called, so the parser does not build formulas directly.

Source: "A high-level LTL synthesis format: TLSF v1.1" (Jacobs, Klein, Schirmer), precedences
included: U, R and W bind more weakly than the Boolean connectives.
"""

import operator
from collections.abc import Callable, Iterator, Mapping
from itertools import product
from typing import ClassVar

from msgspec import Struct

from sysmlc.logic import formula as f
from sysmlc.logic.formula import Apply, Formula, Op, Var
from sysmlc.logic.infix import MAX_DEPTH
from sysmlc.logic.syntax import Cursor, FormulaError
from sysmlc.support.counts import count

INFIX = {
    "R": (1, "left"),
    "U": (2, "right"),
    "W": (3, "right"),
    "->": (4, "right"),
    "IMPLIES": (4, "right"),
    "<->": (4, "right"),
    "EQUIV": (4, "right"),
    "||": (5, "left"),
    "OR": (5, "left"),
    "&&": (6, "left"),
    "AND": (6, "left"),
    **dict.fromkeys(("==", "!=", "<", "<=", ">", ">=", "EQ", "NEQ", "LE", "LEQ"), (8, "left")),
    **dict.fromkeys(("+", "-", "PLUS", "MINUS"), (9, "left")),
    **dict.fromkeys(("*", "/", "%", "MUL", "DIV", "MOD"), (10, "left")),
}
"""Infix operators with precedence and associativity."""
_SUM_PRECEDENCE = 9
_UNARY_PRECEDENCE = 7
PREFIX = ("!", "NOT", "X", "F", "G", "SIZEOF", "-")
QUANTIFIERS = ("&&", "||", "FORALL", "EXISTS", "AND", "OR")
_SIGNS = {
    "IMPLIES": "->",
    "EQUIV": "<->",
    "OR": "||",
    "AND": "&&",
    "NOT": "!",
    "EQ": "==",
    "NEQ": "!=",
    "LE": "<",
    "LEQ": "<=",
    "PLUS": "+",
    "MINUS": "-",
    "MUL": "*",
    "DIV": "/",
    "MOD": "%",
    "FORALL": "&&",
    "EXISTS": "||",
}
"""Operators written as words, with the signs that mean the same."""
_MAX_OPERATORS = MAX_DEPTH * 8
_NO_SETS = "sets are not read; a range is, as 0 <= i < n"
_TEMPORAL = {"X": Op.NEXT, "F": Op.EVENTUALLY, "G": Op.ALWAYS}
_ARITHMETIC: dict[str, Callable[[int, int], int]] = {
    "+": operator.add,
    "-": operator.sub,
    "*": operator.mul,
    "/": operator.floordiv,
    "%": operator.mod,
}
_COMPARISONS: dict[str, Callable[[int, int], bool]] = {
    "==": operator.eq,
    "!=": operator.ne,
    "<": operator.lt,
    "<=": operator.le,
    ">": operator.gt,
    ">=": operator.ge,
}
_CONNECTIVES: dict[str, Callable[[Formula, Formula], Formula]] = {
    "->": f.implies,
    "<->": f.iff,
    "U": lambda left, right: Apply(Op.UNTIL, (left, right)),
    "R": lambda left, right: Apply(Op.RELEASE, (left, right)),
    "W": lambda left, right: Apply(Op.WEAK_UNTIL, (left, right)),
}


# -- parsing ---------------------------------------------------------------------------------------


class Tree(Struct, frozen=True):
    """A node of a syntax tree; ``kind`` is one of the keys of ``Evaluator``, or ``range``."""

    kind: str
    text: str
    offset: int
    args: tuple["Tree", ...] = ()


def parse_expression(cursor: Cursor, min_precedence: int = 0, depth: int = 0) -> Tree:
    """Parse an expression up to the first operator of a lower precedence. Raises FormulaError."""
    if depth > MAX_DEPTH:
        raise FormulaError(f"it is nested more than {MAX_DEPTH} deep", cursor.next.offset)
    tree = _parse_operand(cursor, depth)
    operators = depth
    while (token := cursor.next).text in INFIX and token.kind in ("sign", "name"):
        precedence, associativity = INFIX[token.text]
        if precedence < min_precedence:
            break
        operators += 1
        if operators > _MAX_OPERATORS:
            raise FormulaError("it has too many operands", token.offset)
        cursor.take()
        right = parse_expression(cursor, precedence + (associativity == "left"), depth + 1)
        tree = _join(_SIGNS.get(token.text, token.text), token.offset, tree, right)
    return tree


def _join(sign: str, offset: int, left: Tree, right: Tree) -> Tree:
    """Return the tree of an infix operator; a chain of && or || is one flat tree."""
    if sign not in ("&&", "||"):
        return Tree("infix", sign, offset, (left, right))
    is_chain = left.kind == "chain" and left.text == sign
    return Tree("chain", sign, offset, (*left.args, right) if is_chain else (left, right))


def _parse_operand(cursor: Cursor, depth: int) -> Tree:
    token = cursor.next
    if token.text in QUANTIFIERS and cursor.after_next.text == "[":
        return _parse_quantifier(cursor, depth)
    if token.text in PREFIX and token.kind in ("sign", "name"):
        cursor.take()
        operand = parse_expression(cursor, _UNARY_PRECEDENCE, depth + 1)
        return Tree("prefix", _SIGNS.get(token.text, token.text), token.offset, (operand,))
    if cursor.accept("("):
        content = parse_expression(cursor, 0, depth + 1)
        cursor.expect(")")
        return Tree("group", "(", token.offset, (content,))
    if token.kind == "number":
        return Tree("number", str(cursor.read_integer()), token.offset)
    if cursor.is_next("{"):
        raise FormulaError(_NO_SETS, token.offset)
    name = cursor.expect_kind("name", "an operand")
    tree = Tree("name", name.text, name.offset)
    if cursor.accept("("):
        args = _parse_list(cursor, ")", lambda: parse_expression(cursor, 0, depth + 1))
        tree = Tree("call", name.text, name.offset, args)
    while cursor.accept("["):
        index = parse_expression(cursor, 0, depth + 1)
        cursor.expect("]")
        tree = Tree("index", tree.text, tree.offset, (tree, index))
    return tree


def _parse_list(cursor: Cursor, end: str, parse_item: Callable[[], Tree]) -> tuple[Tree, ...]:
    items = [parse_item()]
    while cursor.accept(","):
        items.append(parse_item())
    cursor.expect(end)
    return tuple(items)


def _parse_quantifier(cursor: Cursor, depth: int) -> Tree:
    token = cursor.take()
    cursor.expect("[")
    ranges = _parse_list(cursor, "]", lambda: _parse_range(cursor, depth))
    body = parse_expression(cursor, _UNARY_PRECEDENCE, depth + 1)
    sign = _SIGNS.get(token.text, token.text)
    return Tree("quantifier", sign, token.offset, (*ranges, body))


def _parse_range(cursor: Cursor, depth: int) -> Tree:
    """Parse ``0 <= i < n`` to a tree with the text ``<= i <`` and the bounds as operands."""
    low = parse_expression(cursor, _SUM_PRECEDENCE, depth + 1)
    if cursor.is_next("IN"):
        raise FormulaError(_NO_SETS, cursor.next.offset)
    low_sign = cursor.expect("<", "<=")
    name = cursor.expect_kind("name", "a name")
    high_sign = cursor.expect("<", "<=")
    high = parse_expression(cursor, _SUM_PRECEDENCE, depth + 1)
    text = f"{low_sign.text} {name.text} {high_sign.text}"
    return Tree("range", text, name.offset, (low, high))


# -- evaluation ------------------------------------------------------------------------------------

MAX_CALL_DEPTH = 150
_MAX_STEPS = 400_000
"""Most trees that are evaluated for one file, since definitions call one another."""
_MAX_NUMBER = 1 << 60


class Bus(Struct, frozen=True):
    """A signal of several bits, by the names of the bits."""

    bits: tuple[str, ...]


Value = int | Formula | Bus
Scope = Mapping[str, Value]


class Definition(Struct, frozen=True):
    """A parameter or a function; of its clauses, the first one with a true guard counts."""

    parameters: tuple[str, ...]
    clauses: tuple[tuple[Tree | None, Tree], ...]


class Evaluator:
    """Evaluates trees with the definitions and signals of a file.

    Parameters of a definition and variables of quantifiers are in the *scope*.
    """

    def __init__(self, definitions: Mapping[str, Definition], signals: Scope) -> None:
        self._definitions = definitions
        self._signals = signals
        self._steps = 0
        self._call_depth = 0

    def evaluate_number(self, tree: Tree, scope: Scope) -> int:
        """Return the number that a tree means. Raises FormulaError."""
        value = self.evaluate(tree, scope)
        if not isinstance(value, int):
            raise FormulaError("a number is expected here", tree.offset)
        return value

    def evaluate_formula(self, tree: Tree, scope: Scope) -> Formula:
        """Return the formula that a tree means. Raises FormulaError."""
        value = self.evaluate(tree, scope)
        if isinstance(value, Bus) and len(value.bits) == 1:
            return Var(value.bits[0])
        if isinstance(value, int | Bus):
            kind = "a number" if isinstance(value, int) else "a bus"
            raise FormulaError(f"{kind} found; expected a condition", tree.offset)
        return value

    def evaluate(self, tree: Tree, scope: Scope) -> Value:
        """Return the value of a tree. Raises FormulaError."""
        self._steps += 1
        if self._steps > _MAX_STEPS:
            raise FormulaError("the definitions take too many steps", tree.offset)
        return self._by_kind[tree.kind](self, tree, scope)

    def _evaluate_name(self, tree: Tree, scope: Scope) -> Value:
        name = tree.text
        if name in ("true", "false"):
            return f.TRUE if name == "true" else f.FALSE
        for names in (scope, self._signals):
            if name in names:
                return names[name]
        if name in self._definitions:
            return self._call(name, (), tree)
        raise FormulaError(f"'{name}' is not declared", tree.offset)

    def _evaluate_call(self, tree: Tree, scope: Scope) -> Value:
        if tree.text not in self._definitions:
            raise FormulaError(f"'{tree.text}' is not a definition", tree.offset)
        arguments = tuple(self.evaluate(arg, scope) for arg in tree.args)
        return self._call(tree.text, arguments, tree)

    def _call(self, name: str, arguments: tuple[Value, ...], tree: Tree) -> Value:
        definition = self._definitions[name]
        expected = len(definition.parameters)
        if len(arguments) != expected:
            reason = f"'{name}' takes {count(expected, 'argument')}, not {len(arguments)}"
            raise FormulaError(reason, tree.offset)
        self._call_depth += 1
        if self._call_depth > MAX_CALL_DEPTH:
            raise FormulaError(f"'{name}' calls itself without end", tree.offset)
        scope = dict(zip(definition.parameters, arguments, strict=True))
        for guard, body in definition.clauses:
            if guard is None or self._is_true(guard, scope):
                value = self.evaluate(body, scope)
                self._call_depth -= 1
                return value
        raise FormulaError(f"no case of '{name}' holds here", tree.offset)

    def _is_true(self, guard: Tree, scope: Scope) -> bool:
        value = self.evaluate_formula(guard, scope)
        if value not in (f.TRUE, f.FALSE):
            raise FormulaError("the case depends on signals", guard.offset)
        return value == f.TRUE

    def _evaluate_index(self, tree: Tree, scope: Scope) -> Value:
        bus = self.evaluate(tree.args[0], scope)
        if not isinstance(bus, Bus):
            raise FormulaError(f"'{tree.text}' has no bits", tree.offset)
        index = self.evaluate_number(tree.args[1], scope)
        if not 0 <= index < len(bus.bits):
            reason = f"'{tree.text}' has bits 0 to {len(bus.bits) - 1}, and no bit {index}"
            raise FormulaError(reason, tree.args[1].offset)
        return Var(bus.bits[index])

    def _evaluate_prefix(self, tree: Tree, scope: Scope) -> Value:
        (operand,) = tree.args
        if tree.text == "SIZEOF":
            bus = self.evaluate(operand, scope)
            if not isinstance(bus, Bus):
                raise FormulaError("SIZEOF is asked of a bus", tree.offset)
            return len(bus.bits)
        if tree.text == "-":
            return -self.evaluate_number(operand, scope)
        formula = self.evaluate_formula(operand, scope)
        return f.negate(formula) if tree.text == "!" else Apply(_TEMPORAL[tree.text], (formula,))

    def _evaluate_chain(self, tree: Tree, scope: Scope) -> Value:
        join = f.both if tree.text == "&&" else f.either
        return join(*(self.evaluate_formula(arg, scope) for arg in tree.args))

    def _evaluate_infix(self, tree: Tree, scope: Scope) -> Value:
        left, right = tree.args
        if tree.text in _CONNECTIVES:
            connect = _CONNECTIVES[tree.text]
            return connect(self.evaluate_formula(left, scope), self.evaluate_formula(right, scope))
        numbers = self.evaluate_number(left, scope), self.evaluate_number(right, scope)
        if tree.text in _COMPARISONS:
            return f.TRUE if _COMPARISONS[tree.text](*numbers) else f.FALSE
        return self._calculate(tree, *numbers)

    def _calculate(self, tree: Tree, left: int, right: int) -> int:
        if tree.text in ("/", "%") and right == 0:
            raise FormulaError("it divides by zero", tree.offset)
        value = _ARITHMETIC[tree.text](left, right)
        if abs(value) >= _MAX_NUMBER:
            raise FormulaError("the number is too large", tree.offset)
        return value

    def _evaluate_quantifier(self, tree: Tree, scope: Scope) -> Value:
        *ranges, body = tree.args
        join = f.both if tree.text == "&&" else f.either
        bindings = self._iter_bindings(ranges, scope)
        return join(*(self.evaluate_formula(body, {**scope, **binding}) for binding in bindings))

    def _iter_bindings(self, ranges: list[Tree], scope: Scope) -> Iterator[dict[str, Value]]:
        """Yield the values of the variables of a quantifier."""
        names, spans = [], []
        for tree in ranges:
            low_sign, name, high_sign = tree.text.split()
            low, high = (self.evaluate_number(bound, scope) for bound in tree.args)
            span = range(low + (low_sign == "<"), high + (high_sign == "<="))
            if len(span) > _MAX_STEPS:
                raise FormulaError("the range is too large", tree.offset)
            names.append(name)
            spans.append(span)
        for values in product(*spans):
            yield dict(zip(names, values, strict=True))

    _by_kind: ClassVar[dict[str, Callable[..., Value]]] = {
        "group": lambda self, tree, scope: self.evaluate(tree.args[0], scope),
        "number": lambda _, tree, scope: int(tree.text),
        "name": _evaluate_name,
        "call": _evaluate_call,
        "index": _evaluate_index,
        "prefix": _evaluate_prefix,
        "chain": _evaluate_chain,
        "infix": _evaluate_infix,
        "quantifier": _evaluate_quantifier,
    }
