"""``__init__`` of dataclasses: written here for a number of fields, then given their names."""

from collections.abc import Callable
from dataclasses import MISSING, Field
from functools import cache
from types import FunctionType, MemberDescriptorType
from typing import Any, cast

from sysmlc.values.declared import Declared, value
from sysmlc.values.written import WRITTEN, Init, Setter


def give_init(cls: type, known: Declared) -> None:
    """Let a class set its fields from arguments, and then call ``__post_init__`` if it has one."""
    setters = _setters(cls, known)
    if hasattr(cls, "__post_init__"):
        setters[-1] = _and_completed(setters[-1])
    make = WRITTEN[len(setters)] if len(setters) < len(WRITTEN) else _written(len(setters))
    made = cast("FunctionType", make(*setters))
    made.__code__ = made.__code__.replace(co_varnames=("self", *known.types))
    made.__defaults__ = _defaults(known)
    made.__annotations__ = {**known.types, "return": None}
    made.__name__, made.__qualname__ = "__init__", f"{cls.__qualname__}.__init__"
    cls.__init__ = made  # type: ignore[misc]


def _setters(cls: type, known: Declared) -> list[Setter]:
    setters = [_setter(getattr(cls, name, None), name) for name in known.types]
    for name, one in known.fields().items() if known.defaults else ():
        if one.default_factory is not MISSING:
            at = list(known.types).index(name)
            setters[at] = _or_made(setters[at], one.default_factory)
    return setters


def _setter(place: Any, name: str) -> Setter:  # noqa: ANN401 - any attribute of a class
    return place.__set__ if type(place) is MemberDescriptorType else _attribute(name)


def _attribute(name: str) -> Setter:
    def set_attribute(self: object, value: object) -> None:
        object.__setattr__(self, name, value)

    return set_attribute


def _or_made(setter: Setter, make: Callable[[], object]) -> Setter:
    def set_or_make(self: object, value: object) -> None:
        setter(self, make() if value is MISSING else value)

    return set_or_make


def _and_completed(setter: Setter) -> Setter:
    def set_and_complete(self: Any, value: object) -> None:  # noqa: ANN401 - any value
        setter(self, value)
        self.__post_init__()

    return set_and_complete


def _defaults(known: Declared) -> tuple[object, ...]:
    if not known.defaults:
        return ()
    given = {name: one for name, one in known.defaults.items() if not _is_needed(one)}
    if list(given) != list(known.types)[len(known.types) - len(given) :]:
        said = ", ".join(known.types)
        raise TypeError(f"of {said} one without a default follows one with a default")
    return tuple(map(value, given.values()))


def _is_needed(default: object) -> bool:
    """Whether it is a ``Field`` without a default."""
    return isinstance(default, Field) and default.default is default.default_factory


@cache
def _written(number: int) -> Callable[..., Init]:
    """The same for more fields than values of this project have."""
    setters = ", ".join(f"set_{at}" for at in range(number))
    values = ", ".join(f"_{at}" for at in range(number))
    body = "".join(f"\n        set_{at}(self, _{at})" for at in range(number))
    known: dict[str, Callable[..., Init]] = {}
    exec(
        f"def of({setters}):\n    def init(self, {values}):{body}\n    return init",
        known,
    )
    return known["of"]
