"""From the YAML of an overlay to its entries, in an order that does not depend on the file's."""

from collections.abc import Iterator

from sysmlc.diagnostics import Sink, Subject
from sysmlc.overlay import rules
from sysmlc.overlay import schema as shape
from sysmlc.overlay.model import (
    Allocation,
    BlockEntry,
    ConnectorEntry,
    FlowEntry,
    ItemEntry,
    Key,
    OperationEntry,
    ParameterEntry,
    PortEntry,
    Refinement,
    Spot,
    Term,
    ValueEntry,
    place_of,
)
from sysmlc.overlay.yaml_tree import TreeError, Value, parse
from sysmlc.sources import Source

_NOTHING = Value(Spot(), entries={})


def read(source: Source, sink: Sink) -> Refinement | None:
    """What an overlay says; None when it cannot be used, which is reported."""
    try:
        top = parse(source.data)
    except TreeError as error:
        subject = Subject(place=place_of(source.name, error.spot))
        sink.report(rules.SYNTAX, subject, problem=error.problem)
        return None
    if not shape.check(top, source.name, sink):
        return None
    return _refinement(top, source.name)


def files_of(refinement: Refinement) -> list[str]:
    """Files that the overlay's terms name before a ``#``, each once, as it writes them."""
    names = [term.text.partition("#") for term in _terms(refinement)]
    return list(dict.fromkeys(file for file, sign, _ in names if sign and file))


def _terms(refinement: Refinement) -> Iterator[Term]:
    found: list[Term | None] = [t for item in refinement.items for t in item.specializes]
    found += [port.type for port in refinement.ports]
    found += [flow.item for one in refinement.connectors for flow in one.flows]
    for block in refinement.blocks:
        found += [*block.specializes, block.behavior, *(value.type for value in block.values)]
        found += [called for _, called in block.calls]
        for operation in block.operations:
            found += [operation.method, *(p.type for p in operation.parameters or ())]
    found += [end for one in refinement.allocations for end in (one.source, one.target)]
    yield from (term for term in found if term is not None)


def _refinement(top: Value, file: str) -> Refinement:
    return Refinement(
        file=file,
        package=_text(top, "package") or "Items",
        spot=(_get(top, "items") or top).spot,
        items=tuple(_item(key, value) for key, value in _keyed(top, "items")),
        ports=tuple(_port(key, value) for key, value in _keyed(top, "ports")),
        connectors=tuple(_connector(key, value) for key, value in _keyed(top, "connectors")),
        blocks=tuple(_block(key, value) for key, value in _keyed(top, "blocks")),
        allocations=tuple(
            sorted((_allocation(one) for one in _list(top, "allocations")), key=_ends)
        ),
    )


def _ends(allocation: Allocation) -> tuple[str, str]:
    return allocation.source.text, allocation.target.text


# -- entries -----------------------------------------------------------------------------------


def _item(key: Key, value: Value) -> ItemEntry:
    general = _sorted_terms(value, "specializes")
    return ItemEntry(key, _text(value, "domain"), _text(value, "description"), general)


def _port(key: Key, value: Value) -> PortEntry:
    return PortEntry(key, _text(value, "direction"), _term(value, "type"))


def _connector(key: Key, value: Value) -> ConnectorEntry:
    flows = [_flow(one) for one in _list(value, "flows")]
    return ConnectorEntry(key, tuple(sorted(flows, key=_flow_order)))


def _flow(value: Value) -> FlowEntry:
    item = _term(value, "item") or Term("", value.spot)
    is_both = _get(value, "both-ways") is not None
    return FlowEntry(item, _term(value, "from"), _term(value, "to"), is_both, item.spot)


def _flow_order(flow: FlowEntry) -> tuple[str, str, str]:
    source, target = (end.text if end else "" for end in (flow.source, flow.target))
    return flow.item.text, source, target


def _block(key: Key, value: Value) -> BlockEntry:
    calls = _named(value, "calls")
    return BlockEntry(
        key=key,
        specializes=_sorted_terms(value, "specializes"),
        values=tuple(_value(name, one) for name, one in _named(value, "values")),
        operations=tuple(_operation(name, one) for name, one in _named(value, "operations")),
        behavior=_term(value, "behavior"),
        calls=tuple((name, Term(one.text, one.spot)) for name, one in calls),
    )


def _value(name: Term, value: Value) -> ValueEntry:
    default = _get(value, "default")
    return ValueEntry(name, _term(value, "type"), None if default is None else default.scalar)


def _operation(name: Term, value: Value) -> OperationEntry:
    listed = _get(value, "parameters")
    parameters = None if listed is None else tuple(map(_parameter, listed.items or ()))
    return OperationEntry(name, parameters, _term(value, "method"), _text(value, "description"))


def _parameter(value: Value) -> ParameterEntry:
    name = _term(value, "name") or Term("", value.spot)
    return ParameterEntry(name, _term(value, "type"), _text(value, "direction") or "in")


def _allocation(value: Value) -> Allocation:
    source, target = (_term(value, word) or Term("", value.spot) for word in ("from", "to"))
    return Allocation(source, target, value.spot)


# -- values ------------------------------------------------------------------------------------


def _get(value: Value, key: str) -> Value | None:
    return (value.entries or {}).get(key)


def _list(value: Value, key: str) -> list[Value]:
    return (_get(value, key) or _NOTHING).items or []


def _text(value: Value, key: str) -> str:
    return (_get(value, key) or _NOTHING).text


def _term(value: Value, key: str) -> Term | None:
    found = _get(value, key)
    return None if found is None else Term(found.text, found.spot)


def _sorted_terms(value: Value, key: str) -> tuple[Term, ...]:
    return tuple(sorted(Term(one.text, one.spot) for one in _list(value, key)))


def _named(value: Value, key: str) -> list[tuple[Term, Value]]:
    """The entries of a mapping below a key, by name in order."""
    inside = _get(value, key) or _NOTHING
    found = [(Term(name, inside.keys[name]), one) for name, one in (inside.entries or {}).items()]
    return sorted(found, key=lambda pair: pair[0].text)


def _keyed(value: Value, key: str) -> list[tuple[Key, Value]]:
    named = _named(value, key)
    return [(Key(name.text, _text(one, "path"), name.spot), one) for name, one in named]
