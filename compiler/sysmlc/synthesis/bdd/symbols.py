"""Variables of a contract as bits, and formulas over them as decision diagrams.

A Boolean is one bit, a number the binary code of its distance from the least value, a literal of
an enumeration that of its place. ``x.0`` is the most significant bit of ``x``, ``x.0'`` its next
value, which lies directly below it in the order.
"""

from collections.abc import Callable, Collection, Iterable, Mapping
from copy import copy

from sysmlc.logic import domains
from sysmlc.logic.contract import BooleanDomain, EnumerationDomain, IntegerDomain, Owner, Variable
from sysmlc.logic.formula import Apply, Const, Formula, Literal, Op, Var
from sysmlc.synthesis.bdd import bit_vectors as vectors
from sysmlc.synthesis.bdd.bit_vectors import Vector
from sysmlc.synthesis.bdd.manager import Manager, Node
from sysmlc.synthesis.bdd.variable_order import ordered


class SymbolError(ValueError):
    """A formula that has no value for some variables: an unknown name, a type that does not fit,
    an operator of temporal logic."""


class Symbols:
    """Bits of the variables in one manager."""

    def __init__(
        self,
        manager: Manager,
        variables: Iterable[Variable],
        together: Iterable[Collection[str]] = (),
    ) -> None:
        """Declare the bits of the variables, each beside its next value (``order``).

        ``together`` are names of variables that something is said of.
        """
        self.manager = manager
        self.variables = {one.name: one for one in variables}
        self._bits = {name: _bits(one) for name, one in self.variables.items()}
        self._nodes: dict[Formula, Node] = {}
        self._vectors: dict[Formula, Vector] = {}
        order = ordered(self.variables.values(), self._bits, together)
        manager.declare([one for bit in order for one in (bit, next_bit(bit))])
        self._to_next = {bit: manager.var(next_bit(bit)) for bit in order}
        self._to_present = {next_bit(bit): manager.var(bit) for bit in order}

    def only(self, names: Collection[str]) -> "Symbols":
        """The same bits, as if there were no other variables than these."""
        found = copy(self)
        found.variables = {name: one for name, one in self.variables.items() if name in names}
        return found

    def bits(self, name: str, primed: bool = False) -> tuple[str, ...]:
        """The bits of a variable, the most significant one first."""
        bits = self._bits[name]
        return tuple(map(next_bit, bits)) if primed else bits

    def owned(self, owner: Owner, primed: bool = False) -> tuple[str, ...]:
        """The bits of all variables of one side, in the order of the variables."""
        return self.all_bits(
            [one.name for one in self.variables.values() if one.owner is owner], primed
        )

    def all_bits(self, names: Iterable[str], primed: bool = False) -> tuple[str, ...]:
        """The bits of variables."""
        return tuple(bit for name in names for bit in self.bits(name, primed))

    def prime(self, node: Node) -> Node:
        """The same about the next step; the diagram must not speak of it already."""
        return self.manager.compose(node, self._to_next)

    def unprime(self, node: Node) -> Node:
        """The same about the present step; the diagram must speak of the next one only."""
        return self.manager.compose(node, self._to_present)

    def names(self, node: Node, primed: bool = False) -> tuple[str, ...]:
        """The variables that the diagram depends on, in this step or in the next."""
        support = self.manager.support(node)
        return tuple(
            name for name in self.variables if not support.isdisjoint(self.bits(name, primed))
        )

    def domain(self, name: str, primed: bool = False) -> Node:
        """The codes of the variable that stand for values."""
        size = domains.size(self.variables[name].domain)
        bits = self.bits(name, primed)
        if size == 1 << len(bits):
            return self.manager.true
        code = vectors.unsigned(self.manager, self._vars(bits)[::-1])
        return vectors.less(self.manager, code, vectors.constant(self.manager, size))

    def encode(self, values: Mapping[str, Literal], primed: bool = False) -> Node:
        """The steps in which the variables have these values.

        Raises SymbolError for a value that is not of the domain.
        """
        bits: dict[str, bool] = {}
        for name, value in values.items():
            bits |= self.code(name, value, primed)
        return self.manager.cube(bits)

    def code(self, name: str, value: Literal, primed: bool = False) -> dict[str, bool]:
        """The bits of a variable for one value; raises SymbolError if it has no such value."""
        domain = self.variables[name].domain
        if not domains.contains(domain, value):
            raise SymbolError(f"{name} cannot be {value}")
        place = domains.values(domain).index(value)
        bits = self.bits(name, primed)
        return {bit: bool(place >> at & 1) for at, bit in enumerate(reversed(bits))}

    def decode(self, assignment: Mapping[str, bool], primed: bool = False) -> dict[str, Literal]:
        """The values of all variables whose bits are in the assignment.

        Raises SymbolError for a code that stands for no value.
        """
        found: dict[str, Literal] = {}
        for name, variable in self.variables.items():
            bits = self.bits(name, primed)
            if all(bit in assignment for bit in bits):
                found[name] = _value(variable, [assignment[bit] for bit in bits])
        return found

    def bdd(self, formula: Formula) -> Node:
        """The diagram of a Boolean formula without temporal operators; primes are next values.

        Raises SymbolError when the formula has none.
        """
        found = self._nodes.get(formula)
        if found is None:
            found = self._nodes[formula] = self._boolean(formula)
        return found

    def _boolean(self, formula: Formula) -> Node:
        match formula:
            case Const(bool(value)):
                return self.manager.true if value else self.manager.false
            case Var(name, primed):
                if not isinstance(self._variable(name).domain, BooleanDomain):
                    raise SymbolError(f"{name} is not Boolean")
                return self.manager.var(self.bits(name, primed)[0])
            case Apply(op, args) if op in _CONNECTIVES:
                return _CONNECTIVES[op](self.manager, [self.bdd(arg) for arg in args])
            case Apply(op, (left, right)) if op in _COMPARISONS:
                return self._compared(op, left, right)
            case Apply(op, _):
                raise SymbolError(f"{op} gives no Boolean of one step")
            case _:
                raise SymbolError(f"{formula.value} is not Boolean")

    def _compared(self, op: Op, left: Formula, right: Formula) -> Node:
        if self._is_boolean(left) or self._is_boolean(right):
            return self._equal(op, self.bdd(left).equiv(self.bdd(right)))
        names = self._literals(left) or self._literals(right)
        if names:
            return self._equal(op, self._same_literal(left, right))
        return _COMPARISONS[op](self.manager, self.vector(left), self.vector(right))

    def _equal(self, op: Op, same: Node) -> Node:
        if op is Op.EQ:
            return same
        if op is Op.NE:
            return ~same
        raise SymbolError(f"{op} compares numbers")

    def _same_literal(self, left: Formula, right: Formula) -> Node:
        shared = self._by_literal(left), self._by_literal(right)
        found = self.manager.false
        for literal, node in shared[0].items():
            found = found | (node & shared[1].get(literal, self.manager.false))
        return found

    def _by_literal(self, formula: Formula) -> dict[str, Node]:
        """Where an operand is which literal."""
        match formula:
            case Const(str(literal)):
                return {literal: self.manager.true}
            case Var(name, primed) if literals := self._literals(formula):
                codes = {one: self.code(name, one, primed) for one in literals}
                return {one: self.manager.cube(code) for one, code in codes.items()}
            case _:
                raise SymbolError("a literal is compared with what is none")

    def _literals(self, formula: Formula) -> tuple[str, ...]:
        match formula:
            case Const(str(literal)):
                return (literal,)
            case Var(name):
                domain = self._variable(name).domain
                return domain.literals if isinstance(domain, EnumerationDomain) else ()
            case _:
                return ()

    def _is_boolean(self, formula: Formula) -> bool:
        match formula:
            case Const(value):
                return isinstance(value, bool)
            case Var(name):
                return isinstance(self._variable(name).domain, BooleanDomain)
            case Apply(op, _):
                return op not in _ARITHMETIC

    def vector(self, formula: Formula) -> Vector:
        """The bits of a whole number; raises SymbolError for what is none."""
        found = self._vectors.get(formula)
        if found is None:
            found = self._vectors[formula] = self._number(formula)
        return found

    def _number(self, formula: Formula) -> Vector:
        match formula:
            case Const(int(value)) if not isinstance(value, bool):
                return vectors.constant(self.manager, value)
            case Var(name, primed):
                return self._read(self._variable(name), primed)
            case Apply(op, (left, right)) if op in _ARITHMETIC:
                return _ARITHMETIC[op](self.manager, self.vector(left), self.vector(right))
            case Apply(Op.SUB, (only,)):
                return self.vector(Apply(Op.SUB, (Const(0), only)))
            case _:
                raise SymbolError("a number is expected")

    def _read(self, variable: Variable, primed: bool) -> Vector:
        domain = variable.domain
        if not isinstance(domain, IntegerDomain):
            raise SymbolError(f"{variable.name} is no number")
        code = vectors.unsigned(self.manager, self._vars(self.bits(variable.name, primed))[::-1])
        least = vectors.constant(self.manager, domain.low)
        return vectors.add(self.manager, code, least) if domain.low else code

    def _variable(self, name: str) -> Variable:
        if name not in self.variables:
            raise SymbolError(f"{name} is no variable of the contract")
        return self.variables[name]

    def _vars(self, bits: Collection[str]) -> list[Node]:
        return [self.manager.var(bit) for bit in bits]


