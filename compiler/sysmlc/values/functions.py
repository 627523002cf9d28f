"""What dataclasses have beside ``__init__``: shared by all, or made for a class when called."""

import dataclasses
from collections.abc import Callable, Sequence
from dataclasses import FrozenInstanceError
from functools import cache
from operator import attrgetter
from reprlib import recursive_repr
from types import CodeType, FunctionType
from typing import Any, NoReturn

from sysmlc.values.declared import FIELDS, Declared

_BODY = {
    "__eq__": """\
def __eq__(self, other):
    if other.__class__ is self.__class__:
        return ({own}) == ({others})
    return NotImplemented
""",
    "__hash__": """\
def __hash__(self):
    return hash(({own}))
""",
}


def compared(known: Declared, *, frozen: bool) -> dict[str, object]:
    """``__eq__``, and ``__hash__`` where values stay as they are."""
    hashed = _when_called("__hash__", known, known.hashed) if frozen else None
    return {"__eq__": _when_called("__eq__", known, known.compared), "__hash__": hashed}


def _when_called(
    function: str, known: Declared, names: Callable[[], list[str]]
) -> Callable[..., object]:
    """A function that makes the right one in its own place: most values are never compared."""

    def first(self: object, *others: object) -> object:
        made = _named(function, names())
        for cls in type(self).__mro__:
            if cls.__dict__.get(FIELDS) is known:
                setattr(cls, function, made)
        return made(self, *others)

    return first


def _named(function: str, names: Sequence[str]) -> FunctionType:
    """The function with the names of fields instead of ``_0``, ``_1`` and so on."""
    code = _code(function, len(names))
    places = {f"_{at}": name for at, name in enumerate(names)}
    renamed = code.replace(co_names=tuple(places.get(name, name) for name in code.co_names))
    return FunctionType(renamed, {"hash": hash, "NotImplemented": NotImplemented})


@cache
def _code(function: str, number: int) -> CodeType:
    texts = {
        word: "".join(f"{who}._{at}, " for at in range(number))
        for word, who in (("own", "self"), ("others", "other"))
    }
    known: dict[str, Any] = {}
    exec(_BODY[function].format(**texts), known)
    code: CodeType = known[function].__code__
    return code


def _replaced(self: Any, /, **changes: object) -> object:  # noqa: ANN401 - every class of values
    """What Python has from 3.13 on, for ``copy.replace``."""
    return (REPLACERS.get(type(self)) or replacer(type(self)))(self, changes)


_Replacer = Callable[[Any, dict[str, object]], Any]
REPLACERS: dict[type, _Replacer] = {}
"""For each class of which something was replaced, what makes another value of it."""


def replacer(cls: type) -> _Replacer:
    """A function that makes another value of the class: from one, and what is to be changed."""
    is_ours = isinstance(cls.__dict__.get(FIELDS), Declared)
    return REPLACERS.setdefault(cls, _replacer(cls) if is_ours else _of_python)


def _of_python(value: Any, changes: dict[str, object]) -> object:  # noqa: ANN401
    return dataclasses.replace(value, **changes)


def _replacer(cls: type) -> _Replacer:
    names: tuple[str, ...] = cls.__match_args__  # type: ignore[attr-defined]
    get = attrgetter(*names) if len(names) > 1 else None
    places = {name: at for at, name in enumerate(names)}

    def replaced(value: object, changes: dict[str, object]) -> object:
        values = [*get(value)] if get else [getattr(value, name) for name in names]
        try:
            for name, one in changes.items():
                values[places[name]] = one
        except KeyError as unknown:
            raise TypeError(f"{cls.__qualname__} has no field {unknown}") from None
        return cls(*values)

    return replaced


@recursive_repr("...")
def _shown(self: Any) -> str:  # noqa: ANN401
    fields = self.__dataclass_fields__
    values = ", ".join(f"{name}={getattr(self, name)!r}" for name in fields if fields[name].repr)
    return f"{type(self).__qualname__}({values})"


def _state(self: Any) -> list[object]:  # noqa: ANN401
    """How frozen values with slots are pickled and copied."""
    return [getattr(self, name) for name in self.__match_args__]


def _set_state(self: Any, state: Sequence[object]) -> None:  # noqa: ANN401
    for name, value in zip(self.__match_args__, state, strict=True):
        object.__setattr__(self, name, value)


def _refuse_setting(_self: object, name: str, _value: object) -> NoReturn:
    raise FrozenInstanceError(f"cannot assign to field {name!r}")


def _refuse_deleting(_self: object, name: str) -> NoReturn:
    raise FrozenInstanceError(f"cannot delete field {name!r}")


COMMON = {"__repr__": _shown, "__replace__": _replaced}
"""What all have."""
FROZEN = {"__setattr__": _refuse_setting, "__delattr__": _refuse_deleting}
"""What those have whose fields stay as they are."""
PACKED = {"__getstate__": _state, "__setstate__": _set_state}
"""What those of them have that have no ``__dict__``."""
