"""Settings of the Python interpreter while a large or deeply nested model is processed."""

import gc
import sys
from collections.abc import Iterator
from contextlib import contextmanager

_CALLS_PER_LEVEL = 20
"""An upper bound for the calls that a function makes for one level of nesting."""


@contextmanager
def pause_garbage_collection() -> Iterator[None]:
    """Disable the cyclic garbage collector, and exempt from it what is created meanwhile.

    A reader creates millions of objects that all stay alive, and the collector would traverse
    them again and again: with it, reading a large model takes a third longer.
    """
    was_enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was_enabled:
            gc.freeze()
            gc.enable()


@contextmanager
def allow_recursion(depth: int) -> Iterator[None]:
    """Raise the recursion limit so that functions can recurse over *depth* levels."""
    limit = sys.getrecursionlimit()
    sys.setrecursionlimit(limit + _CALLS_PER_LEVEL * depth)
    try:
        yield
    finally:
        sys.setrecursionlimit(limit)
