"""Names by which formulas denote the actions of activities: ``running(load.grip)``."""

from collections import Counter
from collections.abc import Collection, Iterable
from itertools import takewhile

from msgspec import Struct

from sysmlc.ir import Element, Graph, Kind
from sysmlc.logic import formula as f
from sysmlc.logic.activities.token_graph import TokenGraph
from sysmlc.logic.identifiers import spell_name


class ActionPath(Struct, frozen=True):
    """An action with the names of the performances around it, outermost first."""

    names: tuple[str, ...]
    node: str


def make_path(names: Iterable[str], node: str) -> ActionPath:
    """Return the path of an action, with names as formulas spell them."""
    return ActionPath(tuple(map(spell_name, names)), node)


def list_enclosing_actions(graph: Graph, element: Element) -> list[str]:
    """List the names of the actions in an activity that contain *element*, outermost first."""
    enclosing = takewhile(lambda owner: owner.kind is Kind.STRUCTURED, graph.ancestors(element))
    return [owner.name for owner in enclosing if owner.name][::-1]


def shorten_paths(paths: Collection[ActionPath]) -> dict[str, str]:
    """Return the shortest path that names an action without ambiguity, by its node."""
    nodes: dict[tuple[str, ...], set[str]] = {}
    for action in paths:
        for start in range(len(action.names)):
            nodes.setdefault(action.names[start:], set()).add(action.node)
    shortest: dict[str, str] = {}
    for action in paths:
        suffixes = (action.names[start:] for start in reversed(range(len(action.names))))
        unique = next((path for path in suffixes if len(nodes[path]) == 1), action.names)
        shortest.setdefault(action.node, ".".join(unique))
    return shortest


def name_actions(graph: Graph, tokens: TokenGraph) -> dict[str, str]:
    """Return the names of the variables about the actions of an activity, by these variables.

    An input that ends several actions has no name, because ``finished(...)`` is about one.
    """
    activity, handshake = graph[tokens.activity].name, tokens.handshake
    actions = [(node, graph[node.origin]) for node in tokens.workers()]
    places = [make_path((activity,), tokens.activity)] if activity else []
    places += [
        make_path((activity, *list_enclosing_actions(graph, action), action.name), node.id)
        for node, action in actions
        if action.name and action.id != tokens.activity
    ]
    paths = shorten_paths(places)
    names: dict[str, str] = {}
    if handshake is not None and tokens.activity in paths:
        names[handshake.running] = f"running({spell_name(activity)})"
        names[handshake.finished] = f"finished({spell_name(activity)})"
    ends = Counter(node.done.name for node, _ in actions if isinstance(node.done, f.Var))
    for node in (node for node, _ in actions if node.id in paths):
        names[node.run] = f"running({paths[node.id]})"
        if isinstance(node.done, f.Var) and ends[node.done.name] == 1:
            names[node.done.name] = f"finished({paths[node.id]})"
    return names
