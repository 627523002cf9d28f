"""Who offers which service: elements of the plant whose blocks own a fitting operation."""

from collections.abc import Callable, Iterator
from typing import NamedTuple

from sysmlc.ir import Edge, Element, Graph, Kind, query
from sysmlc.passes.platform import rules
from sysmlc.passes.platform.binding import misplaced
from sysmlc.passes.platform.context import Context, allocations
from sysmlc.recipe.model import Service
from sysmlc.recipe.plant import PlantElement
from sysmlc.recipe.platform import Binding, Offer
from sysmlc.support.suggestions import did_you_mean


class _Place(NamedTuple):
    """Where a service may run: a machine, or none, and its element of the plant."""

    machine: str
    element: PlantElement


class _Found(NamedTuple):
    """An operation that offers a service, how that is known, and what says it."""

    operation: Element
    how: str
    by: str


def find_offers(context: Context, bound: list[Binding]) -> list[Offer]:
    """Every element of the plant that offers a service of a recipe."""
    at = {one.machine: context.found[one.plant] for one in bound}
    found: list[Offer] = []
    for service in context.services.values():
        found += _of(context, service, at)
    misplaced(context)
    return found


def _of(context: Context, service: Service, at: dict[str, PlantElement]) -> list[Offer]:
    places = list(_places(context, service, at))
    said = list(_said(context, service))
    made: list[Offer] = []
    differing: list[_Differing] = []
    of_block: dict[str, _Answer] = {}
    for place in places:
        block = place.element.block
        if block is None:
            continue
        if block.id not in of_block:
            of_block[block.id] = _operation(context, service, block, said)
        one, why = of_block[block.id]
        if one is not None:
            context.found[place.element.id] = place.element
            id = place.element.id
            made.append(Offer(service.id, place.machine, id, one.operation.id, one.how, one.by))
        elif why is not None:
            differing.append((place, *why))
    _report(context, service, places, made, differing)
    _report_astray(context, service, places, said, made)
    return made


def _places(context: Context, service: Service, at: dict[str, PlantElement]) -> Iterator[_Place]:
    """The elements of its machines and those it is allocated to; else the whole plant."""
    named = [provider.machine for provider in service.providers]
    places = [_Place(machine, at[machine]) for machine in named if machine in at]
    element = context.graph[service.element]
    for target, _, _ in allocations(context.graph, element):
        if not context.is_machine(target) and target.kind is not Kind.OPERATION:
            places += [_Place("", one) for one in context.meant(target)]
    if not named and not places:
        places = [_Place("", one) for one in context.plant.elements.values()]
    yield from {(one.machine, one.element.id): one for one in places}.values()


def _said(context: Context, service: Service) -> Iterator[_Found]:
    """Operations that the model itself ties to the service, the most direct first."""
    graph = context.graph
    element = graph[service.element]
    if element.kind is Kind.OPERATION:
        yield _Found(element, "call", element.id)
    for target, how, by in allocations(graph, element):
        if target.kind is Kind.OPERATION:
            yield _Found(target, how, by.id)
    for operation in graph.sources(element, Edge.METHOD):
        yield _Found(operation, "method", operation.id)


_Differing = tuple[_Place, Element, str]
_Answer = tuple[_Found | None, tuple[Element, str] | None]


def _operation(context: Context, service: Service, block: Element, said: list[_Found]) -> _Answer:
    """The operation of a block that offers the service, or why the one of its name does not."""
    kin = context.plant.class_ids(block)
    for one in said:
        if one.operation.owner in kin:
            return one, None
    element = context.graph[service.element]
    why: tuple[Element, str] | None = None
    for operation in _operations(context, block):
        if element.name and operation.name == element.name:
            problem = difference(context.graph, element, operation, context.is_machine)
            if not problem:
                return _Found(operation, "name", operation.id), None
            why = why or (operation, problem)
    return None, why


def _operations(context: Context, block: Element) -> Iterator[Element]:
    for one in context.plant.classes(block):
        yield from (own for own in context.graph.owned(one) if own.kind is Kind.OPERATION)


# -- findings ----------------------------------------------------------------------------------


