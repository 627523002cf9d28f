"""Who asks for watched attributes is noted, in whatever way they ask."""

import copy
import json

import pytest

from sysmlc.ir import Element, Kind
from sysmlc.ir.reads import Literal, Reads, Watched

VALUE = ("p", "default")


@pytest.fixture
def reads():
    return Reads()


@pytest.fixture
def attrs(reads):
    """Attributes of which only the default value is watched; who asks is 'test'."""
    element = Element("p", Kind.PROPERTY, attrs={"default": 3, "role": "part"})
    reads.watch(element, Literal("a.sysml", 12, *VALUE))
    reads.reader = "test"
    return element.attrs


@pytest.mark.parametrize(
    "ask",
    [
        lambda attrs: attrs["default"],
        lambda attrs: attrs.get("default"),
        lambda attrs: list(attrs.values()),
        lambda attrs: list(attrs.items()),
        lambda attrs: dict(attrs),
        lambda attrs: {**attrs},
        lambda attrs: {}.update(attrs),
        lambda attrs: {} | attrs,
        lambda attrs: attrs | {},
        lambda attrs: attrs == {},
        lambda attrs: attrs != {},
        lambda attrs: {} == attrs,  # noqa: SIM300
        lambda attrs: attrs.copy(),
        lambda attrs: copy.copy(attrs.copy()),
        lambda attrs: repr(attrs),
        lambda attrs: str(attrs),
        lambda attrs: f"{attrs}",
        lambda attrs: json.dumps(attrs),
        lambda attrs: (lambda **given: given)(**attrs),
        lambda attrs: attrs.setdefault("default", 4),
        lambda attrs: attrs.pop("default"),
        lambda attrs: attrs.popitem(),
    ],
)
def test_who_asks_is_noted(reads, attrs, ask):
    ask(attrs)
    assert reads.readers == {VALUE: {"test": None}}


def test_a_pattern_asks_too(reads, attrs):
    match attrs:
        case {"default": 3}:
            assert reads.readers == {VALUE: {"test": None}}
        case _:
            pytest.fail("the pattern should match")


@pytest.mark.parametrize(
    "ask",
    [
        lambda attrs: attrs["role"],
        lambda attrs: attrs.get("role"),
        lambda attrs: attrs.get("lower"),
        lambda attrs: "default" in attrs,
        lambda attrs: len(attrs),
        lambda attrs: bool(attrs),
        lambda attrs: list(attrs),
        lambda attrs: attrs.keys() & {"role"},
        lambda attrs: dict.fromkeys(attrs),
    ],
)
def test_other_values_and_whether_there_is_one_are_not_noted(reads, attrs, ask):
    ask(attrs)
    assert reads.readers == {VALUE: {}}


@pytest.mark.parametrize("way", [copy.copy, copy.deepcopy])
def test_watched_attributes_cannot_be_copied_unseen(attrs, way):
    with pytest.raises(TypeError, match="not copied"):
        way(attrs)


@pytest.mark.parametrize(
    "change",
    [
        lambda attrs: attrs.update(default=4),
        lambda attrs: attrs.update({"default": 4}),
        lambda attrs: attrs.__setitem__("default", 4),
        lambda attrs: attrs.__ior__({"default": 4}),
        lambda attrs: attrs.__delitem__("default"),
        lambda attrs: attrs.setdefault("default", 4),
        lambda attrs: attrs.pop("default"),
        lambda attrs: attrs.clear(),
    ],
)
def test_what_is_set_again_is_no_literal_any_more(reads, attrs, change):
    change(attrs)
    assert reads.rewritten == {VALUE}


def test_other_attributes_may_be_set(reads, attrs):
    attrs["role"] = "port"
    assert not reads.rewritten
    assert attrs["role"] == "port"


def test_a_part_of_some_work_is_told_apart(reads, attrs):
    with reads.part("a7"):
        attrs.get("default")
    attrs.get("default")
    assert list(reads.readers[VALUE]) == ["test a7", "test"]


def test_an_attribute_that_is_watched_for_two_literals_is_one(reads, attrs):
    assert isinstance(attrs, Watched)
    attrs.watch("role")
    attrs.items()
    assert reads.readers.keys() >= {VALUE}
