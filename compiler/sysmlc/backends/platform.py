"""Back end ``platform``: which element of the plant offers which service of the recipes.

It writes one file ``platform.json`` for a unit that has recipes and a plant.
"""

from collections.abc import Iterator, Mapping

from msgspec import Struct

from sysmlc.backends.base import EmitOptions
from sysmlc.diagnostics import Place, Sink
from sysmlc.ir import Graph
from sysmlc.recipe.plant import Offer, Platform, Used
from sysmlc.support.output import Output, encode_json

PATH = "platform.json"

Json = dict[str, object]


class PlatformBackend(Struct, frozen=True):
    """Writes the result of the analysis ``platform`` (metamodels/sysmlc-platform.schema.json)."""

    name: str = "platform"
    summary: str = "which element of the plant offers which service of the recipes, as JSON"
    is_default: bool = True
    needs: tuple[str, ...] = ("platform",)

    def emit(self, graph: Graph, output: Output, sink: Sink, options: EmitOptions) -> None:
        """Add the file; its trace contains machines, services and elements of the plant."""
        for platform in graph.derived(Platform):
            located = options.locate(_iter_places(graph, platform))
            document = _Writer(graph, platform, located).describe_platform()
            output.add(PATH, encode_json(document, 2), _iter_traced_elements(platform), self.name)


BACKEND = PlatformBackend()


def _iter_traced_elements(platform: Platform) -> Iterator[str]:
    yield from (used.element for used in platform.used)
    yield from (element for _, _, element in (*platform.machines, *platform.services))
    yield from (offer.operation for offer in platform.offers)


def _iter_places(graph: Graph, platform: Platform) -> Iterator[Place]:
    """Yield the places of all elements that the document locates, each element once."""
    ids = dict.fromkeys(
        [
            *(used.element for used in platform.used),
            *(unused.element for unused in platform.unused),
            *(element for _, _, element in (*platform.machines, *platform.services)),
            *(binding.by for binding in platform.bindings),
            *(id for offer in platform.offers for id in (offer.by, offer.operation)),
        ]
    )
    for id in ids:
        element = graph.get(id)
        if element is not None and element.source:
            yield Place(element.source, element.ordinal)


class _Writer(Struct, frozen=True):
    """Converts a platform to JSON; *located* maps places to places with line and column."""

    graph: Graph
    platform: Platform
    located: Mapping[Place, Place]

    def describe_platform(self) -> Json:
        """Return the document ``sysmlc-platform/1``; the lists keep the order of the platform."""
        platform = self.platform
        return {
            "format": "sysmlc-platform/1",
            "elements": [self._describe_used(used) for used in platform.used],
            "machines": [self._describe_machine(*machine) for machine in platform.machines],
            "services": [self._describe_service(*service) for service in platform.services],
            "unused": [
                self._describe_plant_element(unused) | {"contents": unused.contents}
                for unused in platform.unused
            ],
        }

    def _describe_plant_element(self, element: Used) -> Json:
        return {
            "id": element.id,
            "qualified_name": element.name,
            "type": element.type,
            "source": self._find_location(element.element),
        }

    def _describe_used(self, used: Used) -> Json:
        """Describe an element, the machines bound to it, and the services that it offers."""
        return self._describe_plant_element(used) | {
            "machines": [
                {
                    "machine": binding.machine,
                    "bound_by": binding.how,
                    "said_at": self._find_location(binding.by),
                }
                for binding in self.platform.bindings
                if binding.plant == used.id
            ],
            "services": [
                self._describe_offer(offer)
                for offer in self.platform.offers
                if offer.plant == used.id
            ],
        }

    def _describe_offer(self, offer: Offer) -> Json:
        operation = self.graph[offer.operation]
        return {
            "service": offer.service,
            "machine": offer.machine or None,
            "operation": {
                "id": operation.id,
                "qualified_name": self.graph.qualified_name(operation),
                "source": self._find_location(operation.id),
            },
            "bound_by": offer.how,
            "said_at": self._find_location(offer.by),
        }

    def _describe_machine(self, name: str, recipes: tuple[str, ...], element: str) -> Json:
        """Describe a machine of the recipes with the first element of the plant it is bound to."""
        plant_elements = [b.plant for b in self.platform.bindings if b.machine == name]
        return {
            "machine": name,
            "recipes": list(recipes),
            "element": plant_elements[0] if plant_elements else None,
            "source": self._find_location(element),
        }

    def _describe_service(self, name: str, recipes: tuple[str, ...], element: str) -> Json:
        """Describe a service of the recipes with the elements of the plant that offer it."""
        plant_elements = {o.plant for o in self.platform.offers if o.service == name}
        return {
            "service": name,
            "recipes": list(recipes),
            "elements": sorted(plant_elements),
            "source": self._find_location(element),
        }

    def _find_location(self, id: str) -> Json | None:
        """Return file, line and column of an element; None if it comes from no file."""
        element = self.graph.get(id)
        if element is None or not element.source:
            return None
        place = Place(element.source, element.ordinal)
        location = self.located.get(place, place)
        return {"file": location.file, "line": location.line, "column": location.column}
