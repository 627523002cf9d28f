"""Our ``StrEnum`` against the standard library's: what one answers the other answers."""

import ast
import copy
import enum
import json
import pickle
from pathlib import Path

import pytest

import sysmlc
from sysmlc.values import enumeration


class Ours(enumeration.StrEnum):
    """Fruits."""

    APPLE = "apple"
    """Red."""
    PEAR_TREE = "pear-tree"

    _ignored = 3
    number = 4

    @property
    def is_tree(self) -> bool:
        return "tree" in self


class Theirs(enum.StrEnum):
    """Fruits."""

    APPLE = "apple"
    """Red."""
    PEAR_TREE = "pear-tree"

    @property
    def is_tree(self) -> bool:
        return "tree" in self


BOTH = pytest.mark.parametrize("fruits", [Ours, Theirs])


@BOTH
def test_members_are_texts_with_a_name(fruits):
    tree = fruits.PEAR_TREE
    assert (tree.name, tree.value, tree, str(tree), f"{tree:>10}") == (
        *("PEAR_TREE", "pear-tree", "pear-tree", "pear-tree"),
        " pear-tree",
    )
    assert isinstance(tree, fruits)
    assert type(str(tree)) is str
    assert repr(tree) == f"<{fruits.__name__}.PEAR_TREE: 'pear-tree'>"
    assert tree.is_tree
    assert not fruits.APPLE.is_tree
    assert {tree: 1}["pear-tree"] == {"pear-tree": 1}[tree] == 1
    assert json.dumps({tree: tree}) == '{"pear-tree": "pear-tree"}'


@BOTH
def test_members_are_found_in_order_by_name_and_by_value(fruits):
    assert list(fruits) == ["apple", "pear-tree"]
    assert len(fruits) == 2
    assert fruits["APPLE"] is fruits("apple") is fruits(fruits.APPLE) is fruits.APPLE
    assert fruits.APPLE in fruits
    assert dict(fruits.__members__) == {"APPLE": "apple", "PEAR_TREE": "pear-tree"}
    assert fruits.__doc__ == "Fruits."
    assert repr(fruits) == f"<enum {fruits.__name__!r}>"


@BOTH
@pytest.mark.parametrize("wrong", ["plum", "APPLE", 3, None, []])
def test_what_is_no_value_is_refused_with_the_same_words(fruits, wrong):
    with pytest.raises(ValueError, match="is not a valid") as found:
        fruits(wrong)
    assert str(found.value) == f"{wrong!r} is not a valid {fruits.__name__}"
    with pytest.raises(KeyError):
        fruits["plum"]


@BOTH
def test_a_member_stays_the_same_when_it_is_copied(fruits):
    tree = fruits.PEAR_TREE
    assert copy.copy(tree) is copy.deepcopy(tree) is pickle.loads(pickle.dumps(tree)) is tree


@BOTH
def test_a_member_can_be_matched(fruits):
    match fruits("apple"):
        case fruits.PEAR_TREE:
            pytest.fail("an apple is no tree")
        case fruits.APPLE:
            pass


def test_other_names_are_no_members():
    assert (Ours._ignored, Ours.number) == (3, 4)


def test_two_members_with_one_value_are_refused():
    with pytest.raises(ValueError, match="two members of Twice have one value"):
        type(Ours)("Twice", (enumeration.StrEnum,), {"ONE": "one", "OTHER": "one"})


def test_every_enumeration_of_texts_is_made_with_it():
    root = Path(sysmlc.__file__).parent
    wrong = sorted(
        f"{path.relative_to(root).as_posix()}: say 'from sysmlc.values import StrEnum'"
        for path in root.rglob("*.py")
        if path.parent != root / "values"
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.ImportFrom) and node.module == "enum"
        for alias in node.names
        if alias.name == "StrEnum"
    )
    assert wrong == []
