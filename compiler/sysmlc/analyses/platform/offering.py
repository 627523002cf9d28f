"""Offers: the plant elements whose blocks own an operation that fits a service."""

from collections.abc import Callable, Iterator
from typing import NamedTuple

from sysmlc.analyses.platform.binding import Context, list_allocations, report_misplaced_services
from sysmlc.diagnostics import Severity, rule
from sysmlc.ir import Edge, Element, Graph, Kind, query
from sysmlc.recipe.model import Service
from sysmlc.recipe.plant import Binding, Offer, PlantElement
from sysmlc.support.suggestions import did_you_mean

NOBODY_OFFERS = rule(
    "SM623",
    "service-nobody-offers",
    Severity.WARNING,
    "no element of the plant offers the service '{service}'",
    help="add the operation to the block of its machine, in the overlay of the plant",
)
PARAMETERS_DIFFER = rule(
    "SM627",
    "parameters-of-service-differ",
    Severity.WARNING,
    "operation '{operation}' of '{element}' does not offer the service '{service}': {difference}",
    help="make the parameters equal, or allocate the service to the operation that is meant",
)
OPERATION_ASTRAY = rule(
    "SM630",
    "operation-of-another-element",
    Severity.WARNING,
    "service '{service}' is allocated to operation '{operation}', which {elements} does not have",
    help="allocate the service to an operation of its machine, or add that machine to the service",
)


class _Site(NamedTuple):
    """A plant element that may offer a service, and the machine that is bound to it or ""."""

    machine: str
    element: PlantElement


class _OfferingOperation(NamedTuple):
    """An operation that offers a service, the kind of statement, and the id of its source."""

    operation: Element
    how: str
    by: str


def find_offers(context: Context, bindings: list[Binding]) -> list[Offer]:
    """Return which plant elements offer which services of the recipes."""
    element_of_machine = {
        binding.machine: context.bound_elements[binding.plant] for binding in bindings
    }
    offers: list[Offer] = []
    for service in context.services.values():
        offers += _find_offers_of(context, service, element_of_machine)
    report_misplaced_services(context)
    return offers


def _find_offers_of(
    context: Context, service: Service, element_of_machine: dict[str, PlantElement]
) -> list[Offer]:
    sites = list(_list_sites(context, service, element_of_machine))
    stated = list(_list_stated_operations(context, service))
    offers: list[Offer] = []
    mismatches: list[_Mismatch] = []
    results: dict[str, _Match] = {}
    for site in sites:
        block = site.element.block
        if block is None:
            continue
        if block.id not in results:
            results[block.id] = _find_operation(context, service, block, stated)
        match, mismatch = results[block.id]
        if match is not None:
            context.bound_elements[site.element.id] = site.element
            id = site.element.id
            offers.append(
                Offer(service.id, site.machine, id, match.operation.id, match.how, match.by)
            )
        elif mismatch is not None:
            mismatches.append((site, *mismatch))
    _report_mismatches(context, service, sites, offers, mismatches)
    _report_foreign_operations(context, service, sites, stated, offers)
    return offers


def _list_sites(
    context: Context, service: Service, element_of_machine: dict[str, PlantElement]
) -> Iterator[_Site]:
    """Yield the plant elements that may offer a service.

    These are the elements of its machines and allocations. Without both, they are all elements.
    """
    machines = [provider.machine for provider in service.providers]
    sites = [
        _Site(machine, element_of_machine[machine])
        for machine in machines
        if machine in element_of_machine
    ]
    element = context.graph[service.element]
    for target, _, _ in list_allocations(context.graph, element):
        if not context.is_machine(target) and target.kind is not Kind.OPERATION:
            sites += [_Site("", part) for part in context.find_plant_elements(target)]
    if not machines and not sites:
        sites = [_Site("", part) for part in context.plant.elements.values()]
    yield from {(site.machine, site.element.id): site for site in sites}.values()


def _list_stated_operations(context: Context, service: Service) -> Iterator[_OfferingOperation]:
    """Yield the operations that the model assigns to the service, the most direct first."""
    graph = context.graph
    element = graph[service.element]
    if element.kind is Kind.OPERATION:
        yield _OfferingOperation(element, "call", element.id)
    for target, how, source in list_allocations(graph, element):
        if target.kind is Kind.OPERATION:
            yield _OfferingOperation(target, how, source.id)
    for operation in graph.sources(element, Edge.METHOD):
        yield _OfferingOperation(operation, "method", operation.id)


_Mismatch = tuple[_Site, Element, str]
_Match = tuple[_OfferingOperation | None, tuple[Element, str] | None]


def _find_operation(
    context: Context, service: Service, block: Element, stated: list[_OfferingOperation]
) -> _Match:
    """Return the operation of a block that offers the service, or a mismatch.

    Without a stated operation, the name and the parameters decide. A mismatch is an operation of
    the same name with other parameters, and a clause about the difference.
    """
    family = context.plant.list_class_ids(block)
    for candidate in stated:
        if candidate.operation.owner in family:
            return candidate, None
    element = context.graph[service.element]
    mismatch: tuple[Element, str] | None = None
    for operation in _list_operations(context, block):
        if element.name and operation.name == element.name:
            problem = _describe_difference(context.graph, element, operation, context.is_machine)
            if not problem:
                return _OfferingOperation(operation, "name", operation.id), None
            mismatch = mismatch or (operation, problem)
    return None, mismatch


