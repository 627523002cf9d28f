"""Reviewed reasons for differences between a model and the graph of its SysML v2 text.

Each reason is a sentence that is true of all its differences, a predicate for them, and the loss
that the back end must have reported near the element (docs/write-sysml-v2.md), unless the text
states the same in other words.
"""

import re
from collections import Counter
from collections.abc import Callable

from text_differences import BEHAVIOURS, Difference, Reason

from sysmlc.backends.sysml.profiles import is_standard
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.ir.compare import What
from sysmlc.ir.expressions import ExpressionError, print_expression
from sysmlc.logic.expressions.parsing import parse_effect, parse_expression

# -- texts -----------------------------------------------------------------------------------------


def _strip(text: object) -> str:
    unified = str(text).replace("\r\n", "\n").replace("\r", "\n").replace("*/", "* /")
    lines = unified.strip().split("\n")
    return "\n".join(line.strip() for line in lines)


def _list_texts(graph: Graph, element: Element | None) -> list[str]:
    """Return the texts of an element and of its comments without white space around lines."""
    if element is None:
        return []
    comments = [child for child in graph.owned(element) if child.kind is Kind.COMMENT]
    comments += [c for c in graph.sources(element, Edge.REFERENCES) if c.kind is Kind.COMMENT]
    texts = {child.id: child.attrs.get("body", "") for child in comments}
    own = [element.attrs.get(key, "") for key in ("body", "bodies", "text")]
    return sorted(_strip(text) for text in (*texts.values(), *own))


def _has_equal_texts(difference: Difference) -> bool:
    is_text = difference.is_about("comment", "body", "bodies", "text")
    trip = difference.trip
    return is_text and _list_texts(trip.old, difference.old) == _list_texts(
        trip.new, difference.new
    )


def _is_empty_text(difference: Difference) -> bool:
    change = difference.change
    return difference.is_about("text") and (change.before, change.after) in (("''", ""), ("", "''"))


# -- stereotypes -----------------------------------------------------------------------------------


def _list_stereotypes(graph: Graph, element: Element | None) -> list[Element]:
    sources = [] if element is None else graph.sources(element, Edge.SUBJECT)
    return [source for source in sources if source.kind is Kind.APPLICATION]


def _is_standard_stereotype(difference: Difference) -> bool:
    """Whether only stereotypes of SysML are missing, and role or kind are the same."""
    old, new = difference.old, difference.new
    if not difference.is_about("stereotype") or old is None or new is None:
        return False
    names = [a for a in _list_stereotypes(difference.trip.old, old) if not is_standard(a)]
    others = _list_stereotypes(difference.trip.new, new)
    is_same_role = old.role == new.role or old.kind is Kind.ENUMERATION
    return len(names) == len(others) and old.kind is new.kind and is_same_role


def _is_standard_tag(difference: Difference) -> bool:
    """Whether the tag belongs to a stereotype of SysML that the text expresses by a keyword."""
    match = re.match(r"«(.+)» ", difference.change.aspect)
    applications = _list_stereotypes(difference.trip.old, difference.old)
    names = {str(a.attrs.get("stereotype") or a.name) for a in applications if is_standard(a)}
    return bool(match) and match[1] in names and not difference.change.after


# -- expressions -----------------------------------------------------------------------------------


def _is_same_expression(difference: Difference) -> bool:
    """Whether an expression is only spelled in another language, or the name of the language goes.

    The guard of a transition of UML is also a constraint that the transition owns. The result of a
    constraint definition is a constraint without a place for the original spelling.
    """
    if not difference.is_about("guard", "guard language", "constraint"):
        return False
    trip = difference.trip
    before, after = (
        _list_conditions(graph, element)
        for graph, element in ((trip.old, difference.old), (trip.new, difference.new))
    )
    return bool(before) and before == after


