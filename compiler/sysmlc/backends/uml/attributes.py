"""Attributes of elements: as XML attributes, as texts, or as value specifications."""

from collections.abc import Callable

from sysmlc.backends.uml.context import Context
from sysmlc.backends.uml.events import find_or_add_signature
from sysmlc.backends.uml.features import find_attribute_feature, to_camel_case
from sysmlc.backends.uml.node import Node
from sysmlc.backends.uml.rules import IMMEDIATE
from sysmlc.backends.uml.sysml_profile import iter_applications
from sysmlc.backends.uml.values import (
    add_expression,
    add_literal,
    add_text,
    fill_packaged_value,
    format_value,
    read_bodies,
    write_bodies,
    write_guard,
    write_multiplicity,
    write_value,
)
from sysmlc.ir import AttrValue, Edge, Element, Kind, as_items, list_items
from sysmlc.ir.query import flow_properties, is_requirement, type_of

_Writer = Callable[[Context, Element, str, AttrValue], None]

_DERIVED_NAMES = """
    role level origin unresolved lineage message_kind path_multiplicity item_property usage
    property_specific req_id text external href library qualified_name stereotype namespace on
    subject_name token_rules"""
_DERIVED = frozenset(_DERIVED_NAMES.split())
"""Attributes that passes derive, or that belong to stereotype applications."""
_FROM_TAGS_NAMES = """encapsulated rate probability no_buffer overwrite distribution
    criterion source_context source_path target_context target_path feature_direction symbol
    description definition_uri domain"""
_FROM_TAGS = frozenset(_FROM_TAGS_NAMES.split())
"""Attributes that passes derive from tags of applications, or from slots of units."""
_PATHS = ("source_path", "target_path")
_STORED = frozenset({"unit", "language", "unresolved"})
"""Attributes that UML expresses only in part, so that a plant stores them for the way back."""
_DEFAULT_MULTIPLICITY = ("multiplicity", "1")
_COMPANIONS = ("_language", "_languages", "_bodies", "_instance", "_literal")
"""Ends of attributes that belong to the attribute with the rest of the name."""
_VALUE_FEATURES = {
    Kind.INSTANCE: "specification",
    Kind.ENUMERATION_LITERAL: "specification",
    Kind.TEMPLATE_SUBSTITUTION: "ownedActual",
}
"""The feature for ``value``, of other kinds ``value``."""


def write_attributes(context: Context, element: Element) -> None:
    """Write all attributes of an element."""
    round_trip = context.losses.round_trip
    for key, value in element.attrs.items():
        writer = _WRITERS.get(key)
        if writer is not None:
            writer(context, element, key, value)
            # UML omits the default, and a reader cannot tell it from an absent multiplicity.
            if (key, value) == _DEFAULT_MULTIPLICITY and round_trip is not None:
                round_trip.store_attribute(element, key)
        elif not _is_expressed_otherwise(context, element, key):
            _write_feature(context, element, key, value)
        elif key in _STORED and round_trip is not None:
            round_trip.store_attribute(element, key)
    if _is_bound_pin(element):
        context.losses.record_attribute(element, "value_kind")
    language = element.attrs.get("language")
    if language and "body" not in element.attrs and element.kind is not Kind.CONSTRAINT:
        # An opaque element without a body.
        context.find_node(element).add(Node("language", text=format_value(language)))


def _is_bound_pin(element: Element) -> bool:
    """Whether a pin equals a value that may change, which UML evaluates only at the start."""
    attrs = element.attrs
    return (
        element.kind is Kind.PIN
        and "value" in attrs
        and "value_kind" not in attrs
        and not isinstance(attrs["value"], bool | int | float)
        and "value_literal" not in attrs
    )


def _is_expressed_otherwise(context: Context, element: Element, key: str) -> bool:
    """Whether another attribute, an application or a pass accounts for the attribute."""
    if key in _DERIVED or key.endswith(_COMPANIONS):
        return True
    if key in ("languages", "bodies", "language"):
        return True
    if key == "unit" and element.role == "value type":
        return True
    if key == "value_kind" and element.kind is Kind.PIN:
        # The value of a ValuePin is evaluated when the action starts.
        return element.attrs[key] == "initial"
    return key in _FROM_TAGS and _has_tags(context, element, key)


