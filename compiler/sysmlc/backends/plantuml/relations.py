"""Relations between classifiers, as lines of a block definition diagram."""

from collections.abc import Iterator

from msgspec import Struct

from sysmlc.backends.plantuml import labels
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.ir.query import templates

_SHAPES = {"composite": "*", "shared": "o"}
_DEPENDENCY_WORDS = {"allocate": "allocate", "usage": "use", "abstraction": "abstraction"}
REQUIREMENT_ROLES = frozenset(["satisfy", "derive", "verify", "refine", "trace", "copy"])


class Relation(Struct, frozen=True):
    """A line from ``source`` to ``target`` (ids of classifiers).

    ``shows`` are the ids of the elements that the line stands for; properties among them are
    not repeated in compartments. ``row`` is the property of the source that can stand for the
    line in a compartment, when the target is far away.
    """

    source: str
    target: str
    arrow: str
    label: str = ""
    near: str = ""
    far: str = ""
    shows: tuple[str, ...] = ()
    row: str = ""


def relations(graph: Graph) -> list[Relation]:
    """All relations between classifiers that are elements or edges of their own."""
    return [
        *_generalizations(graph),
        *_associations(graph),
        *_dependencies(graph),
        *_flows(graph),
        *_bindings(graph),
    ]


def _generalizations(graph: Graph) -> Iterator[Relation]:
    represented = {
        (client.id, supplier.id)
        for item in graph.of_kind(Kind.DEPENDENCY)
        for client in graph.targets(item, Edge.CLIENT)
        for supplier in graph.targets(item, Edge.SUPPLIER)
    }
    for _, source, target in graph.edges(Edge.SPECIALIZES):
        yield Relation(source, target, "--|>")
    for _, source, target in graph.edges(Edge.REALIZES):
        if (source, target) not in represented:
            yield Relation(source, target, "..|>")


def _associations(graph: Graph) -> Iterator[Relation]:
    for association in graph.of_kind(Kind.ASSOCIATION):
        ends = graph.targets(association, Edge.END)
        types = [graph.target(end, Edge.TYPED_BY) for end in ends]
        if len(ends) == 2 and types[0] is not None and types[1] is not None:
            yield _association(graph, association, ends, (types[0], types[1]))


def _association(
    graph: Graph, association: Element, ends: list[Element], types: tuple[Element, Element]
) -> Relation:
    """The line starts at the whole; an end stands at the classifier that is its type."""
    first, second = 0, 1
    if ends[0].attrs.get("aggregation") in _SHAPES or _is_navigable(association, ends[0]):
        first, second = 1, 0
    if ends[second].attrs.get("aggregation") not in _SHAPES and (
        ends[first].attrs.get("aggregation") in _SHAPES
    ):
        first, second = second, first
    whole = _SHAPES.get(str(ends[second].attrs.get("aggregation")), "")
    back = _SHAPES.get(str(ends[first].attrs.get("aggregation")), "")
    tip = ">" if _is_navigable(association, ends[second]) else ""
    tail = "<" if not whole and _is_navigable(association, ends[first]) else ""
    if tip and tail:
        tip = tail = ""
    return Relation(
        types[first].id,
        types[second].id,
        f"{whole or tail}--{back or tip}",
        "" if _is_default_name(association, ends) else association.name,
        _end(association, ends[first], types[first]),
        _end(association, ends[second], types[second]),
        (association.id, *(end.id for end in ends)),
        _row(association, ends, ends[second], types[first]),
    )


def _row(association: Element, ends: list[Element], end: Element, owner: Element) -> str:
    """A property says it all when the association has no name of its own."""
    is_plain = not association.name or _is_default_name(association, ends)
    return end.id if is_plain and end.owner == owner.id else ""


def _is_navigable(association: Element, end: Element) -> bool:
    return end.owner != association.id


def _is_default_name(association: Element, ends: list[Element]) -> bool:
    """``A_line_gate``: what Papyrus and MagicDraw write, and do not show themselves."""
    first, second = (end.name.lower() for end in ends)
    return association.name.lower() in (f"a_{first}_{second}", f"a_{second}_{first}")


