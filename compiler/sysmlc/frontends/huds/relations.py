"""Lowers relations between records to references, which the pass ``resolve`` makes edges."""

from collections import Counter
from collections.abc import Callable, Iterable
from typing import Protocol

from sysmlc.frontends.huds import vocabulary as v
from sysmlc.frontends.huds.records import Record, Relation, parse_literal
from sysmlc.ir import Edge, Element, Graph, Kind, Reference
from sysmlc.ir.element import derived_id


class _FileLowering(Protocol):
    """The part of ``lowering.FileLowering`` that this module uses."""

    graph: Graph
    by_id: dict[str, Record]

    @property
    def instances_by_name(self) -> dict[tuple[str, str], list[str]]: ...

    def target_id(self, id: str) -> str: ...

    def mark_loose_end(self, record: Record, flow: Element, edge: Edge) -> None: ...

    def mark_unnamed_type(self, record: Record) -> None: ...


def add_relations(file: _FileLowering, record: Record, element: Element | None) -> None:
    """Add the references of a record; *element* is the record's own element, if it has one."""
    if element is None:
        if record.local_type in _EDGES:
            _add_edge(file, record, _EDGES[record.local_type])
        return
    for relation in record.relations:
        edge = v.RELATIONS.get(relation.name)
        if edge is Edge.TYPED_BY and element.kind is Kind.LIFELINE and record.targets("represents"):
            # UML: only the represented element has a type, which MTIP repeats.
            continue
        if edge is Edge.TYPED_BY and not relation.id:
            _add_unnamed_type(file, record, element)
        elif edge is Edge.INSTANCE_OF and element.kind not in v.INSTANCES:
            # MTIP repeats the general of a value type as its classifier.
            _refer(file, Edge.SPECIALIZES, element.id, [relation.id], element.kind)
        elif edge is not None:
            _refer(file, edge, element.id, [relation.id], _find_target_kind(relation))
    if element.kind in v.ENDS:
        _add_ends(file, record, element)
    if element.kind in _COMPLETIONS:
        _COMPLETIONS[element.kind](file, record, element)


def _find_target_kind(relation: Relation) -> Kind:
    """Return the kind of the stub for a target that MTIP does not export.

    The type that MTIP states for the target determines it, else the relation.
    """
    mapped = v.KINDS.get(relation.type.rpartition(".")[2])
    return v.TARGET_KINDS.get(relation.name, Kind.CLASS) if mapped is None else mapped[0]


def _add_unnamed_type(file: _FileLowering, record: Record, feature: Element) -> None:
    """Add the type of a feature whose primitive type MTIP does not name.

    In the table of MTIP 2022x that has the names of primitive types by their ids, the id of Boolean
    is misspelt, and those of Complex and Number are missing. A default of true or false shows that
    the type is Boolean; otherwise the feature has no type, which is reported.
    """
    if record.value("defaultValue") in ("true", "false"):
        _refer(file, Edge.TYPED_BY, feature.id, ["Boolean"])
    else:
        file.mark_unnamed_type(record)


def _refer(
    file: _FileLowering, edge: Edge, source: str, ids: Iterable[str], kind: Kind = Kind.CLASS
) -> None:
    for id in ids:
        file.graph.pending.append(Reference(edge, source, file.target_id(id), kind))


def _add_ends(file: _FileLowering, record: Record, element: Element) -> None:
    for edge, relation in zip(v.ENDS[element.kind], ("supplier", "client"), strict=True):
        for id in record.targets(relation)[:1]:
            if element.kind in _FLOWS and file.target_id(id) not in file.graph:
                file.mark_loose_end(record, element, edge)
            else:
                _refer(file, edge, element.id, [id])


def _add_edge(file: _FileLowering, record: Record, edge: Edge) -> None:
    """Add the edge of a record without an element, from its supplier to its client."""
    source, target = record.find_target("supplier"), record.find_target("client")
    if file.graph.get(file.target_id(source)) is not None and target:
        _refer(file, edge, file.target_id(source), [target])


