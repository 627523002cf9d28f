"""Dataclasses with slots whose functions are compiled once for each number of fields.

``dataclasses`` compiles five or six functions for every class, which takes 0.7 ms, and a run
imports two hundred. The functions of two classes with as many fields differ in names alone.
"""

import dataclasses
from collections.abc import Callable, Iterable
from dataclasses import MISSING, Field, InitVar, field
from types import SimpleNamespace
from typing import Any, ClassVar, TypeVar, cast, get_origin

from sysmlc.values import functions

_T = TypeVar("_T")
_Fields = dict[str, "Field[object]"]

FIELDS = "__dataclass_fields__"
"""Attribute by which ``dataclasses.fields`` and ``replace`` know a dataclass."""

_PARAMETERS = "__dataclass_params__"
"""Attribute of which the standard library asks a base class whether it is frozen."""
_OF_NO_SLOTS = frozenset({"__dict__", "__weakref__"})


def dataclass(
    cls: type[_T] | None = None,
    /,
    *,
    frozen: bool = False,
    slots: bool = False,
    eq: bool = True,
    **others: bool,
) -> type[_T] | Callable[[type[_T]], type[_T]]:
    """``dataclasses.dataclass``; without slots, or with ``others``, it is that one itself."""

    def decorate(cls: type[_T]) -> type[_T]:
        if others or not slots or not _is_simple(cls):
            made = dataclasses.dataclass(frozen=frozen, slots=slots, eq=eq, **others)
            return made(cls)
        return _made(cls, frozen=frozen, eq=eq)

    return decorate if cls is None else decorate(cls)


def replace(value: _T, /, **changes: object) -> _T:
    """``dataclasses.replace``."""
    make = type(value).__dict__.get("__replace__")
    if make is None:
        return cast("_T", dataclasses.replace(cast("Any", value), **changes))
    return cast("_T", make(value, **changes))


def _is_simple(cls: type) -> bool:
    """Whether all fields are plain arguments of ``__init__``."""
    annotations = cls.__dict__.get("__annotations__", {})  # noqa: RUF063 - its module takes 7 ms
    declared = [one for one in cls.__dict__.values() if isinstance(one, Field)]
    return (
        "self" not in annotations
        and all(one.init and one.kw_only is not True for one in declared)
        and not any(map(_is_special, annotations.values()))
    )


def _is_special(annotation: object) -> bool:
    if isinstance(annotation, str):
        return any(word in annotation for word in ("ClassVar", "InitVar", "KW_ONLY"))
    is_mark = annotation is InitVar or annotation is dataclasses.KW_ONLY
    return is_mark or isinstance(annotation, InitVar)


def _made(cls: type[_T], *, frozen: bool, eq: bool) -> type[_T]:
    """The class anew, with slots and functions: slots cannot be added to one that is there."""
    given = {name: one for name, one in cls.__dict__.items() if name not in _OF_NO_SLOTS}
    if "__eq__" in given and given["__hash__"] is None:
        del given["__hash__"]
    fields = _inherited(cls) | _own(given)
    post = hasattr(cls, "__post_init__")
    init, complete = functions.init(cls.__qualname__, fields, frozen=frozen, post=post)
    made_functions = functions.common(fields, frozen=frozen, eq=eq) | {"__init__": init}
    content = (
        made_functions
        | given
        | _marks(cls, fields)
        | {_PARAMETERS: SimpleNamespace(frozen=frozen, eq=eq)}
    )
    made: type[_T] = cast("Any", type(cls))(cls.__name__, cls.__bases__, content)
    made.__qualname__ = cls.__qualname__
    complete(made)
    return made


def _marks(cls: type, fields: _Fields) -> dict[str, object]:
    slots = _slots_above(cls)
    return {"__slots__": tuple(name for name in fields if name not in slots), FIELDS: fields}


def _inherited(cls: type) -> _Fields:
    bases = [base for base in reversed(cls.__mro__[1:]) if FIELDS in base.__dict__]
    return {one.name: one for base in bases for one in dataclasses.fields(base)}


def _own(given: dict[str, Any]) -> _Fields:
    """The fields that the class declares; their defaults leave its attributes."""
    found: _Fields = {}
    for name, annotation in given.get("__annotations__", {}).items():
        if annotation is ClassVar or get_origin(annotation) is ClassVar:
            continue
        default = given.pop(name, MISSING)
        found[name] = one = default if isinstance(default, Field) else field(default=default)
        if one.default.__class__.__hash__ is None:
            raise ValueError(f"mutable default of field {name}: use default_factory")
        one.name, one.type, one.kw_only = name, annotation, False
        setattr(one, _PLACE, _PLAIN)
    return found


def _slots_above(cls: type) -> set[str]:
    slots: Iterable[str | Iterable[str]]
    slots = (base.__dict__.get("__slots__", ()) for base in cls.__mro__[1:])
    return {name for some in slots for name in ((some,) if isinstance(some, str) else some)}


@dataclasses.dataclass(init=False, repr=False, eq=False, match_args=False)
class _Sample:
    """Without these words ``dataclasses`` would take 15 ms to write some of its own."""

    field: int


_PLACE = "_field_type"
_PLAIN = getattr(dataclasses.fields(_Sample)[0], _PLACE)
"""What the standard library's functions look for in a field that is no ``ClassVar``."""