def _end(association: Element, end: Element, type_: Element) -> str:
    """Name and multiplicity; the name that tools give to the far end is not shown either."""
    is_default = end.owner == association.id and end.name.lower() == type_.name.lower()
    name = "" if is_default else end.name
    return " ".join(part for part in (name, labels.multiplicity(end)) if part)


def _dependencies(graph: Graph) -> Iterator[Relation]:
    for item in graph.of_kind(Kind.DEPENDENCY):
        if item.role in REQUIREMENT_ROLES:
            continue
        arrow = "..|>" if item.subkind in ("realization", "interface-realization") else "..>"
        word = "" if arrow == "..|>" else _dependency_word(graph, item)
        for client in graph.targets(item, Edge.CLIENT):
            for supplier in graph.targets(item, Edge.SUPPLIER):
                text = " ".join(part for part in (word, item.name) if part)
                yield Relation(client.id, supplier.id, arrow, text, shows=(item.id,))


def _dependency_word(graph: Graph, item: Element) -> str:
    applied = labels.keywords(graph, item)
    word = _DEPENDENCY_WORDS.get(item.role) or _DEPENDENCY_WORDS.get(item.subkind, "")
    return labels.guillemets(applied or ([word] if word else []))


def _bindings(graph: Graph) -> Iterator[Relation]:
    """From what is made of a template to the template (UML 2.5.1, 7.3.4)."""
    for item in graph.of_kind(Kind.TEMPLATE_BINDING):
        bound = graph.owner(item)
        found = templates.read_binding(graph, bound, item) if bound is not None else None
        if found is not None and found.template is not None:
            parts = ", ".join(_substitution(one) for one in found.substitutions)
            shows = (item.id, *(one.id for one in graph.owned(item)))
            text = f"«bind» {parts}".strip()
            yield Relation(found.bound.id, found.template.id, "..>", text, shows=shows)


def _substitution(one: templates.Substitution) -> str:
    actual = labels.name(one.actual) if one.actual is not None else labels.literal(one.value)
    return f"{labels.name(one.formal) if one.formal is not None else '?'} → {actual}"


def _flows(graph: Graph) -> Iterator[Relation]:
    """Item flows drawn between classifiers, not over a connector."""
    for item in graph.of_kind(Kind.ITEM_FLOW):
        for source in graph.targets(item, Edge.FLOW_SOURCE):
            for target in graph.targets(item, Edge.FLOW_TARGET):
                text = f"«flow» {conveyed(graph, item)}"
                yield Relation(source.id, target.id, "..>", text, shows=(item.id,))


def conveyed(graph: Graph, flow: Element) -> str:
    """Name of an item flow and what it conveys: ``pallet : Pallet``."""
    names = ", ".join(labels.name(item) for item in graph.targets(flow, Edge.CONVEYS))
    if flow.name and names:
        return f"{flow.name} : {names}"
    return names or flow.name


def use_case_relations(graph: Graph) -> Iterator[Relation]:
    """A line for each include and extend."""
    for _, source, target in graph.edges(Edge.INCLUDES):
        yield Relation(source, target, "..>", "«include»")
    told = set()
    for extend in graph.of_kind(Kind.EXTEND):
        for case in graph.targets(extend, Edge.EXTENDS):
            if extend.owner is not None:
                told.add((extend.owner, case.id))
                yield _extend(graph, extend, extend.owner, case)
    for _, source, target in graph.edges(Edge.EXTENDS):
        is_case = graph[source].kind is Kind.USE_CASE
        if is_case and (source, target) not in told:
            yield Relation(source, target, "..>", "«extend»")


def _extend(graph: Graph, extend: Element, source: str, case: Element) -> Relation:
    """``«extend» [condition] at extension points``."""
    conditions = [one for one in graph.owned(extend) if one.kind is Kind.CONSTRAINT]
    points = [labels.name(one) for one in graph.targets(extend, Edge.REFERENCES)]
    rows = ["«extend»", *(f"[{one.attrs.get('body') or one.name}]" for one in conditions)]
    rows += [f"at {', '.join(points)}"] if points else []
    shows = (extend.id, *(one.id for one in conditions))
    return Relation(source, case.id, "..>", "\n".join(rows), shows=shows)