def add_association_ends(file: _FileLowering) -> None:
    """Add the ends that associations own, because MTIP exports only the ends that classes own.

    An association with one end leads back to the owner of that end, which is the type of the
    other end. MTIP states both types: they are the supplier and the client.
    """
    for record in file.by_id.values():
        association = file.graph.get(file.target_id(record.id))
        if association is None or association.kind is not Kind.ASSOCIATION:
            continue
        ends = file.graph.targets(association, Edge.END)
        types = (*record.targets("supplier")[:1], *record.targets("client")[:1])
        owners = [id for id in types if len(ends) == 1 and file.target_id(id) == ends[0].owner]
        if owners:
            id = derived_id(association.id, "end")
            source, ordinal = association.source, record.ordinal
            end = Element(id, Kind.PROPERTY, "", association.id, ordinal, source)
            file.graph.add(end)
            file.graph.connect(Edge.END, association, end)
            _refer(file, Edge.TYPED_BY, end.id, owners[:1])


def add_effects(graph: Graph) -> None:
    """Connect transitions with their effects, which MTIP exports as behaviours that they own.

    A transition owns no other behaviour (UML 2.5.1, Transition).
    """
    for behaviour in [element for element in graph if element.kind is Kind.ACTIVITY]:
        owner = graph.owner(behaviour)
        if owner is not None and owner.kind is Kind.TRANSITION:
            graph.connect(Edge.EFFECT, owner, behaviour)


# -- parameters of nodes ---------------------------------------------------------------------------


def add_parameters_of_nodes(file: _FileLowering) -> None:
    """Connect parameter nodes with their parameters, to which MTIP exports no relation.

    A node has the type of its parameter (UML 2.5.1, ActivityParameterNode, same_type). Of the
    parameters with this type, the parameter of the node is the only one with the same name, else
    the only remaining one with a direction that the flows of the node allow. A node to which
    several parameters fit has none in the graph.
    """
    by_owner: dict[str, tuple[list[Record], list[Record]]] = {}
    leaving, arriving = set(), set()
    for record in file.by_id.values():
        if record.local_type == "ObjectFlow":
            leaving.add(record.find_target("supplier"))
            arriving.add(record.find_target("client"))
        elif record.local_type in ("ActivityParameterNode", "Parameter"):
            owned = by_owner.setdefault(record.find_target("hasParent"), ([], []))
            owned[record.local_type == "Parameter"].append(record)

    def allow_direction(node: Record, parameter: Record) -> bool:
        direction = parameter.value("direction") or "in"
        is_input = node.id not in leaving or direction in ("in", "inout")
        return is_input and (node.id not in arriving or direction != "in")

    for nodes, parameters in by_owner.values():
        pairs = _pair_uniquely(nodes, parameters, _have_same_name)
        other_nodes = [node for node in nodes if node.id not in pairs]
        others = [parameter for parameter in parameters if parameter.id not in pairs.values()]
        pairs |= _pair_uniquely(other_nodes, others, allow_direction)
        for node_id, parameter_id in pairs.items():
            node = file.graph.get(file.target_id(node_id))
            if node is not None:
                direction = file.by_id[parameter_id].value("direction")
                is_output = direction in ("out", "return") or node_id in arriving
                node.attrs["direction"] = "out" if is_output else "in"
                _refer(file, Edge.REFERENCES, node.id, [parameter_id])


def _have_same_name(node: Record, parameter: Record) -> bool:
    return node.value("name") == parameter.value("name")


def _pair_uniquely(
    nodes: list[Record], parameters: list[Record], fits: Callable[[Record, Record], bool]
) -> dict[str, str]:
    """Return pairs of ids of the same type that fit each other and nothing else."""
    pairs = [
        (node.id, parameter.id)
        for node in nodes
        for parameter in parameters
        if node.find_target("typedBy") == parameter.find_target("typedBy")
        if fits(node, parameter)
    ]
    counts = Counter(id for pair in pairs for id in pair)
    return {node: parameter for node, parameter in pairs if counts[node] == counts[parameter] == 1}


# -- completions of single kinds -------------------------------------------------------------------


def _complete_connector(file: _FileLowering, record: Record, connector: Element) -> None:
    for number, side in enumerate(("supplier", "client")):
        end = Element(
            derived_id(connector.id, f"end[{number}]"),
            Kind.CONNECTOR_END,
            "",
            connector.id,
            record.ordinal,
            connector.source,
        )
        file.graph.add(end)
        file.graph.connect(Edge.END, connector, end)
        _refer(file, Edge.ROLE, end.id, record.targets(side)[:1])
        _refer(file, Edge.PATH, end.id, record.targets(f"{side}PartWithPort"))


