"""What outputs of a component depend on in the very step in which they are given."""

from collections.abc import Iterable, Iterator, Sequence, Set

from msgspec import Struct

from sysmlc.logic import formula as f
from sysmlc.logic.contract import Class, Composite, Conjunct, Contract, Owner, Part
from sysmlc.synthesis.algebra.fair_systems import Runs, Universe
from sysmlc.synthesis.bdd.manager import Node


class Link(Struct, frozen=True):
    """Outputs that are chosen together, and the inputs of the same step that have a say in it."""

    is_first: bool
    """Whether that is so in the first step, or in each one after it."""
    outputs: frozenset[str]
    inputs: frozenset[str]


def links(contract: Contract, universe: Universe) -> tuple[Link, ...]:
    """What a component has to read at once.

    Outputs belong together when one guarantee names them both in the step that it is about, or
    when what lets a run go on restricts them both. Raises OutsideGr1Error, LimitError.
    """
    outputs = {one.name for one in contract.variables if one.owner is Owner.SYSTEM}
    known = {one.name for one in contract.variables}
    tied = _tied(contract, universe)
    return tuple(
        Link(is_first, frozenset(group & outputs), frozenset(group & known - outputs))
        for is_first in (True, False)
        for group in _joined((*_named(contract, is_first), tied), outputs)
    )


def _named(contract: Contract, is_first: bool) -> Iterator[frozenset[str]]:
    """The variables that each guarantee names of the step that it is about."""
    for conjunct in contract.guarantees:
        if (conjunct.class_ is Class.INIT) == is_first:
            found = f.variables(conjunct.formula)
            yield frozenset(one.name for one in found if is_first or one.primed)


def _joined(groups: Iterable[frozenset[str]], outputs: Set[str]) -> list[frozenset[str]]:
    """Groups that share an output made one; those without an output are left out."""
    found: list[frozenset[str]] = []
    for group in groups:
        if group & outputs:
            shared = [one for one in found if one & group & outputs]
            found = [one for one in found if one not in shared]
            found.append(group.union(*shared))
    return found


def _tied(contract: Contract, universe: Universe) -> frozenset[str]:
    """Variables that are restricted in the states from which guarantees allow to go on."""
    steps = [one for one in contract.guarantees if one.class_ is Class.SAFETY]
    going = Runs(universe.system(steps)).endless
    names = (one.name for one in contract.variables)
    return frozenset(name for name in names if _is_restricted(name, going, universe))


def _is_restricted(name: str, states: Node, universe: Universe) -> bool:
    """Whether not every value of the variable does as well."""
    symbols = universe.symbols
    any_value = universe.manager.exist(symbols.bits(name), states) & symbols.domain(name)
    return any_value != states


class Readings(Struct, frozen=True):
    """The links of all parts of a composition."""

    links: tuple[tuple[Part, Link], ...]
    wires: tuple[frozenset[str], ...]

    def seeing(self, part: Part) -> list[Conjunct]:
        """What a part promises of outputs that it chooses when it has seen inputs of that step."""
        own = [link for one, link in self.links if one == part and link.inputs]
        return [one for one in part.contract.guarantees if any(_sees(one, link) for link in own)]

    def circular(self, parts: Sequence[Part]) -> list[Part]:
        """The parts that give in a step what, through others, depends on what they give in it."""
        among = [(part, link) for part, link in self.links if part in parts]
        return [
            part
            for part in parts
            if any(self._returns(one, among) for one in among if one[0] == part)
        ]

    def _returns(self, start: tuple[Part, Link], among: Sequence[tuple[Part, Link]]) -> bool:
        seen: list[tuple[Part, Link]] = []
        waiting = [one for one in among if self._is_read(start, one)]
        while waiting:
            one = waiting.pop()
            if one == start:
                return True
            if one not in seen:
                seen.append(one)
                waiting += [other for other in among if self._is_read(one, other)]
        return False

    def _is_read(self, reader: tuple[Part, Link], giver: tuple[Part, Link]) -> bool:
        inputs = reader[1].inputs
        heard = inputs.union(*(wire for wire in self.wires if wire & inputs))
        is_same_time = reader[1].is_first == giver[1].is_first
        return is_same_time and reader[0] != giver[0] and bool(heard & giver[1].outputs)


def _sees(conjunct: Conjunct, link: Link) -> bool:
    """Whether the conjunct says something of the outputs of a link, in the step of its inputs."""
    used = f.variables(conjunct.formula)
    is_alone = not any(one.primed for one in used)
    names = {one.name for one in used if one.primed or is_alone}
    is_first = conjunct.class_ is Class.INIT
    is_then = is_first == link.is_first or (is_alone and not is_first)
    return is_then and not names.isdisjoint(link.outputs)


def readings(composite: Composite, universe: Universe) -> Readings:
    """Who reads what at once; raises OutsideGr1Error, LimitError."""
    found = tuple(
        (part, link) for part in composite.parts for link in links(part.contract, universe)
    )
    wires = tuple(
        frozenset(one.name for one in f.variables(wire.formula)) for wire in composite.wiring
    )
    return Readings(found, wires)
