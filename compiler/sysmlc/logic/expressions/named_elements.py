"""Elements of a model by the names that expressions use for them.

A name is plain (``level``), dotted (``machine.busy``, ``level.value``), or names an enumeration
literal (``Mode::auto``).
"""

from collections.abc import Iterable, Iterator
from functools import cached_property

from msgspec.structs import replace

from sysmlc.ir import AttrValue, Edge, Element, Graph, Kind, query
from sysmlc.logic.contract import BooleanDomain, EnumerationDomain, IntegerDomain
from sysmlc.logic.expressions.linear import Number, read_quantity
from sysmlc.logic.expressions.symbols import Symbol
from sysmlc.logic.formula import const
from sysmlc.logic.identifiers import make_unique

VALUE_KINDS = (Kind.PROPERTY, Kind.PORT, Kind.FLOW_PROPERTY, Kind.PARAMETER)
"""Kinds of the elements that have a value in a context."""
_STEPS = (Kind.ACTION, Kind.STRUCTURED)
_OBJECTS = (Kind.CLASS, Kind.COMPONENT, Kind.SIGNAL, Kind.DATA_TYPE)
_CALLED = (Kind.OPERATION, Kind.ACTIVITY)

# -- features of the classifier ------------------------------------------------------------------


def find_named_values(graph: Graph, classifier: Element) -> dict[str, Element]:
    """Return the features and parameters of a classifier by name, inherited ones included.

    The classifier's own elements take precedence over inherited ones.
    """
    elements = [*query.features(graph, classifier), *query.parameters(graph, classifier)]
    values = [element for element in elements if element.name and element.kind in VALUE_KINDS]
    inherited = _iter_inherited_values(graph, classifier)
    # The first element of a name wins, so it must be the last one that the dictionary stores.
    return {element.name: element for element in reversed([*values, *inherited])}


def _iter_inherited_values(graph: Graph, classifier: Element) -> Iterator[Element]:
    for general in query.generals(graph, classifier):
        for element in graph.owned(general):
            if element.name and element.kind in VALUE_KINDS:
                yield element


def find_port_values(graph: Graph, classifier: Element) -> dict[str, Element]:
    """Return the items that flow through the ports of a classifier, by dotted name.

    ``level.value`` is a flow property of the type of port ``level`` (SysML 1.6 clause 9.3.2.7).
    """
    values: dict[str, Element] = {}
    for port in query.ports(graph, classifier):
        type_ = query.type_of(graph, port) if port.name else None
        if type_ is not None and type_.kind in _OBJECTS:
            for item in _iter_port_items(graph, type_):
                values.setdefault(f"{port.name}.{item.name}", item)
    return values


def _iter_port_items(graph: Graph, port_type: Element) -> Iterator[Element]:
    for feature in query.features(graph, port_type):
        if feature.name and (query.is_flow_property(feature) or feature.role == "value"):
            yield feature


def find_part_values(graph: Graph, classifier: Element, names: Iterable[str]) -> dict[str, Element]:
    """Return the values in parts of a classifier for those of *names* that lead to one.

    ``cell.full`` is a feature of the type of the single part ``cell``.
    """
    values: dict[str, Element] = {}
    for name in names:
        *path, last = name.split(".")
        owner: Element | None = classifier
        for step in path:
            part = None if owner is None else find_named_values(graph, owner).get(step)
            is_single = part is not None and query.bounds(part.attrs.get("multiplicity")) in (
                None,
                (1, 1),
            )
            is_part = part is not None and part.role == "part" and is_single
            owner = query.type_of(graph, part) if part is not None and is_part else None
        value = None if owner is None else find_named_values(graph, owner).get(last)
        if path and value is not None and value.role in ("value", "flow property"):
            values[name] = value
    return values


def find_direction(graph: Graph, classifier: Element, name: str, element: Element) -> str:
    """Return the direction of a feature as seen by the classifier; empty if it has none.

    A conjugated port reverses the directions of its flow properties (SysML 1.6 clause 9.3.2.15).
    """
    attribute = element.attrs.get("direction")
    direction = attribute if isinstance(attribute, str) else ""
    head, dot, _ = name.partition(".")
    if not dot or not direction:
        return direction
    port = next((port for port in query.ports(graph, classifier) if port.name == head), None)
    is_reversed = port is not None and port.attrs.get("conjugated")
    return (query.opposite(direction) or direction) if is_reversed else direction


def describe_feature_elsewhere(graph: Graph, id: str, name: str) -> str:
    """Return whose feature a name denotes, or an empty text if *id*, its element, is no value."""
    feature = graph.get(id)
    if feature is None or feature.kind not in (*VALUE_KINDS, Kind.INSTANCE):
        return ""
    owner = graph.owner(feature) or feature
    package = "package " if owner.kind is Kind.PACKAGE else ""
    return f"'{name}' is a feature of {package}'{owner.name}'"


