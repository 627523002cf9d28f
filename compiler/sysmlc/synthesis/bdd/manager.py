"""Decision diagrams: CUDD through ``dd.cudd``, or ``dd.autoref`` with the same calls, and limits.

Diagrams (``Node``) are combined by ``&``, ``|``, ``~``, ``implies`` and ``equiv``; what the two
libraries do differently, and what may run for long, are methods of ``Manager``.
"""

import logging
import time
import warnings
from collections.abc import Collection, Iterator, Mapping
from contextlib import contextmanager
from importlib import import_module
from types import FrameType, ModuleType
from typing import Any, Protocol, Self, cast
from weakref import WeakKeyDictionary

from sysmlc.synthesis.bdd.limits import (
    End,
    LimitError,
    Limits,
    Progress,
    TooLargeError,
    Usage,
    exceeded,
    interrupts,
    watch,
)

ENGINES = ("cudd", "autoref")
"""Names of the libraries, the fast one first."""
_MEMORY = 8 << 30
"""Bytes that a manager may take when nothing else is said."""
_GIBIBYTE = 1 << 30
_START = 1 << 26
"""Bytes that CUDD is told to expect: it sets aside and clears a share of them at once, which for
8 GiB takes longer than most games."""
REORDER_AT = 40_000
"""Nodes from which on a better order of bits is worth the search, where the one that variables
come in is not known to be good (``calm``)."""
_CALM = 1_000_000
"""The same where the order is known to be good."""
_CACHE = 1 << 14
"""Slots of the cache at the start; it grows."""
_NODE = 32
"""Bytes of a node."""
_LOOSE = 5
"""CUDD lets its tables grow fast up to this part of the memory; so it does from ``_START``."""
_PATIENCE = 0.05
"""CPU seconds between looks at the limits: counting nodes takes longer than most operations."""


class Node(Protocol):
    """A decision diagram; equal diagrams of a manager are one node."""

    def __and__(self, other: Self, /) -> Self: ...
    def __or__(self, other: Self, /) -> Self: ...
    def __invert__(self) -> Self: ...
    def __le__(self, other: Self, /) -> bool: ...
    def __len__(self) -> int: ...
    def implies(self, other: Self, /) -> Self: ...
    def equiv(self, other: Self, /) -> Self: ...