def _report(
    context: Context,
    service: Service,
    places: list[_Place],
    made: list[Offer],
    differing: list[_Differing],
) -> None:
    subject = context.graph.subject(context.graph[service.element])
    told: set[str] = set()
    for place, operation, problem in differing:
        if operation.id not in told and (not made or place.machine):
            told.add(operation.id)
            context.sink.report(
                rules.PARAMETERS_DIFFER,
                subject,
                service=service.id,
                operation=operation.name,
                element=context.plant.name_of(place.element),
                difference=problem,
            )
    if not made and not differing and places and _is_expected(service):
        context.sink.report(
            rules.NOBODY_OFFERS,
            subject,
            help="{advice}",
            service=service.id,
            advice=_advice(context, service, places),
        )


def _is_expected(service: Service) -> bool:
    """Databases and the like are not in a plant; what runs on machines is (thesis 3.5.2)."""
    return service.kind == "machine" or bool(service.providers)


def _advice(context: Context, service: Service, places: list[_Place]) -> str:
    blocks = {one.element.block.id: one.element.block for one in places if one.element.block}
    names = {one.name for block in blocks.values() for one in _operations(context, block)}
    name = context.graph[service.element].name
    clause = did_you_mean(name, names)
    if clause.startswith("did you mean"):
        return clause
    return f"add the operation '{name}' to the block of its machine, in the overlay of the plant"


def _report_astray(
    context: Context,
    service: Service,
    places: list[_Place],
    said: list[_Found],
    made: list[Offer],
) -> None:
    """An operation that the author chose for the service must belong to one of its elements."""
    offering = {one.operation for one in made}
    for one in said:
        is_chosen = one.how in ("allocation", "overlay")
        if is_chosen and places and one.operation.id not in offering:
            context.sink.report(
                rules.OPERATION_ASTRAY,
                context.graph.subject(context.graph[one.by]),
                service=service.id,
                operation=context.graph.qualified_name(one.operation),
                elements=", ".join(
                    sorted({f"'{context.plant.name_of(p.element)}'" for p in places})[:3]
                ),
            )


_OUTPUTS = frozenset({"out", "return"})


def difference(
    graph: Graph, service: Element, operation: Element, is_machine: Callable[[Element], bool]
) -> str:
    """What is different, as a clause; empty when the parameters fit.

    Parameters fit by name, direction and type. Machines are no data, and what may be absent
    (lower bound 0) need not be there. A ``return`` is an ``out``; the only output of both may
    have any name.
    """
    wanted, given = _by_name(graph, service), _by_name(graph, operation)
    parts = [
        f"the operation has no parameter '{one.name}'"
        for key, one in wanted.items()
        if key not in given and not _may_be_absent(graph, one, is_machine)
    ]
    parts += [
        f"the service has no parameter '{one.name}'"
        for key, one in given.items()
        if key not in wanted and not _is_optional(one)
    ]
    for key in wanted:
        if key in given:
            parts += _between(graph, wanted[key], given[key])
    return ", ".join(parts)


def _by_name(graph: Graph, owner: Element) -> dict[str, Element]:
    found = query.parameters(graph, owner)
    outputs = [one for one in found if query.direction_of(one) in _OUTPUTS]
    return {"" if [one] == outputs else one.name: one for one in found}


def _may_be_absent(graph: Graph, one: Element, is_machine: Callable[[Element], bool]) -> bool:
    type_ = query.type_of(graph, one)
    return _is_optional(one) or (type_ is not None and is_machine(type_))


def _is_optional(one: Element) -> bool:
    limits = query.bounds(one.attrs.get("multiplicity"))
    return limits is not None and limits[0] == 0


def _between(graph: Graph, wanted: Element, given: Element) -> list[str]:
    there, here = query.direction_of(wanted), query.direction_of(given)
    if there != here and not {there, here} <= _OUTPUTS:
        return [f"'{wanted.name}' is {there} of the service, {here} of the operation"]
    one, other = query.type_of(graph, wanted), query.type_of(graph, given)
    if one is None or other is None or one.name == other.name:
        return []
    if query.conforms(graph, one, other) or query.conforms(graph, other, one):
        return []
    return [f"'{wanted.name}' is a {one.name} of the service, a {other.name} of the operation"]
