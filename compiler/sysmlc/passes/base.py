"""What a pass is: options as fields, a name, its predecessors, and ``run``."""

from typing import ClassVar, Protocol, runtime_checkable

from sysmlc.diagnostics import Sink
from sysmlc.ir import Element, Graph


@runtime_checkable
class InParts(Protocol):
    """A pass that does for one element after the other what no other one concerns.

    While it is at one it says so (``ir.reads.during``). ``follows`` is the pass whose derived
    value of an element it may make its own of; empty for the first.
    """

    follows: ClassVar[str]

    def is_apart(self, graph: Graph, about: Element) -> bool:
        """Whether what is derived for one element is all that comes of it: nothing is joined."""

    def part(self, graph: Graph, about: Element, sink: Sink) -> object:
        """What is derived for one element; equal values have equal consequences."""


class Pass(Protocol):
    """One refinement of the graph: valid before and after, and twice equals once.

    A pass is a frozen dataclass; its fields are its options.
    """

    name: ClassVar[str]
    after: ClassVar[tuple[str, ...]]

    def run(self, graph: Graph, sink: Sink) -> None:
        """Refine the graph in place and report what is wrong with the model."""