# -- values of the objects that a behaviour handles ----------------------------------------------


def find_object_values(graph: Graph, behaviour: Element) -> dict[str, Element]:
    """Return the values of arguments, payloads, pins and loop variables of a behaviour, by name.

    ``machine.busy`` is a value of an argument, ``fault.severity`` a value of the payload of a
    trigger, ``weigh.mass`` an output pin of a step, ``look.image.sharp`` a value of the object in
    such a pin, ``p.number`` a value of the variable p of a structured node.
    """
    arguments = (parameter for parameter in query.parameters(graph, behaviour) if parameter.name)
    values = dict(_iter_values(graph, ((argument.name, argument) for argument in arguments)))
    values |= _iter_values(graph, _iter_payloads(graph, behaviour))
    if behaviour.kind is Kind.ACTIVITY and _has_dotted_guard(graph, behaviour):
        pins = list(_iter_output_pins(graph, behaviour, ""))
        values |= pins
        values |= _iter_values(graph, [*pins, *_iter_loop_variables(graph, behaviour)])
    return values


def _iter_values(
    graph: Graph, objects: Iterable[tuple[str, Element]]
) -> Iterator[tuple[str, Element]]:
    """Yield the values of each object with dotted names that begin with the object's name."""
    for name, typed_element in objects:
        type_ = query.type_of(graph, typed_element)
        if type_ is not None and type_.kind in (*_OBJECTS, *_CALLED):
            for value in _iter_values_of_type(graph, type_):
                yield f"{name}.{value.name}", value


def _iter_values_of_type(graph: Graph, type_: Element) -> Iterator[Element]:
    """Yield the value properties of a type, or the parameters of an operation or an activity."""
    if type_.kind in _CALLED:
        yield from (element for element in graph.owned(type_) if element.kind is Kind.PARAMETER)
        return
    generals = query.generals(graph, type_)
    inherited = (element for general in generals for element in graph.owned(general))
    for element in (*query.features(graph, type_), *inherited):
        if element.kind is Kind.PROPERTY and element.role == "value":
            yield element


def _iter_payloads(graph: Graph, behaviour: Element) -> Iterator[tuple[str, Element]]:
    """Yield the triggers of a state machine by the names of their payloads.

    UML has no payloads: there, the name of the trigger stands for the event that it receives.
    """
    if behaviour.kind is not Kind.STATE_MACHINE:
        return
    for element in graph.subtree(behaviour):
        name = str(element.attrs.get("payload") or element.name)
        if element.kind is Kind.TRIGGER and name:
            yield name, element


def _iter_output_pins(graph: Graph, owner: Element, prefix: str) -> Iterator[tuple[str, Element]]:
    """Yield the output pins of steps by name.

    A step inside a structured node may be named with and without the name of that node.
    """
    for step in graph.owned(owner):
        if step.kind not in _STEPS:
            continue
        if step.kind is Kind.STRUCTURED:
            yield from _iter_output_pins(graph, step, prefix)
            if step.name:
                yield from _iter_output_pins(graph, step, f"{prefix}{step.name}.")
        if step.name:
            for pin in graph.owned(step):
                if pin.kind is Kind.PIN and pin.name and pin.attrs.get("direction") == "out":
                    yield f"{prefix}{step.name}.{pin.name}", pin


def _iter_loop_variables(graph: Graph, owner: Element) -> Iterator[tuple[str, Element]]:
    """Yield the variables of structured nodes, such as the current element of a loop."""
    for element in graph.owned(owner):
        if element.kind is Kind.STRUCTURED:
            yield from _iter_loop_variables(graph, element)
        elif element.kind is Kind.PROPERTY and element.subkind == "variable" and element.name:
            yield element.name, element


def _has_dotted_guard(graph: Graph, owner: Element) -> bool:
    """Whether a guard or a change condition may name a pin or a variable; few activities do."""
    for element in graph.owned(owner):
        if "." in str(element.attrs.get("guard", "")):
            return True
        if element.kind is Kind.STRUCTURED and _has_dotted_guard(graph, element):
            return True
        if element.kind is Kind.ACTION and _has_dotted_trigger(graph, element):
            return True
    return False


def _has_dotted_trigger(graph: Graph, action: Element) -> bool:
    triggers = graph.targets(action, Edge.TRIGGER)
    return any("." in str(trigger.attrs.get("condition", "")) for trigger in triggers)


# -- enumeration literals ------------------------------------------------------------------------


