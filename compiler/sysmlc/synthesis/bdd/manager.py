"""Decision diagrams (BDDs) on CUDD through ``dd.cudd``, or on ``dd.autoref``.

Diagrams (``Node``) are combined by ``&``, ``|``, ``~``, ``implies`` and ``equiv``. Operations that
differ between the two libraries, or that may run for long, are methods of ``Manager``.
"""

import logging
import sys
import time
import warnings
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import reduce
from importlib import import_module
from operator import and_, or_
from types import FrameType, ModuleType
from typing import Any, Protocol, Self, cast
from weakref import WeakKeyDictionary

from sysmlc.synthesis.bdd.limits import (
    LimitError,
    Limits,
    Progress,
    StopReason,
    TooLargeError,
    Usage,
    find_exceeded_limit,
    install_termination_callback,
    intercept_interrupts,
)

_NETWORKX = "networkx"
ENGINES = ("cudd", "autoref")
"""Names of the libraries, the fast one first."""
_DEFAULT_MEMORY = 8 << 30
"""Bytes that a manager may use if its limits state nothing."""
_GIBIBYTE = 1 << 30
_EXPECTED_MEMORY = 1 << 26
"""Bytes that CUDD is told to expect. CUDD allocates and clears a share of them at once, which for
8 GiB takes longer than solving most games."""
REORDER_AT = 15_000
"""Live nodes above which automatic reordering (sifting) is switched on. With 40,000 nodes, AMBA
with three masters took eight times as long; with 10,000, robots on 25 cells took 1.5 times as long.
"""
MAX_SIFTED_NODES = 150_000
"""Live nodes above which it is switched off again. CUDD can be stopped only between two bits that
it sifts. The time for one bit grows fast: 0.1 s at 100,000 nodes, 12 s at 500,000."""
_CACHE_SLOTS = 1 << 14
"""Initial slots of CUDD's cache, which grows."""
_NODE_SIZE = 32
"""Bytes of a node in CUDD."""
_FAST_GROWTH_SHARE = 5
"""CUDD lets its tables grow fast until they take 1/n of the memory limit."""
_SECONDS_BETWEEN_LIMIT_CHECKS = 0.05
"""CPU seconds between checks of the limits: counting nodes takes longer than most operations."""


class Node(Protocol):
    """A decision diagram; equivalent diagrams of one manager are the same node."""

    def __and__(self, other: Self, /) -> Self: ...
    def __or__(self, other: Self, /) -> Self: ...
    def __invert__(self) -> Self: ...
    def __le__(self, other: Self, /) -> bool: ...
    def __len__(self) -> int: ...
    def implies(self, other: Self, /) -> Self: ...
    def equiv(self, other: Self, /) -> Self: ...


