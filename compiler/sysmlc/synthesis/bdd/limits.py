"""How much a manager of decision diagrams may use, what it used, and how it says that it is over.

A limit that was reached is kept as an ``End``, not as the exception: that would hold the frames it
went through, they the manager and its diagrams, and the manager the exception. Such a circle is
left to the collector, which may take the manager away before its diagrams.
"""

import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType

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
