"""Limits inside an operation: CUDD asks every 2,048 steps whether it is to give up.

``dd`` does not hand on what CUDD has for that (cudd.h: ``Cudd_RegisterTerminationCallback``), but
exports CUDD's functions, and keeps the manager beside the attributes of ``dd.cudd.BDD``. It is
taken from there only if these lie as they are declared; where not, or where the functions are not
exported, limits hold between operations alone.
"""

import ctypes
from collections.abc import Callable
from functools import partial
from itertools import count
from types import ModuleType
from typing import Protocol
from weakref import WeakValueDictionary

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
