"""What elements of single kinds need besides their attributes, often from later rows or files."""

import re
from functools import partial

from sysmlc.diagnostics import Subject
from sysmlc.frontends.xmi import metaclasses, rules
from sysmlc.frontends.xmi import vocabulary as v
from sysmlc.frontends.xmi.document import WrittenReference
from sysmlc.frontends.xmi.unit import ElementHandler, File, Stage
from sysmlc.frontends.xmi.values import read_value, store_alternatives
from sysmlc.frontends.xmi.vocabulary import TRUE
from sysmlc.ir import Edge, Element, Kind
from sysmlc.support.units import read_time

_EVENT_VALUES = {"when": "when", "changeExpression": "condition"}
"""Attributes of triggers, by the feature of the event that holds the value."""

_ANY_EVENT = re.compile(
    r"(any|all|any ?receive( ?event)?)[ _]?\d*|\*|else|otherwise", re.IGNORECASE
)
"""Names of events that mean any message, and those that tools generate."""

_GUARD_ATTRIBUTES = {
    "body": "guard",
    "language": "guard_language",
    "bodies": "guard_bodies",
    "languages": "guard_languages",
}
"""Attributes of a transition, by the attribute of the constraint that is its guard."""


def _complete_pin(file: File, element: Element, row: int) -> None:
    owner = file.find_owner(row)
    if owner is not None and owner.subkind == "reply":
        # Where no type is written the default is that of an accepted call, an output pin.
        element.attrs["direction"] = "in"


def _complete_constraint(file: File, element: Element, row: int) -> None:
    owner = file.find_owner(row)
    if owner is not None:
        file.defer(Stage.GUARDS, partial(_complete_guard, file, owner, element))


def _complete_transition(file: File, element: Element, row: int) -> None:
    for reference in file.document.references(row, "guard"):
        file.defer(Stage.GUARDS, partial(_complete_guard, file, element, reference))


def _complete_flow(file: File, element: Element, row: int) -> None:
    # The guard of a flow is a child in UML; an attribute can only contain its text.
    text = file.document.attributes[row].get("guard")
    if text is not None:
        element.attrs["guard"] = text


def _complete_state_behaviour(file: File, element: Element, row: int) -> None:
    owner = file.find_owner(row)
    if owner is not None:
        edge = v.STATE_BEHAVIOURS[file.document.features[row]]
        file.unit.graph.connect(edge, owner, element)
        file.defer(Stage.BEHAVIOURS, partial(_read_name_as_body, element))


def _read_name_as_body(element: Element) -> None:
    """Set the body of an opaque behaviour to its name if the name is an assignment.

    StarUML has only names for effects, entries and exits.
    """
    if element.subkind == "opaque" and "body" not in element.attrs and ":=" in element.name:
        element.attrs["body"] = element.name


def _complete_trigger(file: File, element: Element, row: int) -> None:
    owner = file.find_owner(row)
    for event in file.document.targets(row, "event"):
        file.triggers_by_event.setdefault(event, []).append(element.id)
    file.defer(Stage.TRIGGERS, partial(_read_event, file, element, row))
    if file.document.features[row] == "deferrableTrigger":
        element.attrs["deferred"] = True
    elif owner is not None:
        file.unit.graph.connect(Edge.TRIGGER, owner, element)


def _complete_connector_end(file: File, element: Element, row: int) -> None:
    owner = file.find_owner(row)
    if owner is not None:
        file.unit.graph.connect(Edge.END, owner, element)
    file.defer(Stage.APPLICATIONS, partial(_lower_connector_path, file, element, row))


def _complete_activity_parameter(file: File, element: Element, row: int) -> None:
    file.defer(Stage.BODIES, partial(_set_direction, file, element, row))


# -- triggers and events ---------------------------------------------------------------------------


def _read_event(file: File, trigger: Element, row: int) -> None:
    """Give a trigger the content of its event, which many triggers can share."""
    event = file.find_first_target(row, "event")
    if event is None:
        _refer_to_unknown_event(file, trigger, row)
        return
    subkind = metaclasses.EVENT_TYPES.get(event.type)
    if subkind is None:
        return
    trigger.attrs["subkind"] = subkind
    if not trigger.name:
        file.unit.graph.rename(trigger, event.name)
    if subkind == "any" and trigger.name and not _ANY_EVENT.fullmatch(trigger.name.strip()):
        _read_name_as_event(file, trigger, row)
    document = event.document
    for feature in ("signal", "operation"):
        for reference in document.references(event.row, feature):
            event.file.add_reference(Edge.TYPED_BY, trigger.id, reference, feature)
    for feature, key in _EVENT_VALUES.items():
        for child in document.children(event.row, feature):
            value = read_value(document, child)
            if value.text.strip():
                trigger.attrs[key] = value.text
                store_alternatives(trigger, value, key)
    if subkind == "time" and document.attributes[event.row].get("isRelative") in TRUE:
        trigger.attrs["relative"] = True
    _read_text_in_name(trigger, event.name)