def _has_tags(context: Context, element: Element, key: str) -> bool:
    """Whether the source of a derived attribute is written: tags, slots or item flows."""
    is_flow = element.kind in (Kind.ITEM_FLOW, Kind.CONNECTOR) and key not in _PATHS
    is_unit = element.role in ("unit", "quantity kind")
    return is_flow or is_unit or any(iter_applications(context.graph, element))


def _write_feature(context: Context, element: Element, key: str, value: AttrValue) -> None:
    """Write an attribute as a feature: references, texts or one XML attribute."""
    feature = find_attribute_feature(key)
    if not feature:
        name = "tagged values without stereotype" if key.startswith("tag.") else key
        context.losses.record_attribute(element, name)
    elif not _write_references(context, element, key, feature, value):
        node = context.find_node(element)
        if isinstance(value, tuple):
            for item in value:
                node.add(Node(feature, text=format_value(item)))
        else:
            node.attributes[feature] = format_value(value)


def _write_references(
    context: Context, element: Element, key: str, feature: str, value: AttrValue
) -> bool:
    """Write a value that consists of ids as references; return whether it does."""
    ids = as_items(value)
    targets = [context.graph.get(id) if isinstance(id, str) else None for id in ids]
    elements = [target for target in targets if target is not None]
    if not elements or len(elements) < len(targets):
        return False
    context.write_references(element, context.find_node(element), feature, elements, key)
    return True


def _join_ids(context: Context, values: AttrValue) -> str:
    """Return the ids in the file of those elements that are written."""
    ids = [str(id) for id in as_items(values)]
    return " ".join(context.ids[id] for id in ids if id in context.nodes)


# -- values ------------------------------------------------------------------------------------


def _write_bounds(context: Context, element: Element, _key: str, value: AttrValue) -> None:
    if value != "1":
        write_multiplicity(context, element)


def _write_default(context: Context, element: Element, key: str, value: AttrValue) -> None:
    if element.kind is not Kind.TEMPLATE_PARAMETER:
        write_value(context, element, key, "defaultValue")
    elif not _write_references(context, element, key, "default", value):
        write_value(context, element, key, "ownedDefault")


def _write_any_value(context: Context, element: Element, key: str, value: AttrValue) -> None:
    if element.kind is Kind.EXPRESSION:
        fill_packaged_value(context, element)
    elif element.kind is Kind.SLOT:
        node = context.find_node(element)
        for item in as_items(value):
            add_literal(context, element, node, "value", item)
    else:
        write_value(context, element, key, _VALUE_FEATURES.get(element.kind, "value"))


def _write_any_guard(context: Context, element: Element, _key: str, _value: AttrValue) -> None:
    """Write a guard that is stored as an attribute; a constraint as guard is an edge instead."""
    if element.kind in (Kind.CONTROL_FLOW, Kind.OBJECT_FLOW):
        write_guard(context, element)
    elif context.graph.target(element, Edge.GUARD) is None:
        _add_guard_constraint(context, element)


def _add_guard_constraint(context: Context, element: Element) -> None:
    """Add the constraint for a guard of which the graph has only the text."""
    node = context.find_node(element)
    if element.kind is Kind.OPERAND:
        constraint = context.add_part(element, node, "guard", "InteractionConstraint")
    else:
        constraint = context.add_part(element, node, "ownedRule", "Constraint")
        node.attributes["guard"] = constraint.id
    language = format_value(element.attrs.get("guard_language"))
    body = format_value(element.attrs.get("guard"))
    add_expression(context, element, constraint, "specification", body, language)


def _write_body(context: Context, element: Element, _key: str, value: AttrValue) -> None:
    attrs, node = element.attrs, context.find_node(element)
    body, language = format_value(value), format_value(attrs.get("language"))
    bodies = read_bodies(attrs) or ((body,), (language,))
    if element.kind is not Kind.CONSTRAINT:
        write_bodies(node, *bodies)
        return
    mark = _find_assumption_mark(context, element)
    if mark:
        texts, languages = bodies
        bodies = texts, tuple(f"{name or 'KerML'} {mark}" for name in languages)
    if element.subkind in ("duration", "time", "interval"):
        _write_interval(context, element, node, body, language)
    else:
        write_bodies(context.add_part(element, node, "specification", "OpaqueExpression"), *bodies)


