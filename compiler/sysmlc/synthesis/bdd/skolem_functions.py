"""Skolem functions: from a relation of allowed answers to one function for each bit of the answer.

The functions do not depend on the order of bits in the library: if several values are allowed, a
bit is false if it can be, and earlier bits are decided first.
"""

from collections.abc import Iterable, Mapping, Sequence

from sysmlc.synthesis.bdd.manager import Manager, Node


def choose_functions(manager: Manager, relation: Node, bits: Sequence[str]) -> dict[str, Node]:
    """Return each of *bits* as a function of the other bits of the relation.

    Where the relation allows some answer, the functions give an allowed one; elsewhere their values
    are arbitrary.
    """
    functions: dict[str, Node] = {}
    support = manager.support(relation)
    remaining = [bit for bit in bits if bit in support]
    for bit in bits:
        remaining = remaining[1:] if remaining[:1] == [bit] else remaining
        possible = manager.exist(remaining, relation)
        can_be_true, can_be_false = (
            manager.assign(possible, {bit: value}) for value in (True, False)
        )
        functions[bit] = can_be_true & ~can_be_false
        relation = substitute(manager, relation, {bit: functions[bit]})
    return functions


def substitute(manager: Manager, node: Node, functions: Mapping[str, Node]) -> Node:
    """Replace bits of the diagram by functions, none of which depends on a replaced bit.

    Bit by bit this takes a fraction of the time of one simultaneous composition.
    """
    for bit in sorted(manager.support(node).intersection(functions)):
        high, low = (manager.assign(node, {bit: value}) for value in (True, False))
        node = manager.ite(functions[bit], high, low)
    return node


def combine_cases(
    manager: Manager, cases: Iterable[tuple[Node, Mapping[str, Node]]]
) -> dict[str, Node]:
    """Combine functions by disjoint cases, each a condition with the functions valid under it."""
    combined: dict[str, Node] = {}
    for condition, functions in cases:
        for bit, function in functions.items():
            combined[bit] = combined.get(bit, manager.false) | (condition & function)
    return combined


def find_least_assignment(
    manager: Manager, node: Node, bits: Sequence[str]
) -> dict[str, bool] | None:
    """Return the satisfying values of *bits* that are the least binary number, or None.

    *bits* must contain the support of the diagram.
    """
    if node == manager.false:
        return None
    assignment: dict[str, bool] = {}
    for bit in bits:
        low = manager.assign(node, {bit: False})
        assignment[bit] = low == manager.false
        node = manager.assign(node, {bit: True}) if assignment[bit] else low
    return assignment
