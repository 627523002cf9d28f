"""Attributes of elements: as XML attributes, as texts, or as value specifications."""

from collections.abc import Callable

from sysmlc.backends.uml import events, values
from sysmlc.backends.uml.book import Book
from sysmlc.backends.uml.meant import applications
from sysmlc.backends.uml.names import camel, feature_of
from sysmlc.backends.uml.node import Node
from sysmlc.backends.uml.rules import UNSAID_ATTRIBUTE
from sysmlc.ir import AttrValue, Edge, Element, Kind
from sysmlc.ir.query import flow_properties, type_of

_Writer = Callable[[Book, Element, str, AttrValue], None]

_OF_PASSES_NAMES = """
    role level origin unresolved lineage message_kind path_multiplicity item_property usage
    property_specific req_id text external href library qualified_name stereotype namespace on"""
_OF_PASSES = frozenset(_OF_PASSES_NAMES.split())
"""What passes work out again, or what stereotype applications hold."""
_OF_TAGS_NAMES = """encapsulated rate probability no_buffer overwrite distribution
    criterion source_context source_path target_context target_path feature_direction symbol
    description definition_uri domain"""
_OF_TAGS = frozenset(_OF_TAGS_NAMES.split())
"""What passes work out from tags of applications, or slots of units."""
_PATHS = ("source_path", "target_path")
_KEPT = frozenset({"unit", "language", "unresolved"})
"""What UML says in other words, and AutomationML in these too."""
_ONE = ("multiplicity", "1")
"""What UML says by silence."""
_SUFFIXES = ("_language", "_languages", "_bodies", "_instance", "_literal")
_VALUES = {
    Kind.INSTANCE: "specification",
    Kind.ENUMERATION_LITERAL: "specification",
    Kind.TEMPLATE_SUBSTITUTION: "ownedActual",
}


def write(book: Book, element: Element) -> None:
    """Write all attributes of an element whose node is made."""
    for key, given in element.attrs.items():
        writer = _WRITERS.get(key)
        if writer is not None:
            writer(book, element, key, given)
            if (key, given) == _ONE and book.losses.kept is not None:
                book.losses.kept.attribute(element, key)
        elif not _is_said_otherwise(book, element, key):
            _plain(book, element, key, given)
        elif key in _KEPT and book.losses.kept is not None:
            book.losses.kept.attribute(element, key)
    if "body" not in element.attrs and element.kind is not Kind.CONSTRAINT:
        _language(book, element)


def _is_said_otherwise(book: Book, element: Element, key: str) -> bool:
    if key in _OF_PASSES or any(key.endswith(suffix) for suffix in _SUFFIXES):
        return True
    if key in ("languages", "bodies", "language"):
        return True
    if key == "unit" and element.role == "value type":
        return True
    return key in _OF_TAGS and _has_meaning(book, element, key)


def _has_meaning(book: Book, element: Element, key: str) -> bool:
    is_flow = element.kind in (Kind.ITEM_FLOW, Kind.CONNECTOR) and key not in _PATHS
    is_unit = element.role in ("unit", "quantity kind")
    return is_flow or is_unit or any(applications(book.graph, element))


def _plain(book: Book, element: Element, key: str, given: AttrValue) -> None:
    feature = feature_of(key)
    if not feature:
        name = "tagged values without stereotype" if key.startswith("tag.") else key
        book.losses.note(UNSAID_ATTRIBUTE, element, attribute=name, kind=str(element.kind))
    elif not _references(book, element, key, feature, given):
        node = book.node(element)
        if isinstance(given, tuple):
            for one in given:
                node.add(Node(feature, text=values.shown(one)))
        else:
            node.attributes[feature] = values.shown(given)


def _references(book: Book, element: Element, key: str, feature: str, given: AttrValue) -> bool:
    named = given if isinstance(given, tuple) else (given,)
    found = [book.graph.get(one) if isinstance(one, str) else None for one in named]
    targets = [one for one in found if one is not None]
    if not targets or len(targets) < len(found):
        return False
    book.refer(element, book.node(element), feature, targets, key)
    return True


# -- values ------------------------------------------------------------------------------------


def _bounds(book: Book, element: Element, _key: str, given: AttrValue) -> None:
    if given != "1":
        values.bounds(book, element)


def _default(book: Book, element: Element, key: str, given: AttrValue) -> None:
    if element.kind is not Kind.TEMPLATE_PARAMETER:
        values.value(book, element, key, "defaultValue")
    elif not _references(book, element, key, "default", given):
        values.value(book, element, key, "ownedDefault")