def next_bit(bit: str) -> str:
    """The bit of the next value."""
    return f"{bit}'"


def width(variable: Variable) -> int:
    """Number of bits; a variable with one value has one, so that it can be seen."""
    return max(1, (domains.size(variable.domain) - 1).bit_length())


def _bits(variable: Variable) -> tuple[str, ...]:
    return tuple(f"{variable.name}.{place}" for place in range(width(variable)))


def _value(variable: Variable, bits: list[bool]) -> Literal:
    place = sum(bit << at for at, bit in enumerate(reversed(bits)))
    if place >= domains.size(variable.domain):
        raise SymbolError(f"{variable.name} has no value with the code {place}")
    return domains.values(variable.domain)[place]


def _and(manager: Manager, parts: list[Node]) -> Node:
    found = manager.true
    for part in parts:
        found = found & part
    return found


def _or(manager: Manager, parts: list[Node]) -> Node:
    found = manager.false
    for part in parts:
        found = found | part
    return found


_CONNECTIVES: dict[Op, Callable[[Manager, list[Node]], Node]] = {
    Op.NOT: lambda _, parts: ~parts[0],
    Op.AND: _and,
    Op.OR: _or,
    Op.IMPLIES: lambda _, parts: parts[0].implies(parts[1]),
    Op.IFF: lambda _, parts: parts[0].equiv(parts[1]),
}
_COMPARISONS: dict[Op, Callable[[Manager, Vector, Vector], Node]] = {
    Op.EQ: vectors.equal,
    Op.NE: lambda manager, left, right: ~vectors.equal(manager, left, right),
    Op.LT: vectors.less,
    Op.GE: lambda manager, left, right: ~vectors.less(manager, left, right),
    Op.GT: lambda manager, left, right: vectors.less(manager, right, left),
    Op.LE: lambda manager, left, right: ~vectors.less(manager, right, left),
}
_ARITHMETIC: dict[Op, Callable[[Manager, Vector, Vector], Vector]] = {
    Op.ADD: vectors.add,
    Op.SUB: vectors.subtract,
    Op.MUL: vectors.multiply,
    Op.DIV: vectors.divide,
    Op.MOD: vectors.modulo,
}
