"""Comparison of two graphs of one model that different tools or settings saved.

Elements are matched by id, otherwise by kind, name and position among equal elements below a
matched owner. The comparison of a pair covers kind, name, owner, all attributes (role,
multiplicity, direction, guard, ...) and the targets of the edges of each kind.
"""

from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass

from sysmlc.ir import Edge, Element, Graph

_LOCATION_ATTRIBUTES = frozenset({"href", "origin", "namespace"})
"""Attributes that hold the location of an element in its file."""


@dataclass(frozen=True, slots=True)
class Difference:
    """One aspect in which the elements of a pair differ; a missing value is None."""

    left: Element
    right: Element
    aspect: str
    before: object
    after: object

    def __str__(self) -> str:
        return f"{self.left.kind} {self.left.name!r} {self.aspect}: {self.before} | {self.after}"


Reason = tuple[str, Callable[[Difference], bool]]
"""A reason for differences, and a predicate for the differences that it explains."""


class Agreement:
    """The pairs of equal elements in two graphs, and their differences."""

    def __init__(self, left: Graph, right: Graph) -> None:
        self.left = left
        self.right = right
        self.right_of = _find_pairs(left, right)
        self.left_of = {right: left for left, right in self.right_of.items()}
        self.differences = [d for pair in self.right_of.items() for d in self._compare(*pair)]

    def count_pairs(self) -> int:
        """Return the number of pairs."""
        return len(self.right_of)

    def measure_agreement(self) -> float:
        """Return the share of pairs without differences; values of tags do not count."""
        unequal = {d.left.id for d in self.differences if not d.aspect.startswith("tag.")}
        return 1 - len(unequal) / len(self.right_of)

    def count_only_left(self) -> Counter[str]:
        """Count the kinds of elements that only the left graph has, without their members."""
        return _count_uppermost(self.left, self.right_of)

    def count_only_right(self) -> Counter[str]:
        """Count the kinds of elements that only the right graph has, without their members."""
        return _count_uppermost(self.right, self.left_of)

    def explain(self, reasons: Iterable[Reason]) -> tuple[Counter[str], list[str]]:
        """Count the differences by the first reason that fits, and list the unexplained ones."""
        table = tuple(reasons)
        counts: Counter[str] = Counter()
        unexplained: list[str] = []
        for difference in self.differences:
            reason = next((name for name, fits in table if fits(difference)), None)
            if reason is None:
                unexplained.append(str(difference))
            else:
                counts[reason] += 1
        return counts, unexplained

    def _compare(self, left: str, right: str) -> Iterator[Difference]:
        left_element, right_element = self.left[left], self.right[right]
        before, after = (
            self._collect_facts(left_element),
            self._collect_facts(right_element, is_right=True),
        )
        for aspect in sorted(before.keys() | after.keys()):
            if before.get(aspect) != after.get(aspect):
                yield Difference(
                    left_element, right_element, aspect, before.get(aspect), after.get(aspect)
                )

    def _collect_facts(self, element: Element, is_right: bool = False) -> dict[str, object]:
        graph = self.right if is_right else self.left
        facts: dict[str, object] = {"kind": str(element.kind), "name": element.name}
        facts["owner"] = self._map_id(element.owner, is_right)
        for name, value in element.attrs.items():
            if name not in _LOCATION_ATTRIBUTES:
                facts[name] = self._map_value(value, is_right)
        for edge in Edge:
            targets = graph.targets(element, edge) if edge is not Edge.OWNS else []
            if targets:
                facts[f"-> {edge}"] = sorted(str(self._map_id(t.id, is_right)) for t in targets)
        return facts

    def _map_value(self, value: object, is_right: bool) -> object:
        if isinstance(value, tuple):
            return tuple(self._map_value(member, is_right) for member in value)
        return self._map_id(value, is_right) if isinstance(value, str) else value

    def _map_id(self, id: str | None, is_right: bool) -> str | None:
        """Return the id of the left element; for an external stub its id in the other file."""
        graph = self.right if is_right else self.left
        if id is None or id not in graph:
            return id
        href = str(graph[id].attrs.get("href", ""))
        if href:
            return href.partition("#")[2] or href
        return self.left_of.get(id, id) if is_right else id


def _count_uppermost(graph: Graph, matched: dict[str, str]) -> Counter[str]:
    return Counter(
        str(element.kind)
        for element in graph
        if element.id not in matched and "external" not in element.attrs
        if element.owner is None or element.owner in matched
    )


def _find_pairs(left: Graph, right: Graph) -> dict[str, str]:
    pairs = {e.id: e.id for e in left if e.source and e.id in right and right[e.id].source}
    taken = set(pairs.values())
    _pair_equals(_list_roots(left), _list_roots(right), pairs, taken)
    for element in left:
        if element.id in pairs:
            children = left.owned(element), right.owned(right[pairs[element.id]])
            _pair_equals(*children, pairs, taken)
    return pairs


def _list_roots(graph: Graph) -> list[Element]:
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
            partner = equals.pop(0)
            pairs[element.id] = partner.id
            taken.add(partner.id)