class Manager:
    """Owner of the diagrams of one game; bits are declared in their order."""

    def __init__(
        self, engine: str = "", limits: Limits | None = None, progress: Progress | None = None
    ) -> None:
        """Take the named library, or the fast one if it is there.

        Raises ImportError when the library that is asked for cannot be loaded.
        """
        self.limits = limits or Limits()
        self.engine, library = _library(engine)
        self._library = library
        self._progress = progress
        self._start = time.process_time()
        self._peak = self._nodes = self._ceiling = 0
        self._next_look = 0.0
        self._reorder_at = REORDER_AT
        self._numbers: dict[str, int] = {}
        self._supports: WeakKeyDictionary[Node, frozenset[str]] = WeakKeyDictionary()
        self._end: End | None = None
        # dd has no type hints that a checker could use.
        self._bdd: Any = _new(library, self.engine, self.limits.memory or _MEMORY)
        self.true: Node = cast("Node", self._bdd.true)
        self.false: Node = cast("Node", self._bdd.false)
        is_cudd = self.engine == "cudd"
        self._alive = watch(library, self._bdd, self) if is_cudd else None

    def declare(self, bits: Collection[str]) -> None:
        """Add bits below those that are there."""
        self._bdd.declare(*bits)
        for bit in bits:
            self._numbers.setdefault(bit, len(self._numbers))

    @property
    def bits(self) -> tuple[str, ...]:
        """All bits, the topmost first."""
        levels: Mapping[str, int] = self._bdd.var_levels
        return tuple(sorted(levels, key=lambda bit: levels[bit]))

    def var(self, bit: str) -> Node:
        """The diagram of one bit."""
        return cast("Node", self._bdd.var(bit))

    def cube(self, values: Mapping[str, bool]) -> Node:
        """The conjunction of bits and negated bits."""
        return cast("Node", self._bdd.cube(dict(values)))

    def ite(self, test: Node, then: Node, otherwise: Node) -> Node:
        """``then`` where the test holds, else ``otherwise``."""
        return cast("Node", self._bdd.ite(test, then, otherwise))

    def exist(self, bits: Collection[str], node: Node) -> Node:
        """Some values of the bits make it true."""
        return cast("Node", self._bdd.exist(set(bits), node)) if bits else node

    def forall(self, bits: Collection[str], node: Node) -> Node:
        """All values of the bits make it true."""
        return cast("Node", self._bdd.forall(set(bits), node)) if bits else node

    def and_exist(self, left: Node, right: Node, bits: Collection[str]) -> Node:
        """``exist(bits, left & right)`` without the conjunction itself, where CUDD is there."""
        if not bits:
            return left & right
        if self.engine == "cudd":
            return cast("Node", self._library.and_exists(left, right, bits))
        return self.exist(bits, left & right)

    def rename(self, node: Node, bits: Mapping[str, str]) -> Node:
        """The diagram over other bits; those that take a name must not be in it."""
        return cast("Node", self._bdd.let(dict(bits), node)) if bits else node

    def compose(self, node: Node, by: Mapping[str, Node]) -> Node:
        """Bits replaced by diagrams, all at once."""
        return cast("Node", self._bdd.let(dict(by), node)) if by else node

    def assign(self, node: Node, values: Mapping[str, bool]) -> Node:
        """The diagram for these values of bits."""
        return cast("Node", self._bdd.let(dict(values), node)) if values else node

    def restrict(self, node: Node, care: Node) -> Node:
        """A diagram, smaller if possible, that is the same wherever ``care`` holds."""
        if self.engine != "cudd" or care == self.true or care == self.false:
            return node
        made = cast("Node", self._library.restrict(node, care))
        return made if len(made) < len(node) else node

    def support(self, node: Node) -> frozenset[str]:
        """The bits that the diagram depends on."""
        found = self._supports.get(node)
        if found is None:
            found = self._supports[node] = frozenset(self._bdd.support(node))
        return found

    def branches(self, node: Node) -> tuple[str, Node, Node]:
        """The topmost bit of a diagram that is neither true nor false; what is left when it is
        false, and when it is true."""
        found: Any = node
        low, high = found.low, found.high
        return (found.var, ~low, ~high) if found.negated else (found.var, low, high)

    def pick(self, node: Node, bits: Collection[str]) -> dict[str, bool] | None:
        """Values of the bits that make it true; None if there are none.

        They are the first in the order in which bits were declared, false before true, whatever
        order the diagrams have come to. Bits that do not matter are false. ``bits`` must contain
        the support.
        """
        if node == self.false:
            return None
        found = dict.fromkeys(bits, False)
        for bit in sorted(self.support(node), key=self._numbers.__getitem__):
            low = self.assign(node, {bit: False})
            found[bit] = low == self.false
            node = self.assign(node, {bit: True}) if found[bit] else low
        return found

    def count(self, node: Node, bits: Collection[str]) -> int:
        """Number of assignments to the bits that make it true (exact up to 2^53)."""
        found: float = self._bdd.count(node, len(bits))
        return round(found)

    def reorder_automatically(self, is_on: bool) -> None:
        """Let the library change the order of bits when diagrams grow."""
        self._bdd.configure(reordering=is_on)

    @contextmanager
    def calm(self) -> Iterator[None]:
        """Leave the order of bits what it is until diagrams are much larger than elsewhere."""
        before, self._reorder_at = self._reorder_at, _CALM
        self.reorder_automatically(False)
        try:
            yield
        finally:
            self._reorder_at = before

    @contextmanager
    def at_most(self, nodes: int) -> Iterator[None]:
        """Give up with TooLargeError what needs more nodes at once; what comes after goes on."""
        before, self._ceiling = self._ceiling, nodes
        try:
            with self.guard():
                yield
        finally:
            self._ceiling = before
            if self._end is not None and isinstance(self._end(), TooLargeError):
                self._end = None

    def sift(self) -> None:
        """Look for a better order of bits now."""
        with self.guard():
            self._bdd.reorder()

    def usage(self) -> Usage:
        """Nodes alive, the most there have been, CPU seconds."""
        nodes, peak = self._counts()
        self._peak = max(self._peak, peak)
        return Usage(nodes, self._peak, time.process_time() - self._start)

    def check(self, doing: str = "") -> None:
        """Say what is being done; raises LimitError when a limit is exceeded."""
        if doing and self._progress is not None:
            self._progress(doing)
        # Not when the clock says so: what is decided must not depend on how fast that was.
        nodes = self._nodes if self._alive is None else self._alive()
        if self._end is None:
            self._end = exceeded(Usage(nodes, nodes, 0.0), self.limits, 0)
        if self.is_over() and self._end is not None:
            raise self._end()
        if nodes > self._reorder_at:
            self.reorder_automatically(True)

    def is_over(self) -> bool:
        """Whether a limit is exceeded, or somebody pressed Ctrl-C; asked within operations too."""
        now = time.process_time()
        if self._end is None and now >= self._next_look:
            self._next_look = now + _PATIENCE
            used = self.usage()
            self._nodes, self._end = used.nodes, exceeded(used, self.limits, self._ceiling)
        return self._end is not None

    def _counts(self) -> tuple[int, int]:
        if self.engine != "cudd":
            nodes = len(self._bdd)
            return nodes, nodes
        with warnings.catch_warnings():
            # dd warns of a change of the unit of memory in every call.
            warnings.simplefilter("ignore")
            found = self._bdd.statistics()
        return found["n_nodes"], found["peak_live_nodes"]

    @contextmanager
    def guard(self) -> Iterator[None]:
        """Turn what the library raises when an operation is given up, or its memory used up, into
        LimitError; within it Ctrl-C ends operations, too."""
        try:
            with interrupts(self._interrupted):
                yield
        except (RuntimeError, ValueError, MemoryError) as problem:
            if self._end is not None:
                raise self._end() from None
            if isinstance(problem, MemoryError) or _is_memory(str(problem)):
                size = (self.limits.memory or _MEMORY) / _GIBIBYTE
                raise LimitError("of memory", f"{size:.3g} GiB") from None
            raise
        if self._end is KeyboardInterrupt:
            raise KeyboardInterrupt

    def _interrupted(self, number: int, frame: FrameType | None) -> None:
        """Ctrl-C: what runs is given up soon; when it is pressed again, at once."""
        if self._end is not None:
            raise KeyboardInterrupt
        self._end = KeyboardInterrupt


def _is_memory(text: str) -> bool:
    """How dd says that CUDD had no more memory: it does not look at most of its results."""
    return "NULL" in text or "out of memory" in text


def _library(engine: str) -> tuple[str, ModuleType]:
    names = (engine,) if engine else ENGINES
    for name in names:
        try:
            return name, import_module(f"dd.{name}")
        except ImportError:
            if name == names[-1]:
                raise
    raise ImportError(engine)


def _new(library: ModuleType, engine: str, memory: int) -> Any:  # noqa: ANN401
    logging.getLogger("dd").setLevel(logging.ERROR)
    if engine != "cudd":
        return library.BDD()
    made = library.BDD(_START, _CACHE)
    loose = memory // _NODE // _LOOSE
    made.configure(reordering=False, max_memory=memory, loose_up_to=loose)
    return made
