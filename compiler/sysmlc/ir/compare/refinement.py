"""Pairs of elements without a unique name, found by their surroundings.

Colour refinement (Weisfeiler and Leman): the first colour of an element is a fingerprint of its
facts and its subtree; each round mixes in the colours of the neighbours. Elements of both models
with equal colours have equal surroundings.
"""

from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import partial
from itertools import islice
from typing import NamedTuple

from sysmlc.ir.compare.content import name_in_comparison
from sysmlc.ir.compare.facts import iter_facts
from sysmlc.ir.compare.pairs import Pairs, Token, fact_token
from sysmlc.ir.compare.side import Side
from sysmlc.ir.element import Element

_MOST_ROUNDS = 12

Colours = dict[str, int]
Group = tuple[list[Element], list[Element]]
"""Unpaired children of one pair of owners, of the old and of the new model."""


def list_refinements(pairs: Pairs) -> list[Callable[[Pairs], None]]:
    """Return the steps that pair elements by surroundings, the most reliable one first."""
    fingerprints = BothFingerprints(pairs)
    steps = (pair_by_surroundings, pair_by_structure, pair_by_choice)
    return [partial(step, fingerprints) for step in steps]


def pair_by_surroundings(fingerprints: "BothFingerprints", pairs: Pairs) -> None:
    """Pair siblings whose colour is unique on both sides, by colours of the last round first."""
    groups = list(pairs.iter_unpaired())
    if groups:
        _pair_unique_colours(pairs, groups, _Refinement(fingerprints, groups).rounds)


def pair_by_structure(fingerprints: "BothFingerprints", pairs: Pairs) -> None:
    """Pair siblings whose position among linked elements is unique, whatever their facts are.

    The first colours are kinds and names, so that changed facts do not change the colours of the
    neighbours. Without a link, an element has no position.
    """
    groups = [
        (linked_olds, linked_news)
        for olds, news in pairs.iter_unpaired()
        if (linked_olds := [element for element in olds if pairs.old.links.get(element.id)])
        if (linked_news := [element for element in news if pairs.new.links.get(element.id)])
    ]
    if groups:
        refinement = _Refinement(fingerprints, groups, is_structural=True)
        _pair_unique_colours(pairs, groups, refinement.rounds[:-1])


def _pair_unique_colours(
    pairs: Pairs, groups: Sequence[Group], rounds: Sequence[tuple[Colours, Colours]]
) -> None:
    for old_colours, new_colours in rounds:
        for group in groups:
            for olds, news in list(_iter_equal(pairs, group, old_colours, new_colours)):
                if len(olds) == len(news) == 1:
                    pairs.add(olds[0], news[0])


def pair_by_choice(fingerprints: "BothFingerprints", pairs: Pairs) -> None:
    """Pair any two siblings of equal colour, and follow the choice to their neighbours.

    Each group uses only the latest round in which colours are equal. The pairs change the colours,
    so that further elements of the group are paired in a later call.
    """
    groups = list(pairs.iter_unpaired())
    refinement = _Refinement(fingerprints, groups)
    for group in groups:
        for old_colours, new_colours in refinement.rounds:
            classes = list(_iter_equal(pairs, group, old_colours, new_colours))
            propagation = _Propagation(pairs, refinement, old_colours, new_colours)
            for olds, news in classes:
                _choose_pairs(pairs, olds, news, propagation)
            if classes:
                break


def _choose_pairs(
    pairs: Pairs, olds: list[Element], news: list[Element], propagation: "_Propagation"
) -> None:
    for old in olds:
        new = next((element for element in news if element.id not in pairs.old_of), None)
        if new is not None and old.id not in pairs.new_of:
            propagation.add_pair(old, new)


def _iter_equal(
    pairs: Pairs, group: Group, old_colours: Colours, new_colours: Colours
) -> Iterator[tuple[list[Element], list[Element]]]:
    """Iterate over the unpaired old and new elements of a group with the same colour."""
    olds = _by_colour((e for e in group[0] if e.id not in pairs.new_of), old_colours)
    news = _by_colour((e for e in group[1] if e.id not in pairs.old_of), new_colours)
    return ((elements, news[colour]) for colour, elements in olds.items() if colour in news)


def _by_colour(elements: Iterable[Element], colours: Colours) -> dict[int, list[Element]]:
    index: dict[int, list[Element]] = {}
    for element in elements:
        index.setdefault(colours[element.id], []).append(element)
    return index


