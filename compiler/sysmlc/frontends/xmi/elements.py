"""Adds the elements of rows to the graph, with what their kind, metaclass and feature imply."""

from itertools import islice

from sysmlc.diagnostics import Subject, Verdict
from sysmlc.frontends.xmi import metaclasses, rules
from sysmlc.frontends.xmi import vocabulary as v
from sysmlc.frontends.xmi.attributes import lower_attributes
from sysmlc.frontends.xmi.context import Context, ElementHandler, RowHandler
from sysmlc.ir import AttrValue, Edge, Element, Kind
from sysmlc.sources import DEFAULT_LIMITS


def add_element(context: Context, row: int, kind: Kind, subkind: str, type_name: str) -> bool:
    """Add the row's element with its attributes; return False if its owner cannot own the kind.

    *type_name* is the metaclass, which the row may omit.
    """
    document = context.document
    feature, owner = document.features[row], context.element_ids[row]
    if kind in metaclasses.OWNERS and not _may_own(context, owner, kind):
        return False
    values = document.attributes[row]
    id = context.new_id(row, owner, feature)
    element = Element(
        id, kind, values.get("name", ""), owner or None, document.ordinals[row], document.name
    )
    implied = _imply_attributes(kind, subkind, type_name, feature)
    if implied:
        element.attrs = implied
    context.graph.add(element)
    context.element_ids[row] = id
    context.elements[row] = element
    context.verdicts[row] = Verdict.MAPPED
    if kind in _COMPLETIONS and feature in _COMPLETED_FEATURES.get(kind, (feature,)):
        _COMPLETIONS[kind](context, element, row)
    if len(values) > DEFAULT_LIMITS.attributes:
        values = _limit_attributes(context, row, values)
    lower_attributes(context, element, row, values)
    return True


def make_handler(type_name: str, complete: ElementHandler) -> RowHandler:
    """Return a handler that adds elements of one metaclass and then calls *complete*."""
    kind, subkind = metaclasses.KINDS[type_name]

    def lower(context: Context, row: int) -> None:
        if add_element(context, row, kind, subkind, type_name):
            complete(context, context.graph[context.element_ids[row]], row)
        else:
            context.mark_subtree(row, Verdict.UNSUPPORTED)

    return lower


def _may_own(context: Context, owner: str, kind: Kind) -> bool:
    element = context.graph.get(owner)
    return element is not None and element.kind in metaclasses.OWNERS[kind]


def _limit_attributes(context: Context, row: int, values: dict[str, str]) -> dict[str, str]:
    most = DEFAULT_LIMITS.attributes
    name = context.qualified_name(row)
    subject = Subject(name, "", context.locate(row))
    context.sink.report(rules.MANY_ATTRIBUTES, subject, element=name, count=len(values), most=most)
    return dict(islice(values.items(), most))


def _imply_attributes(
    kind: Kind, subkind: str, type_name: str, feature: str
) -> dict[str, AttrValue]:
    """Return the attributes that follow from kind, metaclass and feature.

    Attributes that the file writes override them.
    """
    attributes: dict[str, AttrValue] = {"subkind": subkind} if subkind else {}
    if kind is Kind.PARAMETER:
        attributes["direction"] = "in"
    elif kind is Kind.PIN:
        attributes["direction"] = v.PIN_DIRECTIONS[type_name]
        attributes["subkind"] = metaclasses.to_kebab_case(feature)
        if type_name == "ValuePin":
            # Its value is evaluated when the action starts (UML 2.5.1, 16.2.3.3), not bound to it.
            attributes["value_kind"] = "initial"
    elif kind is Kind.PSEUDOSTATE and type_name == "Pseudostate":
        attributes["subkind"] = "initial"
    elif kind is Kind.STRUCTURED and subkind == "expansion":
        attributes["mode"] = v.default_value("mode")
    elif kind is Kind.CONSTRAINT and feature in v.CONDITIONS:
        attributes["subkind"] = v.CONDITIONS[feature]
    elif kind is Kind.DEPENDENCY and feature == "roleBinding":
        attributes["subkind"] = "role-binding"
    return attributes


# -- completions of single kinds -------------------------------------------------------------------


def _complete_pin(context: Context, element: Element, row: int) -> None:
    owner = context.find_owner(row)
    if owner is not None and owner.subkind == "reply":
        # Where no type is written the default is that of an accepted call, an output pin.
        element.attrs["direction"] = "in"


def _complete_constraint(context: Context, element: Element, row: int) -> None:
    owner = context.find_owner(row)
    if owner is not None:
        context.guards.append((owner, element, row))


def _complete_transition(context: Context, element: Element, row: int) -> None:
    for reference in context.document.references(row, "guard"):
        context.guards.append((element, reference, row))


def _complete_flow(context: Context, element: Element, row: int) -> None:
    # The guard of a flow is a child in UML; an attribute can only contain its text.
    text = context.document.attributes[row].get("guard")
    if text is not None:
        element.attrs["guard"] = text


def _complete_state_behaviour(context: Context, element: Element, row: int) -> None:
    owner = context.find_owner(row)
    if owner is not None:
        edge = v.STATE_BEHAVIOURS[context.document.features[row]]
        context.graph.connect(edge, owner, element)
        context.completions.append((_read_name_as_body, element, row))


def _read_name_as_body(_context: Context, element: Element, _row: int) -> None:
    """Set the body of an opaque behaviour to its name if the name is an assignment.

    StarUML has only names for effects, entries and exits.
    """
    if element.subkind == "opaque" and "body" not in element.attrs and ":=" in element.name:
        element.attrs["body"] = element.name


def _complete_trigger(context: Context, element: Element, row: int) -> None:
    owner = context.find_owner(row)
    context.triggers.append((element, row))
    if context.document.features[row] == "deferrableTrigger":
        element.attrs["deferred"] = True
    elif owner is not None:
        context.graph.connect(Edge.TRIGGER, owner, element)


def _complete_connector_end(context: Context, element: Element, row: int) -> None:
    owner = context.find_owner(row)
    if owner is not None:
        context.graph.connect(Edge.END, owner, element)
    context.connector_ends.append((element, row))


def _complete_activity_parameter(context: Context, element: Element, row: int) -> None:
    context.parameter_nodes.append((element, row))


_COMPLETIONS: dict[Kind, ElementHandler] = {
    Kind.PIN: _complete_pin,
    Kind.CONSTRAINT: _complete_constraint,
    Kind.TRANSITION: _complete_transition,
    Kind.CONTROL_FLOW: _complete_flow,
    Kind.OBJECT_FLOW: _complete_flow,
    Kind.ACTIVITY: _complete_state_behaviour,
    Kind.STATE_MACHINE: _complete_state_behaviour,
    Kind.INTERACTION: _complete_state_behaviour,
    Kind.TRIGGER: _complete_trigger,
    Kind.CONNECTOR_END: _complete_connector_end,
    Kind.ACTIVITY_PARAMETER: _complete_activity_parameter,
}
_COMPLETED_FEATURES: dict[Kind, frozenset[str]] = {
    Kind.PIN: frozenset({"returnInformation"}),
    Kind.CONSTRAINT: frozenset({"guard", "preCondition"}),
    Kind.ACTIVITY: frozenset(v.STATE_BEHAVIOURS),
    Kind.STATE_MACHINE: frozenset(v.STATE_BEHAVIOURS),
    Kind.INTERACTION: frozenset(v.STATE_BEHAVIOURS),
}
"""Kinds of which only the elements of these features are completed."""