class Manager:
    """The owner of the diagrams of one game: creates and combines them within limits.

    Bits are ordered as they were declared until the library reorders them.
    """

    def __init__(
        self,
        engine: str = "",
        limits: Limits | None = None,
        progress: Progress | None = None,
        start_time: float | None = None,
    ) -> None:
        """Create an empty manager on the library *engine*, or on the fastest one that is installed.

        The CPU time counts from *start_time* (``time.process_time``), or else from now. Raises
        ImportError if the requested library cannot be loaded.
        """
        self.limits = limits or Limits()
        self.engine, library = _import_library(engine)
        self._library = library
        self._progress = progress
        self._start_time = time.process_time() if start_time is None else start_time
        self._peak = self._nodes = self._ceiling = 0
        self._next_limit_check = 0.0
        self._is_declaring = False
        self._may_reorder, self._is_reordering = True, False
        self._supports: WeakKeyDictionary[Node, frozenset[str]] = WeakKeyDictionary()
        self._stop_reason: StopReason | None = None
        # dd has no type hints that a checker could use.
        self._bdd: Any = _create_bdd(library, self.engine, self.limits.memory or _DEFAULT_MEMORY)
        self.true: Node = cast("Node", self._bdd.true)
        self.false: Node = cast("Node", self._bdd.false)
        is_cudd = self.engine == "cudd"
        self._count_live_nodes = (
            install_termination_callback(library, self._bdd, self) if is_cudd else None
        )

    def declare(self, bits: Collection[str]) -> None:
        """Append bits to the order, below all bits declared before."""
        self._is_declaring = True
        try:
            self._bdd.declare(*bits)
        finally:
            self._is_declaring = False

    @property
    def bits(self) -> tuple[str, ...]:
        """All bits in the current order, the topmost first."""
        levels: Mapping[str, int] = self._bdd.var_levels
        return tuple(sorted(levels, key=lambda bit: levels[bit]))

    def var(self, bit: str) -> Node:
        """Return the diagram that is true where *bit* is true."""
        return cast("Node", self._bdd.var(bit))

    def cube(self, values: Mapping[str, bool]) -> Node:
        """Return the conjunction of bits and negated bits."""
        return cast("Node", self._bdd.cube(dict(values)))

    def ite(self, test: Node, then: Node, otherwise: Node) -> Node:
        """Return the diagram that equals *then* where *test* holds, else *otherwise*."""
        return cast("Node", self._bdd.ite(test, then, otherwise))

    def conjoin(self, parts: Iterable[Node]) -> Node:
        """Return the conjunction of the parts; true for none."""
        return reduce(and_, parts, self.true)

    def disjoin(self, parts: Iterable[Node]) -> Node:
        """Return the disjunction of the parts; false for none."""
        return reduce(or_, parts, self.false)

    def conjoin_small(self, parts: Iterable[Node], limit: int) -> Node | None:
        """Return the conjunction, or None if it or an intermediate one has over *limit* nodes."""
        result = self.true
        for part in parts:
            result = result & part
            if len(result) > limit:
                return None
        return result

    def exist(self, bits: Collection[str], node: Node) -> Node:
        """Quantify the bits existentially."""
        return cast("Node", self._bdd.exist(set(bits), node)) if bits else node

    def forall(self, bits: Collection[str], node: Node) -> Node:
        """Quantify the bits universally."""
        return cast("Node", self._bdd.forall(set(bits), node)) if bits else node

    def and_exist(self, left: Node, right: Node, bits: Collection[str]) -> Node:
        """Return ``exist(bits, left & right)``; CUDD does not build the conjunction for it."""
        if not bits:
            return left & right
        if self.engine == "cudd":
            return cast("Node", self._library.and_exists(left, right, bits))
        return self.exist(bits, left & right)

    def rename(self, node: Node, bits: Mapping[str, str]) -> Node:
        """Replace bits by other bits that the diagram does not depend on."""
        return cast("Node", self._bdd.let(dict(bits), node)) if bits else node

    def compose(self, node: Node, replacements: Mapping[str, Node]) -> Node:
        """Replace bits by diagrams simultaneously."""
        return cast("Node", self._bdd.let(dict(replacements), node)) if replacements else node

    def assign(self, node: Node, values: Mapping[str, bool]) -> Node:
        """Return the cofactor of the diagram for these values of bits."""
        return cast("Node", self._bdd.let(dict(values), node)) if values else node

    def restrict(self, node: Node, care: Node) -> Node:
        """Return a diagram that equals *node* wherever *care* holds, and that is not larger."""
        if self.engine != "cudd" or care == self.true or care == self.false:
            return node
        restricted = cast("Node", self._library.restrict(node, care))
        # CUDD's restrict may return a larger diagram (Coudert and Madre, 1990).
        return restricted if len(restricted) < len(node) else node

    def support(self, node: Node) -> frozenset[str]:
        """Return the bits that the diagram depends on."""
        # Conjuncts are asked for their support again and again, which dd computes by traversal.
        support = self._supports.get(node)
        if support is None:
            support = self._supports[node] = frozenset(self._bdd.support(node))
        return support

    def branches(self, node: Node) -> tuple[str, Node, Node]:
        """Return the topmost bit of a diagram and its cofactors for false and for true.

        The diagram must not be constant.
        """
        # CUDD marks negation on the edge to a node, and dd returns the cofactors of the node
        # itself.
        bdd_node: Any = node
        # CUDD shares a diagram with its complement: a negated edge negates both cofactors.
        low, high = bdd_node.low, bdd_node.high
        return (bdd_node.var, ~low, ~high) if bdd_node.negated else (bdd_node.var, low, high)

    def pick(self, node: Node, bits: Sequence[str]) -> dict[str, bool] | None:
        """Return values of *bits* that satisfy the diagram, or None if it is unsatisfiable.

        The values are the lexicographically least ones in the order of *bits*, with false before
        true, so they do not depend on the order of the diagram. Bits outside the support are false.
        *bits* must contain the support.
        """
        if node == self.false:
            return None
        assignment = dict.fromkeys(bits, False)
        support = self.support(node)
        for bit in filter(support.__contains__, bits):
            low = self.assign(node, {bit: False})
            assignment[bit] = low == self.false
            node = self.assign(node, {bit: True}) if assignment[bit] else low
        return assignment

    def count(self, node: Node, bits: Collection[str]) -> int:
        """Return the number of satisfying assignments to *bits* (exact up to 2^53)."""
        # dd counts in floating point.
        models: float = self._bdd.count(node, len(bits))
        return round(models)

    def reorder_automatically(self, is_on: bool) -> None:
        """Switch the library's automatic reordering of bits on or off."""
        # CUDD reorders inside operations, so a switch takes effect with the next one.
        self._bdd.configure(reordering=is_on)
        self._is_reordering = is_on

    @contextmanager
    def without_reordering(self) -> Iterator[None]:
        """Inside the block, do not reorder bits."""
        previous, self._may_reorder = self._may_reorder, False
        self.reorder_automatically(False)
        try:
            yield
        finally:
            self._may_reorder = previous

    @contextmanager
    def limit_nodes(self, nodes: int) -> Iterator[None]:
        """Raise TooLargeError if the block needs more live nodes than *nodes*.

        The manager remains usable after the error.
        """
        previous, self._ceiling = self._ceiling, nodes
        try:
            with self.guard():
                yield
        finally:
            self._ceiling = previous
            if self._stop_reason is not None and isinstance(self._stop_reason(), TooLargeError):
                self._stop_reason = None

    def sift(self) -> None:
        """Reorder the bits now."""
        with self.guard():
            self._bdd.reorder()

    def restart_clock(self, start_time: float) -> None:
        """Let the CPU time of the limits count from *start_time*, for a new question.

        A manager that a limit has stopped remains stopped.
        """
        self._start_time = start_time

    def usage(self) -> Usage:
        """Return the live nodes, their peak and the CPU seconds."""
        nodes, peak = self._count_nodes()
        self._peak = max(self._peak, peak)
        return Usage(nodes, self._peak, time.process_time() - self._start_time)

    def check(self, activity: str = "") -> None:
        """Report *activity* as progress and adapt reordering. Raises LimitError at a limit."""
        if activity and self._progress is not None:
            self._progress(activity)
        if self.should_stop() and self._stop_reason is not None:
            raise self._stop_reason()
        # Reordering depends on nodes alone: results must not depend on the speed of the machine.
        is_sifted = self._may_reorder and REORDER_AT < self._nodes <= MAX_SIFTED_NODES
        if is_sifted and not self._is_reordering:
            self.reorder_automatically(True)

    def should_stop(self) -> bool:
        """Return whether a limit is exceeded or Ctrl-C was pressed; called by CUDD, too."""
        if self._is_declaring:
            # CUDD counts nodes through its array of variables, whose new entry is not yet valid.
            return False
        if self._stop_reason is not None:
            return True
        if self._count_live_nodes is not None:
            self._nodes = self._count_live_nodes()
            usage = Usage(self._nodes, self._nodes, 0.0)
            self._stop_reason = find_exceeded_limit(usage, self.limits, self._ceiling)
        if self._is_reordering and self._nodes > MAX_SIFTED_NODES:
            self.reorder_automatically(False)
        time_now = time.process_time()
        if self._stop_reason is None and time_now >= self._next_limit_check:
            self._next_limit_check = time_now + _SECONDS_BETWEEN_LIMIT_CHECKS
            usage = self.usage()
            self._nodes = usage.nodes
            self._stop_reason = find_exceeded_limit(usage, self.limits, self._ceiling)
        return self._stop_reason is not None

    def _count_nodes(self) -> tuple[int, int]:
        if self.engine != "cudd":
            nodes = len(self._bdd)
            return nodes, nodes
        with warnings.catch_warnings():
            # dd warns of a change of the unit of memory in every call.
            warnings.simplefilter("ignore")
            statistics = self._bdd.statistics()
        return statistics["n_nodes"], statistics["peak_live_nodes"]

    @contextmanager
    def guard(self) -> Iterator[None]:
        """Convert the library's errors about stopped operations or exhausted memory to LimitError.

        Inside the block Ctrl-C stops operations of the library, too.
        """
        try:
            with intercept_interrupts(self._handle_interrupt):
                yield
        except (RuntimeError, ValueError, MemoryError) as problem:
            if self._stop_reason is not None:
                raise self._stop_reason() from None
            if isinstance(problem, MemoryError) or _is_memory_error(str(problem)):
                size = (self.limits.memory or _DEFAULT_MEMORY) / _GIBIBYTE
                raise LimitError("of memory", f"{size:.3g} GiB") from None
            raise
        if self._stop_reason is KeyboardInterrupt:
            raise KeyboardInterrupt

    def _handle_interrupt(self, number: int, frame: FrameType | None) -> None:
        """Request that the running operation stops; raise at once if Ctrl-C is pressed again."""
        if self._stop_reason is not None:
            raise KeyboardInterrupt
        self._stop_reason = KeyboardInterrupt


