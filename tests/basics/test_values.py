"""Our ``dataclass`` against the standard library's: what one makes is like what the other makes."""

import ast
import copy
import dataclasses
import inspect
import pickle
import weakref
from collections.abc import Callable
from dataclasses import FrozenInstanceError, InitVar, field, fields, replace
from pathlib import Path
from typing import Any, ClassVar

import pytest

import sysmlc
from sysmlc.values.slotted import dataclass
from sysmlc.values.slotted import replace as ours_replace

MADE: dict[str, Callable[..., Any]] = {"ours": dataclass, "theirs": dataclasses.dataclass}


def both(build: Callable[[Callable[..., Any]], type]) -> list[type]:
    return [build(MADE[name]) for name in ("ours", "theirs")]


def _empty(made):
    @made(frozen=True, slots=True)
    class Empty:
        """Nothing."""

    return Empty


def _single(made):
    @made(frozen=True, slots=True)
    class Single:
        one: int

    return Single


def _full(made):
    @made(frozen=True, slots=True)
    class Full:
        kind: ClassVar[str] = "full"
        one: int
        two: "str" = "b"
        three: list[int] = field(default_factory=list, compare=False)
        four: int = field(default=4, repr=False)

        def total(self) -> int:
            return self.one + self.four

    return Full


def _open(made):
    @made(slots=True)
    class Open:
        one: int
        two: dict[str, int] = field(default_factory=dict)

    return Open


def _identical(made):
    @made(slots=True, eq=False)
    class Identical:
        one: int = 1

    return Identical


def _own_words(made):
    @made(frozen=True, slots=True)
    class OwnWords:
        one: int

        def __post_init__(self) -> None:
            object.__setattr__(self, "one", self.one + 1)

        def __eq__(self, other: object) -> bool:
            return other == self.one

        def __repr__(self) -> str:
            return f"<{self.one}>"

    return OwnWords


def _child(made):
    @made(frozen=True, slots=True)
    class Parent:
        one: int
        two: int = 2

    @made(frozen=True, slots=True)
    class Child(Parent):
        two: int = 3
        three: int = 4

    return Child


def _loose(made):
    @made(frozen=True)
    class Loose:
        one: int
        two: int = 2

    return Loose


def _many(made):
    names = [f"field_{number}" for number in range(20)]
    return made(frozen=True, slots=True)(
        type("Many", (), {"__annotations__": dict.fromkeys(names, int), "__module__": __name__})
    )


CLASSES = [
    (_empty, ()),
    (_single, (1,)),
    (_full, (1,)),
    (_open, (1,)),
    (_identical, ()),
    (_own_words, (1,)),
    (_child, (1,)),
    (_loose, (1,)),
    (_many, tuple(range(20))),
]


@pytest.mark.parametrize(("build", "given"), CLASSES)
def test_the_class_says_the_same_of_itself(build, given):
    ours, theirs = both(build)
    for said in ("__name__", "__qualname__", "__module__", "__slots__", "__match_args__"):
        assert getattr(ours, said, None) == getattr(theirs, said, None)
    assert inspect.signature(ours.__init__).parameters.keys() == (
        inspect.signature(theirs.__init__).parameters.keys()
    )
    told = ("name", "type", "default", "default_factory", "init", "repr", "compare", "kw_only")
    assert [[getattr(one, word) for word in told] for one in fields(ours)] == (
        [[getattr(one, word) for word in told] for one in fields(theirs)]
    )


@pytest.mark.parametrize(("build", "given"), CLASSES)
def test_values_behave_alike(build, given):
    answers = []
    for cls in both(build):
        one, same = cls(*given), cls(*given)
        is_hashed = cls.__hash__ is not None
        answers.append((repr(one), one == same, is_hashed and hash(one) == hash(same)))
        assert hasattr(one, "__dict__") == (not hasattr(cls, "__slots__"))
        assert one != object()
    assert answers[0] == answers[1]


@pytest.mark.parametrize("given", [(), (1, 2, 3, 4, 5), (1, "b", [], 4, 5, 6)])
def test_wrong_arguments_are_refused_with_the_same_words(given):
    said = []
    for cls in both(_full):
        with pytest.raises(TypeError) as refused:
            cls(*given)
        said.append(str(refused.value))
    assert said[0] == said[1]


def test_values_are_compared_by_the_fields_that_count():
    full = _full(dataclass)
    assert full(1, three=[1]) == full(1, three=[2])
    assert hash(full(1, three=[1])) == hash(full(1, three=[2]))
    assert full(1) != full(2)
    assert full(1).three is not full(1).three
    assert full(one=1, two="c").total() == 5


