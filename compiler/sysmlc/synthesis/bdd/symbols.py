"""Variables of a contract encoded in bits, and formulas over them as decision diagrams.

A Boolean is encoded as one bit, an integer as the binary number of its distance from the lower
bound, and a literal of an enumeration as the binary number of its index. ``x.0`` is the most
significant bit of ``x``; the bit of the next value, ``x.0'``, lies directly below it in the order.
"""

from collections.abc import Callable, Collection, Iterable, Mapping
from copy import copy

from sysmlc.logic import domains
from sysmlc.logic.contract import BooleanDomain, EnumerationDomain, IntegerDomain, Owner, Variable
from sysmlc.logic.formula import Apply, Const, Formula, Literal, Op, Var
from sysmlc.synthesis.bdd import bit_vectors as vectors
from sysmlc.synthesis.bdd.bit_vectors import Vector
from sysmlc.synthesis.bdd.manager import Manager, Node
from sysmlc.synthesis.bdd.variable_order import VariableOrder, order_bits


class SymbolError(ValueError):
    """Reports a formula without a diagram: an unknown name, a type error or a temporal operator.

    Also raised for values outside of a domain, and for codes that encode no value.
    """


class Symbols:
    """The symbol table of one manager: variables with their bits, current and next."""

    def __init__(
        self,
        manager: Manager,
        variables: Iterable[Variable],
        edges: Iterable[Collection[str]] = (),
        order: VariableOrder = VariableOrder.CONJUNCTS,
    ) -> None:
        """Declare the bits of the variables in an order of ``variable_order``.

        Each of *edges* contains the names of the variables of one conjunct.
        """
        self.manager = manager
        self.variables = {variable.name: variable for variable in variables}
        self._bits = {
            name: tuple(f"{name}.{index}" for index in range(domains.width(variable.domain)))
            for name, variable in self.variables.items()
        }
        self._nodes: dict[Formula, Node] = {}
        self._vectors: dict[Formula, Vector] = {}
        bit_order = order_bits(self.variables.values(), self._bits, edges, order)
        manager.declare([name for bit in bit_order for name in (bit, next_bit(bit))])
        self._to_next = {bit: manager.var(next_bit(bit)) for bit in bit_order}
        self._to_current = {next_bit(bit): manager.var(bit) for bit in bit_order}

    def only(self, names: Collection[str]) -> "Symbols":
        """Return the same symbols restricted to the variables *names*."""
        restricted = copy(self)
        restricted.variables = {
            name: variable for name, variable in self.variables.items() if name in names
        }
        return restricted

    def bits(self, name: str, primed: bool = False) -> tuple[str, ...]:
        """Return the bits of a variable, the most significant one first."""
        bits = self._bits[name]
        return tuple(map(next_bit, bits)) if primed else bits

    def names_of(self, owner: Owner) -> tuple[str, ...]:
        """Return the variables of one owner."""
        return tuple(name for name, item in self.variables.items() if item.owner is owner)

    def bits_of_owner(self, owner: Owner, primed: bool = False) -> tuple[str, ...]:
        """Return the bits of all variables of one owner, in the order of the variables."""
        return self.all_bits(self.names_of(owner), primed)

    def all_bits(self, names: Iterable[str], primed: bool = False) -> tuple[str, ...]:
        """Return the bits of several variables."""
        return tuple(bit for name in names for bit in self.bits(name, primed))

    def prime(self, node: Node) -> Node:
        """Replace current by next values; the diagram must not depend on next values already."""
        return self.manager.compose(node, self._to_next)

    def unprime(self, node: Node) -> Node:
        """Replace next by current values; the diagram must depend on next values only."""
        return self.manager.compose(node, self._to_current)

    def names(self, node: Node, primed: bool = False) -> tuple[str, ...]:
        """Return the variables whose current value (next value if *primed*) the diagram reads."""
        support = self.manager.support(node)
        return tuple(
            name for name in self.variables if not support.isdisjoint(self.bits(name, primed))
        )

    def domain(self, name: str, primed: bool = False) -> Node:
        """Return the condition that the bits of the variable encode a value of its domain."""
        # Sizes need not be powers of two, so some combinations of bits encode no value.
        size = domains.size(self.variables[name].domain)
        bits = self.bits(name, primed)
        if size == 1 << len(bits):
            return self.manager.true
        code = vectors.from_unsigned(self.manager, self._bit_nodes(bits)[::-1])
        return vectors.less(self.manager, code, vectors.constant(self.manager, size))

    def encode(self, values: Mapping[str, Literal], primed: bool = False) -> Node:
        """Return the states in which the variables have these values.

        Raises SymbolError for a value outside of its domain.
        """
        bits: dict[str, bool] = {}
        for name, value in values.items():
            bits |= self.code(name, value, primed)
        return self.manager.cube(bits)

    def code(self, name: str, value: Literal, primed: bool = False) -> dict[str, bool]:
        """Return the bits that encode a value of a variable.

        Raises SymbolError for a value outside of the domain.
        """
        domain = self.variables[name].domain
        if not domains.contains(domain, value):
            raise SymbolError(f"{name} cannot be {value}")
        return dict(zip(self.bits(name, primed), domains.encode(domain, value), strict=True))

    def decode(self, assignment: Mapping[str, bool], primed: bool = False) -> dict[str, Literal]:
        """Return the values of all variables whose bits are assigned.

        Raises SymbolError for a code that encodes no value.
        """
        values: dict[str, Literal] = {}
        for name, variable in self.variables.items():
            bits = self.bits(name, primed)
            if all(bit in assignment for bit in bits):
                try:
                    values[name] = domains.decode(
                        variable.domain, (assignment[bit] for bit in bits)
                    )
                except IndexError as problem:
                    raise SymbolError(f"{name} has {problem}") from None
        return values

    def bdd(self, formula: Formula) -> Node:
        """Return the diagram of a Boolean formula; primed variables denote next values.

        Raises SymbolError if the formula has none, for instance because of a temporal operator.
        """
        # Memoised, because the conjuncts of a contract have many subformulas in common.
        node = self._nodes.get(formula)
        if node is None:
            node = self._nodes[formula] = self._encode_boolean(formula)
        return node

    def _encode_boolean(self, formula: Formula) -> Node:
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
                return self._encode_comparison(op, left, right)
            case Apply(op, _):
                raise SymbolError(f"{op} gives no Boolean of one step")
            case _:
                raise SymbolError(f"{formula.value} is not Boolean")

    def _encode_comparison(self, op: Op, left: Formula, right: Formula) -> Node:
        if self._is_boolean(left) or self._is_boolean(right):
            return self._encode_equality(op, self.bdd(left).equiv(self.bdd(right)))
        is_literal = bool(self._literals_of(left)), bool(self._literals_of(right))
        if any(is_literal):
            if not all(is_literal):
                raise SymbolError("a literal is compared with a value that is not a literal")
            return self._encode_equality(op, self._equal_literals(left, right))
        return _COMPARISONS[op](self.manager, self.vector(left), self.vector(right))

    def _encode_equality(self, op: Op, same: Node) -> Node:
        if op is Op.EQ:
            return same
        if op is Op.NE:
            return ~same
        raise SymbolError(f"{op} compares numbers")

    def _equal_literals(self, left: Formula, right: Formula) -> Node:
        right_literals = frozenset(self._literals_of(right))
        return self.manager.disjoin(
            self._equal_literal(left, literal) & self._equal_literal(right, literal)
            for literal in self._literals_of(left)
            if literal in right_literals
        )

    def _equal_literal(self, formula: Formula, literal: str) -> Node:
        """Return the condition under which a variable, or a constant literal, is *literal*."""
        if isinstance(formula, Var):
            return self.manager.cube(self.code(formula.name, literal, formula.primed))
        return self.manager.true

    def _literals_of(self, formula: Formula) -> tuple[str, ...]:
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
        """Return the bit vector of an integer term. Raises SymbolError for other terms."""
        vector = self._vectors.get(formula)
        if vector is None:
            vector = self._vectors[formula] = self._encode_number(formula)
        return vector

    def _encode_number(self, formula: Formula) -> Vector:
        match formula:
            case Const(int(value)) if not isinstance(value, bool):
                return vectors.constant(self.manager, value)
            case Var(name, primed):
                return self._vector_of_variable(self._variable(name), primed)
            case Apply(op, (left, right)) if op in _ARITHMETIC:
                return _ARITHMETIC[op](self.manager, self.vector(left), self.vector(right))
            case Apply(Op.SUB, (operand,)):
                return self.vector(Apply(Op.SUB, (Const(0), operand)))
            case _:
                raise SymbolError("a number is expected")

    def _vector_of_variable(self, variable: Variable, primed: bool) -> Vector:
        domain = variable.domain
        if not isinstance(domain, IntegerDomain):
            raise SymbolError(f"{variable.name} is not a number")
        code = vectors.from_unsigned(
            self.manager, self._bit_nodes(self.bits(variable.name, primed))[::-1]
        )
        lower_bound = vectors.constant(self.manager, domain.low)
        return vectors.add(self.manager, code, lower_bound) if domain.low else code

    def _variable(self, name: str) -> Variable:
        if name not in self.variables:
            raise SymbolError(f"{name} is not a variable of the contract")
        return self.variables[name]

    def _bit_nodes(self, bits: Collection[str]) -> list[Node]:
        return [self.manager.var(bit) for bit in bits]


def next_bit(bit: str) -> str:
    """Return the name of the bit of the next value."""
    return f"{bit}'"


def current_bit(bit: str) -> str:
    """Return the name of the bit of the current value."""
    return bit.removesuffix("'")


def is_next(bit: str) -> bool:
    """Whether a bit belongs to a next value."""
    return bit.endswith("'")


_CONNECTIVES: dict[Op, Callable[[Manager, list[Node]], Node]] = {
    Op.NOT: lambda _, parts: ~parts[0],
    Op.AND: Manager.conjoin,
    Op.OR: Manager.disjoin,
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
