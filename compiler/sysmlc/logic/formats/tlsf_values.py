"""What expressions of TLSF mean: numbers, formulas, buses, calls of definitions."""

from collections.abc import Callable, Iterator, Mapping
from itertools import product
from typing import ClassVar

from msgspec import Struct

from sysmlc.logic import formula as f
from sysmlc.logic.formats.tlsf_tree import Tree
from sysmlc.logic.formula import Apply, Formula, Op, Var
from sysmlc.logic.spelling import FormulaError

MOST_STEPS = 400_000
"""Parts of expressions that are evaluated for one file: definitions call one another."""
DEEPEST_CALL = 150


class Bus(Struct, frozen=True):
    """A signal of several bits, by the names of the bits."""

    bits: tuple[str, ...]


Value = int | Formula | Bus


class Definition(Struct, frozen=True):
    """A parameter, or a function: what to evaluate under which condition, the first that holds."""

    parameters: tuple[str, ...]
    clauses: tuple[tuple[Tree | None, Tree], ...]


class Values:
    """Evaluates trees; ``known`` are the signals of the file."""

    def __init__(self, definitions: Mapping[str, Definition], known: Mapping[str, Value]) -> None:
        self._definitions = definitions
        self._known = known
        self._steps = 0
        self._calls = 0

    def number(self, tree: Tree, local: Mapping[str, Value]) -> int:
        """The number that a tree is. Raises FormulaError."""
        value = self.value(tree, local)
        if not isinstance(value, int):
            raise FormulaError("a number is expected here", tree.at)
        return value

    def truth(self, tree: Tree, local: Mapping[str, Value]) -> Formula:
        """The formula that a tree is. Raises FormulaError."""
        value = self.value(tree, local)
        if isinstance(value, Bus) and len(value.bits) == 1:
            return Var(value.bits[0])
        if isinstance(value, int | Bus):
            what = "a number" if isinstance(value, int) else "a bus"
            raise FormulaError(f"{what} stands where a condition is expected", tree.at)
        return value

    def value(self, tree: Tree, local: Mapping[str, Value]) -> Value:
        """What a tree is where the names of ``local`` are known. Raises FormulaError."""
        self._steps += 1
        if self._steps > MOST_STEPS:
            raise FormulaError("the definitions take too many steps", tree.at)
        return self._by_kind[tree.kind](self, tree, local)

    def _group(self, tree: Tree, local: Mapping[str, Value]) -> Value:
        return self.value(tree.args[0], local)

    def _number(self, tree: Tree, local: Mapping[str, Value]) -> Value:
        return int(tree.text)

    def _name(self, tree: Tree, local: Mapping[str, Value]) -> Value:
        name = tree.text
        if name in ("true", "false"):
            return f.TRUE if name == "true" else f.FALSE
        for scope in (local, self._known):
            if name in scope:
                return scope[name]
        if name in self._definitions:
            return self._called(name, (), tree)
        raise FormulaError(f"'{name}' is not declared", tree.at)

    def _call(self, tree: Tree, local: Mapping[str, Value]) -> Value:
        if tree.text not in self._definitions:
            raise FormulaError(f"'{tree.text}' is no definition", tree.at)
        return self._called(tree.text, tuple(self.value(arg, local) for arg in tree.args), tree)

    def _called(self, name: str, args: tuple[Value, ...], tree: Tree) -> Value:
        definition = self._definitions[name]
        if len(args) != len(definition.parameters):
            wanted = len(definition.parameters)
            raise FormulaError(f"'{name}' takes {wanted} arguments, not {len(args)}", tree.at)
        self._calls += 1
        if self._calls > DEEPEST_CALL:
            raise FormulaError(f"'{name}' calls itself without end", tree.at)
        local = dict(zip(definition.parameters, args, strict=True))
        for guard, body in definition.clauses:
            if guard is None or self._holds(guard, local):
                value = self.value(body, local)
                self._calls -= 1
                return value
        raise FormulaError(f"no case of '{name}' holds here", tree.at)

    def _holds(self, guard: Tree, local: Mapping[str, Value]) -> bool:
        value = self.truth(guard, local)
        if value not in (f.TRUE, f.FALSE):
            raise FormulaError("the case depends on signals", guard.at)
        return value == f.TRUE

    def _index(self, tree: Tree, local: Mapping[str, Value]) -> Value:
        bus = self.value(tree.args[0], local)
        if not isinstance(bus, Bus):
            raise FormulaError(f"'{tree.text}' has no bits", tree.at)
        index = self.number(tree.args[1], local)
        if not 0 <= index < len(bus.bits):
            reason = f"'{tree.text}' has bits 0 to {len(bus.bits) - 1}, and no bit {index}"
            raise FormulaError(reason, tree.args[1].at)
        return Var(bus.bits[index])

    def _prefix(self, tree: Tree, local: Mapping[str, Value]) -> Value:
        (inner,) = tree.args
        if tree.text == "SIZEOF":
            bus = self.value(inner, local)
            if not isinstance(bus, Bus):
                raise FormulaError("SIZEOF is asked of a bus", tree.at)
            return len(bus.bits)
        if tree.text == "-":
            return -self.number(inner, local)
        formula = self.truth(inner, local)
        return f.negate(formula) if tree.text == "!" else Apply(_TEMPORAL[tree.text], (formula,))

    def _chain(self, tree: Tree, local: Mapping[str, Value]) -> Value:
        join = f.both if tree.text == "&&" else f.either
        return join(*(self.truth(arg, local) for arg in tree.args))

    def _infix(self, tree: Tree, local: Mapping[str, Value]) -> Value:
        left, right = tree.args
        if tree.text in _COUNTING:
            return self._counted(tree, self.number(left, local), self.number(right, local))
        if tree.text in _COMPARING:
            one, other = self.number(left, local), self.number(right, local)
            return f.TRUE if _COMPARING[tree.text](one, other) else f.FALSE
        return _JOINING[tree.text](self.truth(left, local), self.truth(right, local))

    def _counted(self, tree: Tree, left: int, right: int) -> int:
        if tree.text in ("/", "%") and right == 0:
            raise FormulaError("it divides by zero", tree.at)
        value = _COUNTING[tree.text](left, right)
        if abs(value) >= 1 << 60:
            raise FormulaError("the number is too large", tree.at)
        return value

    def _every(self, tree: Tree, local: Mapping[str, Value]) -> Value:
        *ranges, body = tree.args
        join = f.both if tree.text == "&&" else f.either
        return join(*(self.truth(body, {**local, **one}) for one in self._places(ranges, local)))

    def _places(self, ranges: list[Tree], local: Mapping[str, Value]) -> Iterator[dict[str, Value]]:
        names, spans = [], []
        for one in ranges:
            first, name, second = one.text.split()
            low, high = (self.number(bound, local) for bound in one.args)
            names.append(name)
            span = range(low + (first == "<"), high + (second == "<="))
            if len(span) > MOST_STEPS:
                raise FormulaError("the range is too large", one.at)
            spans.append(span)
        for row in product(*spans):
            yield dict(zip(names, row, strict=True))

    _by_kind: ClassVar[dict[str, Callable[..., Value]]] = {
        "group": _group,
        "number": _number,
        "name": _name,
        "call": _call,
        "index": _index,
        "prefix": _prefix,
        "chain": _chain,
        "infix": _infix,
        "every": _every,
    }


_TEMPORAL = {"X": Op.NEXT, "F": Op.EVENTUALLY, "G": Op.ALWAYS}
_COUNTING: dict[str, Callable[[int, int], int]] = {
    "+": lambda a, b: a + b,
    "-": lambda a, b: a - b,
    "*": lambda a, b: a * b,
    "/": lambda a, b: a // b,
    "%": lambda a, b: a % b,
}
_COMPARING: dict[str, Callable[[int, int], bool]] = {
    "==": lambda a, b: a == b,
    "!=": lambda a, b: a != b,
    "<": lambda a, b: a < b,
    "<=": lambda a, b: a <= b,
    ">": lambda a, b: a > b,
    ">=": lambda a, b: a >= b,
}
_JOINING: dict[str, Callable[[Formula, Formula], Formula]] = {
    "->": f.implies,
    "<->": f.iff,
    "U": lambda a, b: Apply(Op.UNTIL, (a, b)),
    "R": lambda a, b: Apply(Op.RELEASE, (a, b)),
    "W": lambda a, b: Apply(Op.WEAK_UNTIL, (a, b)),
}