def test_values_of_two_classes_differ():
    assert _single(dataclass)(1) != _single(dataclass)(1)


@pytest.mark.parametrize("build", [_full, _child])
def test_frozen_values_stay(build):
    value = build(dataclass)(1)
    with pytest.raises(FrozenInstanceError, match="cannot assign to field 'one'"):
        value.one = 2
    with pytest.raises(FrozenInstanceError, match="cannot delete field 'one'"):
        del value.one


def test_others_change():
    made = _open(dataclass)
    value = made(1)
    value.one = 2
    assert value == made(2) != made(1)
    with pytest.raises(AttributeError):
        value.three = 3


@pytest.mark.parametrize("build", [_full, _open, _child])
@pytest.mark.parametrize("name", MADE)
def test_replaced(build, name):
    value = build(MADE[name])(1)
    assert ours_replace(value, one=2) == replace(value, one=2)
    assert ours_replace(value, one=2).two == value.two
    with pytest.raises(TypeError, match="'none'"):
        ours_replace(value, none=2)


def test_replaced_and_asked_by_the_standard_library():
    value = _full(dataclass)(1)
    assert replace(value, two="c").two == "c"
    assert dataclasses.asdict(value) == {"one": 1, "two": "b", "three": [], "four": 4}
    match value:
        case object(one=1, two=two):
            assert two == "b"


@dataclass(frozen=True, slots=True)
class Kept:
    """At the top of a module, so that it can be pickled."""

    one: int
    two: tuple[int, ...] = ()


def test_pickled_and_copied():
    kept = Kept(1, (2,))
    assert pickle.loads(pickle.dumps(kept)) == kept == copy.deepcopy(kept) == copy.copy(kept)


@pytest.mark.parametrize("above", MADE)
@pytest.mark.parametrize("below", MADE)
def test_each_inherits_from_the_other(above, below):
    @MADE[above](frozen=True, slots=True)
    class Above:
        word: ClassVar[str] = "above"
        one: int
        two: int = 2

    @MADE[below](frozen=True, slots=True)
    class Below(Above):
        three: int = 3

    assert repr(Below(1)).endswith("Below(one=1, two=2, three=3)")
    assert Below.__slots__ == ("three",)
    assert Below(1) != Above(1, 2)


def test_a_value_that_is_made_elsewhere_and_held_weakly():
    @dataclass(frozen=True, slots=True, eq=False, init=False, weakref_slot=True)
    class Single:
        one: int

        def __new__(cls, one: int):
            made = object.__new__(cls)
            object.__setattr__(made, "one", one)
            return made

    value = Single(1)
    assert (weakref.ref(value)() is value, value.one) == (True, 1)
    assert value != Single(1)


def test_defaults_of_loose_values_are_attributes_of_the_class():
    for cls in both(_loose):
        assert (cls.two, vars(cls(1))) == (2, {"one": 1, "two": 2})


def test_what_is_no_plain_argument_is_left_to_the_standard_library():
    @dataclass(frozen=True, slots=True)
    class Special:
        one: int
        given: InitVar[int]
        two: int = field(init=False)

        def __post_init__(self, given: int) -> None:
            object.__setattr__(self, "two", given)

    @dataclass(frozen=True, slots=True)
    class Words:
        one: int = field(kw_only=True)

    @dataclass
    class Loose:
        one: int

    assert Special(1, 2).two == 2
    assert Words(one=1).one == 1
    assert vars(Loose(1)) == {"one": 1}


def test_defaults_that_cannot_be():
    with pytest.raises(ValueError, match="mutable default of field one"):
        dataclass(slots=True)(type("A", (), {"__annotations__": {"one": list}, "one": []}))
    with pytest.raises(TypeError, match="one without a default follows"):
        dataclass(slots=True)(
            type("A", (), {"__annotations__": {"one": int, "two": int}, "one": 1})
        )


def test_a_value_that_holds_itself_is_shown():
    value = _open(dataclass)(1)
    value.two["self"] = value
    assert repr(value).endswith("Open(one=1, two={'self': ...})")


def test_every_value_of_the_project_is_declared_with_it():
    root = Path(sysmlc.__file__).parent
    others = [path for path in root.rglob("*.py") if path.parent != root / "values"]
    names = {
        (path.relative_to(root).as_posix(), alias.name)
        for path in others
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.ImportFrom) and node.module == "dataclasses"
        for alias in node.names
    }
    wrong = sorted(
        f"{path}: say 'from sysmlc.values import {name}'"
        for path, name in names
        if name in ("dataclass", "replace")
    )
    assert wrong == []