def _list_conditions(graph: Graph, element: Element | None) -> list[str]:
    """Return the guard of an element, or else its constraints, in one spelling if possible."""
    if element is None:
        return []
    constraints = [child for child in graph.owned(element) if child.kind is Kind.CONSTRAINT]
    guard = element.attrs.get("guard")
    texts = [str(constraint.attrs.get("body", "")) for constraint in constraints]
    texts = texts if guard is None else [str(guard)]
    try:
        return sorted(print_expression(parse_expression(text)) for text in texts)
    except ExpressionError:
        return sorted(texts)


def _is_body_in_sysml(difference: Difference) -> bool:
    return difference.is_about("language") and difference.change.before == "KerML"


def _is_unit(difference: Difference) -> bool:
    old = difference.old
    is_unit = old is not None and old.role in ("unit", "quantity kind")
    return is_unit and difference.is_about("type", "value of symbol")


# -- templates -------------------------------------------------------------------------------------


def _is_template_parameter(difference: Difference) -> bool:
    old, graph = difference.old, difference.trip.old
    owner = None if old is None else graph.owner(old)
    return any(e is not None and e.kind is Kind.TEMPLATE_PARAMETER for e in (old, owner))


def _has_type_of_template(difference: Difference) -> bool:
    """Whether the element refers to the type that a template parameter owns."""
    old, graph = difference.old, difference.trip.old
    if old is None or not difference.is_about("type", "calls"):
        return False
    targets = graph.targets(old, Edge.TYPED_BY) + graph.targets(old, Edge.CALLS)
    owners = [graph.owner(target) for target in targets]
    return any(owner is not None and owner.kind is Kind.TEMPLATE_PARAMETER for owner in owners)


# -- activities ------------------------------------------------------------------------------------


def _is_moved_object_flow(difference: Difference) -> bool:
    """Whether an object flow has another owner or other ends.

    The comparison pairs the flows of a namespace with those that are most similar.
    """
    if difference.kind is not Kind.OBJECT_FLOW:
        return False
    return not difference.change.aspect or difference.is_about("ends")


def _is_parameter_node(difference: Difference) -> bool:
    return difference.kind is Kind.ACTIVITY_PARAMETER


def _is_allocation_by_partition(difference: Difference) -> bool:
    is_partition = difference.kind is Kind.PARTITION and difference.is_about("stereotype")
    return is_partition or (difference.kind is Kind.ACTION and difference.is_about("allocated-to"))


def _is_second_parameter_node(difference: Difference) -> bool:
    """Whether the parameter is inout, so that it has two nodes in the model."""
    old, graph = difference.old, difference.trip.old
    if old is None or old.kind is not Kind.ACTIVITY_PARAMETER:
        return False
    parameter = graph.target(old, Edge.REFERENCES)
    nodes = [] if parameter is None else graph.sources(parameter, Edge.REFERENCES)
    return sum(node.kind is Kind.ACTIVITY_PARAMETER for node in nodes) > 1


def _is_second_start(difference: Difference) -> bool:
    """Whether a behaviour has several initial nodes, of which the text knows one."""
    old, graph = difference.old, difference.trip.old
    if old is None or (difference.change.aspect and not difference.is_about("ends", "name")):
        return False
    source = graph.target(old, Edge.FLOW_SOURCE)
    start = old if source is None else source
    if start.kind not in (Kind.CONTROL, Kind.PSEUDOSTATE) or start.subkind != "initial":
        return False
    owner = graph.owner(start)
    if owner is not None and owner.kind is Kind.REGION:
        owner = graph.owner(owner)
    members = [] if owner is None else graph.owned(owner)
    regions = [member for member in members if member.kind is Kind.REGION]
    nodes = [*members, *(node for region in regions for node in graph.owned(region))]
    return sum((n.kind, n.subkind) == (start.kind, "initial") for n in nodes) > 1


