"""Include and extend as lines between use cases (UML 2.5.1 clauses 18.1.3, 18.1.4)."""

from collections.abc import Iterator

from sysmlc.backends.plantuml import labels
from sysmlc.backends.plantuml.relations import Relation
from sysmlc.ir import Edge, Element, Graph, Kind


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
