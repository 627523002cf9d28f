"""Overlays: YAML files that add to a model what its language cannot express (thesis 3.4).

``read_overlay`` converts the YAML of a file to entries, and sorts them.
"""

from collections.abc import Iterator

from sysmlc.diagnostics import Severity, Sink, Subject, rule
from sysmlc.documents import (
    DocumentError,
    Value,
    ViolationKind,
    list_violations,
    parse_yaml,
)
from sysmlc.overlay.model import (
    Allocation,
    BlockEntry,
    Change,
    ConnectorEntry,
    FlowEntry,
    ItemEntry,
    Key,
    OperationEntry,
    ParameterEntry,
    PortEntry,
    Refinement,
    Term,
    ValueEntry,
    place_of,
)
from sysmlc.sources import Source

__all__ = ["SUFFIX", "Change", "Refinement", "list_files", "read_overlay"]

SUFFIX = ".overlay.yaml"
"""Suffix of an overlay beside a model; it replaces the suffix of the model's name."""

SYNTAX = rule(
    "SM320",
    "overlay-syntax",
    Severity.ERROR,
    "the overlay cannot be read: {problem}",
    help="an overlay is one YAML document in UTF-8 without tags",
)
SHAPE = rule(
    "SM321",
    "overlay-shape",
    Severity.ERROR,
    "in the overlay {where}: {problem}",
    help="metamodels/sysmlc-overlay.schema.json has every entry; editors can check it too",
)
UNKNOWN_KEY = rule(
    "SM322",
    "overlay-unknown-key",
    Severity.ERROR,
    "in the overlay {where}: {problem}",
    help="{advice}",
)
KEY_TWICE = rule(
    "SM323",
    "overlay-key-twice",
    Severity.ERROR,
    "in the overlay {where}: {problem}",
    help="merge the two entries, or rename one of them",
)
_RULES = {
    ViolationKind.SHAPE: SHAPE,
    ViolationKind.UNKNOWN_KEY: UNKNOWN_KEY,
    ViolationKind.KEY_TWICE: KEY_TWICE,
}


def read_overlay(source: Source, sink: Sink) -> Refinement | None:
    """Return the content of an overlay; report the faults of an unusable one, and return None."""
    try:
        top = parse_yaml(source.data)
    except DocumentError as error:
        subject = Subject(place=place_of(source.name, error.spot))
        sink.report(SYNTAX, subject, problem=error)
        return None
    violations = list_violations(top, "sysmlc-overlay.schema.json")
    for violation in violations:
        sink.report(
            _RULES[violation.kind],
            Subject(place=place_of(source.name, violation.spot)),
            where=violation.where,
            problem=violation.problem,
            advice=violation.advice,
        )
    return None if violations else _build_refinement(top, source.name)


def list_files(refinement: Refinement) -> list[str]:
    """Return the files that texts ``file#qualified name`` of an overlay name, each once."""
    names = [term.text.partition("#") for term in _list_terms(refinement)]
    return list(dict.fromkeys(file for file, sign, _ in names if sign and file))


def _list_terms(refinement: Refinement) -> Iterator[Term]:
    terms: list[Term | None] = [t for item in refinement.items for t in item.specializes]
    terms += [port.type for port in refinement.ports]
    terms += [flow.item for connector in refinement.connectors for flow in connector.flows]
    for block in refinement.blocks:
        terms += [*block.specializes, block.behavior, *(value.type for value in block.values)]
        terms += [operation for _, operation in block.calls]
        for operation in block.operations:
            terms += [operation.method, *(p.type for p in operation.parameters or ())]
    terms += [end for pair in refinement.allocations for end in (pair.source, pair.target)]
    yield from (term for term in terms if term is not None)