def _has_lost_end(difference: Difference) -> bool:
    """Whether a flow or transition is removed whose source or target the model does not have."""
    old, graph = difference.old, difference.trip.old
    flows = (Kind.CONTROL_FLOW, Kind.OBJECT_FLOW, Kind.TRANSITION)
    if old is None or not _is_removed(*flows)(difference):
        return False
    return not (graph.targets(old, Edge.FLOW_SOURCE) and graph.targets(old, Edge.FLOW_TARGET))


def _is_idle_start_or_end(difference: Difference) -> bool:
    """Whether no flow with both ends leaves an initial node or enters a final node."""
    old, graph = difference.old, difference.trip.old
    if old is None or not _is_removed(Kind.CONTROL, Kind.PSEUDOSTATE)(difference):
        return False
    edges = (Edge.FLOW_SOURCE, Edge.FLOW_TARGET)
    flows = [flow for edge in edges for flow in graph.sources(old, edge)]
    has_flow = any(all(graph.targets(flow, edge) for edge in edges) for flow in flows)
    return old.subkind in ("initial", "final", "flow-final") and not has_flow


def _is_second_end(difference: Difference) -> bool:
    """Whether a final node is removed, or a flow leads to one, that shares ``done`` with others."""
    old, graph = difference.old, difference.trip.old
    if old is None or (difference.change.aspect and not difference.is_about("ends")):
        return False
    end = graph.target(old, Edge.FLOW_TARGET) or old
    owner = graph.owner(end)
    siblings = [] if owner is None else graph.owned(owner)
    finals = [e for e in siblings if e.subkind in ("final", "flow-final")]
    return end.kind is Kind.CONTROL and end in finals and len(finals) > 1


def _is_flow_of_action(difference: Difference) -> bool:
    """Whether an object flow leads to or from an action itself, or a pin is added for it."""
    trip = difference.trip
    edges = (Edge.FLOW_SOURCE, Edge.FLOW_TARGET)
    if difference.old is None:
        owners = trip.old_by_name.get(difference.change.owner, [])
        flows = [flow for o in owners for edge in edges for flow in trip.old.sources(o, edge)]
        is_pin = difference.kind is Kind.PIN
        return is_pin and any(flow.kind is Kind.OBJECT_FLOW for flow in flows)
    ends = [trip.old.target(difference.old, edge) for edge in edges]
    is_of_action = any(end is not None and end.kind is Kind.ACTION for end in ends)
    return difference.kind is Kind.OBJECT_FLOW and is_of_action and difference.is_about("ends")


def _is_undeclared_tag(difference: Difference) -> bool:
    """Whether an attribute is added to a stereotype that does not declare this tag."""
    trip = difference.trip
    if difference.old is not None or difference.kind is not Kind.PROPERTY:
        return False
    stereotypes = trip.old_by_name.get(difference.change.owner, [])
    return any(
        f"tag.{difference.change.name}" in application.attrs
        for stereotype in stereotypes
        for application in trip.old.sources(stereotype, Edge.INSTANCE_OF)
    )


def _is_empty_partition(difference: Difference) -> bool:
    """Whether a partition is removed that contains no node, nor does a partition in it."""
    old, graph = difference.old, difference.trip.old
    if old is None or not _is_removed(Kind.PARTITION)(difference):
        return False
    return not any(graph.sources(element, Edge.IN_PARTITION) for element in graph.subtree(old))


def _has_single_parameter(difference: Difference) -> bool:
    """Whether a parameter node without a parameter is involved, which becomes a parameter."""
    graph = difference.trip.old
    owners = [difference.old] if difference.old else []
    owners += difference.trip.old_by_name.get(difference.change.owner, [])
    nodes = [*owners, *(child for owner in owners for child in graph.owned(owner))]
    names = [
        node.name
        for node in nodes
        if node.kind is Kind.ACTIVITY_PARAMETER and not graph.targets(node, Edge.REFERENCES)
    ]
    if difference.kind is Kind.ACTIVITY:
        return bool(names) and difference.is_about("order")
    is_parameter = difference.kind in (Kind.PARAMETER, Kind.ACTIVITY_PARAMETER)
    return is_parameter and difference.change.name in names


