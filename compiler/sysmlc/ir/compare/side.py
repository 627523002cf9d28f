"""One of the two models that are compared, indexed for the queries of the comparison.

An InternalElement is up to three elements of the graph (docs/automationml.md): a part, an instance
that holds its values, and an *own class* if it has more than its SystemUnitClass. Differences of
these that follow from the InternalElement are reported with it.
"""

from collections.abc import Container, Iterator
from functools import cached_property

from sysmlc.ir.compare.content import (
    NOT_CONTENT,
    PASSED_OVER,
    WORDS,
    is_detail,
    is_header,
)
from sysmlc.ir.element import AttrValue, Element
from sysmlc.ir.graph import Graph
from sysmlc.ir.kinds import Edge, Kind
from sysmlc.ir.pending import Declarations, Statement
from sysmlc.ir.query.names import CAEX_ID

_COMPARED = tuple(edge for edge in Edge if edge not in PASSED_OVER)


class Side:
    """An index of one graph: visible elements by owner, details by owner, edges by source.

    A detail (comment, stereotype application, slot ...) is compared as a property of its owner.
    Details, headers of files and everything below them are *hidden*; all other elements are
    *visible*. The key None stands for the owner of roots.
    """

    def __init__(self, graph: Graph) -> None:
        self.graph = graph
        self.members: dict[str | None, list[Element]] = {}
        self.details: dict[str, list[Element]] = {}
        self.hidden: set[str] = set()
        for root in graph.roots():
            self._index(root)
        self.edges = self._index_edges()

    def _index(self, root: Element) -> None:
        for element in self.graph.subtree(root):
            owner = self.graph.owner(element)
            if element.owner in self.hidden or is_header(element):
                self.hidden.add(element.id)
            elif is_detail(element, owner):
                self.hidden.add(element.id)
                self._add_detail(element, owner)
            else:
                self.members.setdefault(element.owner, []).append(element)

    def _add_detail(self, detail: Element, owner: Element | None) -> None:
        subject = owner if owner is not None else self.graph.target(detail, Edge.SUBJECT)
        if subject is not None:
            self.details.setdefault(subject.id, []).append(detail)

    def _index_edges(self) -> dict[str, dict[Edge, list[Element]]]:
        index: dict[str, dict[Edge, list[Element]]] = {}
        applications = {element.id for element in self.graph.of_kind(Kind.APPLICATION)}
        for edge in _COMPARED:
            # The subject of a stereotype application is the element that it is a detail of.
            skipped = applications if edge is Edge.SUBJECT else ()
            for _, source, target in self.graph.edges(edge):
                if source not in skipped:
                    targets = index.setdefault(source, {}).setdefault(edge, [])
                    targets.append(self.graph[target])
        return index

    @cached_property
    def incoming(self) -> dict[str, list[tuple[Edge, Element]]]:
        """Edges and their sources by target; an edge from a detail counts as one from its owner."""
        index: dict[str, list[tuple[Edge, Element]]] = {}
        for source_id, edges in self.edges.items():
            source = self.find_visible(self.graph[source_id])
            for edge, targets in edges.items():
                for target in targets:
                    if source is not None and source is not target:
                        index.setdefault(target.id, []).append((edge, source))
        return index

    @cached_property
    def links(self) -> dict[str, list[tuple[str, Element]]]:
        """Links from and to each element with labels: edges, and attributes whose values are ids.

        The links of a detail belong to its owner. Their labels begin with the title of the detail.
        """
        index: dict[str, list[tuple[str, Element]]] = {}
        for element, label, target in (*self._edge_links(), *self._attribute_links()):
            source = self.find_visible(element)
            if source is None:
                continue
            full_label = label if source is element else f"{_describe(element)} {label}"
            index.setdefault(source.id, []).append((f"{full_label} >", target))
            if source is not target:
                index.setdefault(target.id, []).append((f"< {full_label}", source))
        return index

    def _edge_links(self) -> Iterator[tuple[Element, str, Element]]:
        for source, edges in self.edges.items():
            for edge, targets in edges.items():
                yield from ((self.graph[source], str(edge), target) for target in targets)

    def _attribute_links(self) -> Iterator[tuple[Element, str, Element]]:
        for element in self.graph:
            for name, value in element.attrs.items():
                if name not in WORDS and name not in NOT_CONTENT:
                    for label, id in _iter_texts(value, name):
                        target = self.graph.get(id)
                        if target is not None and target is not element:
                            yield element, label, target

    @cached_property
    def _by_caex_id(self) -> dict[str, Element]:
        """Elements by their ids in AutomationML, if the graph has other ids for them."""
        ids = ((element, element.attrs.get(CAEX_ID)) for element in self.graph)
        return {id: element for element, id in ids if isinstance(id, str)}

    def find_by_id(self, id: str) -> Element | None:
        """Return the element with this id in the graph or in AutomationML, or None."""
        return self.graph.get(id) or self._by_caex_id.get(id)

    @cached_property
    def statements(self) -> dict[str, list[Statement]]:
        """Parts of declarations by element; those of a detail belong to its owner."""
        index: dict[str, list[Statement]] = {}
        for declarations in self.graph.derived(Declarations):
            for id, statements in declarations.statements.items():
                element = self.graph.get(id)
                subject = None if element is None else self.find_visible(element)
                if subject is not None:
                    index.setdefault(subject.id, []).extend(statements)
        return index

    def find_visible(self, element: Element) -> Element | None:
        """Return *element*, or its nearest owner that is visible, or None."""
        candidate: Element | None = element
        while candidate is not None and candidate.id in self.hidden:
            candidate = self.graph.owner(candidate)
        return candidate

    def children(self, owner: Element | None) -> list[Element]:
        """Return the visible elements that *owner* owns, in order."""
        return self.members.get(None if owner is None else owner.id, [])

    def visible_subtree(self, element: Element) -> Iterator[Element]:
        """Iterate over *element* and the visible elements below it, owners first."""
        stack = [element]
        while stack:
            owner = stack.pop()
            yield owner
            stack.extend(reversed(self.children(owner)))


