"""Room for functions that call one another as deep as a model is nested."""

import sys
from collections.abc import Iterator
from contextlib import contextmanager

_CALLS = 20
"""Most calls that one level of a model takes."""


@contextmanager
def room_for(depth: int) -> Iterator[None]:
    """Let functions call one another through ``depth`` levels, without a RecursionError."""
    limit = sys.getrecursionlimit()
    sys.setrecursionlimit(limit + _CALLS * depth)
    try:
        yield
    finally:
        sys.setrecursionlimit(limit)
