"""Skolem functions: turn a relation of allowed answers into a function for each bit of the answer.

If the relation allows several answers, earlier bits are decided first, and a bit is false if it can
be. So the functions do not depend on the order of bits in the library.
"""

from collections.abc import Collection, Iterable, Mapping, Sequence

from sysmlc.synthesis.bdd.manager import Manager, Node


def choose_functions(manager: Manager, relation: Node, bits: Sequence[str]) -> dict[str, Node]:
    """Return each of *bits* as a function of the bits of the relation that are not in *bits*.

    Where the relation allows some answer, the functions give an allowed one; elsewhere their values
    are arbitrary.
    """
    functions: dict[str, Node] = {}
    support = manager.support(relation)
    remaining = [bit for bit in bits if bit in support]
    for bit in bits:
        # Bits after this one are quantified; bits before it were replaced by their functions.
        remaining = remaining[1:] if remaining[:1] == [bit] else remaining
        possible = manager.exist(remaining, relation)
        can_be_true, can_be_false = (
            manager.assign(possible, {bit: value}) for value in (True, False)
        )
        functions[bit] = can_be_true & ~can_be_false
        relation = substitute(manager, relation, {bit: functions[bit]})
    return functions


def find_functions(
    manager: Manager, relation: Node, bits: Collection[str]
) -> dict[str, Node] | None:
    """Return each of *bits* as a function of the other bits if the relation allows one answer.

    The functions are arbitrary where it allows none. None if it allows several answers somewhere.
    """
    functions: dict[str, Node] = {}
    for bit in sorted(bits):
        functions[bit] = manager.and_exist(relation, manager.var(bit), bits)
        can_be_false = manager.and_exist(relation, ~manager.var(bit), bits)
        if functions[bit] & can_be_false != manager.false:
            return None
    return functions


def substitute(manager: Manager, node: Node, functions: Mapping[str, Node]) -> Node:
    """Replace bits of the diagram by functions, none of which depends on a replaced bit."""
    # Bit by bit, because the simultaneous composition of the library takes ten times as long
    # (decision 24). The order does not matter, as no function depends on a replaced bit.
    for bit in sorted(manager.support(node).intersection(functions)):
        high, low = (manager.assign(node, {bit: value}) for value in (True, False))
        node = manager.ite(functions[bit], high, low)
    return node


def combine_cases(
    manager: Manager, cases: Iterable[tuple[Node, Mapping[str, Node]]]
) -> dict[str, Node]:
    """Combine the functions of disjoint cases; a case is a condition with the functions under it.

    Where no condition holds, all functions are false.
    """
    combined: dict[str, Node] = {}
    for condition, functions in cases:
        for bit, function in functions.items():
            combined[bit] = combined.get(bit, manager.false) | (condition & function)
    return combined
