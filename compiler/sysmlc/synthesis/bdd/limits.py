"""How much a manager of decision diagrams may use, what it used, and how it says that it is over.

A limit that was reached is kept as an ``End``, not as the exception: that would hold the frames it
went through, they the manager and its diagrams, and the manager the exception. Such a circle is
left to the collector, which may take the manager away before its diagrams.
"""

import ctypes
import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from itertools import count
from types import FrameType, ModuleType
from typing import Protocol
from weakref import WeakValueDictionary

from msgspec import Struct


class Limits(Struct, frozen=True):
    """How much a manager may use; 0 is no limit of its own."""

    nodes: int = 0
    """Nodes that are alive at once."""
    memory: int = 0
    """Bytes."""
    seconds: float = 0.0
    """CPU time since the manager was made."""


class Usage(Struct, frozen=True):
    """What a manager has used so far."""

    nodes: int
    peak: int
    seconds: float


class LimitError(Exception):
    """A limit was reached: ``what`` it limits, and the limit itself, in words."""

    def __init__(self, what: str, limit: str) -> None:
        super().__init__(f"the limit of {limit} {what} was reached")
        self.what = what
        self.limit = limit


class TooLargeError(LimitError):
    """One form of an outcome is too large; another one may not be."""


Progress = Callable[[str], None]
"""Called between operations with what is being done."""
End = Callable[[], LimitError | KeyboardInterrupt]
"""Why operations are to be given up: makes the exception to be raised."""


def exceeded(used: Usage, limits: Limits, ceiling: int) -> End | None:
    """The limit that was reached, if one was; ``ceiling`` is one of nodes for a while."""
    if ceiling and used.nodes > ceiling:
        return lambda: TooLargeError("nodes", f"{ceiling:,}")
    if limits.nodes and used.nodes > limits.nodes:
        return lambda: LimitError("nodes", f"{limits.nodes:,}")
    if limits.seconds and used.seconds > limits.seconds:
        return lambda: LimitError("of CPU time", f"{limits.seconds:g} s")
    return None


@contextmanager
def interrupts(handler: Callable[[int, FrameType | None], None]) -> Iterator[None]:
    """Let a function see Ctrl-C where it would raise KeyboardInterrupt: an operation of the library
    would not be ended by that."""
    is_main = threading.current_thread() is threading.main_thread()
    before = signal.getsignal(signal.SIGINT)
    if not is_main or before is not signal.default_int_handler:
        yield
        return
    signal.signal(signal.SIGINT, handler)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)


_ATTRIBUTES = ("vars", "_index_of_var", "_var_with_index")
"""What ``dd.cudd.BDD`` declares right behind the manager (dd 0.6)."""
_WORD = ctypes.sizeof(ctypes.c_void_p)


class Watched(Protocol):
    """Somebody whose operations may have to end early."""

    def is_over(self) -> bool:
        """Whether the operation that runs is to be given up."""
        ...


_watched: WeakValueDictionary[int, Watched] = WeakValueDictionary()
_numbers = count(1)


def watch(library: ModuleType, bdd: object, watched: Watched) -> Callable[[], int] | None:
    """Have CUDD ask whether an operation of ``bdd`` is to be given up.

    Returns what counts the nodes alive, in no time; None if nothing of this can be done. An
    operation that is given up raises what ``dd`` raises when CUDD has no result: RuntimeError or
    ValueError.
    """
    manager = _manager(bdd)
    try:
        known = ctypes.CDLL(library.__file__)
        register, counted = known.Cudd_RegisterTerminationCallback, known.Cudd_ReadNodeCount
    except (OSError, AttributeError):
        return None
    if manager is None:
        return None
    counted.restype = ctypes.c_long
    number = next(_numbers)
    _watched[number] = watched
    register(ctypes.c_void_p(manager), _ASKED, ctypes.c_void_p(number))
    return partial(counted, ctypes.c_void_p(manager))


def _manager(bdd: object) -> int | None:
    """The address that stands before those of the attributes, if they stand there in a row."""
    size = type(bdd).__basicsize__ // _WORD
    words = list((ctypes.c_size_t * size).from_address(id(bdd)))
    known = [id(getattr(bdd, name, None)) for name in _ATTRIBUTES]
    places = [at for at in range(1, size) if words[at : at + len(known)] == known]
    return words[places[0] - 1] or None if len(places) == 1 else None


def _asked(number: int) -> int:
    watched = _watched.get(number)
    return 0 if watched is None else int(watched.is_over())


_ASKED = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_void_p)(_asked)
"""One function for all managers, never freed: diagrams may outlive whoever made them."""