def literals_of(graph: Graph, enumeration: Element) -> dict[str, str]:
    """Return the identifiers of the literals of an enumeration, by literal name."""
    owned = graph.owned(enumeration)
    names = [element.name for element in owned if element.kind is Kind.ENUMERATION_LITERAL]
    return dict(zip(names, make_unique(names, "literal"), strict=True))


def find_enumeration_domain(graph: Graph, enumeration: Element) -> EnumerationDomain | None:
    """Return the literals of an enumeration; None if it has none."""
    literals = tuple(literals_of(graph, enumeration).values())
    name = graph.qualified_name(enumeration)
    return EnumerationDomain(literals, type_name=name) if literals else None


def constant_value(attribute: Element) -> AttrValue:
    """Return the value of an attribute of a package; None if it may change or has a unit."""
    if "value_kind" in attribute.attrs or "value_unit" in attribute.attrs:
        return None
    return attribute.attrs.get("value")


class Enumerations:
    """Enumeration literals and constants of a model, collected when the first one is looked up.

    Use ``enumerations_of``, which collects them once for all components.
    """

    def __init__(self, graph: Graph) -> None:
        self._graph = graph
        self.revision = graph.revision

    @cached_property
    def literals_by_id(self) -> dict[str, Symbol]:
        """The symbol of each literal by its id."""
        literals = {}
        for enumeration in self._graph.of_kind(Kind.ENUMERATION):
            identifiers = literals_of(self._graph, enumeration)
            domain = find_enumeration_domain(self._graph, enumeration)
            for literal in self._graph.owned(enumeration):
                if literal.kind is Kind.ENUMERATION_LITERAL:
                    value = literal.attrs.get("value")
                    number = value if type(value) is int else None
                    literals[literal.id] = Symbol(const(identifiers[literal.name]), domain, number)
        return literals

    @cached_property
    def literals(self) -> dict[str, Symbol]:
        """The symbol of each literal by the names ``Mode::auto`` and ``Mode.auto``.

        A name of several literals that differ, such as those of two packages, has no domain.
        """
        literals: dict[str, Symbol] = {}
        for id, symbol in self.literals_by_id.items():
            literal = self._graph[id]
            enumeration = self._graph.owner(literal)
            assert enumeration is not None
            assert isinstance(symbol.domain, EnumerationDomain)
            untyped = replace(symbol, domain=EnumerationDomain(symbol.domain.literals))
            for separator in ("::", "."):
                name = f"{enumeration.name}{separator}{literal.name}"
                first = literals.setdefault(name, symbol)
                if first is not symbol:
                    # Several enumerations have the name: with the same literals, or others.
                    literals[name] = untyped if first == symbol else Symbol(symbol.formula, None)
        return literals

    @cached_property
    def constants(self) -> dict[str, Symbol | None]:
        """The symbol of each attribute of a package with a bound value, by qualified name.

        None stands for an attribute whose value may change, or has no finite type.
        """
        constants = self.constants_by_id.items()
        return {self._graph.qualified_name(self._graph[id]): value for id, value in constants}

    @cached_property
    def constants_by_id(self) -> dict[str, Symbol | None]:
        """The same symbols by the ids of the attributes."""
        attributes = self._graph.of_kind(Kind.INSTANCE)
        return {attribute.id: self._read_constant(attribute) for attribute in attributes}

    @cached_property
    def integers(self) -> dict[str, int]:
        """The constants that are Integers, by id."""
        values = ((id, constant_value(self._graph[id])) for id in self.constants_by_id)
        return {id: value for id, value in values if type(value) is int}

    def _read_constant(self, attribute: Element) -> Symbol | None:
        value = constant_value(attribute)
        if isinstance(value, bool):
            return Symbol(const(value), BooleanDomain())
        if isinstance(value, int):
            return Symbol(const(value), IntegerDomain(value, value))
        quantity = read_quantity(self._graph, attribute, "value")
        if quantity is not None and attribute.attrs.get("value_kind", "bound") == "bound":
            number = Number("", (quantity,), is_constant=True)
            return Symbol(const(attribute.name), None, quantity=number)
        literal = self.literals_by_id.get(str(attribute.attrs.get("value_instance")))
        return literal if value is not None else None

    @cached_property
    def numbers(self) -> dict[str, int]:
        """The numbers of literals and Integer constants, by the ids and the names of literals."""
        literals = {**self.literals, **self.literals_by_id}.items()
        numbers = {key: symbol.number for key, symbol in literals if symbol.number is not None}
        return numbers | self.integers


def enumerations_of(graph: Graph) -> Enumerations:
    """Return the enumerations of a graph; they are collected again after a change."""
    for enumerations in graph.derived(Enumerations):
        if enumerations.revision == graph.revision:
            return enumerations
    enumerations = Enumerations(graph)
    graph.store(Enumerations, (enumerations,))
    return enumerations
