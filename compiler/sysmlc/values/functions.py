"""Functions of dataclasses: compiled for a number of fields, then given the names of a class."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import MISSING, Field, FrozenInstanceError
from functools import cache
from operator import attrgetter
from reprlib import recursive_repr
from types import CodeType, FunctionType
from typing import Any, NoReturn

_Fields = Mapping[str, "Field[Any]"]
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


def common(fields: _Fields, *, frozen: bool, eq: bool) -> dict[str, object]:
    """All that a dataclass has beside ``__init__``, as the standard library has it."""
    names = tuple(fields)
    made: dict[str, object] = {"__match_args__": names, "__repr__": _shown}
    made["__replace__"] = _replacement(names)
    if frozen:
        made |= {"__setattr__": _refuse_setting, "__delattr__": _refuse_deleting}
        made |= {"__getstate__": _state, "__setstate__": _set_state}
    if eq:
        compared = tuple(name for name, one in fields.items() if one.compare)
        hashed = tuple(name for name, one in fields.items() if _is_hashed(one))
        made["__eq__"] = _when_called("__eq__", compared)
        made["__hash__"] = _when_called("__hash__", hashed) if frozen else None
    return made


def _is_hashed(one: "Field[Any]") -> bool:
    return one.compare if one.hash is None else one.hash


def init(
    owner: str, fields: _Fields, *, frozen: bool, post: bool
) -> tuple[FunctionType, Callable[[type], None]]:
    """``__init__``, and what completes it when the class is there: its slots set the fields."""
    names = tuple(fields)
    factories = {
        number: one.default_factory
        for number, one in enumerate(fields.values())
        if one.default_factory is not MISSING
    }
    code = _renamed(_init_code(len(names), frozenset(factories), frozen, post), names)
    known: dict[str, object] = {f"make_{number}": make for number, make in factories.items()}
    known["missing"] = MISSING
    made = FunctionType(code, known, "__init__", _defaults(fields))
    made.__qualname__ = f"{owner}.__init__"
    made.__annotations__ = {name: one.type for name, one in fields.items()} | {"return": None}

    def complete(cls: type) -> None:
        if frozen:
            for number, name in enumerate(names):
                known[f"set_{number}"] = getattr(cls, name).__set__

    return made, complete


def _defaults(fields: _Fields) -> tuple[object, ...]:
    defaults = [
        (name, one.default)
        for name, one in fields.items()
        if one.default is not MISSING or one.default_factory is not MISSING
    ]
    if [name for name, _ in defaults] != list(fields)[len(fields) - len(defaults) :]:
        raise TypeError(f"of {', '.join(fields)} one without a default follows one with a default")
    return tuple(default for _, default in defaults)


@cache
def _init_code(number: int, made: frozenset[int], frozen: bool, post: bool) -> CodeType:
    lines = [f"def __init__(self{''.join(f', _{at}' for at in range(number))}):"]
    for at in range(number):
        value = f"_{at} if _{at} is not missing else make_{at}()" if at in made else f"_{at}"
        lines.append(f"    set_{at}(self, {value})" if frozen else f"    self._{at} = {value}")
    lines.append("    self.__post_init__()" if post else "    return")
    return _compiled("\n".join(lines), "__init__")


def _when_called(function: str, names: Sequence[str]) -> Callable[..., object]:
    """A function that makes the right one in its own place: most values are never compared."""

    def first(self: object, *others: object) -> object:
        made = _named(function, names)
        for cls in type(self).__mro__:
            if cls.__dict__.get(function) is first:
                setattr(cls, function, made)
        return made(self, *others)

    return first


def _named(function: str, names: Sequence[str]) -> FunctionType:
    code = _renamed(_code(function, len(names)), names)
    return FunctionType(code, {"hash": hash, "NotImplemented": NotImplemented})


@cache
def _code(function: str, number: int) -> CodeType:
    texts = {
        word: "".join(f"{who}._{at}, " for at in range(number))
        for word, who in (("own", "self"), ("others", "other"))
    }
    return _compiled(_BODY[function].format(**texts), function)


def _compiled(source: str, function: str) -> CodeType:
    known: dict[str, Any] = {}
    exec(source, known)
    code: CodeType = known[function].__code__
    return code


@cache
def _places(number: int) -> tuple[str, ...]:
    return tuple(f"_{at}" for at in range(number))


def _renamed(code: CodeType, names: Sequence[str]) -> CodeType:
    """The code with the names of fields instead of ``_0``, ``_1`` and so on."""
    get = dict(zip(_places(len(names)), names, strict=True)).get
    return code.replace(
        co_varnames=tuple([get(name, name) for name in code.co_varnames]),
        co_names=tuple([get(name, name) for name in code.co_names]),
    )


def _replacement(names: Sequence[str]) -> Callable[..., object]:
    """What Python has from 3.13 on, for ``copy.replace``."""
    get = attrgetter(*names) if len(names) > 1 else None
    places = {name: at for at, name in enumerate(names)}

    def __replace__(self: object, /, **changes: object) -> object:  # noqa: N807
        values = [*get(self)] if get else [getattr(self, name) for name in names]
        for name, value in changes.items():
            if name not in places:
                raise TypeError(f"{type(self).__qualname__} has no field {name!r}")
            values[places[name]] = value
        return self.__class__(*values)

    return __replace__


@recursive_repr("...")
def _shown(self: Any) -> str:  # noqa: ANN401 - every class of values
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
