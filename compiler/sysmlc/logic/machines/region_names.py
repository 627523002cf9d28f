"""Names by which formulas denote the regions of a state machine: ``state``, ``Work.state``."""

from collections.abc import Iterator, Mapping

from sysmlc.ir import Graph, Kind
from sysmlc.logic.identifiers import spell_name
from sysmlc.logic.machines.machine import Machine, element_id


def name_regions(graph: Graph, machine: Machine) -> Mapping[str, str]:
    """Return the shortest unambiguous name of each region, by its variable."""
    owner = graph.owner(graph[machine.id])
    siblings = [] if owner is None else graph.owned(owner)
    is_only = sum(element.kind is Kind.STATE_MACHINE for element in siblings) <= 1
    variables: dict[str, set[str]] = {}
    for name, variable in iter_region_names(graph, machine, is_only):
        variables.setdefault(name, set()).add(variable)
    return choose_shortest(
        (variable, name)
        for name, denoted in variables.items()
        for variable in denoted
        if len(denoted) == 1
    )


def choose_shortest(spellings: Iterator[tuple[str, str]]) -> dict[str, str]:
    """Return for each variable its name with the fewest dots, of these the shortest, first one."""
    shortest: dict[str, str] = {}
    for variable, name in spellings:
        names = (shortest.get(variable, name), name)
        shortest[variable] = min(names, key=lambda name: (name.count("."), len(name)))
    return shortest


def iter_region_names(graph: Graph, machine: Machine, is_only: bool) -> Iterator[tuple[str, str]]:
    """Yield each name of a region, seen from the owner of the machine, with its variable.

    *is_only* is true if the owner has no second machine.
    """
    regions, machine_name = machine.regions, spell_name(machine.name)
    for id in machine.top:
        variable = regions[id].variable
        if len(machine.top) == 1:
            yield f"{machine_name}.state", variable
            if is_only:
                yield "state", variable
        else:
            region = spell_name(graph[element_id(id)].name)
            yield f"{region}.state", variable
            yield f"{machine_name}.{region}.state", variable
    for state in machine.list_states():
        for id in state.regions:
            for path in _list_region_paths(graph, machine, id):
                yield f"{path}.state", regions[id].variable
                yield f"{machine_name}.{path}.state", regions[id].variable


def _list_region_paths(graph: Graph, machine: Machine, region: str) -> list[str]:
    """Return the paths of a region in a state: its own name, from its state on, and the whole path.

    A region that is the only one of its state has the name of the state.
    """
    levels = list(_iter_levels(graph, machine, region))[::-1]
    state, name = levels[-1]
    states = [state for state, _ in levels if state]
    whole = [part for level in levels for part in level if part]
    paths = ([name], [state, name], whole, [*states, name])
    return list(dict.fromkeys(".".join(filter(None, path)) for path in paths if any(path)))


def _iter_levels(graph: Graph, machine: Machine, region: str) -> Iterator[tuple[str, str]]:
    """Yield the names of the state and the region at each level around a region, inside out.

    A region without siblings has no name, and a region of the machine no state.
    """
    vertices = machine.vertices
    id = region
    while id:
        state = machine.regions[id].state
        siblings = vertices[state].regions if state else machine.top
        name = spell_name(graph[element_id(id)].name) if len(siblings) > 1 else ""
        yield spell_name(graph[element_id(state)].name) if state else "", name
        id = vertices[state].region if state else ""