def _has_type_of_parameter(difference: Difference) -> bool:
    """Whether an untyped pin has the type of a parameter of the behaviour that is called."""
    old, new, graph = difference.old, difference.new, difference.trip.new
    if old is None or new is None or new.kind is not Kind.PIN or not difference.is_about("type"):
        return False
    action = graph.owner(new)
    called = [] if action is None else graph.targets(action, Edge.CALLS)
    parameters = [child for target in called for child in graph.owned(target)]
    types = [graph.targets(p, Edge.TYPED_BY) for p in parameters if p.kind is Kind.PARAMETER]
    is_untyped = not difference.trip.old.targets(old, Edge.TYPED_BY)
    return is_untyped and graph.targets(new, Edge.TYPED_BY) in types


def _is_event_of_message(difference: Difference) -> bool:
    """Whether the text adds events to the messages of an interaction that has none."""
    old, new, trip = difference.old, difference.new, difference.trip
    if old is not None and old.kind is Kind.MESSAGE:
        has_events = trip.old.targets(old, Edge.SEND_EVENT) + trip.old.targets(
            old, Edge.RECEIVE_EVENT
        )
        return difference.is_about("send-event", "receive-event") and not has_events
    if new is None or old is not None or new.kind is not Kind.OCCURRENCE:
        return False
    interactions = trip.old_by_name.get(difference.change.owner, [])
    members = [member for interaction in interactions for member in trip.old.owned(interaction)]
    edges = (Edge.SEND_EVENT, Edge.RECEIVE_EVENT)
    is_of_message = any(trip.new.sources(new, edge) for edge in edges)
    return is_of_message and all(member.kind is not Kind.OCCURRENCE for member in members)


def _is_same_time(difference: Difference) -> bool:
    """Whether only white space between the number and the unit of a time differs."""
    texts = ["".join(text.split()) for text in (difference.change.before, difference.change.after)]
    is_time = difference.change.before.startswith("time ") and texts[0] == texts[1]
    return is_time and difference.is_about("trigger")


def _has_same_statements(difference: Difference) -> bool:
    """Whether a body consists of the same statements, or the name of its language goes."""
    old, new = difference.old, difference.new
    if old is None or new is None or not difference.is_about("body", "language"):
        return False
    bodies = [str(element.attrs.get("body", "")) for element in (old, new)]
    try:
        before, after = (parse_effect(body) for body in bodies)
    except ExpressionError:
        return False
    return before == after


# -- moved and omitted elements --------------------------------------------------------------------


def _is_removed(*kinds: Kind) -> Callable[[Difference], bool]:
    return lambda d: d.change.what is What.REMOVED and d.kind in kinds


def _is_added_or_removed(*kinds: Kind) -> Callable[[Difference], bool]:
    return lambda d: d.change.what in (What.ADDED, What.REMOVED) and d.kind in kinds


def _is_of(kind: Kind, *aspects: str) -> Callable[[Difference], bool]:
    return lambda d: d.kind is kind and d.is_about(*aspects)


def _is_attribute(*aspects: str) -> Callable[[Difference], bool]:
    return lambda d: d.is_about(*aspects) and not d.change.after


def _is_import_from_outside(difference: Difference) -> bool:
    """Whether all imports of elements of the model are in the text."""
    old, new = difference.old, difference.new
    if not difference.is_about("import") or old is None or new is None:
        return False
    trip = difference.trip
    imports = [child for child in trip.old.owned(old) if child.kind is Kind.IMPORT]
    targets = [t for child in imports for t in trip.old.targets(child, Edge.REFERENCES)]
    inside = [target for target in targets if not target.attrs.get("external")]
    return len(inside) <= sum(child.kind is Kind.IMPORT for child in trip.new.owned(new))


