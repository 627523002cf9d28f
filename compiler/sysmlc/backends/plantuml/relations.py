"""Relations between classifiers, use cases and actors, as lines of diagrams.

An allocation that no line can show is a row of a box (SysML 1.6 clause 15.3.1).
"""

from collections.abc import Iterable, Iterator

from msgspec import Struct

from sysmlc.backends.plantuml import labels
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.ir.query import templates
from sysmlc.support.plantuml_text import wrap_lines

_SHAPES = {"composite": "*", "shared": "o"}
_DEPENDENCY_WORDS = {"allocate": "allocate", "usage": "use", "abstraction": "abstraction"}
REQUIREMENT_ROLES = frozenset(
    ["satisfy", "not satisfy", "derive", "verify", "refine", "trace", "copy"]
)


class Relation(Struct, frozen=True):
    """A line from ``source`` to ``target`` (ids of classifiers).

    ``shows`` are the ids of the elements that the line shows; properties among them are not
    repeated in compartments. ``row`` is the property of the source that can replace the line in a
    compartment if the target is in another diagram.
    """

    source: str
    target: str
    arrow: str
    label: str = ""
    near: str = ""
    far: str = ""
    shows: tuple[str, ...] = ()
    row: str = ""


def list_relations(graph: Graph) -> list[Relation]:
    """Return all relations between classifiers except containment, include and extend."""
    return [
        *_iter_generalizations(graph),
        *_iter_associations(graph),
        *_iter_dependencies(graph),
        *_iter_flows(graph),
        *_iter_template_bindings(graph),
    ]


def find_neighbours(ids: Iterable[str], candidates: Iterable[Relation]) -> dict[str, list[str]]:
    """Return the ids that are connected by relations with each of *ids*."""
    adjacency: dict[str, list[str]] = {id: [] for id in ids}
    for relation in candidates:
        for end, opposite_end in (
            (relation.source, relation.target),
            (relation.target, relation.source),
        ):
            if end in adjacency and end != opposite_end:
                adjacency[end].append(opposite_end)
    return adjacency


def _iter_generalizations(graph: Graph) -> Iterator[Relation]:
    represented = {
        (client.id, supplier.id)
        for item in graph.of_kind(Kind.DEPENDENCY)
        for client in graph.targets(item, Edge.CLIENT)
        for supplier in graph.targets(item, Edge.SUPPLIER)
    }
    for _, source, target in graph.edges(Edge.SPECIALIZES):
        yield Relation(source, target, "--|>")
    for _, source, target in graph.edges(Edge.REALIZES):
        # A realization that has an element is drawn with the dependencies, with its name.
        if (source, target) not in represented:
            yield Relation(source, target, "..|>")


def _iter_associations(graph: Graph) -> Iterator[Relation]:
    for association in graph.of_kind(Kind.ASSOCIATION):
        ends = graph.targets(association, Edge.END)
        types = [graph.target(end, Edge.TYPED_BY) for end in ends]
        if len(ends) == 2 and types[0] is not None and types[1] is not None:
            yield _make_association(graph, association, ends, (types[0], types[1]))


def _make_association(
    graph: Graph, association: Element, ends: list[Element], types: tuple[Element, Element]
) -> Relation:
    """Return the line of an association; an aggregation starts at the whole.

    The name and multiplicity of an end stand beside the classifier that is its type.
    """
    first, second = 0, 1
    if ends[0].attrs.get("aggregation") in _SHAPES or _is_navigable(association, ends[0]):
        first, second = 1, 0
    if ends[second].attrs.get("aggregation") not in _SHAPES and (
        ends[first].attrs.get("aggregation") in _SHAPES
    ):
        first, second = second, first
    # The attribute ``aggregation`` belongs to the end at the part, the diamond to the opposite end.
    whole = _SHAPES.get(str(ends[second].attrs.get("aggregation")), "")
    back = _SHAPES.get(str(ends[first].attrs.get("aggregation")), "")
    tip = ">" if _is_navigable(association, ends[second]) else ""
    tail = "<" if not whole and _is_navigable(association, ends[first]) else ""
    # UML 2.5.1, 11.5.4: an association that is navigable both ways may be drawn without arrows.
    if tip and tail:
        tip = tail = ""
    return Relation(
        types[first].id,
        types[second].id,
        f"{whole or tail}--{back or tip}",
        "" if _is_default_name(association, ends) else association.name,
        _format_end(association, ends[first], types[first]),
        _format_end(association, ends[second], types[second]),
        (association.id, *(end.id for end in ends)),
        _find_row(association, ends, ends[second], types[first]),
    )


