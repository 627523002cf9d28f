"""What rows of one shape have in common - feature, type, names of attributes - decided once.

A large file has some hundred shapes. For rows that only become an element with references and
texts the plan of their shape says all there is to do; rows of other shapes go the general way
(``lowering``), which gives the same result for every row.
"""

from collections.abc import Iterator, Mapping
from typing import NamedTuple, TypeVar

from sysmlc.frontends.xmi import details, metaclasses
from sysmlc.frontends.xmi import vocabulary as v
from sysmlc.frontends.xmi.document import Shape
from sysmlc.frontends.xmi.keys import KEYS, PASSED_OVER, Key
from sysmlc.ir import AttrValue, Edge, Kind
from sysmlc.sources import DEFAULT_LIMITS

_R = TypeVar("_R")


class Step(NamedTuple):
    """One attribute: the id of an element, a text, or one of the rarer cases.

    An id is the target of ``edge``; without one something else says the same, and it only has
    to lead to an element. The edge of a mere list leads from what it names.
    """

    name: str
    is_id: bool = False
    """Whether it names one element, nearly always."""
    is_list: bool = False
    """Whether it can name several."""
    edge: Edge | None = None
    key: Key | None = None


class Plan(NamedTuple):
    """What becomes of the rows of a shape."""

    kind: Kind
    type_name: str
    owners: frozenset[Kind] | None
    attributes: dict[str, AttrValue]
    """What all elements of the shape say."""
    detail: details.Detail | None
    may_be_metaclass: bool
    is_done: bool
    """Whether nobody looks at the attributes again when the element is made."""
    steps: tuple[Step, ...]


def plan_of(
    shape: Shape,
    keys: tuple[str, str],
    features: Mapping[str, object],
    types: Mapping[str, object],
) -> Plan | None:
    """The plan, or None for a shape that goes the general way.

    ``keys`` are those of ``xmi:id`` and ``xmi:idref``; ``features`` and ``types`` have readers
    of their own.
    """
    feature, written, names = shape
    type_name = written or metaclasses.DEFAULT_TYPES.get(feature, "")
    has_reader = feature in features and may_be_value(feature, written) is not False
    if has_reader or feature in v.NOTATION_FEATURES or not _is_plain(names, keys):
        return None
    if type_name in types and type_name != "Property":
        return None
    known = metaclasses.kind_of(type_name)
    if known is None:
        return None
    kind, subkind = known
    return Plan(
        kind,
        type_name,
        metaclasses.OWNERS.get(kind),
        details.attributes(kind, subkind, type_name, feature),
        details.of(kind, feature),
        kind is Kind.PROPERTY,
        kind in _DONE,
        tuple(_steps(kind, names)),
    )


def reader_of(
    shape: Shape, keys: tuple[str, str], features: Mapping[str, _R], reference: _R
) -> _R | None:
    """What reads the rows of a shape that are no elements, with all that is in them.

    None where more than the shape decides. ``reference`` is for rows that name another element.
    """
    feature, written, names = shape
    if feature in v.NOTATION_FEATURES:
        return None
    if "href" in names or keys[1] in names:
        return reference
    return features.get(feature) if may_be_value(feature, written) else None


_DONE = frozenset(
    {
        Kind.ACTION,
        Kind.COMMENT,
        Kind.CONNECTOR,
        Kind.CONSTRAINT,
        Kind.CONTROL,
        Kind.CONTROL_FLOW,
        Kind.OBJECT_FLOW,
        Kind.OBJECT_NODE,
        Kind.PIN,
        Kind.PSEUDOSTATE,
        Kind.STATE,
        Kind.TRANSITION,
    }
)
"""Most of a large model, and named by nothing that is read later than they are."""


def may_be_value(feature: str, type_name: str) -> bool | None:
    """Whether a row of a feature with a reader is a value; None when its owner decides."""
    if feature in ALWAYS_VALUES:
        return True
    if type_name:
        return type_name in metaclasses.VALUE_TYPES
    return None if feature == "value" else feature not in metaclasses.DEFAULT_TYPES


def _is_plain(names: tuple[str, ...], keys: tuple[str, str]) -> bool:
    id_key, idref_key = keys
    is_element = id_key in names and idref_key not in names and "href" not in names
    return is_element and len(names) <= DEFAULT_LIMITS.attributes


def _steps(kind: Kind, names: tuple[str, ...]) -> Iterator[Step]:
    for name in names:
        if name in v.REDUNDANT or (name not in PASSED_OVER and "}" not in name):
            yield _step(kind, name)


def _step(kind: Kind, name: str) -> Step:
    edge = v.REFERENCES.get(name)
    if edge is not None:
        return Step(name, True, True, v.SPECIAL.get((kind, name), edge))
    if name in KEYS:
        return Step(name, key=KEYS[name])
    backwards = v.REVERSED.get((kind, name))
    is_unread = name in v.REDUNDANT and name not in v.CONDITIONS and backwards is None
    return Step(name, is_unread, is_unread or backwards is not None, backwards)


ALWAYS_VALUES = frozenset(
    {
        "lowerValue",
        "upperValue",
        "lower",
        "upper",
        "defaultValue",
        "joinSpec",
        "upperBound",
        "specification",
    }
    | {"clause", "handler", "endData", "weight", "nameExpression"}
)
"""Features that hold values whatever their type."""