def _value(book: Book, element: Element, key: str, given: AttrValue) -> None:
    if element.kind is Kind.EXPRESSION:
        values.packaged(book, element)
    elif element.kind is Kind.SLOT:
        for one in given if isinstance(given, tuple) else (given,):
            values.literal(book, element, book.node(element), "value", one)
    else:
        values.value(book, element, key, _VALUES.get(element.kind, "value"))


def _guard(book: Book, element: Element, _key: str, _given: AttrValue) -> None:
    if element.kind in (Kind.CONTROL_FLOW, Kind.OBJECT_FLOW):
        values.guard(book, element)
    elif book.graph.target(element, Edge.GUARD) is None:
        _own_guard(book, element)


def _own_guard(book: Book, element: Element) -> None:
    """A guard that only a text says needs a constraint that holds it."""
    node = book.node(element)
    if element.kind is Kind.OPERAND:
        rule = book.part(element, node, "guard", "InteractionConstraint")
    else:
        rule = book.part(element, node, "ownedRule", "Constraint")
        node.attributes["guard"] = rule.id
    language = values.shown(element.attrs.get("guard_language"))
    said = values.shown(element.attrs.get("guard"))
    values.opaque(book, element, rule, "specification", said, language)


def _weight(book: Book, element: Element, _key: str, given: AttrValue) -> None:
    values.literal(book, element, book.node(element), "weight", given)


def _body(book: Book, element: Element, _key: str, given: AttrValue) -> None:
    attrs, node = element.attrs, book.node(element)
    language = values.shown(attrs.get("language"))
    said = values.texts(attrs) or ((values.shown(given),), (language,))
    if element.kind is not Kind.CONSTRAINT:
        values.say(node, said[0], said[1])
    elif element.subkind in ("duration", "time", "interval"):
        _interval(book, element, node, values.shown(given), language)
    else:
        made = book.part(element, node, "specification", "OpaqueExpression")
        values.say(made, said[0], said[1])


def _language(book: Book, element: Element) -> None:
    """The language of an opaque element that says nothing yet."""
    language = element.attrs.get("language")
    if language:
        book.node(element).add(Node("language", text=values.shown(language)))


def _interval(book: Book, element: Element, node: Node, said: str, language: str) -> None:
    """Eclipse keeps the bounds of intervals elsewhere; one expression says both."""
    metaclass = "TimeExpression" if element.subkind == "time" else "Duration"
    made = book.part(element, node, "specification", metaclass)
    given = element.attrs.get("observations", ())
    ids = [str(one) for one in given] if isinstance(given, tuple) else [str(given)]
    known = [book.ids[id] for id in ids if id in book.nodes]
    if known:
        made.attributes["observation"] = " ".join(known)
    values.opaque(book, element, made, "expr", said, language)


def _text_value(tag: str) -> _Writer:
    def write(book: Book, element: Element, key: str, given: AttrValue) -> None:
        node, several = book.node(element), values.texts(element.attrs, f"{key}_")
        if several:
            made = book.part(element, node, tag, "OpaqueExpression")
            values.say(made, several[0], several[1])
        elif tag == "nameExpression":
            made = book.part(element, node, tag, "StringExpression")
            made.attributes["symbol"] = values.shown(given)
        else:
            values.text(book, element, node, tag, given)

    return write


def _arguments(book: Book, element: Element, _key: str, given: AttrValue) -> None:
    for one in given if isinstance(given, tuple) else (given,):
        values.text(book, element, book.node(element), "argument", one)


def _times(tag: str) -> _Writer:
    """Bounds of a loop stand in the constraint of its operand."""

    def write(book: Book, element: Element, key: str, given: AttrValue) -> None:
        node = book.node(element)
        if element.kind is Kind.OPERAND:
            found = next((one for one in node.children if one.tag == "guard"), None)
            node = found or book.part(element, node, "guard", "InteractionConstraint")
        values.literal(book, element, node, tag, given)

    return write


# -- texts -------------------------------------------------------------------------------------


def _direction(book: Book, element: Element, key: str, given: AttrValue) -> None:
    if element.kind in (Kind.PIN, Kind.ACTIVITY_PARAMETER, Kind.FLOW_PROPERTY):
        return
    if element.kind is Kind.PARAMETER:
        if given != "in":
            book.node(element).attributes["direction"] = values.shown(given)
    elif element.role != "flow property" and not _gives_direction(book, element):
        book.losses.note(UNSAID_ATTRIBUTE, element, attribute=key, kind=str(element.kind))