def _find_row(association: Element, ends: list[Element], end: Element, owner: Element) -> str:
    """Return the id of the property whose row can replace the line, or an empty text.

    A row cannot show the name of an association.
    """
    is_plain = not association.name or _is_default_name(association, ends)
    return end.id if is_plain and end.owner == owner.id else ""


def _is_navigable(association: Element, end: Element) -> bool:
    return end.owner != association.id


def _is_default_name(association: Element, ends: list[Element]) -> bool:
    """Whether the name is ``A_line_gate``, which Papyrus and MagicDraw write but do not show."""
    first, second = (end.name.lower() for end in ends)
    return association.name.lower() in (f"a_{first}_{second}", f"a_{second}_{first}")


def _format_end(association: Element, end: Element, type_: Element) -> str:
    """Return the name and multiplicity of an end.

    The name is omitted if it is the name of the type, which tools assign by default.
    """
    is_default = end.owner == association.id and end.name.lower() == type_.name.lower()
    name = "" if is_default else end.name
    return " ".join(part for part in (name, labels.multiplicity(end)) if part)


def _iter_dependencies(graph: Graph) -> Iterator[Relation]:
    for item in graph.of_kind(Kind.DEPENDENCY):
        if item.role in REQUIREMENT_ROLES:
            continue
        arrow = "..|>" if item.subkind in ("realization", "interface-realization") else "..>"
        keyword = _DEPENDENCY_WORDS.get(item.role) or _DEPENDENCY_WORDS.get(item.subkind, "")
        words = labels.keywords(graph, item) or ([keyword] if keyword else [])
        word = "" if arrow == "..|>" else labels.guillemets(words)
        for client in graph.targets(item, Edge.CLIENT):
            for supplier in graph.targets(item, Edge.SUPPLIER):
                text = " ".join(part for part in (word, item.name) if part)
                yield Relation(client.id, supplier.id, arrow, text, shows=(item.id,))


def _iter_template_bindings(graph: Graph) -> Iterator[Relation]:
    """Yield relations from an instance of a template to the template (UML 2.5.1, 7.3.4)."""
    for item in graph.of_kind(Kind.TEMPLATE_BINDING):
        bound = graph.owner(item)
        binding = templates.read_binding(graph, bound, item) if bound is not None else None
        if binding is not None and binding.template is not None:
            parts = ", ".join(
                _format_substitution(substitution) for substitution in binding.substitutions
            )
            shows = (item.id, *(owned.id for owned in graph.owned(item)))
            text = f"«bind» {parts}".strip()
            yield Relation(binding.bound.id, binding.template.id, "..>", text, shows=shows)


def _format_substitution(substitution: templates.Substitution) -> str:
    actual = (
        labels.name(substitution.actual)
        if substitution.actual is not None
        else labels.literal(substitution.value)
    )
    return (
        f"{labels.name(substitution.formal) if substitution.formal is not None else '?'} → {actual}"
    )


def _iter_flows(graph: Graph) -> Iterator[Relation]:
    """Yield item flows between classifiers that no connector realises."""
    for item in graph.of_kind(Kind.ITEM_FLOW):
        for source in graph.targets(item, Edge.FLOW_SOURCE):
            for target in graph.targets(item, Edge.FLOW_TARGET):
                text = f"«flow» {format_conveyed(graph, item)}"
                yield Relation(source.id, target.id, "..>", text, shows=(item.id,))


def format_conveyed(graph: Graph, flow: Element) -> str:
    """Return the name of an item flow and its items: ``pallet : Pallet``."""
    names = ", ".join(labels.name(item) for item in graph.targets(flow, Edge.CONVEYS))
    if flow.name and names:
        return f"{flow.name} : {names}"
    return names or flow.name


def iter_use_case_relations(graph: Graph) -> Iterator[Relation]:
    """Yield a line for each include and extend (UML 2.5.1 clauses 18.1.3, 18.1.4)."""
    for _, source, target in graph.edges(Edge.INCLUDES):
        yield Relation(source, target, "..>", "«include»")
    pairs = set()
    for extend in graph.of_kind(Kind.EXTEND):
        for case in graph.targets(extend, Edge.EXTENDS):
            if extend.owner is not None:
                pairs.add((extend.owner, case.id))
                yield _make_extend(graph, extend, extend.owner, case)
    for _, source, target in graph.edges(Edge.EXTENDS):
        is_case = graph[source].kind is Kind.USE_CASE
        if is_case and (source, target) not in pairs:
            yield Relation(source, target, "..>", "«extend»")


def _make_extend(graph: Graph, extend: Element, source: str, case: Element) -> Relation:
    """Return a line with the text ``«extend» [condition] at extension points``."""
    conditions = [element for element in graph.owned(extend) if element.kind is Kind.CONSTRAINT]
    points = [labels.name(element) for element in graph.targets(extend, Edge.REFERENCES)]
    rows = [
        "«extend»",
        *(f"[{element.attrs.get('body') or element.name}]" for element in conditions),
    ]
    rows += [f"at {', '.join(points)}"] if points else []
    shows = (extend.id, *(element.id for element in conditions))
    return Relation(source, case.id, "..>", "\n".join(rows), shows=shows)