class _Propagation:
    """Pairs two elements, and along equal links their neighbours of equal colour."""

    def __init__(
        self, pairs: Pairs, refinement: "_Refinement", old_colours: Colours, new_colours: Colours
    ) -> None:
        self._pairs = pairs
        self._refinement = refinement
        self._old_colours = old_colours
        self._new_colours = new_colours

    def add_pair(self, old: Element, new: Element) -> None:
        """Pair two elements, their neighbours, the neighbours of those, and so on."""
        self._pairs.add(old, new)
        worklist = [(old, new)]
        while worklist:
            for pair in self._iter_neighbours(*worklist.pop()):
                self._pairs.add(*pair)
                worklist.append(pair)

    def _iter_neighbours(self, old: Element, new: Element) -> Iterator[tuple[Element, Element]]:
        candidates: dict[tuple[str, int | None], list[Element]] = {}
        for label, neighbour in reversed(self._refinement.new.neighbours(new)):
            if neighbour.id in self._new_colours and neighbour.id not in self._pairs.old_of:
                key = (label, self._new_colours[neighbour.id])
                candidates.setdefault(key, []).append(neighbour)
        for label, neighbour in self._refinement.old.neighbours(old):
            equals = candidates.get((label, self._old_colours.get(neighbour.id)))
            if equals and neighbour.id not in self._pairs.new_of:
                candidate = equals.pop()
                if self._can_pair(neighbour, candidate):
                    yield neighbour, candidate

    def _can_pair(self, old: Element, new: Element) -> bool:
        """Whether *new* is unpaired and the owners are a pair."""
        if new.id in self._pairs.old_of:
            return False
        old_owner, new_owner = self._pairs.old.graph.owner(old), self._pairs.new.graph.owner(new)
        if old_owner is None or new_owner is None:
            return old_owner is new_owner
        return self._pairs.new_of.get(old_owner.id) is new_owner


# -- fingerprints ------------------------------------------------------------------------------


class _Numbering(dict[Token, int]):
    """A number for each distinct token, assigned at the first lookup."""

    def __missing__(self, token: Token) -> int:
        self[token] = number = len(self)
        return number


class _Fingerprints:
    """Fingerprints of the elements of one side: numbers that are equal for equal content.

    An unpaired element counts only by kind and name where another element refers to it. Pairing
    it invalidates the fingerprints of those elements and of their owners. The others are reused,
    because nested elements without names are paired level by level, and each level has all below
    it.
    """

    def __init__(self, pairs: Pairs, side: Side, numbering: _Numbering) -> None:
        self.side = side
        self._pairs = pairs
        self._is_old = side is pairs.old
        self._to_token = pairs.old_token if self._is_old else pairs.new_token
        self._numbering = numbering
        self._processed_pairs = 0
        self._of_element: dict[str, int] = {}
        self._of_subtree: dict[str, int] = {}
        self._dependents: dict[str, list[str]] = {}
        """Ids of the elements whose facts refer to an element."""

    def of_subtree(self, element: Element) -> int:
        """Return the fingerprint of *element* and of the visible elements below it."""
        # Without recursion: models may be nested deeply.
        stack, missing = [element], []
        while stack:
            top = stack.pop()
            if top.id not in self._of_subtree:
                missing.append(top)
                stack += self.side.children(top)
        for owner in reversed(missing):
            children = sorted([self._of_subtree[c.id] for c in self.side.children(owner)])
            self._of_subtree[owner.id] = self._numbering[self._fingerprint(owner), *children]
        return self._of_subtree[element.id]

    def _fingerprint(self, element: Element) -> int:
        """Return the fingerprint of the facts about *element* itself."""
        if element.id not in self._of_element:

            def to_token(target: Element) -> Token:
                visible = self.side.find_visible(target)
                if visible is not None:
                    self._dependents.setdefault(visible.id, []).append(element.id)
                return self._reference_token(target)

            tokens = [fact_token(fact, to_token) for fact in iter_facts(self.side, element)]
            facts = tuple(sorted([self._numbering[token] for token in tokens]))
            self._of_element[element.id] = self._numbering[
                element.kind, name_in_comparison(element), facts
            ]
        return self._of_element[element.id]

    def of_reference(self, element: Element) -> int:
        """Return the fingerprint of a reference to *element*."""
        return self._numbering[self._reference_token(element)]

    def _reference_token(self, element: Element) -> Token:
        if element.id in self.side.hidden:
            owner = self.side.find_visible(element)
            return ("of", owner and self._reference_token(owner), element.kind, element.name)
        token = self._to_token(element)
        is_paired = isinstance(token, tuple) and token[0] in ("new", "outside")
        return token if is_paired else ("?", element.kind, name_in_comparison(element))

    def invalidate_new_pairs(self) -> None:
        """Remove the fingerprints that depend on elements paired since the last call."""
        new_of = self._pairs.new_of
        for old_id, new in islice(new_of.items(), self._processed_pairs, None):
            for dependent in self._dependents.pop(old_id if self._is_old else new.id, ()):
                self._invalidate(dependent)
        self._processed_pairs = len(new_of)

    def _invalidate(self, id: str) -> None:
        self._of_element.pop(id, None)
        owner: str | None = id
        while owner is not None and self._of_subtree.pop(owner, None) is not None:
            owner = self.side.graph[owner].owner


