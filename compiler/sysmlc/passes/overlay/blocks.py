"""Entries about blocks: general blocks, values, operations with their parameters."""

from sysmlc.ir import AttrValue, Edge, Element, Graph, Kind, derived_id
from sysmlc.ir.query import generals, parameters
from sysmlc.overlay.model import BlockEntry, OperationEntry, Term, ValueEntry
from sysmlc.passes.overlay import rules
from sysmlc.passes.overlay.finder import BLOCK, TYPE, Finder
from sysmlc.passes.overlay.items import add_description

_Signature = list[tuple[str, AttrValue]]


def refine_block(finder: Finder, entry: BlockEntry) -> None:
    """Apply what the overlay states about a block, except behaviours."""
    block = finder.find_entry(entry.key, BLOCK)
    if block is None:
        return
    for general in entry.specializes:
        general_block = finder.find_term(general, BLOCK)
        if general_block is not None and general_block is not block:
            finder.graph.connect(Edge.SPECIALIZES, block, general_block)
    for value in entry.values:
        _add_value(finder, block, value)
    for operation in entry.operations:
        _add_operation(finder, block, operation)


def _add_value(finder: Finder, block: Element, entry: ValueEntry) -> None:
    graph = finder.graph
    id = derived_id(block.id, f"value of an overlay:{entry.name.text}")
    holder = next(
        (
            candidate
            for candidate in _with_generals(finder, block)
            if _has_other_feature(finder, candidate, entry, id)
        ),
        None,
    )
    if holder is not None:
        name = graph.qualified_name(block)
        where = "" if holder is block else f", inherited from '{graph.qualified_name(holder)}'"
        facts = {"feature": entry.name.text, "block": name, "where": where}
        finder.report(rules.FEATURE_TWICE, entry.name, **facts)
        return
    type_ = None if entry.type is None else finder.find_term(entry.type, TYPE)
    value = finder.ensure_element(
        id,
        Kind.PROPERTY,
        entry.name.text,
        block.id,
        entry.name.spot,
        origin=block.id,
        role="value",
        default=entry.default,
    )
    if type_ is not None:
        graph.connect(Edge.TYPED_BY, value, type_)
        if entry.default is not None and not fits_type(graph, entry.default, type_):
            facts = {"value": str(entry.default), "feature": entry.name.text, "type": type_.name}
            finder.report(rules.UNFIT_VALUE, entry.name, **facts)


def _with_generals(finder: Finder, block: Element) -> list[Element]:
    return [block, *generals(finder.graph, block)]


def _has_other_feature(finder: Finder, block: Element, entry: ValueEntry, id: str) -> bool:
    """Whether a block owns another feature of the name."""
    owned = finder.graph.owned(block)
    return any(feature.name == entry.name.text and feature.id != id for feature in owned)


def _add_operation(finder: Finder, block: Element, entry: OperationEntry) -> None:
    """Add an operation, unless the block already has it with the same parameters."""
    graph, name = finder.graph, entry.name
    id = derived_id(block.id, f"operation of an overlay:{name.text}")
    existing = find_operation(finder, block, name)
    if existing is not None and existing.id != id:
        if entry.parameters is not None and _read_signature(finder, existing) != _stated_signature(
            entry
        ):
            shown = graph.qualified_name(block)
            finder.report(rules.OPERATION_TWICE, name, operation=name.text, block=shown)
        return
    operation = finder.ensure_element(
        id, Kind.OPERATION, name.text, block.id, name.spot, origin=block.id
    )
    add_description(finder, operation, entry.description, name)
    for number, parameter in enumerate(entry.parameters or ()):
        add_parameter(
            finder, operation, number, parameter.name, parameter.direction, parameter.type
        )


def find_operation(finder: Finder, block: Element, name: Term) -> Element | None:
    """Return the operation that the block, or the nearest general block, has under this name."""
    for classifier in (block, *generals(finder.graph, block)):
        for feature in finder.graph.owned(classifier):
            if feature.kind is Kind.OPERATION and feature.name == name.text:
                return feature
    return None


def add_parameter(
    finder: Finder,
    operation: Element,
    number: int,
    name: Term,
    direction: str,
    type: Term | Element | None,
) -> None:
    """Add a parameter at its position among the others."""
    id = derived_id(operation.id, f"parameter:{number}:{name.text}")
    stated_direction = None if direction == "in" else direction
    parameter = finder.ensure_element(
        id,
        Kind.PARAMETER,
        name.text,
        operation.id,
        name.spot,
        origin=operation.id,
        direction=stated_direction,
    )
    type_element = finder.find_term(type, TYPE) if isinstance(type, Term) else type
    if type_element is not None:
        finder.graph.connect(Edge.TYPED_BY, parameter, type_element)


def _read_signature(finder: Finder, operation: Element) -> _Signature:
    owned = parameters(finder.graph, operation)
    return sorted((parameter.name, parameter.attrs.get("direction", "in")) for parameter in owned)


def _stated_signature(entry: OperationEntry) -> _Signature:
    return sorted(
        (parameter.name.text, parameter.direction) for parameter in entry.parameters or ()
    )


_FORMS: dict[str, tuple[type, ...]] = {
    "Boolean": (bool,),
    "Integer": (int,),
    "UnlimitedNatural": (int,),
    "Real": (int, float),
    "String": (str,),
}
"""What YAML makes of the values of UML's primitives."""


def fits_type(graph: Graph, value: AttrValue, type_: Element) -> bool:
    """Whether a value belongs to the primitive or the enumeration that a type is or specialises.

    Values of any other type cannot be checked, so any value fits.
    """
    for candidate in (type_, *generals(graph, type_)):
        if candidate.kind is Kind.ENUMERATION:
            return value in [literal.name for literal in _literals(graph, candidate)]
        if candidate.kind is Kind.DATA_TYPE and candidate.name in _FORMS:
            return isinstance(value, _FORMS[candidate.name]) and _agrees_on_boolean(
                value, candidate
            )
    return True


def _literals(graph: Graph, enumeration: Element) -> list[Element]:
    return [part for part in graph.owned(enumeration) if part.kind is Kind.ENUMERATION_LITERAL]


def _agrees_on_boolean(value: AttrValue, type_: Element) -> bool:
    """Whether Booleans and numbers are not confused: to Python, true is a number."""
    return isinstance(value, bool) == (type_.name == "Boolean")