def _list_operations(context: Context, block: Element) -> Iterator[Element]:
    for classifier in context.plant.list_classes(block):
        yield from (
            feature for feature in context.graph.owned(classifier) if feature.kind is Kind.OPERATION
        )


# -- findings ----------------------------------------------------------------------------------


def _report_mismatches(
    context: Context,
    service: Service,
    sites: list[_Site],
    offers: list[Offer],
    mismatches: list[_Mismatch],
) -> None:
    subject = context.graph.subject(context.graph[service.element])
    reported: set[str] = set()
    for site, operation, problem in mismatches:
        if operation.id not in reported and (not offers or site.machine):
            reported.add(operation.id)
            context.sink.report(
                PARAMETERS_DIFFER,
                subject,
                service=service.id,
                operation=operation.name,
                element=context.plant.qualified_name(site.element),
                difference=problem,
            )
    # Databases and the like are not part of a plant; services of machines are (thesis 3.5.2).
    is_of_plant = service.kind == "machine" or bool(service.providers)
    if not offers and not mismatches and sites and is_of_plant:
        context.sink.report(
            NOBODY_OFFERS,
            subject,
            help="{advice}",
            service=service.id,
            advice=_advise(context, service, sites),
        )


def _advise(context: Context, service: Service, sites: list[_Site]) -> str:
    blocks = {site.element.block.id: site.element.block for site in sites if site.element.block}
    names = {
        operation.name
        for block in blocks.values()
        for operation in _list_operations(context, block)
    }
    name = context.graph[service.element].name
    clause = did_you_mean(name, names)
    if clause.startswith("did you mean"):
        return clause
    return f"add the operation '{name}' to the block of its machine, in the overlay of the plant"


def _report_foreign_operations(
    context: Context,
    service: Service,
    sites: list[_Site],
    stated: list[_OfferingOperation],
    offers: list[Offer],
) -> None:
    """Report operations that are allocated to the service but belong to none of its elements."""
    offering_ids = {offer.operation for offer in offers}
    for candidate in stated:
        is_chosen = candidate.how in ("allocation", "overlay")
        if is_chosen and sites and candidate.operation.id not in offering_ids:
            context.sink.report(
                OPERATION_ASTRAY,
                context.graph.subject(context.graph[candidate.by]),
                service=service.id,
                operation=context.graph.qualified_name(candidate.operation),
                elements=", ".join(
                    sorted({f"'{context.plant.qualified_name(p.element)}'" for p in sites})[:3]
                ),
            )


_OUTPUTS = frozenset({"out", "return"})


def _describe_difference(
    graph: Graph, service: Element, operation: Element, is_machine: Callable[[Element], bool]
) -> str:
    """Return the difference of the signatures as a clause; empty if they fit.

    Parameters are compared by name, direction and type. The operation may omit parameters for
    machines and parameters with the lower bound 0. ``return`` equals ``out``, and if both have only
    one output, its name is ignored.
    """
    required, offered = _index_parameters(graph, service), _index_parameters(graph, operation)
    parts = [
        f"the operation has no parameter '{parameter.name}'"
        for key, parameter in required.items()
        if key not in offered and not _can_be_absent(graph, parameter, is_machine)
    ]
    parts += [
        f"the service has no parameter '{parameter.name}'"
        for key, parameter in offered.items()
        if key not in required and not _is_optional(parameter)
    ]
    for key in required:
        if key in offered:
            parts += _compare_parameters(graph, required[key], offered[key])
    return ", ".join(parts)


def _index_parameters(graph: Graph, owner: Element) -> dict[str, Element]:
    """Return the parameters by name; a single output has the key ""."""
    parameters = query.parameters(graph, owner)
    outputs = [parameter for parameter in parameters if query.direction_of(parameter) in _OUTPUTS]
    return {"" if [parameter] == outputs else parameter.name: parameter for parameter in parameters}


def _can_be_absent(graph: Graph, parameter: Element, is_machine: Callable[[Element], bool]) -> bool:
    type_ = query.type_of(graph, parameter)
    return _is_optional(parameter) or (type_ is not None and is_machine(type_))


def _is_optional(parameter: Element) -> bool:
    limits = query.bounds(parameter.attrs.get("multiplicity"))
    return limits is not None and limits[0] == 0


def _compare_parameters(graph: Graph, required: Element, offered: Element) -> list[str]:
    name, directions = (
        required.name,
        [query.direction_of(parameter) for parameter in (required, offered)],
    )
    if directions[0] != directions[1] and not _OUTPUTS.issuperset(directions):
        return [f"'{name}' is {directions[0]} of the service, {directions[1]} of the operation"]
    expected, actual = query.type_of(graph, required), query.type_of(graph, offered)
    if expected is None or actual is None or expected.name == actual.name:
        return []
    if query.conforms(graph, expected, actual) or query.conforms(graph, actual, expected):
        return []
    return [f"'{name}' is a {expected.name} of the service, a {actual.name} of the operation"]
