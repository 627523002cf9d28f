"""Dataclasses without code that is made for each class.

``dataclasses`` compiles five or six functions for every class, which takes 0.7 ms, and a run
imports two hundred. The functions of two classes with as many fields differ in names alone.
"""

import dataclasses
from collections.abc import Callable, Iterable
from functools import cache
from types import SimpleNamespace
from typing import Any, TypeVar, cast

from sysmlc.values import declared, functions
from sysmlc.values.declared import FIELDS, Declared
from sysmlc.values.inits import give_init

_T = TypeVar("_T")

_PARAMETERS = "__dataclass_params__"
"""Attribute of which the standard library asks a base class whether it is frozen."""
_OF_PYTHON = frozenset({"__dict__", "__weakref__"})


def dataclass(
    cls: type[_T] | None = None,
    /,
    *,
    frozen: bool = False,
    slots: bool = False,
    eq: bool = True,
    init: bool = True,
    weakref_slot: bool = False,
    **others: bool,
) -> type[_T] | Callable[[type[_T]], type[_T]]:
    """``dataclasses.dataclass``; with ``others`` it is that one itself."""

    def decorate(cls: type[_T]) -> type[_T]:
        given = _given(cls)
        own = None if others else declared.own(given)
        if own is None or (init and not own.types and hasattr(cls, "__post_init__")):
            words = {"frozen": frozen, "slots": slots, "eq": eq, "init": init} | others
            return dataclasses.dataclass(weakref_slot=weakref_slot, **words)(cls)
        known = declared.with_inherited(cls, own)
        content = _shared(frozen, slots, eq) | {
            "__match_args__": tuple(known.types),
            FIELDS: known,
        }
        content |= functions.compared(known, frozen=frozen) if eq else {}
        content |= given if slots else given | _values(own)
        if slots:
            content["__slots__"] = _slots(cls, known, weakref_slot)
        return _made(cls, content, known if init else None)

    return decorate if cls is None else decorate(cls)


def _given(cls: type) -> dict[str, Any]:
    """What the class says itself; a hash that Python took from it is to come again."""
    given = {name: one for name, one in cls.__dict__.items() if name not in _OF_PYTHON}
    if "__eq__" in given and given["__hash__"] is None:
        del given["__hash__"]
    return given


def replace(value: _T, /, **changes: object) -> _T:
    """``dataclasses.replace``."""
    cls = type(value)
    made: _T = (functions.REPLACERS.get(cls) or functions.replacer(cls))(value, changes)
    return made


@cache
def _shared(frozen: bool, slots: bool, eq: bool) -> dict[str, object]:
    """What classes declared with the same words have in common."""
    marks: dict[str, object] = {_PARAMETERS: SimpleNamespace(frozen=frozen, eq=eq)}
    marks |= functions.COMMON
    if frozen:
        marks |= functions.FROZEN
    return marks | functions.PACKED if frozen and slots else marks


def _values(own: Declared) -> dict[str, object]:
    """Defaults that are attributes of a class without slots, too."""
    given = {name: declared.value(default) for name, default in own.defaults.items()}
    return {name: one for name, one in given.items() if one is not dataclasses.MISSING}


def _slots(cls: type, known: Declared, weakref_slot: bool) -> tuple[str, ...]:
    wanted = (*known.types, "__weakref__") if weakref_slot else tuple(known.types)
    above = cls.__mro__[1:-1]
    if not above:
        return wanted
    taken = {name for base in above for name in _names(base.__dict__.get("__slots__", ()))}
    return tuple([name for name in wanted if name not in taken])


def _names(slots: str | Iterable[str]) -> Iterable[str]:
    return (slots,) if isinstance(slots, str) else slots


def _made(cls: type[_T], content: dict[str, object], known: Declared | None) -> type[_T]:
    """The class anew: slots cannot be added to one that is there."""
    made: type[_T] = cast("Any", type(cls))(cls.__name__, cls.__bases__, content)
    made.__qualname__ = cls.__qualname__
    if known is not None:
        give_init(made, known)
    return made
