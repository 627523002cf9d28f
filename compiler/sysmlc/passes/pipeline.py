"""The interface of passes, and the pipeline that runs them in the order of their ``after``."""

from collections.abc import Callable, Iterable, Sequence
from importlib import import_module
from typing import ClassVar, Protocol, cast

from msgspec import Struct

from sysmlc.diagnostics import Sink
from sysmlc.ir import Graph
from sysmlc.ir.verify import verify


class Pass(Protocol):
    """A refinement of the graph.

    The graph is valid before and after the pass, and a second run changes nothing. A pass is a
    frozen value whose fields are its options. ``after`` names the passes that must run before it.
    """

    name: ClassVar[str]
    after: ClassVar[tuple[str, ...]]

    def run(self, graph: Graph, sink: Sink) -> None:
        """Refine the graph in place and report faults of the model."""


# -- order -------------------------------------------------------------------------------------

NAMES = (
    "resolve",
    "kept",
    "overlay",
    "inherit",
    "classify",
    "ports",
    "flows",
    "guards",
    "behaviours",
    "interactions",
    "expressions",
    "views",
)
"""All passes in order; the class of a pass is its capitalised name in ``sysmlc.passes.<name>``."""


READING = ("resolve", "kept")
"""Passes that only resolve references and preserve what the authors wrote."""


class InvalidGraphError(RuntimeError):
    """A front end or a pass left a graph that ``verify`` rejects: a fault of the compiler."""


def load(name: str) -> Pass:
    """Import and return the pass of this name with its default options.

    Raises KeyError for an unknown name.
    """
    if name not in NAMES:
        raise KeyError(name)
    module = import_module(f"sysmlc.passes.{name}")
    return cast("Pass", getattr(module, name.capitalize())())


def sort_passes(passes: Iterable[Pass]) -> list[Pass]:
    """Return the passes in a topological order by ``after``, otherwise in the given order.

    Names in ``after`` of passes that are not given are ignored. Raises ValueError for a cycle.
    """
    remaining = list(passes)
    sorted_passes: list[Pass] = []
    while remaining:
        names = {step.name for step in remaining}
        ready = next((step for step in remaining if names.isdisjoint(step.after)), None)
        if ready is None:
            raise ValueError(f"passes wait for one another: {', '.join(sorted(names))}")
        remaining.remove(ready)
        sorted_passes.append(ready)
    return sorted_passes


class Pipeline(Struct, frozen=True):
    """Passes in the order in which they run."""

    passes: tuple[Pass, ...]

    def run(
        self,
        graph: Graph,
        sink: Sink,
        *,
        verify_each: bool = False,
        until: str | None = None,
        after_pass: Callable[[str, Graph], None] | None = None,
    ) -> None:
        """Run the passes up to and including *until*, and call *after_pass* after each pass.

        Raises KeyError if no pass has the name *until*, and, with *verify_each*, InvalidGraphError
        if the graph is not valid before the first pass or after a pass.
        """
        if until is not None and until not in {step.name for step in self.passes}:
            raise KeyError(until)
        if verify_each:
            _verify("the front end", graph)
        for step in self.passes:
            step.run(graph, sink)
            if verify_each:
                _verify(f"pass {step.name}", graph)
            if after_pass is not None:
                after_pass(step.name, graph)
            if step.name == until:
                return


def build_pipeline(names: Sequence[str] = NAMES) -> Pipeline:
    """Return the passes of these names with default options, in order."""
    return Pipeline(tuple(sort_passes(load(name) for name in names)))


def run(
    graph: Graph,
    sink: Sink,
    verify_each: bool = False,
    until: str | None = None,
    after_pass: Callable[[str, Graph], None] | None = None,
) -> None:
    """Run all passes, or the passes up to and including *until*; see ``Pipeline.run``.

    The modules of later passes are not imported.
    """
    names = NAMES if until is None else NAMES[: _find_position(until) + 1]
    build_pipeline(names).run(
        graph, sink, verify_each=verify_each, until=until, after_pass=after_pass
    )


def _find_position(name: str) -> int:
    if name not in NAMES:
        raise KeyError(name)
    return NAMES.index(name)


def _verify(step: str, graph: Graph) -> None:
    faults = verify(graph)
    if faults:
        raise InvalidGraphError(f"{step} left an invalid graph: " + "; ".join(faults[:5]))