def _find_assumption_mark(context: Context, constraint: Element) -> str:
    """Return ``assume`` or ``require`` for a constraint of a requirement with a subject.

    SysML v1 can mark an assumption only by the language of the constraint (docs/contracts.md).
    """
    requirement = context.graph.owner(constraint)
    if requirement is None or not is_requirement(requirement):
        return ""
    if not context.graph.targets(requirement, Edge.SUBJECT):
        return ""
    is_assumed = constraint in context.graph.targets(requirement, Edge.ASSUMES)
    return "assume" if is_assumed else "require"


def _write_interval(
    context: Context, element: Element, node: Node, body: str, language: str
) -> None:
    """Write the bounds of a time or duration constraint as one expression.

    In Eclipse UML, the bounds are further elements, which the graph does not have.
    """
    metaclass = "TimeExpression" if element.subkind == "time" else "Duration"
    time = context.add_part(element, node, "specification", metaclass)
    observations = _join_ids(context, element.attrs.get("observations", ()))
    if observations:
        time.attributes["observation"] = observations
    add_expression(context, element, time, "expr", body, language)


def _make_text_writer(tag: str) -> _Writer:
    def write_text(context: Context, element: Element, key: str, value: AttrValue) -> None:
        """Write a text as the expression that UML requires."""
        node, bodies = context.find_node(element), read_bodies(element.attrs, f"{key}_")
        if bodies is not None:
            write_bodies(context.add_part(element, node, tag, "OpaqueExpression"), *bodies)
        elif tag == "nameExpression":
            expression = context.add_part(element, node, tag, "StringExpression")
            expression.attributes["symbol"] = format_value(value)
        else:
            add_text(context, element, node, tag, value)

    return write_text


def _write_arguments(context: Context, element: Element, _key: str, value: AttrValue) -> None:
    for argument in as_items(value):
        add_text(context, element, context.find_node(element), "argument", argument)


def _make_literal_writer(tag: str) -> _Writer:
    def write_literal(context: Context, element: Element, _key: str, value: AttrValue) -> None:
        """Write a number; the guard of an operand has its bounds (UML 2.5.1 clause 17.6)."""
        node = context.find_node(element)
        if element.kind is Kind.OPERAND:
            guard = next((child for child in node.children if child.tag == "guard"), None)
            node = guard or context.add_part(element, node, "guard", "InteractionConstraint")
        add_literal(context, element, node, tag, value)

    return write_literal


# -- texts -------------------------------------------------------------------------------------


def _write_direction(context: Context, element: Element, key: str, value: AttrValue) -> None:
    """Write the direction of a parameter; count a direction that nothing in the file implies."""
    if element.kind in (Kind.PIN, Kind.ACTIVITY_PARAMETER, Kind.FLOW_PROPERTY):
        return
    if element.kind is Kind.PARAMETER:
        if value != "in":
            context.find_node(element).attributes["direction"] = format_value(value)
    elif element.role != "flow property" and not _is_direction_implied(context, element):
        context.losses.record_attribute(element, key)


def _is_direction_implied(context: Context, port: Element) -> bool:
    """Whether passes derive the direction from the rest of the model."""
    graph, type_ = context.graph, type_of(context.graph, port)
    if port.role == "flow port" or graph.targets(port, Edge.REDEFINES):
        return True
    if any(graph.sources(port, edge) for edge in (Edge.FLOW_SOURCE, Edge.FLOW_TARGET)):
        return True
    if type_ is None:
        return False
    features = graph.targets(type_, Edge.FEATURE)
    has_operations = any(feature.kind is Kind.OPERATION for feature in features)
    return has_operations or bool(flow_properties(graph, type_)) or _is_conjugate(context, type_)


def _is_conjugate(context: Context, type_: Element) -> bool:
    """Whether SysML's tag ``original`` makes the type a conjugated interface block."""
    applications = iter_applications(context.graph, type_)
    return any("tag.original" in application.attrs for application in applications)


_SUBKIND_FEATURES = {
    Kind.FRAGMENT: ("interactionOperator", "seq"),
    Kind.MESSAGE: ("messageSort", "synch-call"),
    Kind.PSEUDOSTATE: ("kind", "initial"),
    Kind.TRANSITION: ("kind", "external"),
}
"""The feature that expresses the subkind, and its default."""
_WITH_SUBKIND = frozenset(
    {"CombinedFragment", "ConsiderIgnoreFragment", "Message", "Pseudostate", "Transition"}
)
"""Metaclasses that have these features; others express the subkind themselves."""


