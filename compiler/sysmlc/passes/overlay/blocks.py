"""What blocks are and can do: general blocks, values, operations with their parameters."""

from sysmlc.ir import AttrValue, Edge, Element, Graph, Kind, derived_id
from sysmlc.ir.query import generals, parameters
from sysmlc.overlay.model import BlockEntry, OperationEntry, Term, ValueEntry
from sysmlc.passes.overlay import rules
from sysmlc.passes.overlay.finder import BLOCK, TYPE, Finder
from sysmlc.passes.overlay.items import describe

_Signature = list[tuple[str, AttrValue]]


def refine_block(finder: Finder, entry: BlockEntry) -> None:
    """Add what the overlay says of a block, but for behaviours."""
    block = finder.entry(entry.key, BLOCK)
    if block is None:
        return
    for general in entry.specializes:
        found = finder.term(general, BLOCK)
        if found is not None and found is not block:
            finder.graph.connect(Edge.SPECIALIZES, block, found)
    for value in entry.values:
        _add_value(finder, block, value)
    for operation in entry.operations:
        _add_operation(finder, block, operation)


def _add_value(finder: Finder, block: Element, entry: ValueEntry) -> None:
    graph = finder.graph
    id = derived_id(block.id, f"value of an overlay:{entry.name.text}")
    holder = next(
        (one for one in _with_generals(finder, block) if _has(finder, one, entry, id)), None
    )
    if holder is not None:
        name = graph.qualified_name(block)
        where = "" if holder is block else f", inherited from '{graph.qualified_name(holder)}'"
        facts = {"feature": entry.name.text, "block": name, "where": where}
        finder.report(rules.FEATURE_TWICE, entry.name, **facts)
        return
    type_ = None if entry.type is None else finder.term(entry.type, TYPE)
    made = finder.add(
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
        graph.connect(Edge.TYPED_BY, made, type_)
        if entry.default is not None and not fits(graph, entry.default, type_):
            facts = {"value": str(entry.default), "feature": entry.name.text, "type": type_.name}
            finder.report(rules.UNFIT_VALUE, entry.name, **facts)


def _with_generals(finder: Finder, block: Element) -> list[Element]:
    return [block, *generals(finder.graph, block)]


def _has(finder: Finder, block: Element, entry: ValueEntry, id: str) -> bool:
    """Whether a block owns another feature of the name."""
    owned = finder.graph.owned(block)
    return any(one.name == entry.name.text and one.id != id for one in owned)


def _add_operation(finder: Finder, block: Element, entry: OperationEntry) -> None:
    """Add an operation, or find that the block has it with the same parameters already."""
    graph, name = finder.graph, entry.name
    id = derived_id(block.id, f"operation of an overlay:{name.text}")
    same = operation_of(finder, block, name)
    if same is not None and same.id != id:
        if entry.parameters is not None and _signature(finder, same) != _wanted(entry):
            shown = graph.qualified_name(block)
            finder.report(rules.OPERATION_TWICE, name, operation=name.text, block=shown)
        return
    made = finder.add(id, Kind.OPERATION, name.text, block.id, name.spot, origin=block.id)
    describe(finder, made, entry.description, name)
    for number, given in enumerate(entry.parameters or ()):
        add_parameter(finder, made, number, given.name, given.direction, given.type)


def operation_of(finder: Finder, block: Element, name: Term) -> Element | None:
    """The operation that the block, or the nearest general block, has under this name."""
    for one in (block, *generals(finder.graph, block)):
        for inner in finder.graph.owned(one):
            if inner.kind is Kind.OPERATION and inner.name == name.text:
                return inner
    return None


def add_parameter(
    finder: Finder,
    operation: Element,
    number: int,
    name: Term,
    direction: str,
    type: Term | Element | None,
) -> None:
    """Add a parameter in its place among the others."""
    id = derived_id(operation.id, f"parameter:{number}:{name.text}")
    given = None if direction == "in" else direction
    made = finder.add(
        id, Kind.PARAMETER, name.text, operation.id, name.spot, origin=operation.id, direction=given
    )
    found = finder.term(type, TYPE) if isinstance(type, Term) else type
    if found is not None:
        finder.graph.connect(Edge.TYPED_BY, made, found)


def _signature(finder: Finder, operation: Element) -> _Signature:
    found = parameters(finder.graph, operation)
    return sorted((one.name, one.attrs.get("direction", "in")) for one in found)


def _wanted(entry: OperationEntry) -> _Signature:
    return sorted((one.name.text, one.direction) for one in entry.parameters or ())


_FORMS: dict[str, tuple[type, ...]] = {
    "Boolean": (bool,),
    "Integer": (int,),
    "UnlimitedNatural": (int,),
    "Real": (int, float),
    "String": (str,),
}
"""What YAML makes of the values of UML's primitives."""


def fits(graph: Graph, value: AttrValue, type_: Element) -> bool:
    """Whether a value is of the primitive or the enumeration that a type is in the end.

    Of any other type nobody can tell, so any value fits it.
    """
    for one in (type_, *generals(graph, type_)):
        if one.kind is Kind.ENUMERATION:
            return value in [literal.name for literal in _literals(graph, one)]
        if one.kind is Kind.DATA_TYPE and one.name in _FORMS:
            return isinstance(value, _FORMS[one.name]) and _is_truth(value, one)
    return True


def _literals(graph: Graph, enumeration: Element) -> list[Element]:
    return [one for one in graph.owned(enumeration) if one.kind is Kind.ENUMERATION_LITERAL]


def _is_truth(value: AttrValue, type_: Element) -> bool:
    """Whether it is a truth value just where one is wanted: to Python true is a number."""
    return isinstance(value, bool) == (type_.name == "Boolean")
