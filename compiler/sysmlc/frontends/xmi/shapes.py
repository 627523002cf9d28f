"""What rows of one shape have in common - feature, type, names of attributes - decided once.

A large file has some hundred shapes. For rows that only become an element with references and
texts the plan of their shape says all there is to do; rows of other shapes go the general way
(``lowering``), which gives the same result for every row.
"""

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, NamedTuple

from sysmlc.frontends.xmi import details, metaclasses
from sysmlc.frontends.xmi import vocabulary as v
from sysmlc.ir import Edge, Element, Kind
from sysmlc.sources import DEFAULT_LIMITS

if TYPE_CHECKING:
    from sysmlc.frontends.xmi.context import Context

Shape = tuple[str, ...]
"""Feature, type, and names of the attributes in order."""


class Step(NamedTuple):
    """One attribute: an edge to what it names, a text under ``key``, or neither (rarer cases)."""

    name: str
    edge: Edge | None = None
    key: str = ""
    default: str = ""


class Plan(NamedTuple):
    """What becomes of the rows of a shape."""

    kind: Kind
    subkind: str
    type_name: str
    owners: frozenset[Kind] | None
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
    feature, written, *names = shape
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
        subkind,
        type_name,
        metaclasses.OWNERS.get(kind),
        _detail(kind, tuple(name for name in names if _says_nothing(kind, name))),
        kind is Kind.PROPERTY,
        kind in _DONE,
        tuple(_steps(kind, names)),
    )


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


def _is_plain(names: list[str], keys: tuple[str, str]) -> bool:
    id_key, idref_key = keys
    is_element = id_key in names and idref_key not in names and "href" not in names
    return is_element and len(names) <= DEFAULT_LIMITS.attributes


def _steps(kind: Kind, names: list[str]) -> Iterator[Step]:
    for name in names:
        if name not in PASSED_OVER and "}" not in name and not _says_nothing(kind, name):
            yield _step(kind, name)


def _says_nothing(kind: Kind, name: str) -> bool:
    is_other = name in v.REFERENCES or name in v.CONDITIONS or (kind, name) in v.REVERSED
    return name in v.REDUNDANT and not is_other


def _detail(kind: Kind, unread: tuple[str, ...]) -> details.Detail | None:
    """What completes elements of the kind; of ``unread`` counts only whether they lead anywhere."""
    known = details.OF.get(kind)
    if not unread:
        return known

    def look(context: "Context", element: Element, row: int, type_name: str, feature: str) -> None:
        values, ids = context.document.attributes[row], context.document.ids
        for name in unread:
            if values[name] not in ids:
                context.look(row, name, values[name])
        if known is not None:
            known(context, element, row, type_name, feature)

    return look


def _step(kind: Kind, name: str) -> Step:
    edge = v.REFERENCES.get(name)
    if edge is not None:
        return Step(name, v.SPECIAL.get((kind, name), edge))
    if name in v.TEXTS and name not in v.FLAGS:
        return Step(name, None, *v.TEXTS[name])
    return Step(name)


_HANDLED = frozenset(
    {"partWithPort", "guard", "event", "value"}
    | {"firstEvent", "interactionOperator", "messageKind", "messageSort"}
)
"""Attributes that the readers of single kinds take themselves."""

PASSED_OVER = (v.REDUNDANT | _HANDLED | {"name"}) - {name for _, name in v.REVERSED}
"""Attributes that never need a look at the other tables; most of a large file's."""

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
