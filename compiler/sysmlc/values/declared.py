"""Fields as a class declares them; what ``dataclasses`` says of each is made when it asks."""

import dataclasses
from collections.abc import Collection
from dataclasses import KW_ONLY, MISSING, Field, InitVar, field
from types import GenericAlias, UnionType
from typing import Any, ClassVar

FIELDS = "__dataclass_fields__"
"""Attribute by which ``dataclasses.fields`` and ``replace`` know a dataclass."""
_PLACE = "_field_type"
_NOT_OURS = ("ClassVar", "InitVar", "KW_ONLY")
_PLAIN = frozenset({type, GenericAlias, UnionType})
"""Of which most annotations are; the others are looked at."""


class Declared:
    """Annotation of each field, and defaults of those that have one: a value, or a ``Field``.

    As the attribute ``FIELDS`` of a class it shows the standard library a dict of ``Field``.
    """

    __slots__ = ("_shown", "defaults", "types")

    def __init__(self, types: dict[str, Any], defaults: dict[str, Any]) -> None:
        self.types = types
        self.defaults = defaults
        self._shown: dict[str, Field[Any]] | None = None

    def __get__(self, _value: object, _owner: type) -> "dict[str, Field[Any]]":
        if self._shown is None:
            self._shown = {name: self._field(name) for name in self.types}
        return self._shown

    def _field(self, name: str) -> "Field[Any]":
        default = self.defaults.get(name, MISSING)
        one: Field[Any] = default if isinstance(default, Field) else field(default=default)
        if getattr(one, _PLACE) is None:
            one.name, one.type, one.kw_only = name, self.types[name], False
            setattr(one, _PLACE, _plain())
        return one

    def compared(self) -> list[str]:
        """Names of the fields by which values are equal."""
        more = self.fields()
        return [name for name in self.types if name not in more or more[name].compare]

    def hashed(self) -> list[str]:
        """Names of the fields that make the hash."""
        more = self.fields()
        return [name for name in self.types if name not in more or _is_hashed(more[name])]

    def fields(self) -> "dict[str, Field[Any]]":
        """Those of which more is said than a default."""
        given = self.defaults.items()
        return {name: default for name, default in given if isinstance(default, Field)}


def _is_hashed(one: "Field[Any]") -> bool:
    return one.compare if one.hash is None else one.hash


def _plain() -> object:
    """What the standard library's functions look for in a field that is no ``ClassVar``."""

    @dataclasses.dataclass(init=False, repr=False, eq=False, match_args=False)
    class Sample:
        field: int

    return getattr(dataclasses.fields(Sample)[0], _PLACE)


def own(given: dict[str, Any]) -> Declared | None:
    """The fields that a class declares; their defaults leave ``given``, its attributes.

    None where they are no plain arguments of ``__init__``. Raises ValueError for a default that
    all values would share and could change.
    """
    types: dict[str, Any] = given.get("__annotations__", {})
    looked_at = [name for name in types if type(types[name]) not in _PLAIN]
    if "self" in types or any(_is_special(types[name]) for name in looked_at):
        return None
    of_class = [name for name in looked_at if _is_of_class(types[name])]
    mine = {name: types[name] for name in types if name not in of_class} if of_class else types
    defaults = {name: given.pop(name) for name in mine if name in given}
    if not defaults:
        return Declared(mine, defaults)
    for name, default in defaults.items():
        if value(default).__class__.__hash__ is None:
            raise ValueError(f"mutable default of field {name}: use default_factory")
    known = Declared(mine, defaults)
    return known if _are_arguments(known.fields().values()) else None


def value(default: object) -> object:
    """The default that all values share, or ``MISSING``."""
    return default.default if isinstance(default, Field) else default


def _are_arguments(fields: "Collection[Field[Any]]") -> bool:
    return not fields or all(one.init and one.kw_only is not True for one in fields)


def _is_of_class(annotation: object) -> bool:
    return annotation is ClassVar or getattr(annotation, "__origin__", None) is ClassVar


def _is_special(annotation: object) -> bool:
    if isinstance(annotation, str):
        return any(word in annotation for word in _NOT_OURS)
    return annotation is KW_ONLY or isinstance(annotation, InitVar)


def with_inherited(cls: type, own: Declared) -> Declared:
    """The fields of a class and of those above it, which come first."""
    above = [_known(base) for base in reversed(cls.__mro__) if FIELDS in base.__dict__]
    if not above:
        return own
    types: dict[str, Any] = {}
    defaults: dict[str, Any] = {}
    for one in (*above, own):
        types |= one.types
        for name in one.types:
            defaults.pop(name, None)
        defaults |= one.defaults
    return Declared(types, {name: defaults[name] for name in types if name in defaults})


def _known(cls: Any) -> Declared:  # noqa: ANN401 - a dataclass
    """The fields of a class above, which may be the standard library's."""
    found = cls.__dict__[FIELDS]
    if isinstance(found, Declared):
        return found
    shown = {one.name: one for one in dataclasses.fields(cls)}
    return Declared({name: one.type for name, one in shown.items()}, dict(shown))
