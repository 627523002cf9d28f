"""Reading without the cyclic garbage collector, to which nothing that is read is garbage."""

import gc
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def uncollected() -> Iterator[None]:
    """Hold the cyclic garbage collector: nothing that is made here dies before the end.

    What lives then is left out of its later rounds too: there are no cycles in it that die, and
    to walk over a large graph again and again costs more than many passes.
    """
    was_enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was_enabled:
            gc.freeze()
            gc.enable()