def _iter_texts(value: AttrValue, label: str) -> Iterator[tuple[str, str]]:
    """Iterate over the texts of an attribute value, each with its position in nested tuples."""
    if isinstance(value, str):
        yield label, value
    elif isinstance(value, tuple):
        for position, item in enumerate(value):
            yield from _iter_texts(item, f"{label} {position}")


def _describe(detail: Element) -> str:
    words = [str(detail.attrs[name]) for name in sorted(WORDS & detail.attrs.keys())]
    return " ".join([detail.kind, detail.name, *words])


# -- InternalElements --------------------------------------------------------------------------

_VALUES = "#values"
"""Suffix of the id of an instance whose part has the id of the InternalElement."""
_TYPES = (Edge.TYPED_BY, Edge.INSTANCE_OF)


def is_own_class(element: Element) -> bool:
    """Whether *element* is the own class of an InternalElement."""
    return element.kind is Kind.CLASS and element.subkind == "internal-element"


def own_classes(side: Side, element: Element) -> list[Element]:
    """Return the own class of a part or an instance, as a list of at most one."""
    edges = side.edges.get(element.id, {})
    types = [type_ for edge in _TYPES for type_ in edges.get(edge, ())]
    return [type_ for type_ in types if is_own_class(type_)]


def users_of_own_class(side: Side, own_class: Element) -> list[Element]:
    """Return the part and the instance that have the own class."""
    return [user for edge, user in side.incoming.get(own_class.id, ()) if edge in _TYPES]


def declared_class(side: Side, type_: Element) -> Element | str:
    """Return the SystemUnitClass of an own class, "its own" without one; else *type_* itself."""
    if not is_own_class(type_):
        return type_
    return next(iter(side.edges.get(type_.id, {}).get(Edge.SPECIALIZES, ())), "its own")


def is_part_instance(element: Element) -> bool:
    """Whether *element* is an instance that holds the values of a part."""
    return element.kind is Kind.INSTANCE and element.subkind == "part"


def represented_part(side: Side, instance: Element) -> Element | None:
    """Return the part whose values *instance* holds, or None."""
    return next(iter(side.edges.get(instance.id, {}).get(Edge.REPRESENTS, ())), None)


def follows_internal_element(side: Side, element: Element, paired: Container[str]) -> bool:
    """Return whether an unpaired element is reported with an InternalElement.

    *paired* holds the ids of this side that have a partner in the other model.
    """
    if is_part_instance(element):
        part = represented_part(side, element)
        return part is not None and part.id not in paired
    if is_own_class(element):
        return bool(users_of_own_class(side, element))
    if element.kind is Kind.PROPERTY:
        return any(instance.id in paired for instance in _instances_of_part(side, element))
    return False


def _instances_of_part(side: Side, part: Element) -> list[Element]:
    sources = [source for edge, source in side.incoming.get(part.id, ()) if edge is Edge.REPRESENTS]
    return [source for source in sources if is_part_instance(source)]


def alternate_id(element: Element) -> str:
    """Return the other id that an instance may have, or an empty string for another element.

    An instance has the id of its InternalElement with a suffix if its part has that id, and without
    the suffix otherwise.
    """
    if element.kind is not Kind.INSTANCE:
        return ""
    if element.id.endswith(_VALUES):
        return element.id.removesuffix(_VALUES)
    return element.id + _VALUES
