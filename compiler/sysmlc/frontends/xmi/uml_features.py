"""Which features the metaclasses of UML have (``metamodels/uml-features.txt``)."""

from functools import cache

from sysmlc.support import resources

_Table = dict[str, tuple[tuple[str, ...], frozenset[str]]]


def is_misplaced(metaclass: str, feature: str) -> bool:
    """Whether UML gives the feature to other metaclasses only; not of a metaclass unknown here.

    Metaclasses are named as in ``xmi:type``, without prefix; parts are nobody's attributes, so
    that nothing is said of them.
    """
    known = _features(metaclass)
    return bool(known) and feature not in known and feature in _placed()


@cache
def _features(metaclass: str) -> frozenset[str]:
    """Its features and those that it inherits; none of what is no metaclass of UML."""
    generals, own = _table().get(metaclass, ((), frozenset()))
    return own.union(*map(_features, generals))


@cache
def _placed() -> frozenset[str]:
    return frozenset[str]().union(*(own for _, own in _table().values()))


@cache
def _table() -> _Table:
    lines = resources.read_text("metamodels", "uml-features.txt").splitlines()
    return dict(_entry(line) for line in lines if not line.startswith("#"))


def _entry(line: str) -> tuple[str, tuple[tuple[str, ...], frozenset[str]]]:
    name, _, rest = line.partition(":")
    generals, _, features = rest.partition("|")
    return name, (tuple(generals.split()), frozenset(features.split()))