def _write_subkind(context: Context, element: Element, _key: str, value: AttrValue) -> None:
    node = context.find_node(element)
    if element.kind in _SUBKIND_FEATURES and node.metaclass in _WITH_SUBKIND:
        feature, default = _SUBKIND_FEATURES[element.kind]
        if value != default:
            node.attributes[feature] = to_camel_case(format_value(value))


def _write_first_event(context: Context, element: Element, _key: str, value: AttrValue) -> None:
    """Write ``firstEvent``: one value for each end of a duration, a single one for a time."""
    node = context.find_node(element)
    if isinstance(value, tuple) or element.subkind == "duration":
        for item in as_items(value):
            node.add(Node("firstEvent", text=format_value(item)))
    else:
        node.attributes["firstEvent"] = format_value(value)


def _write_payload(context: Context, element: Element, key: str, value: AttrValue) -> None:
    """Write the name of a payload as the name of the trigger, by which guards refer to it."""
    if element.name:
        context.losses.record_attribute(element, key)
    else:
        context.find_node(element).attributes["name"] = format_value(value)


def _write_immediate(context: Context, element: Element, _key: str, value: AttrValue) -> None:
    """Report a trigger that UML lets wait longer than SysML v2."""
    if value is True:
        context.losses.record(IMMEDIATE, element)


def _write_nothing(context: Context, element: Element, key: str, value: AttrValue) -> None:
    """Write nothing: the event of the trigger or the value of the constraint expresses it."""


# -- records -----------------------------------------------------------------------------------


def _make_record_writer(tag: str, metaclass: str, *features: str) -> _Writer:
    def write_records(context: Context, element: Element, _key: str, value: AttrValue) -> None:
        """Write each record as a child; each column of a record lists ids for one feature."""
        node = context.find_node(element)
        for index, record in enumerate(list_items(value)):
            child = _find_or_add_record(context, element, node, tag, metaclass, index)
            for feature, ids in zip(features, list_items(record), strict=False):
                references = _join_ids(context, list_items(ids))
                if references:
                    child.attributes[feature] = references

    return write_records


def _find_or_add_record(
    context: Context, element: Element, node: Node, tag: str, metaclass: str, index: int
) -> Node:
    """Return the child of a record; another attribute of the element may have added it."""
    records = [child for child in node.children if child.tag == tag]
    if index < len(records):
        return records[index]
    if tag == "endData":
        ends = {"create-link": "LinkEndCreationData", "destroy-link": "LinkEndDestructionData"}
        metaclass = ends.get(element.subkind, metaclass)
    return context.add_part(element, node, tag, metaclass)


def _write_extended_signature(
    context: Context, element: Element, _key: str, value: AttrValue
) -> None:
    """Write ``extendedSignature``; the value has ids of templates, not of their signatures."""
    templates = [context.graph[str(id)] for id in as_items(value) if str(id) in context.nodes]
    ids = [find_or_add_signature(context, template).id for template in templates]
    if ids:
        signature = find_or_add_signature(context, element)
        signature.attributes["extendedSignature"] = " ".join(ids)


_WRITERS: dict[str, _Writer] = {
    "multiplicity": _write_bounds,
    "default": _write_default,
    "value": _write_any_value,
    "guard": _write_any_guard,
    "weight": _make_literal_writer("weight"),
    "body": _write_body,
    "join_spec": _make_text_writer("joinSpec"),
    "upper_bound": _make_text_writer("upperBound"),
    "name_expression": _make_text_writer("nameExpression"),
    "selector": _make_text_writer("selector"),
    "return_value": _make_text_writer("returnValue"),
    "arguments": _write_arguments,
    "min": _make_literal_writer("minint"),
    "max": _make_literal_writer("maxint"),
    "direction": _write_direction,
    "subkind": _write_subkind,
    "first_event": _write_first_event,
    "observations": _write_nothing,
    "when": _write_nothing,
    "condition": _write_nothing,
    "immediate": _write_immediate,
    "relative": _write_nothing,
    "deferred": _write_nothing,
    "payload": _write_payload,
    "clauses": _make_record_writer("clause", "Clause", "test", "body"),
    "clause_outputs": _make_record_writer("clause", "Clause", "decider", "bodyOutput"),
    "handlers": _make_record_writer(
        "handler", "ExceptionHandler", "handlerBody", "exceptionInput", "exceptionType"
    ),
    "link_ends": _make_record_writer("endData", "LinkEndData", "end", "value"),
    "extended_signature": _write_extended_signature,
}