ManagerFactory = Callable[[], Manager]
"""Creates a manager for the variables of one question."""


def _is_memory_error(text: str) -> bool:
    """Whether dd's message says that CUDD has no more memory.

    dd does not check most results of CUDD, so that the message is often about a NULL node.
    """
    return "NULL" in text or "out of memory" in text


def _import_library(engine: str) -> tuple[str, ModuleType]:
    names = (engine,) if engine else ENGINES
    for name in names:
        try:
            with _hide_networkx():
                return name, import_module(f"dd.{name}")
        except ImportError:
            if name == names[-1]:
                raise
    raise ImportError(engine)


@contextmanager
def _hide_networkx() -> Iterator[None]:
    """Inside the block, let imports of networkx fail.

    dd works without networkx, which it uses only to export diagrams as graphs, and importing it
    takes longer than most decisions.
    """
    if _NETWORKX in sys.modules:
        yield
        return
    hidden: dict[str, Any] = {_NETWORKX: None}
    sys.modules.update(hidden)
    try:
        yield
    finally:
        del sys.modules[_NETWORKX]


def _create_bdd(library: ModuleType, engine: str, memory: int) -> Any:  # noqa: ANN401
    # dd logs a warning in each call of `let` that replaces nothing.
    logging.getLogger("dd").setLevel(logging.ERROR)
    if engine != "cudd":
        return library.BDD()
    bdd = library.BDD(_EXPECTED_MEMORY, _CACHE_SLOTS)
    fast_growth_nodes = memory // _NODE_SIZE // _FAST_GROWTH_SHARE
    bdd.configure(reordering=False, max_memory=memory, loose_up_to=fast_growth_nodes)
    return bdd