def _complete_property(file: _FileLowering, record: Record, property_: Element) -> None:
    """Make a property an end of the association that it names; set its aggregation."""
    owner = file.graph.get(property_.owner or "")
    for id in record.targets("association"):
        association = file.graph.get(file.target_id(id))
        if association is not None and association.kind is Kind.ASSOCIATION:
            file.graph.connect(Edge.END, association, property_)
            is_composition = file.by_id[id].type.endswith("Composition")
            if is_composition and owner is not None and owner.kind is not Kind.ASSOCIATION:
                property_.attrs["aggregation"] = "composite"
    if record.type.endswith("PartProperty"):
        property_.attrs["aggregation"] = "composite"
    _complete_default(file, record, property_)


def _complete_default(file: _FileLowering, record: Record, feature: Element) -> None:
    """Read the default value of a feature as the literal that its text denotes.

    MTIP writes the text of every value specification and not its type: "0.0" is the number in a
    LiteralReal, a text for a feature of type String is the string, and the name of an instance of
    the type is the instance. Any other text stays an expression.
    """
    text = feature.attrs.get("default")
    if not isinstance(text, str):
        return
    type_id = record.find_target("typedBy")
    instances = file.instances_by_name.get((type_id, text), [])
    if len(instances) == 1 and instances[0] in file.graph:
        feature.attrs["default_instance"] = instances[0]
    elif type_id != "String":
        value = parse_literal(text)
        if value is None:
            return
        feature.attrs["default"] = value
    del feature.attrs["default_language"]


def _complete_trigger(file: _FileLowering, record: Record, trigger: Element) -> None:
    """Connect a trigger with its owner, and add the content of its event to it."""
    owner = file.graph.get(trigger.owner or "")
    if owner is not None and owner.kind in (Kind.TRANSITION, Kind.ACTION):
        file.graph.connect(Edge.TRIGGER, owner, trigger)
    elif owner is not None:
        trigger.attrs["deferred"] = True
    event = file.by_id.get(record.find_target("event"))
    if event is None:
        return
    trigger.attrs["subkind"] = event.local_type.removesuffix("Event").lower()
    _refer(file, Edge.TYPED_BY, trigger.id, event.targets("signal"))
    _refer(file, Edge.TYPED_BY, trigger.id, event.targets("operation"))
    when = file.by_id.get(event.value("when"))
    if when is not None and when.value("expr"):
        trigger.attrs["when"] = when.value("expr")
        trigger.attrs["relative"] = True


def _complete_constraint(file: _FileLowering, record: Record, constraint: Element) -> None:
    """Make a constraint of a transition its guard."""
    owner = file.graph.get(constraint.owner or "")
    if owner is not None and owner.kind is Kind.TRANSITION:
        owner.attrs["guard"] = constraint.attrs.get("body") or constraint.name
        file.graph.connect(Edge.GUARD, owner, constraint)


def _complete_slot(file: _FileLowering, record: Record, slot: Element) -> None:
    values = record.literals("value")
    if values:
        slot.attrs["value"] = values[0] if len(values) == 1 else tuple(values)


def _complete_pin(file: _FileLowering, record: Record, pin: Element) -> None:
    pin.attrs["direction"] = "out" if record.type.endswith("OutputPin") else "in"


_FLOWS = frozenset({Kind.CONTROL_FLOW, Kind.OBJECT_FLOW, Kind.TRANSITION})
"""Kinds that lead from node to node: an external stub for a node that is not read is no node."""
_COMPLETIONS: dict[Kind, Callable[[_FileLowering, Record, Element], None]] = {
    Kind.CONNECTOR: _complete_connector,
    Kind.PROPERTY: _complete_property,
    Kind.PORT: _complete_default,
    Kind.PARAMETER: _complete_default,
    Kind.TRIGGER: _complete_trigger,
    Kind.CONSTRAINT: _complete_constraint,
    Kind.SLOT: _complete_slot,
    Kind.PIN: _complete_pin,
}
_EDGES = {
    "Generalization": Edge.SPECIALIZES,
    "Include": Edge.INCLUDES,
    "Extend": Edge.EXTENDS,
}
"""Types of records that are only an edge."""
