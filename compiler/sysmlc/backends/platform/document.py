"""A platform as JSON (``sysmlc-platform/1``)."""

from collections.abc import Iterator, Mapping
from typing import Protocol

from msgspec import Struct

from sysmlc.diagnostics import Place
from sysmlc.ir import Element, Graph
from sysmlc.recipe.plant import Offer, Platform, Used

Json = dict[str, object]
Places = Mapping[Place, Place]


def places(graph: Graph, platform: Platform) -> Iterator[Place]:
    """The places that the document shows."""
    ids = dict.fromkeys(
        [
            *(one.element for one in platform.used),
            *(one.element for one in platform.unused),
            *(element for _, _, element in (*platform.machines, *platform.services)),
            *(one.by for one in platform.bindings),
            *(id for one in platform.offers for id in (one.by, one.operation)),
        ]
    )
    found = (_place(graph[id]) for id in ids if id in graph)
    yield from (place for place in found if place.file)


def document(graph: Graph, platform: Platform, found: Places) -> Json:
    """The platform; every list is sorted, places are those of ``found``."""
    maker = _Maker(graph, platform, found)
    return {
        "format": "sysmlc-platform/1",
        "elements": [maker.used(one) for one in platform.used],
        "machines": [maker.machine(*one) for one in platform.machines],
        "services": [maker.service(*one) for one in platform.services],
        "unused": [maker.head(one) | {"contents": one.contents} for one in platform.unused],
    }


class _PlantElement(Protocol):
    @property
    def id(self) -> str: ...
    @property
    def name(self) -> str: ...
    @property
    def type(self) -> str: ...
    @property
    def element(self) -> str: ...


class _Maker(Struct, frozen=True):
    graph: Graph
    platform: Platform
    found: Places

    def head(self, one: _PlantElement) -> Json:
        """What is said of every element of the plant."""
        return {
            "id": one.id,
            "qualified_name": one.name,
            "type": one.type,
            "source": self.source(one.element),
        }

    def used(self, one: Used) -> Json:
        """An element with the machines that it is and the services that it offers."""
        bindings = [b for b in self.platform.bindings if b.plant == one.id]
        offers = [o for o in self.platform.offers if o.plant == one.id]
        return self.head(one) | {
            "machines": [
                {"machine": b.machine, "bound_by": b.how, "said_at": self.source(b.by)}
                for b in bindings
            ],
            "services": [self._offer(o) for o in offers],
        }

    def _offer(self, offer: Offer) -> Json:
        operation = self.graph[offer.operation]
        return {
            "service": offer.service,
            "machine": offer.machine or None,
            "operation": {
                "id": operation.id,
                "qualified_name": self.graph.qualified_name(operation),
                "source": self.source(operation.id),
            },
            "bound_by": offer.how,
            "said_at": self.source(offer.by),
        }

    def machine(self, name: str, recipes: tuple[str, ...], element: str) -> Json:
        """A machine of the recipes, and its element of the plant."""
        bound = [one.plant for one in self.platform.bindings if one.machine == name]
        return {
            "machine": name,
            "recipes": list(recipes),
            "element": bound[0] if bound else None,
            "source": self.source(element),
        }

    def service(self, name: str, recipes: tuple[str, ...], element: str) -> Json:
        """A service of the recipes, and the elements that offer it."""
        offered = {one.plant for one in self.platform.offers if one.service == name}
        return {
            "service": name,
            "recipes": list(recipes),
            "elements": sorted(offered),
            "source": self.source(element),
        }

    def source(self, id: str) -> Json | None:
        """Where an element stands; None when nothing is known."""
        element = self.graph.get(id)
        place = None if element is None else _place(element)
        if place is None or not place.file:
            return None
        at = self.found.get(place, place)
        return {"file": place.file, "line": at.line, "column": at.column}


def _place(element: Element) -> Place:
    return Place(element.source, element.ordinal)
