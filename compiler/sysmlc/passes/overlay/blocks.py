"""Entries about blocks: general blocks, values, operations with their parameters, item types.

Item types are the types of what flows over connectors; they have a domain (thesis 3.4.1).
"""

from sysmlc.ir import AttrValue, Edge, Element, Graph, Kind, derived_id
from sysmlc.ir.query import domain_of, generals, parameters
from sysmlc.overlay.model import BlockEntry, ItemEntry, Key, OperationEntry, Term, ValueEntry
from sysmlc.passes.overlay import rules
from sysmlc.passes.overlay.finder import BLOCK, PACKAGE, TYPE, Finder, Sort

_Signature = list[tuple[str, AttrValue]]


def refine_block(finder: Finder, entry: BlockEntry) -> None:
    """Add the generals, values and operations that the overlay states for a block."""
    block = finder.find_entry(entry.key, BLOCK)
    if block is None:
        return
    for general in entry.specializes:
        _specialize(finder, block, general, BLOCK)
    for value in entry.values:
        _add_value(finder, block, value)
    for operation in entry.operations:
        _add_operation(finder, block, operation)


def _add_value(finder: Finder, block: Element, entry: ValueEntry) -> None:
    graph = finder.graph
    id = derived_id(block.id, f"value of an overlay:{entry.name.text}")
    for holder in (block, *generals(graph, block)):
        # A feature with the id was added by an earlier run of the pass.
        if any(f.name == entry.name.text and f.id != id for f in graph.owned(holder)):
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
        if entry.default is not None and not _fits_type(graph, entry.default, type_):
            facts = {"value": str(entry.default), "feature": entry.name.text, "type": type_.name}
            finder.report(rules.INVALID_VALUE, entry.name, **facts)


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
    """Return the operation with this name in the block, or in the nearest general block."""
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
    """Add the parameter at position *number* of an operation."""
    id = derived_id(operation.id, f"parameter:{number}:{name.text}")
    # A parameter without the attribute has UML's default direction, which is `in`.
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


_PYTHON_TYPES: dict[str, tuple[type, ...]] = {
    "Boolean": (bool,),
    "Integer": (int,),
    "UnlimitedNatural": (int,),
    "Real": (int, float),
    "String": (str,),
}
"""Python types of YAML values that UML's primitive types accept."""


def _fits_type(graph: Graph, value: AttrValue, type_: Element) -> bool:
    """Whether the value is valid for a primitive type, an enumeration or a special of these.

    Values of other types cannot be checked and count as valid.
    """
    for candidate in (type_, *generals(graph, type_)):
        if candidate.kind is Kind.ENUMERATION:
            return value in [literal.name for literal in _literals(graph, candidate)]
        if candidate.kind is Kind.DATA_TYPE and candidate.name in _PYTHON_TYPES:
            return isinstance(value, _PYTHON_TYPES[candidate.name]) and _agrees_on_boolean(
                value, candidate
            )
    return True


def _literals(graph: Graph, enumeration: Element) -> list[Element]:
    return [part for part in graph.owned(enumeration) if part.kind is Kind.ENUMERATION_LITERAL]


def _agrees_on_boolean(value: AttrValue, type_: Element) -> bool:
    """Whether value and type are both Boolean or both not: in Python, True is also an int."""
    return isinstance(value, bool) == (type_.name == "Boolean")


# -- item types --------------------------------------------------------------------------------


def add_items(finder: Finder) -> None:
    """Add or find all item types, then add their generalizations."""
    entries = finder.refinement.items
    for entry in entries:
        item = _ensure_item(finder, entry.key)
        if item is not None:
            finder.items[entry.key.text] = item
            _describe_item(finder, entry, item)
    for entry in entries:
        if entry.key.text in finder.items:
            for general in entry.specializes:
                _specialize(finder, finder.items[entry.key.text], general, TYPE)


def check_domains(finder: Finder) -> None:
    """Report item types without a domain, in entries for items and in flows of the overlay."""
    keys = {
        finder.items[entry.key.text].id: entry.key
        for entry in finder.refinement.items
        if entry.key.text in finder.items
    }
    for connector in finder.refinement.connectors:
        for flow in connector.flows:
            item = finder.items.get(flow.item.text) or _find_item(finder, flow.item)
            if item is not None:
                keys.setdefault(item.id, Key(flow.item.text, "", flow.item.spot))
    for id, key in keys.items():
        if domain_of(finder.graph, finder.graph[id]) is None:
            finder.report(rules.NO_DOMAIN, key, item=finder.graph[id].name)


def _find_item(finder: Finder, term: Term) -> Element | None:
    elements = finder.find_named(term.text, TYPE)
    return elements[0] if len(elements) == 1 else None


def _ensure_item(finder: Finder, key: Key) -> Element | None:
    """Return the element with this id, path or name, or else a new block with this name."""
    # A text with a separator is a path, which cannot be the name of a new block.
    is_known = key.path or finder.find_named(key.text, TYPE)
    if is_known or any(separator in key.text for separator in "/:#["):
        return finder.find_entry(key, TYPE)
    package = _ensure_package(finder)
    id = derived_id(package.id, f"item:{key.text}")
    if id not in finder.graph:
        _report_namesakes(finder, key)
    return finder.ensure_element(id, Kind.CLASS, key.text, package.id, key.spot, role="block")


def _ensure_package(finder: Finder) -> Element:
    name = finder.refinement.package
    packages = finder.find_named(name, PACKAGE)
    if packages:
        return packages[0]
    id = derived_id(name, "package of an overlay")
    return finder.ensure_element(id, Kind.PACKAGE, name, None, finder.refinement.spot)


def _report_namesakes(finder: Finder, key: Key) -> None:
    graph = finder.graph
    namesakes = [element for element in graph.of_kind(*TYPE.kinds) if element.name == key.text]
    if namesakes:
        finder.report(rules.NAMESAKE, key, item=key.text, other=finder.path_of(namesakes[0]))


def _describe_item(finder: Finder, entry: ItemEntry, item: Element) -> None:
    graph = finder.graph
    stated = item.attrs.get("domain")
    if entry.domain and stated not in (None, entry.domain):
        finder.report(
            rules.CONTRADICTION,
            entry.key,
            name=item.name,
            what="domain",
            new=entry.domain,
            old=str(stated),
        )
    graph.set(item, domain=entry.domain or stated)
    if entry.domain and stated != entry.domain:
        finder.record_change(item, f"the domain '{entry.domain}'", entry.key)
    add_description(finder, item, entry.description, entry.key)


def add_description(finder: Finder, element: Element, text: str, term: Term | Key) -> None:
    """Add the description of an element as a comment."""
    if text:
        id = derived_id(element.id, "description of an overlay")
        comment = finder.ensure_element(id, Kind.COMMENT, "", element.id, term.spot, body=text)
        finder.graph.connect(Edge.REFERENCES, comment, element)


def _specialize(finder: Finder, special: Element, term: Term, sort: Sort) -> None:
    general = finder.find_term(term, sort)
    if general is not None and general is not special:
        finder.graph.connect(Edge.SPECIALIZES, special, general)
        finder.record_change(special, f"the general '{general.name}'", term)
