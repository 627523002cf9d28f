"""Settings of the Python interpreter for large or deeply nested models, and texts of exceptions."""

import gc
import sys
from collections.abc import Iterator
from contextlib import contextmanager

_CALLS_PER_LEVEL = 20
"""Upper bound of the nested calls of a function for one level of the model."""


def describe_error(problem: BaseException) -> str:
    """Return the class and the text of an exception; the text of a plug-in's may itself fail."""
    try:
        return f"{type(problem).__name__}: {problem}"
    except Exception:
        return f"{type(problem).__name__} without a readable text"


@contextmanager
def pause_garbage_collection() -> Iterator[None]:
    """Disable the cyclic garbage collector meanwhile.

    A reader creates millions of objects that all stay alive. The collector would traverse them
    again and again: with it, reading a large model takes a third longer.
    """
    was_enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was_enabled:
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
