"""From what may be answered to what is answered: functions in a relation.

Nothing here depends on the order of bits in the library: where several values are possible, a bit
is false if it can be, the first bits first.
"""

from collections.abc import Iterable, Mapping, Sequence

from sysmlc.synthesis.bdd.manager import Manager, Node


def chosen(manager: Manager, relation: Node, bits: Sequence[str]) -> dict[str, Node]:
    """Each bit as a function of all that the relation speaks of beside ``bits``.

    Together they are in the relation wherever some values are; elsewhere they mean nothing.
    """
    found: dict[str, Node] = {}
    spoken = manager.support(relation)
    later = [bit for bit in bits if bit in spoken]
    for bit in bits:
        later = later[1:] if later[:1] == [bit] else later
        possible = manager.exist(later, relation)
        on, off = (manager.assign(possible, {bit: value}) for value in (True, False))
        found[bit] = on & ~off
        relation = substituted(manager, relation, {bit: found[bit]})
    return found


def substituted(manager: Manager, node: Node, by: Mapping[str, Node]) -> Node:
    """The diagram with functions for some bits; none of them may speak of these bits.

    Bit by bit, which takes a fraction of the time that it takes for all at once.
    """
    for bit in sorted(manager.support(node).intersection(by)):
        on, off = (manager.assign(node, {bit: value}) for value in (True, False))
        node = manager.ite(by[bit], on, off)
    return node


def joined(manager: Manager, pieces: Iterable[tuple[Node, Mapping[str, Node]]]) -> dict[str, Node]:
    """Functions by cases: in each piece, where its condition holds, those of the piece."""
    found: dict[str, Node] = {}
    for where, functions in pieces:
        for bit, node in functions.items():
            found[bit] = found.get(bit, manager.false) | (where & node)
    return found


def least(manager: Manager, node: Node, bits: Sequence[str]) -> dict[str, bool] | None:
    """The values of the bits that make the diagram true and come first as binary numbers.

    None if there are none. ``bits`` must contain the support.
    """
    if node == manager.false:
        return None
    found: dict[str, bool] = {}
    for bit in bits:
        off = manager.assign(node, {bit: False})
        found[bit] = off == manager.false
        node = manager.assign(node, {bit: True}) if found[bit] else off
    return found