def _gives_direction(book: Book, port: Element) -> bool:
    """Whether the model tells the direction of a port otherwise."""
    graph, type_ = book.graph, type_of(book.graph, port)
    if port.role == "flow port" or graph.targets(port, Edge.REDEFINES):
        return True
    if any(graph.sources(port, edge) for edge in (Edge.FLOW_SOURCE, Edge.FLOW_TARGET)):
        return True
    if type_ is None:
        return False
    features = graph.targets(type_, Edge.FEATURE)
    called = any(one.kind is Kind.OPERATION for one in features)
    return called or bool(flow_properties(graph, type_)) or _is_conjugated(book, type_)


def _is_conjugated(book: Book, type_: Element) -> bool:
    return any("tag.original" in one.attrs for one in applications(book.graph, type_))


def _subkind(book: Book, element: Element, _key: str, given: AttrValue) -> None:
    """Subkinds that an attribute says, not the metaclass."""
    named = {
        Kind.FRAGMENT: ("interactionOperator", "seq"),
        Kind.MESSAGE: ("messageSort", "synch-call"),
        Kind.PSEUDOSTATE: ("kind", "initial"),
        Kind.TRANSITION: ("kind", "external"),
    }.get(element.kind)
    metaclass = book.node(element).metaclass
    if named is None or metaclass not in _SORTED or given == named[1]:
        return
    book.node(element).attributes[named[0]] = camel(values.shown(given))


_SORTED = frozenset(
    {"CombinedFragment", "ConsiderIgnoreFragment", "Message", "Pseudostate", "Transition"}
)


def _first_event(book: Book, element: Element, _key: str, given: AttrValue) -> None:
    node = book.node(element)
    if isinstance(given, tuple) or element.subkind == "duration":
        for one in given if isinstance(given, tuple) else (given,):
            node.add(Node("firstEvent", text=values.shown(one)))
    else:
        node.attributes["firstEvent"] = values.shown(given)


def _nothing(book: Book, element: Element, key: str, given: AttrValue) -> None:
    """Something else says it: the event of a trigger, the value of a constraint."""


# -- records -----------------------------------------------------------------------------------


def _records(tag: str, metaclass: str, *features: str) -> _Writer:
    def write(book: Book, element: Element, _key: str, given: AttrValue) -> None:
        node = book.node(element)
        for number, record in enumerate(given if isinstance(given, tuple) else ()):
            made = _record(book, element, node, tag, metaclass, number)
            columns = record if isinstance(record, tuple) else ()
            for feature, ids in zip(features, columns, strict=False):
                _column(book, made, feature, ids)

    return write


def _record(
    book: Book, element: Element, node: Node, tag: str, metaclass: str, number: int
) -> Node:
    """The record of this number, which other columns may have begun."""
    begun = [child for child in node.children if child.tag == tag]
    if number < len(begun):
        return begun[number]
    ends = {"create-link": "LinkEndCreationData", "destroy-link": "LinkEndDestructionData"}
    name = ends.get(element.subkind, metaclass) if tag == "endData" else metaclass
    return book.part(element, node, tag, name)


def _column(book: Book, node: Node, feature: str, ids: AttrValue) -> None:
    named = [str(id) for id in ids] if isinstance(ids, tuple) else []
    known = [book.ids[id] for id in named if id in book.nodes]
    if known:
        node.attributes[feature] = " ".join(known)


def _extended_signature(book: Book, element: Element, _key: str, given: AttrValue) -> None:
    """The signature of a template extends those of other templates."""
    ids = [str(id) for id in (given if isinstance(given, tuple) else (given,))]
    known = [events.signature(book, book.graph[id]).id for id in ids if id in book.nodes]
    if known:
        events.signature(book, element).attributes["extendedSignature"] = " ".join(known)


_WRITERS: dict[str, _Writer] = {
    "multiplicity": _bounds,
    "default": _default,
    "value": _value,
    "guard": _guard,
    "weight": _weight,
    "body": _body,
    "join_spec": _text_value("joinSpec"),
    "upper_bound": _text_value("upperBound"),
    "name_expression": _text_value("nameExpression"),
    "selector": _text_value("selector"),
    "return_value": _text_value("returnValue"),
    "arguments": _arguments,
    "min": _times("minint"),
    "max": _times("maxint"),
    "direction": _direction,
    "subkind": _subkind,
    "first_event": _first_event,
    "observations": _nothing,
    "when": _nothing,
    "condition": _nothing,
    "relative": _nothing,
    "deferred": _nothing,
    "clauses": _records("clause", "Clause", "test", "body"),
    "clause_outputs": _records("clause", "Clause", "decider", "bodyOutput"),
    "handlers": _records(
        "handler", "ExceptionHandler", "handlerBody", "exceptionInput", "exceptionType"
    ),
    "link_ends": _records("endData", "LinkEndData", "end", "value"),
    "extended_signature": _extended_signature,
}