def _read_name_as_event(file: File, trigger: Element, row: int) -> None:
    """Let a trigger wait for the event of its name, not for any message.

    StarUML gives triggers an any-receive event where the modeller chose no kind.
    """
    trigger.attrs["subkind"] = ""
    name = file.qualified_name(row)
    subject = Subject(name, trigger.id, file.locate(row))
    file.unit.sink.report(rules.ANY_EVENT_WITH_NAME, subject, event=trigger.name)


def _read_text_in_name(trigger: Element, event_name: str) -> None:
    """Set the time or condition of an event that has it only in its name (``after 5 s``)."""
    for name in (event_name, trigger.name):
        word, _, text = name.strip().partition(" ")
        if trigger.subkind == "change" and word == "when" and text:
            trigger.attrs.setdefault("condition", text.strip())
        time = read_time(name)
        is_time = trigger.subkind == "time" and time.text != name.strip()
        if is_time and "when" not in trigger.attrs:
            trigger.attrs["when"] = time.text
            if time.is_relative:
                trigger.attrs["relative"] = True


def _refer_to_unknown_event(file: File, trigger: Element, row: int) -> None:
    """Refer to an event in no file of the unit; the pass ``resolve`` reports it.

    The href may state its metaclass.
    """
    document = file.document
    for reference in document.references(row, "event"):
        subkind = metaclasses.EVENT_TYPES.get(document.types[reference.row])
        if subkind is not None and reference.is_href:
            trigger.attrs["subkind"] = subkind
        file.add_reference(Edge.REFERENCES, trigger.id, reference, "event")


# -- guards, parameters and paths ------------------------------------------------------------------


def _complete_guard(file: File, transition: Element, guard: Element | WrittenReference) -> None:
    """Give a transition the text of its guard; the text is empty if nothing can be read.

    A constraint without a value has the text in its name, as modellers write it in diagrams.
    """
    transition.attrs["guard"] = ""
    if isinstance(guard, WrittenReference):
        id = file.unit.find_target_id(file, guard.target, guard.is_href)
        constraint = file.unit.graph.get(id)
        if constraint is None:
            file.add_reference(Edge.GUARD, transition.id, guard, "guard")
            return
        guard = constraint
    file.unit.graph.connect(Edge.GUARD, transition, guard)
    transition.attrs["guard"] = guard.name
    if str(guard.attrs.get("body", "")).strip():
        for key, guard_key in _GUARD_ATTRIBUTES.items():
            value = guard.attrs.get(key)
            if value is not None:
                transition.attrs[guard_key] = value


def _set_direction(file: File, node: Element, row: int) -> None:
    """Set the direction of an activity parameter node.

    A parameter with direction ``inout`` has two nodes; the one that flows lead to is ``out``.
    """
    parameter = file.find_first_target(row, "parameter")
    if parameter is None:
        return
    direction = parameter.document.get(parameter.row, "direction") or "in"
    if direction == "inout":
        direction = "out" if node.id in file.unit.flow_targets else "in"
    node.attrs["direction"] = "out" if direction in ("out", "return") else "in"


def _lower_connector_path(file: File, end: Element, row: int) -> None:
    """Add the path of a connector end: its nested path, and the part that has the port.

    MagicDraw repeats that part in the nested path, and other tools repeat the role.
    """
    document = file.document
    nested_file, nested = file.unit.nested_paths.get(end.id, (file, []))
    part_with_port = document.references(row, "partWithPort")
    roles = {_fragment(role) for role in document.references(row, "role")}
    roles -= {_fragment(part) for part in part_with_port}
    while nested and _fragment(nested[-1]) in roles:
        nested = nested[:-1]
    nested_ids = {_fragment(step) for step in nested}
    steps: list[tuple[File, WrittenReference]]
    steps = [(nested_file, step) for step in nested]
    steps += [(file, part) for part in part_with_port if _fragment(part) not in nested_ids]
    for step_file, step in steps:
        step_file.add_reference(Edge.PATH, end.id, step, "partWithPort")


def _fragment(reference: WrittenReference) -> str:
    return reference.target.rpartition("#")[2]


COMPLETIONS: dict[Kind, ElementHandler] = {
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
COMPLETED_FEATURES: dict[Kind, frozenset[str]] = {
    Kind.PIN: frozenset({"returnInformation"}),
    Kind.CONSTRAINT: frozenset({"guard", "preCondition"}),
    Kind.ACTIVITY: frozenset(v.STATE_BEHAVIOURS),
    Kind.STATE_MACHINE: frozenset(v.STATE_BEHAVIOURS),
    Kind.INTERACTION: frozenset(v.STATE_BEHAVIOURS),
}
"""Kinds of which only the elements of these features are completed."""
