"""The mapping of recipes to a plant: machines, and offers of services (thesis 3.2).

The JSON form is described by metamodels/sysmlc-platform.schema.json.
"""

from msgspec import Struct


class Binding(Struct, frozen=True):
    """A machine of a recipe is an element of the plant.

    ``how`` is ``itself``, ``id``, ``tag``, ``allocation`` or ``overlay``; ``by`` is the id of the
    element of the graph that states it.
    """

    machine: str
    plant: str
    how: str
    by: str


class Offer(Struct, frozen=True):
    """An element of the plant offers a service by an operation.

    ``machine`` is empty when the service needs none. ``how`` is ``name``, ``method``, ``call``,
    ``allocation`` or ``overlay``; ``by`` is the id of the element that states it.
    """

    service: str
    machine: str
    plant: str
    operation: str
    how: str
    by: str


class Used(Struct, frozen=True):
    """An element of the plant that recipes use; ``element`` is its id in the graph."""

    id: str
    name: str
    type: str
    element: str


class Unused(Struct, frozen=True):
    """An element of the plant that no recipe uses; ``contents`` counts the elements below it."""

    id: str
    name: str
    type: str
    element: str
    contents: int


class Platform(Struct, frozen=True):
    """The recipes of a unit on its plant; all tuples are sorted.

    ``machines`` and ``services`` are ids (qualified names) with the recipes that use them and
    their elements in the graph: (name, recipes, element).
    """

    used: tuple[Used, ...]
    bindings: tuple[Binding, ...]
    offers: tuple[Offer, ...]
    unused: tuple[Unused, ...]
    machines: tuple[tuple[str, tuple[str, ...], str], ...]
    services: tuple[tuple[str, tuple[str, ...], str], ...]
