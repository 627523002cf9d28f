"""A recursion limit for functions that recurse over the nesting of a model."""

import sys
from collections.abc import Iterator
from contextlib import contextmanager

_CALLS_PER_LEVEL = 20
"""An upper bound for the calls that a function makes for one level of nesting."""


@contextmanager
def allow_recursion(depth: int) -> Iterator[None]:
    """Raise the recursion limit so that functions can recurse over *depth* levels."""
    limit = sys.getrecursionlimit()
    sys.setrecursionlimit(limit + _CALLS_PER_LEVEL * depth)
    try:
        yield
    finally:
        sys.setrecursionlimit(limit)
