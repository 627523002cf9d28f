"""Whether an operation takes and gives what a service does."""

from collections.abc import Callable

from sysmlc.ir import Element, Graph, query

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
