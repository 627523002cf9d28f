"""The parts of a recipe model by id, for the derivation and the checks."""

from collections.abc import Callable, Mapping

from msgspec import Struct, field

from sysmlc.recipe.model import FlowGraph, Function, Model, Node, Range, Service


class Tables(Struct, frozen=True):
    """The services, functions and graphs of a model by id, and memoised durations."""

    services: Mapping[str, Service]
    functions: Mapping[str, Function]
    service_graphs: Mapping[str, FlowGraph]
    function_graphs: Mapping[str, FlowGraph]
    open_graphs: frozenset[str] = frozenset()
    """Function graphs whose calls are being followed."""
    _times: dict[tuple[str, ...], Range | None] = field(default_factory=dict)

    @classmethod
    def from_model(cls, model: Model) -> "Tables":
        """Build the tables of *model*."""
        return cls(
            {service.id: service for service in model.services},
            {function.id: function for function in model.functions},
            {graph.id: graph for graph in model.service_graphs},
            {graph.id: graph for graph in model.function_graphs},
        )

    def find_service(self, node: Node) -> Service | None:
        """Return the service that a node calls, or None."""
        return self.services.get(node.ref) if node.kind == "service" else None

    def memoise_duration(
        self, key: tuple[str, ...], compute: Callable[[], Range | None]
    ) -> Range | None:
        """Return the duration stored under *key*, which the first call computes and stores."""
        if key not in self._times:
            self._times[key] = compute()
        return self._times[key]

    def without_graph(self, id: str) -> "Tables":
        """Return the tables without one function graph, so that calls of it are not followed."""
        rest = {key: graph for key, graph in self.function_graphs.items() if key != id}
        opened = self.open_graphs | {id}
        return Tables(self.services, self.functions, self.service_graphs, rest, opened)
