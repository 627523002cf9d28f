"""Limits of nodes, memory and CPU time for a manager of decision diagrams.

CUDD asks every 2,048 steps of an operation whether the operation shall stop. ``dd`` does not expose
the callback for this (cudd.h: ``Cudd_RegisterTerminationCallback``), but it exports CUDD's
functions and stores the C pointer of the manager next to the attributes of ``dd.cudd.BDD``. The
pointer is read from there only if these attributes lie in memory as they are declared. Otherwise,
or if the functions are not exported, limits are checked between operations only.

A limit that was reached is stored as a ``StopReason``, not as the exception: the exception would
hold its frames, the frames the manager, and the manager the exception. Python's collector may free
the manager of such a cycle before its diagrams, which crashes CUDD.
"""

import ctypes
import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from itertools import count as count_up
from types import FrameType, ModuleType
from typing import Protocol, Self
from weakref import WeakValueDictionary

from msgspec import Struct

from sysmlc.support.counts import count


class Limits(Struct, frozen=True):
    """Limits of one manager; 0 means that there is no limit."""

    nodes: int = 0
    """Live nodes."""
    memory: int = 0
    """Bytes."""
    seconds: float = 0.0
    """CPU time since the manager was created."""


class Usage(Struct, frozen=True):
    """Resources that a manager has used so far."""

    nodes: int
    peak: int
    seconds: float


class LimitError(Exception):
    """Reports that a limit was reached: what is limited (``of CPU time``), and how much of it."""

    def __init__(self, subject: str, limit: str) -> None:
        super().__init__(" ".join(filter(None, ("the limit of", limit, subject, "was reached"))))

    @classmethod
    def of_number(cls, number: int, noun: str, subject: str = "") -> Self:
        """Return the error about a limited number of things: ``1 node``, ``2 steps``."""
        return cls(subject, count(number, noun))


class TooLargeError(LimitError):
    """Reports that one representation of a result is too large; another one may be small enough."""


Progress = Callable[[str], None]
"""Called between operations with the current activity."""
StopReason = Callable[[], LimitError | KeyboardInterrupt]
"""Creates the exception for the reason why operations stop."""


def find_exceeded_limit(usage: Usage, limits: Limits, ceiling: int) -> StopReason | None:
    """Return the first limit that *usage* exceeds, or None.

    *ceiling* is a temporary limit of nodes, reported as TooLargeError; 0 means that there is none.
    """
    if ceiling and usage.nodes > ceiling:
        return lambda: TooLargeError.of_number(ceiling, "node")
    if limits.nodes and usage.nodes > limits.nodes:
        return lambda: LimitError.of_number(limits.nodes, "node")
    if limits.seconds and usage.seconds > limits.seconds:
        return lambda: LimitError("of CPU time", f"{limits.seconds:g} s")
    return None


@contextmanager
def intercept_interrupts(handler: Callable[[int, FrameType | None], None]) -> Iterator[None]:
    """Call *handler* on Ctrl-C instead of raising KeyboardInterrupt.

    KeyboardInterrupt would not stop an operation that runs inside the library.
    """
    # Only the main thread may install handlers, and a handler of an embedding program takes
    # precedence.
    is_main = threading.current_thread() is threading.main_thread()
    previous = signal.getsignal(signal.SIGINT)
    # Python allows handlers in the main thread only, and a handler of the host program stays.
    if not is_main or previous is not signal.default_int_handler:
        yield
        return
    signal.signal(signal.SIGINT, handler)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, previous)


_BDD_ATTRIBUTES = ("vars", "_index_of_var", "_var_with_index")
"""The attributes that ``dd.cudd.BDD`` declares directly behind the manager (dd 0.6)."""
_WORD_SIZE = ctypes.sizeof(ctypes.c_void_p)


class Stoppable(Protocol):
    """Decides whether a running operation has to stop; implemented by ``Manager``."""

    def should_stop(self) -> bool:
        """Return whether the running operation has to stop."""
        ...


_stoppables: WeakValueDictionary[int, Stoppable] = WeakValueDictionary()
"""The objects that CUDD asks, by the key that CUDD passes to the callback. A key is no pointer, so
that a callback after the end of its object finds nothing."""
_callback_keys = count_up(1)


def install_termination_callback(
    library: ModuleType, bdd: object, stoppable: Stoppable
) -> Callable[[], int] | None:
    """Make CUDD ask *stoppable* during operations of *bdd* whether they shall stop.

    Return a function that counts the live nodes in constant time, or None if the callback cannot be
    installed. A stopped operation raises what ``dd`` raises when CUDD returns no result:
    RuntimeError or ValueError.
    """
    # dd offers neither callbacks nor the address of CUDD's manager: both come from the library
    # itself.
    manager = _find_manager_address(bdd)
    try:
        cudd = ctypes.CDLL(library.__file__)
        register, count_nodes = cudd.Cudd_RegisterTerminationCallback, cudd.Cudd_ReadNodeCount
    except (OSError, AttributeError):
        return None
    if manager is None:
        return None
    _survive_failing_allocations(cudd, manager)
    count_nodes.restype = ctypes.c_long
    key = next(_callback_keys)
    _stoppables[key] = stoppable
    register(ctypes.c_void_p(manager), _TERMINATION_CALLBACK, ctypes.c_void_p(key))
    return partial(count_nodes, ctypes.c_void_p(manager))


def _survive_failing_allocations(cudd: ctypes.CDLL, manager: int) -> None:
    """Let operations of CUDD fail when the process has no more memory.

    Otherwise CUDD prints a message and ends the process with exit code 1.
    """
    try:
        ignore_failure = ctypes.cast(cudd.Cudd_OutOfMemSilent, ctypes.c_void_p)
        cudd.Cudd_InstallOutOfMemoryHandler(ignore_failure)
        cudd.Cudd_RegisterOutOfMemoryCallback(ctypes.c_void_p(manager), ignore_failure)
    except AttributeError:
        return


def _find_manager_address(bdd: object) -> int | None:
    """Return the address of CUDD's manager in the object *bdd*, or None if it is not found.

    It is the word before the consecutive addresses of ``_BDD_ATTRIBUTES``.
    """
    size = type(bdd).__basicsize__ // _WORD_SIZE
    words = list((ctypes.c_size_t * size).from_address(id(bdd)))
    attribute_addresses = [id(getattr(bdd, name, None)) for name in _BDD_ATTRIBUTES]
    matches = [
        index
        for index in range(1, size)
        if words[index : index + len(attribute_addresses)] == attribute_addresses
    ]
    # Another layout of the object gives no match; then limits apply between operations only.
    return words[matches[0] - 1] or None if len(matches) == 1 else None


def _is_termination_requested(key: int) -> int:
    stoppable = _stoppables.get(key)
    return 0 if stoppable is None else int(stoppable.should_stop())


_TERMINATION_CALLBACK = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_void_p)(_is_termination_requested)
"""One callback for all managers, never freed, because diagrams may outlive their manager."""
