"""Paths to features in expressions: names, and chains of features such as ``left.level``."""

from collections.abc import Iterator

from msgspec.structs import replace

from sysmlc.ir.expressions import Expression, Index, Member, Name, dotted_name, list_children
from sysmlc.logic.expressions.linear import Lookup, Number
from sysmlc.logic.regions import Term

_PATH = "\0"
"""Separates the key of a feature from the path to it."""


def iter_paths(node: object) -> Iterator[Name | Member]:
    """Yield the names and the chains of features in an expression; units are none."""
    if isinstance(node, Name | Member):
        yield node
        return
    for child in [node.base] if isinstance(node, Index) else list_children(node):
        yield from iter_paths(child)


def distinguish_paths(expression: Expression, find: Lookup) -> Lookup:
    """Return a lookup with a key for each path to a feature if several lead to the same one.

    ``left.level - right.level`` is not zero if both parts have the same type.
    """
    numbers = {dotted_name(path): find(path) for path in iter_paths(expression)}
    keys = [number.key for number in numbers.values() if number is not None and number.key]
    if len(set(keys)) == len(keys):
        return find

    def find_path(path: Name | Member) -> Number | None:
        number = find(path)
        if number is None or not number.key:
            return number
        return replace(number, key=f"{number.key}{_PATH}{dotted_name(path)}")

    return find_path


def merge_paths(term: Term) -> Term:
    """Return a term with the keys of the features in the place of those of paths."""
    return tuple((key.partition(_PATH)[0], factor) for key, factor in term)