class BothFingerprints:
    """The fingerprints of both sides; they are comparable, and shared by all steps."""

    def __init__(self, pairs: Pairs) -> None:
        numbering = _Numbering()
        self.old = _Fingerprints(pairs, pairs.old, numbering)
        self.new = _Fingerprints(pairs, pairs.new, numbering)


# -- colours -----------------------------------------------------------------------------------


class _Neighbourhood(NamedTuple):
    """The labelled links of an element."""

    unpaired: list[tuple[str, Element]]
    """Links to elements that are coloured."""
    rest: int
    """A number for all other links, the same in every round."""


class _SideRefinement:
    """The colours of the unpaired elements of one side.

    A link of an element below an unpaired element counts as a link of the unpaired element.
    The first colours are fingerprints, or kinds and names if *is_structural*. These colours are not
    negative; later colours are.
    """

    def __init__(
        self,
        fingerprints: _Fingerprints,
        elements: list[Element],
        numbering: _Numbering,
        *,
        is_structural: bool,
    ) -> None:
        self._fingerprints = fingerprints
        self._side = fingerprints.side
        self._numbering = numbering
        self._elements = elements
        self._unpaired_owner = {
            part.id: element for element in elements for part in self._side.visible_subtree(element)
        }
        self._neighbourhoods: dict[str, _Neighbourhood] = {}
        fingerprints.invalidate_new_pairs()
        self.colours: Colours = {
            element.id: numbering[element.kind, element.subkind, name_in_comparison(element)]
            if is_structural
            else fingerprints.of_subtree(element)
            for element in elements
        }

    def count_colours(self) -> int:
        """Return the number of different colours."""
        return len(set(self.colours.values()))

    def mix(self) -> None:
        """Replace each colour by a mix with the colours of the neighbours."""
        colours, numbering = self.colours, self._numbering
        self.colours = {}
        for element in self._elements:
            neighbourhood = self._neighbourhood(element)
            near = sorted([(label, colours[n.id]) for label, n in neighbourhood.unpaired])
            number = numbering[colours[element.id], neighbourhood.rest, *near]
            self.colours[element.id] = -1 - number

    def neighbours(self, element: Element) -> list[tuple[str, Element]]:
        """Return the links between *element* and unpaired elements."""
        return self._neighbourhood(element).unpaired

    def _neighbourhood(self, element: Element) -> _Neighbourhood:
        if element.id not in self._neighbourhoods:
            self._neighbourhoods[element.id] = self._find_neighbourhood(element)
        return self._neighbourhoods[element.id]

    def _find_neighbourhood(self, element: Element) -> _Neighbourhood:
        unpaired, rest = [], []
        for label, linked in self._iter_links(element):
            owner = self._unpaired_owner.get(linked.id)
            if owner is None:
                rest.append((label, self._fingerprints.of_reference(linked)))
            else:
                unpaired.append((label, owner))
        return _Neighbourhood(unpaired, self._numbering[tuple(sorted(rest))])

    def _iter_links(self, element: Element) -> Iterator[tuple[str, Element]]:
        for part in self._side.visible_subtree(element):
            for label, linked in self._side.links.get(part.id, ()):
                yield f"{part.name} {label}", linked


class _Refinement:
    """The colours of both sides after each round, the last round first."""

    def __init__(
        self,
        fingerprints: BothFingerprints,
        groups: Sequence[Group],
        *,
        is_structural: bool = False,
    ) -> None:
        numbering = _Numbering()
        olds = [element for group in groups for element in group[0]]
        news = [element for group in groups for element in group[1]]
        self.old = _SideRefinement(fingerprints.old, olds, numbering, is_structural=is_structural)
        self.new = _SideRefinement(fingerprints.new, news, numbering, is_structural=is_structural)
        self.rounds = [(self.old.colours, self.new.colours)]
        self._refine()
        self.rounds.reverse()

    def _refine(self) -> None:
        count = 0
        while count < self.old.count_colours() and len(self.rounds) <= _MOST_ROUNDS:
            count = self.old.count_colours()
            self.old.mix()
            self.new.mix()
            self.rounds.append((self.old.colours, self.new.colours))
