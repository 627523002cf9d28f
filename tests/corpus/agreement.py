"""Compares two graphs of one model that different tools or settings saved.

Elements are matched by id, else, below a matched owner, by kind, name and position among their
equals. Of each pair everything is compared: kind, name, owner, all attributes (role, multiplicity,
direction, guard, ...) and where the edges of each kind lead.
"""

from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass

from sysmlc.ir import Edge, Element, Graph

_OF_THE_FILE = frozenset({"href", "origin", "namespace"})
"""Attributes that say where something is kept, not what it is."""


@dataclass(frozen=True, slots=True)
class Difference:
    """One aspect in which the two elements of a pair differ; None where one has it not."""

    left: Element
    right: Element
    aspect: str
    before: object
    after: object

    def __str__(self) -> str:
        return f"{self.left.kind} {self.left.name!r} {self.aspect}: {self.before} | {self.after}"


Reason = tuple[str, Callable[["Agreement", Difference], bool]]
"""Why two files differ in a place, and the differences that it explains."""


class Agreement:
    """What two graphs share, and in what it differs."""

    def __init__(self, left: Graph, right: Graph) -> None:
        self.left = left
        self.right = right
        self.right_of = _pairs(left, right)
        self.left_of = {right: left for left, right in self.right_of.items()}
        self.differences = [d for pair in self.right_of.items() for d in self._compare(*pair)]

    def shared(self) -> int:
        """Number of pairs."""
        return len(self.right_of)

    def equal(self) -> float:
        """Share of the pairs that agree in what the model says: all but values of tags."""
        unequal = {d.left.id for d in self.differences if not d.aspect.startswith("tag.")}
        return 1 - len(unequal) / len(self.right_of)

    def only_left(self) -> Counter[str]:
        """Kinds of what only the left graph has, without what lies below such elements."""
        return _uppermost(self.left, self.right_of)

    def only_right(self) -> Counter[str]:
        """Kinds of what only the right graph has, without what lies below such elements."""
        return _uppermost(self.right, self.left_of)

    def explained(self, reasons: Iterable[Reason]) -> tuple[Counter[str], list[str]]:
        """How many differences each reason explains, the first that fits; and what none does."""
        table = tuple(reasons)
        counts: Counter[str] = Counter()
        unexplained: list[str] = []
        for difference in self.differences:
            name = next((n for n, fits in table if fits(self, difference)), None)
            if name is None:
                unexplained.append(str(difference))
            else:
                counts[name] += 1
        return counts, unexplained

    def _compare(self, left: str, right: str) -> Iterator[Difference]:
        one, other = self.left[left], self.right[right]
        before, after = self._facts(one), self._facts(other, is_right=True)
        for aspect in sorted(before.keys() | after.keys()):
            if before.get(aspect) != after.get(aspect):
                yield Difference(one, other, aspect, before.get(aspect), after.get(aspect))

    def _facts(self, element: Element, is_right: bool = False) -> dict[str, object]:
        graph = self.right if is_right else self.left
        facts: dict[str, object] = {"kind": str(element.kind), "name": element.name}
        facts["owner"] = self._target(element.owner, is_right)
        for name, value in element.attrs.items():
            if name not in _OF_THE_FILE:
                facts[name] = self._value(value, is_right)
        for edge in Edge:
            targets = graph.targets(element, edge) if edge is not Edge.OWNS else []
            if targets:
                facts[f"-> {edge}"] = sorted(str(self._target(t.id, is_right)) for t in targets)
        return facts

    def _value(self, value: object, is_right: bool) -> object:
        if isinstance(value, tuple):
            return tuple(self._value(item, is_right) for item in value)
        return self._target(value, is_right) if isinstance(value, str) else value

    def _target(self, id: str | None, is_right: bool) -> str | None:
        """The id of the left element; for a stand-in the id that the other file gives it."""
        graph = self.right if is_right else self.left
        if id is None or id not in graph:
            return id
        href = str(graph[id].attrs.get("href", ""))
        if href:
            return href.partition("#")[2] or href
        return self.left_of.get(id, id) if is_right else id


def _uppermost(graph: Graph, matched: dict[str, str]) -> Counter[str]:
    return Counter(
        str(element.kind)
        for element in graph
        if element.id not in matched and "external" not in element.attrs
        if element.owner is None or element.owner in matched
    )


def _pairs(left: Graph, right: Graph) -> dict[str, str]:
    pairs = {e.id: e.id for e in left if e.source and e.id in right and right[e.id].source}
    taken = set(pairs.values())
    _pair_equals(_roots(left), _roots(right), pairs, taken)
    for element in left:
        if element.id in pairs:
            children = left.owned(element), right.owned(right[pairs[element.id]])
            _pair_equals(*children, pairs, taken)
    return pairs


def _roots(graph: Graph) -> list[Element]:
    return [element for element in graph.roots() if "external" not in element.attrs]


def _pair_equals(
    left: Iterable[Element], right: Iterable[Element], pairs: dict[str, str], taken: set[str]
) -> None:
    free: dict[tuple[str, str], list[Element]] = {}
    for element in right:
        if element.id not in taken:
            free.setdefault((element.kind, element.name), []).append(element)
    for element in left:
        equals = free.get((element.kind, element.name))
        if element.id not in pairs and equals:
            found = equals.pop(0)
            pairs[element.id] = found.id
            taken.add(found.id)