def _is_untyped_feature(difference: Difference) -> bool:
    """Whether a stereotype of SysML is missing from a feature without a type."""
    old, graph = difference.old, difference.trip.old
    is_feature = old is not None and old.kind in (Kind.PROPERTY, Kind.PORT)
    if old is None or not is_feature or not difference.is_about("stereotype"):
        return False
    return not graph.targets(old, Edge.TYPED_BY)


def _is_directed_feature(difference: Difference) -> bool:
    """Whether a flow property of a block is read as a directed feature, with its direction."""
    old, new = difference.old, difference.new
    if old is None or new is None or not difference.is_about("stereotype"):
        return False
    is_flow_property = old.role == "flow property" and old.kind is Kind.PROPERTY
    return is_flow_property and old.attrs.get("direction") == new.attrs.get("direction")


def _has_usage_as_type(difference: Difference) -> bool:
    """Whether the type is a behaviour of a class, which the text writes as a usage."""
    old, graph = difference.old, difference.trip.old
    if old is None or not difference.is_about("type"):
        return False
    types = graph.targets(old, Edge.TYPED_BY)
    owners = [graph.owner(type_) for type_ in types if type_.kind in BEHAVIOURS]
    return any(owner is not None and owner.kind is Kind.CLASS for owner in owners)


def _is_represented(difference: Difference) -> bool:
    """Whether an interaction owns the element for a lifeline that represents it."""
    old, graph = difference.old, difference.trip.old
    lifelines = [] if old is None else graph.sources(old, Edge.REPRESENTS)
    return any(lifeline.kind is Kind.LIFELINE for lifeline in lifelines)


def _has_inherited_type(difference: Difference) -> bool:
    """Whether an untyped feature has the type or direction of the feature that it subsets."""
    old, new = difference.old, difference.new
    if old is None or new is None or not difference.is_about("type", "direction"):
        return False
    graph = difference.trip.new
    types = [
        type_
        for edge in (Edge.SUBSETS, Edge.REDEFINES)
        for general in graph.targets(new, edge)
        for type_ in graph.targets(general, Edge.TYPED_BY)
    ]
    is_untyped = not difference.trip.old.targets(old, Edge.TYPED_BY)
    return is_untyped and bool(types) and graph.targets(new, Edge.TYPED_BY) == types


def _is_about_element_groups(difference: Difference) -> bool:
    groups = set(difference.change.before.split(", "))
    return difference.is_about("comment") and groups == {"role: element group"}


def _has_qualified_stereotype(difference: Difference) -> bool:
    """Whether the name of an applied stereotype is the end of its definition's name."""
    graph = difference.trip.old
    if not re.match("stereotype|«", difference.change.aspect):
        return False
    return any(
        definition.name.endswith(f"::{application.attrs.get('stereotype')}")
        for application in _list_stereotypes(graph, difference.old)
        for definition in graph.targets(application, Edge.INSTANCE_OF)
    )


def _is_id_as_tag(difference: Difference) -> bool:
    """Whether a tagged value is the id of an element of the model that has no name."""
    element = difference.trip.old.get(difference.change.after)
    is_tag = difference.change.aspect.startswith("«")
    return is_tag and element is not None and not element.name


def _is_beside_omitted_connector(difference: Difference) -> bool:
    """Whether the text has all connectors of the owner except those with an end without a name.

    The comparison pairs an omitted connector with a similar one of the text.
    """
    old, trip = difference.old, difference.trip
    owner = None if old is None else trip.old.owner(old)
    if old is None or owner is None or old.kind is not Kind.CONNECTOR:
        return False
    path = trip.old.qualified_name(owner)
    others = [e for e in trip.new.of_kind(owner.kind) if trip.new.qualified_name(e) == path]
    kept = [
        connector
        for connector in _list_connectors(trip.old, [owner])
        if not any(loss.startswith("SM736 end") for loss in trip.list_losses(connector))
    ]
    before = Counter(_list_end_names(trip.old, connector) for connector in kept)
    return before == Counter(
        _list_end_names(trip.new, connector) for connector in _list_connectors(trip.new, others)
    )