def _build_refinement(top: Value, file: str) -> Refinement:
    return Refinement(
        file=file,
        package=top.get_text("package") or "Items",
        spot=(top.get("items") or top).spot,
        items=tuple(_build_item(key, value) for key, value in _sort_by_key(top, "items")),
        ports=tuple(_build_port(key, value) for key, value in _sort_by_key(top, "ports")),
        connectors=tuple(
            _build_connector(key, value) for key, value in _sort_by_key(top, "connectors")
        ),
        blocks=tuple(_build_block(key, value) for key, value in _sort_by_key(top, "blocks")),
        allocations=tuple(
            sorted(
                (_build_allocation(entry) for entry in top.list_items("allocations")),
                key=lambda allocation: (allocation.source.text, allocation.target.text),
            )
        ),
    )


# -- entries -----------------------------------------------------------------------------------


def _build_item(key: Key, value: Value) -> ItemEntry:
    general = _list_sorted_terms(value, "specializes")
    return ItemEntry(key, value.get_text("domain"), value.get_text("description"), general)


def _build_port(key: Key, value: Value) -> PortEntry:
    return PortEntry(key, value.get_text("direction"), _read_term(value, "type"))


def _build_connector(key: Key, value: Value) -> ConnectorEntry:
    flows = [_build_flow(entry) for entry in value.list_items("flows")]
    return ConnectorEntry(key, tuple(sorted(flows, key=_make_flow_key)))


def _build_flow(value: Value) -> FlowEntry:
    item = _read_term(value, "item") or Term("", value.spot)
    is_both = value.get("both-ways") is not None
    return FlowEntry(item, _read_term(value, "from"), _read_term(value, "to"), is_both, item.spot)


def _make_flow_key(flow: FlowEntry) -> tuple[str, str, str]:
    source, target = (end.text if end else "" for end in (flow.source, flow.target))
    return flow.item.text, source, target


def _build_block(key: Key, value: Value) -> BlockEntry:
    calls = _sort_by_name(value, "calls")
    return BlockEntry(
        key=key,
        specializes=_list_sorted_terms(value, "specializes"),
        values=tuple(_build_value(name, entry) for name, entry in _sort_by_name(value, "values")),
        operations=tuple(
            _build_operation(name, entry) for name, entry in _sort_by_name(value, "operations")
        ),
        behavior=_read_term(value, "behavior"),
        calls=tuple((name, Term(entry.text, entry.spot)) for name, entry in calls),
    )


def _build_value(name: Term, value: Value) -> ValueEntry:
    default = value.get("default")
    return ValueEntry(name, _read_term(value, "type"), None if default is None else default.scalar)


def _build_operation(name: Term, value: Value) -> OperationEntry:
    parameter_list = value.get("parameters")
    parameters = (
        None if parameter_list is None else tuple(map(_build_parameter, parameter_list.items or ()))
    )
    return OperationEntry(
        name, parameters, _read_term(value, "method"), value.get_text("description")
    )


def _build_parameter(value: Value) -> ParameterEntry:
    name = _read_term(value, "name") or Term("", value.spot)
    return ParameterEntry(name, _read_term(value, "type"), value.get_text("direction") or "in")


def _build_allocation(value: Value) -> Allocation:
    source, target = (_read_term(value, word) or Term("", value.spot) for word in ("from", "to"))
    return Allocation(source, target, value.spot)


# -- values ------------------------------------------------------------------------------------


def _read_term(value: Value, key: str) -> Term | None:
    entry = value.get(key)
    return None if entry is None else Term(entry.text, entry.spot)


def _list_sorted_terms(value: Value, key: str) -> tuple[Term, ...]:
    return tuple(sorted(Term(entry.text, entry.spot) for entry in value.list_items(key)))


def _sort_by_name(value: Value, key: str) -> list[tuple[Term, Value]]:
    """Return the entries of the mapping that *value* has below *key*, sorted by name."""
    keys = value.find([key]).keys
    return [(Term(name, keys[name]), entry) for name, entry in sorted(value.iter_entries(key))]


def _sort_by_key(value: Value, key: str) -> list[tuple[Key, Value]]:
    """Return the entries of the mapping below *key* whose names are ids or paths of elements."""
    return [
        (Key(name.text, entry.get_text("path"), name.spot), entry)
        for name, entry in _sort_by_name(value, key)
    ]
