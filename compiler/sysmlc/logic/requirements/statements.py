"""The conditions of requirements, by the element that they are about."""

from collections.abc import Iterator

from msgspec import Struct

from sysmlc.ir import Edge, Element, Graph, Kind, query

_SUBJECTS = (*query.CLASSIFIERS, *query.BEHAVIORS)


class Statement(Struct, frozen=True):
    """A constraint of a requirement, assumed of the environment or demanded of the subject."""

    constraint: Element
    requirement: Element
    is_assumed: bool
    is_open: bool = False
    """Nothing says which it is, in SysML v1: what is about inputs alone is assumed."""


def statements(graph: Graph) -> list[tuple[Element, list[Statement]]]:
    """Subjects in the order of the model, each with what all its requirements say of it.

    A requirement about a definition is one about all that specialise it, and about operations that
    it is the method of; a definition that is abstract, or in no file of the model, has only those.
    """
    found: dict[str, dict[str, Statement]] = {}
    for requirement in filter(query.is_requirement, graph.of_kind(Kind.CLASS)):
        said = list(_conditions(graph, requirement))
        for subject in _subjects(graph, requirement) if said else ():
            rows = found.setdefault(subject.id, {})
            rows.update((one.constraint.id, one) for one in said)
    return [(graph[id], list(rows.values())) for id, rows in found.items()]


def _conditions(graph: Graph, requirement: Element) -> Iterator[Statement]:
    """Its own constraints and those of the requirements that it specialises."""
    family = (requirement, *query.generals(graph, requirement))
    is_open = not any(_tells_apart(graph, one) for one in family)
    for one in family:
        assumed = {constraint.id for constraint in graph.targets(one, Edge.ASSUMES)}
        for constraint in graph.owned(one):
            if constraint.kind is Kind.CONSTRAINT and constraint.attrs.get("body"):
                is_assumed = constraint.id in assumed or _says_assume(constraint)
                yield Statement(constraint, requirement, is_assumed, is_open)


def _tells_apart(graph: Graph, requirement: Element) -> bool:
    """Whether a requirement says what of it is assumed."""
    has_subject = bool(graph.targets(requirement, Edge.SUBJECT))
    return has_subject or any(
        one.kind is Kind.CONSTRAINT and _says_assume(one) for one in graph.owned(requirement)
    )


def _says_assume(constraint: Element) -> bool:
    """Whether a constraint of SysML v1, which has no assumptions, says it by its language."""
    return "assume" in str(constraint.attrs.get("language", "")).lower()


def _subjects(graph: Graph, requirement: Element) -> Iterator[Element]:
    """What satisfies it, else what it says it is about, with all that specialises that."""
    family = (requirement, *query.generals(graph, requirement))
    stated = graph.sources(requirement, Edge.SATISFIES)
    if not stated:
        stated = next(filter(None, (graph.targets(one, Edge.SUBJECT) for one in family)), [])
    for one in stated:
        type_ = one if one.kind in _SUBJECTS else query.type_of(graph, one)
        if type_ is not None:
            yield from _with_special(graph, type_, set())


def _with_special(graph: Graph, type_: Element, seen: set[str]) -> Iterator[Element]:
    if type_.id in seen:
        return
    seen.add(type_.id)
    if not type_.attrs.get("external") and not type_.attrs.get("abstract"):
        yield type_
    yield from graph.sources(type_, Edge.METHOD)
    for special in graph.sources(type_, Edge.SPECIALIZES):
        yield from _with_special(graph, special, seen)


def definition_of(graph: Graph, subject: Element) -> Element:
    """What has the features that formulas name: of an operation that is its method."""
    method = graph.target(subject, Edge.METHOD) if subject.kind is Kind.OPERATION else None
    return method or subject


def component_of(graph: Graph, subject: Element) -> str:
    """Name of the component that a subject is: an operation is one of what owns it."""
    owner = graph.owner(subject) if subject.kind is Kind.OPERATION else None
    if owner is None:
        return query.component_name(graph, subject)
    return f"{query.component_name(graph, owner)}.{subject.name}"


def redefining(graph: Graph, subject: Element) -> Element | None:
    """An operation that gives parameters of its method other values; None when it does not."""
    if subject.kind is not Kind.OPERATION:
        return None
    own = query.parameters(graph, subject)
    return subject if any(graph.targets(one, Edge.REDEFINES) for one in own) else None
