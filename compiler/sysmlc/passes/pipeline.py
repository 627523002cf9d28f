"""The passes by name, and running them in the order that their ``after`` asks for."""

from collections.abc import Callable, Iterable, Sequence
from importlib import import_module
from typing import cast

from msgspec import Struct

from sysmlc.diagnostics import Sink
from sysmlc.ir import Graph
from sysmlc.ir.verify import verify
from sysmlc.passes.base import Pass

NAMES = (
    "resolve",
    "kept",
    "overlay",
    "inherit",
    "classify",
    "ports",
    "flows",
    "activities",
    "behaviours",
    "interactions",
    "recipe",
    "platform",
    "contracts",
    "robots",
    "views",
)
"""Every pass; ``sysmlc.passes.<name>`` has the class of that name, capitalised."""


class InvalidGraphError(RuntimeError):
    """A front end or a pass left a graph that ``verify`` rejects: our fault, not the model's."""


def load(name: str) -> Pass:
    """The pass of this name with its default options, imported only now.

    Raises KeyError for an unknown name.
    """
    if name not in NAMES:
        raise KeyError(name)
    module = import_module(f"sysmlc.passes.{name}")
    return cast("Pass", getattr(module, name.capitalize())())


def ordered(passes: Iterable[Pass]) -> list[Pass]:
    """The passes, each behind those that it names in ``after``, else in the order given.

    A name in ``after`` that is not among them is passed over. Raises ValueError when they wait
    for one another.
    """
    waiting = list(passes)
    done: list[Pass] = []
    while waiting:
        names = {one.name for one in waiting}
        ready = next((one for one in waiting if names.isdisjoint(one.after)), None)
        if ready is None:
            raise ValueError(f"passes wait for one another: {', '.join(sorted(names))}")
        waiting.remove(ready)
        done.append(ready)
    return done


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
        """Run the passes, up to and with ``until``; ``after_pass`` sees the graph behind each.

        Raises KeyError when no pass has the name ``until``, InvalidGraphError with
        ``verify_each`` when the graph is not valid before the first pass or behind one.
        """
        if until is not None and until not in {one.name for one in self.passes}:
            raise KeyError(until)
        if verify_each:
            _verify("the front end", graph)
        for one in self.passes:
            one.run(graph, sink)
            if verify_each:
                _verify(f"pass {one.name}", graph)
            if after_pass is not None:
                after_pass(one.name, graph)
            if one.name == until:
                return


def pipeline(names: Sequence[str] = NAMES) -> Pipeline:
    """The passes of these names with default options, in order."""
    return Pipeline(tuple(ordered(load(name) for name in names)))


def run(
    graph: Graph,
    sink: Sink,
    verify_each: bool = False,
    until: str | None = None,
    after_pass: Callable[[str, Graph], None] | None = None,
) -> None:
    """Run all passes, or those up to and with ``until``; see ``Pipeline.run``.

    A pass that ``until`` does not need is not even imported.
    """
    names = NAMES if until is None else NAMES[: _position(until) + 1]
    pipeline(names).run(graph, sink, verify_each=verify_each, until=until, after_pass=after_pass)


def _position(name: str) -> int:
    if name not in NAMES:
        raise KeyError(name)
    return NAMES.index(name)


def _verify(who: str, graph: Graph) -> None:
    faults = verify(graph)
    if faults:
        raise InvalidGraphError(f"{who} left an invalid graph: " + "; ".join(faults[:5]))