# -- allocations as rows -----------------------------------------------------------------------

_ROW_WIDTH = 44
_STRUCTURAL_FEATURES = (Kind.PROPERTY, Kind.PORT)
_FEATURES = (*_STRUCTURAL_FEATURES, Kind.OPERATION)
_BOX_KINDS = (
    Kind.CLASS,
    Kind.COMPONENT,
    Kind.INTERFACE,
    Kind.DATA_TYPE,
    Kind.SIGNAL,
    Kind.ACTOR,
    Kind.ACTIVITY,
    Kind.STATE_MACHINE,
    Kind.USE_CASE,
    Kind.PACKAGE,
)
"""Kinds between which block definition diagrams draw allocations as lines."""


def list_node_allocations(graph: Graph, node: Element) -> tuple[list[str], list[str]]:
    """Return rows for the allocations of an activity node, and the ids of these allocations."""
    rows: list[str] = []
    ids: list[str] = []
    for dependency, target in _iter_opposite_ends(graph, node, Edge.CLIENT):
        rows += wrap_lines(f"allocated to {_format_opposite_end(graph, target)}", _ROW_WIDTH)
        ids.append(dependency.id)
    return rows, ids


def list_block_allocations(graph: Graph, block: Element) -> tuple[list[str], list[str]]:
    """Return rows for the allocations of a block and its features, and the ids of these."""
    rows: list[str] = []
    ids: list[str] = []
    for element in (block, *_list_features(graph, block)):
        for dependency, other in _iter_opposite_ends(graph, element, Edge.CLIENT):
            if not _has_line(element, other):
                rows += wrap_lines(
                    f"{_format_own_end(block, element)}→ {_format_opposite_end(graph, other)}",
                    _ROW_WIDTH,
                )
                ids.append(dependency.id)
        for dependency, other in _iter_opposite_ends(graph, element, Edge.SUPPLIER):
            if not _has_line(element, other) and not _has_row_at_client(graph, other):
                rows += wrap_lines(
                    f"{_format_own_end(block, element)}← {_format_opposite_end(graph, other)}",
                    _ROW_WIDTH,
                )
                ids.append(dependency.id)
    return rows, ids


def iter_feature_allocations(
    graph: Graph, block: Element
) -> Iterator[tuple[Element, Element, Element]]:
    """Yield allocations between two features of the block: dependency, client, supplier."""
    for client in _list_features(graph, block):
        for dependency, other in _iter_opposite_ends(graph, client, Edge.CLIENT):
            if (
                client.kind in _STRUCTURAL_FEATURES
                and other.kind in _STRUCTURAL_FEATURES
                and other.owner == block.id
            ):
                yield dependency, client, other


def _iter_opposite_ends(
    graph: Graph, element: Element, edge: Edge
) -> Iterator[tuple[Element, Element]]:
    other = Edge.SUPPLIER if edge is Edge.CLIENT else Edge.CLIENT
    for dependency in graph.sources(element, edge):
        if dependency.kind is Kind.DEPENDENCY and dependency.role == "allocate":
            for opposite in graph.targets(dependency, other):
                yield dependency, opposite


def _list_features(graph: Graph, block: Element) -> list[Element]:
    return [member for member in graph.owned(block) if member.kind in _FEATURES]


def _has_line(left: Element, right: Element) -> bool:
    """Whether a block definition or an internal block diagram draws the allocation as a line."""
    if left.kind in _STRUCTURAL_FEATURES and right.kind in _STRUCTURAL_FEATURES:
        return left.owner == right.owner
    return left.kind in _BOX_KINDS and right.kind in _BOX_KINDS


def _has_row_at_client(graph: Graph, client: Element) -> bool:
    """Whether the box of the client, or of the block that owns it, has a row for the allocation."""
    block = graph.owner(client) if client.kind in _FEATURES else client
    if block is None or block.attrs.get("external"):
        return False
    return block.kind in _BOX_KINDS and block.kind is not Kind.ACTIVITY


def _format_own_end(block: Element, element: Element) -> str:
    return "" if element is block else f"{labels.name(element)} "


def _format_opposite_end(graph: Graph, element: Element) -> str:
    """Return the name of an element, or ``owner.name`` of a feature or an action."""
    owner = graph.owner(element)
    if element.kind in (*_FEATURES, Kind.ACTION) and owner is not None:
        return f"{labels.name(owner)}.{labels.name(element)}"
    return labels.name(element)