def _list_connectors(graph: Graph, owners: list[Element]) -> list[Element]:
    return [c for owner in owners for c in graph.owned(owner) if c.kind is Kind.CONNECTOR]


def _list_end_names(graph: Graph, connector: Element) -> tuple[tuple[str, ...], ...]:
    """Return the paths of names to the roles of a connector, sorted."""
    return tuple(
        sorted(
            tuple(step.name for edge in (Edge.PATH, Edge.ROLE) for step in graph.targets(end, edge))
            for end in graph.targets(connector, Edge.END)
        )
    )


def _is_redundant_alias(difference: Difference) -> bool:
    """Whether only aliases are missing that equal the names of the imported elements."""
    old, graph = difference.old, difference.trip.old
    imports = [] if old is None else [e for e in graph.owned(old) if e.kind is Kind.IMPORT]
    aliases = [e for e in imports if "alias" in e.attrs]
    before = re.sub(r"; alias: \w+", "", difference.change.before)
    return (
        difference.is_about("import")
        and before == difference.change.after
        and all(
            target.name == import_.attrs["alias"]
            for import_ in aliases
            for target in graph.targets(import_, Edge.REFERENCES)
        )
    )


REASONS: list[Reason] = [
    Reason(
        "SysML v2 removes white space around the lines of a comment (KerML 1.0, 8.2.3.3.2)",
        _has_equal_texts,
        r"SM734 (white space|'\*/' in a text)",
    ),
    Reason("an empty text is not written", _is_empty_text),
    Reason(
        "a keyword of SysML v2 expresses the stereotype of SysML; the role is the same",
        _is_standard_stereotype,
        "SM734 an applied stereotype of SysML",
    ),
    Reason(
        "SysML v2 has no keyword for a value, constraint or flow port without a type",
        _is_untyped_feature,
        "SM734 an applied stereotype of SysML",
    ),
    Reason(
        "a flow property of a block is a directed feature of SysML v2",
        _is_directed_feature,
        "SM734 an applied stereotype of SysML",
    ),
    Reason("a type that is a usage of SysML v2 is subsetted", _has_usage_as_type),
    Reason(
        "a keyword, an attribute or a relation expresses the tag of a stereotype of SysML",
        _is_standard_tag,
        "SM734 an applied stereotype of SysML",
    ),
    Reason(
        "a condition that SysML v2 spells differently is the same expression",
        _is_same_expression,
    ),
    Reason("a body in the language of SysML v2 consists of actions", _is_body_in_sysml),
    Reason(
        "a unit is a SimpleUnit of the standard library; its short name is its symbol",
        _is_unit,
    ),
    Reason(
        "SysML v2 has no templates: the type of a template parameter stands in its place",
        _is_template_parameter,
        "SM730 TemplateParameter",
    ),
    Reason(
        "SysML v2 has no templates: features have the type that stands for a template parameter",
        _has_type_of_template,
    ),
    Reason(
        "SysML v2 has no templates: their bindings are omitted",
        _is_attribute("template binding"),
        "SM730 TemplateBinding",
    ),
    Reason(
        "a flow of SysML v2 stands where the text can name both its ends",
        _is_moved_object_flow,
        "SM734 (a flow that another node owns|the owner of an object flow)",
        is_in_behaviour=True,
    ),
    Reason(
        "a parameter of SysML v2 is one feature: all flows of an inout parameter have one node",
        _is_moved_object_flow,
        "SM734 the second node of an inout parameter",
        is_in_behaviour=True,
    ),
    Reason(
        "a parameter of SysML v2 is one feature: its node has the type of the parameter",
        lambda d: _is_parameter_node(d) and d.is_about("type"),
        "SM734 a parameter node without a type",
    ),
    Reason(
        "a parameter of SysML v2 is one feature: an inout parameter has one node, not two",
        _is_second_parameter_node,
    ),
    Reason(
        "SysML v2 has no partitions: metadata names them without stereotypes and allocations",
        _is_allocation_by_partition,
        "SM730 Application",
        is_in_behaviour=True,
    ),
    Reason(
        "a decision of SysML v2 does not name the flow of its input",
        _is_attribute("decision input flow"),
        "SM732 decision_input_flow",
    ),
    Reason(
        "elements outside the model, of which only the id is known, are no ends of connectors",
        _is_removed(Kind.CONNECTOR),
        "SM736 end",
    ),
    Reason(
        "a default value that is an element outside the model has no name",
        _is_attribute("default instance"),
        "SM732 default_instance",
    ),
    Reason(
        "an item flow stands in the namespace of the connector that realises it",
        _is_added_or_removed(Kind.ITEM_FLOW),
        "SM734 the owner of an item flow",
    ),
    Reason(
        "the text imports no element outside the model that nothing else uses",
        _is_import_from_outside,
        "SM73[46] (an import of primitive types|the import of the library|references Import)",
    ),
    Reason(
        "a satisfaction or allocation stands in the definition that has its ends",
        _is_added_or_removed(Kind.DEPENDENCY),
        "SM734 the owner of a dependency",
    ),
    Reason(
        "a dependency with an end that has no name in the text is omitted",
        lambda d: _is_removed(Kind.DEPENDENCY)(d) or d.is_about("depends", "satisfies", "traces"),
        "SM736 (client|supplier)",
    ),
    Reason(
        "a lifeline of SysML v2 is a part of the interaction itself",
        lambda d: _is_represented(d) or _is_of(Kind.LIFELINE, "represents", "type", "kind")(d),
        "SM734 what a lifeline represents",
    ),
    Reason(
        "SysML v2 has no collaborations: their uses are omitted",
        lambda d: (
            _is_removed(Kind.COLLABORATION_USE)(d)
            or (d.new is not None and d.new.subkind == "role-binding")
        ),
        "SM730 CollaborationUse",
    ),
    Reason(
        "a time without a unit is in seconds",
        lambda d: d.is_about("trigger") and d.change.after == f"{d.change.before} s",
    ),
    Reason(
        "a binding that has no name for one of its ends is omitted",
        _is_attribute("binds"),
        "SM736 end",
    ),
    Reason(
        "a step waits for all flows except those with false guards: a merge stands before it",
        lambda d: d.kind in (Kind.CONTROL, Kind.CONTROL_FLOW),
        "SM734 a step that waits for several flows",
        is_in_behaviour=True,
    ),
    Reason(
        "a text that is not an expression becomes an attribute of that name",
        lambda d: d.kind is Kind.PROPERTY and d.change.what is What.ADDED,
        "SM735",
        is_in_behaviour=True,
    ),
    Reason(
        "a property of an enumeration stands beside it: enumerations own only their values",
        _is_added_or_removed(Kind.PROPERTY, Kind.INSTANCE, Kind.CONSTRAINT),
        "SM734 the owner of .* in an enumeration",
    ),
    Reason(
        "SysML v2 has no exception handlers",
        _is_attribute("handlers"),
        "SM732 handlers",
    ),
    Reason(
        "a reference to an element without a name in the text is omitted",
        _is_attribute(
            "references", "calls", "subsets", "represents", "covers", "type", "specializes"
        ),
        "SM73[16] (references|calls|subsets|represents|covers|typed-by|specializes)",
    ),
    Reason(
        "elements outside the model that have one name are one element",
        _is_attribute("applies"),
        "SM731 applies",
    ),
    Reason(
        "a behaviour of SysML v2 has one start, at which the flows of all initial nodes begin",
        _is_second_start,
        "SM73(7 an|4 one of several) initial",
        is_in_behaviour=True,
    ),
    Reason(
        "a pseudostate of a state belongs to the only region of the state",
        lambda d: (
            (d.kind in (Kind.PSEUDOSTATE, Kind.REGION) and not d.change.aspect)
            or (d.kind is Kind.TRANSITION and d.is_about("ends"))
        ),
        "SM734 a pseudostate that no region owns",
        is_in_behaviour=True,
    ),
    Reason(
        "SysML v2 has no execution specifications",
        _is_removed(Kind.EXECUTION),
        "SM730 Execution",
    ),
    Reason("a guard of SysML v2 has no name", _is_attribute("constraint name"), "SM737 a guard"),
    Reason(
        "a feature of SysML v2 has the type of the feature that it subsets", _has_inherited_type
    ),
    Reason(
        "SysML v2 has no element groups: a group is a comment about its members",
        _is_about_element_groups,
        "SM734 an element group",
    ),
    Reason(
        "a comment of a comment is about the same elements",
        lambda d: d.is_about("comment"),
        "SM734 a comment about a comment",
    ),
    Reason(
        "metadata has the full name of its definition, the model only the end",
        _has_qualified_stereotype,
    ),
    Reason(
        "a tagged value that is an element without a name is its id",
        _is_id_as_tag,
        "SM734 a tagged value that refers to an element without a name",
    ),
    Reason(
        "a connector beside one that the text omits is compared with that one",
        _is_beside_omitted_connector,
    ),
    Reason("an alias that equals the name says nothing", _is_redundant_alias),
    Reason(
        "in the library ISQ, a unit determines its quantity kind",
        lambda d: d.is_about("quantity kind name", "unit"),
        "SM734 a quantity kind that has other units",
    ),
    Reason(
        "an object flow that does not pass a control node has no guard",
        _is_attribute("guard", "guard literal"),
        "SM732 guard",
    ),
    Reason(
        "a flow of which the model has no source or no target is omitted",
        _has_lost_end,
        "SM736 flow",
    ),
    Reason(
        "every behaviour has start and done: initial and final nodes without flows are omitted",
        _is_idle_start_or_end,
    ),
    Reason(
        "metadata has values of declared attributes: the text declares tags of unread stereotypes",
        _is_undeclared_tag,
    ),
    Reason(
        "several final nodes that end nothing else are one done of SysML v2",
        _is_second_end,
        "SM734 one of several final nodes",
        is_in_behaviour=True,
    ),
    Reason(
        "an object flow of SysML v2 has pins at its ends: an action at an end gets one",
        _is_flow_of_action,
        "SM734 an object flow of an action",
        is_in_behaviour=True,
    ),
    Reason(
        "an item flow between features of types, without a connector, has no path to its ends",
        _is_removed(Kind.ITEM_FLOW),
        "SM736 flow ends ItemFlow",
    ),
    Reason(
        "SysML v2 has no partitions: one without nodes is omitted",
        _is_empty_partition,
        "SM730 Partition",
    ),
    Reason(
        "a parameter node without a parameter becomes a parameter",
        _has_single_parameter,
        "SM734 a parameter node without a parameter",
    ),
    Reason(
        "a pin of SysML v2 redefines a parameter and has its type",
        _has_type_of_parameter,
    ),
    Reason(
        "a state of SysML v2 does not defer events",
        _is_of(Kind.STATE, "trigger"),
        "SM732 deferred Trigger",
    ),
    Reason(
        "an action of SysML v2 that accepts something unnamed accepts any event",
        lambda d: d.is_about("trigger") and (d.change.before, d.change.after) == ("", "any"),
        "SM734 a trigger without an event",
    ),
    Reason("a message of SysML v2 with ends has events at them", _is_event_of_message),
    Reason("a time is the same if its unit is spelled apart", _is_same_time),
    Reason("a body that SysML v2 spells as actions has the same statements", _has_same_statements),
    Reason(
        "messages of SysML v2 have no events of their own",
        lambda d: (
            d.kind in (Kind.OCCURRENCE, Kind.MESSAGE, Kind.LIFELINE)
            or (d.kind is Kind.INTERACTION and d.is_about("order"))
        ),
        "SM734 (the|an) events? of a message",
        is_in_behaviour=True,
    ),
]
