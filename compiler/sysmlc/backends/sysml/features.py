"""Features: properties, ports, operations, parameters, pins and object nodes."""

from sysmlc.backends.sysml.comments import write_opaque_bodies
from sysmlc.backends.sysml.compatibility import forbids_inherited_types, is_without_parameters
from sysmlc.backends.sysml.connections import write_association_end
from sysmlc.backends.sysml.declarations import (
    Head,
    is_referential_owner,
    list_types,
    make_definition_head,
    make_feature_head,
)
from sysmlc.backends.sysml.definitions import write_contents
from sysmlc.backends.sysml.expressions import SIGNS, format_value
from sysmlc.backends.sysml.plan import Member
from sysmlc.backends.sysml.printing import Line, quote_name
from sysmlc.backends.sysml.references import is_accessible, iter_generals
from sysmlc.backends.sysml.writer import Writer
from sysmlc.ir import Edge, Element, Kind
from sysmlc.ir.query import direction_of, flow_directions, type_of

_DIRECTIONS = ("in", "out", "inout")


# -- properties and ports ------------------------------------------------------------------------


def write_property(writer: Writer, member: Member) -> list[Line]:
    """Write a property: an end of an association, else a feature."""
    owner = None if member.parent is None else member.parent.element
    if owner is None or owner.kind is not Kind.ASSOCIATION:
        return write_feature(writer, member)
    is_end = member.element in writer.graph.targets(owner, Edge.END)
    return write_association_end(writer, member) if is_end else write_feature(writer, member)


def write_feature(writer: Writer, member: Member) -> list[Line]:
    """Write a feature of a classifier, with its default."""
    element = member.require_element()
    head = make_feature_head(writer, member)
    if "default" in element.attrs:
        default = format_value(writer, member.parent, element, element, "default")
        sign = SIGNS[str(element.attrs.get("default_kind", "default"))]
        head.value = f" {sign} {default}" if default else ""
    body = write_contents(writer, member)
    if element.attrs.get("aggregation") == "shared":
        body.insert(0, Line(f"@{writer.refer_to_sysmlc(member, 'shared')}", is_short=True))
    return [Line(head.format(), body)]


def write_port(writer: Writer, member: Member) -> list[Line]:
    """Write a port.

    A port whose type is not a port definition becomes a part (full ports), or a port that owns a
    feature of this type.
    """
    element = member.require_element()
    head = make_feature_head(writer, member)
    if flow_directions(writer.graph, element):
        head.prefixes = [word for word in head.prefixes if word not in _DIRECTIONS]
    body = write_contents(writer, member)
    is_full_port = element.role == "full port"
    if member.shape.keyword == "part":
        keyword = "fullPort" if is_full_port else "blockPort"
        head.prefixes = [word for word in head.prefixes if word not in ("ref", *_DIRECTIONS)]
        head.prefixes += ["ref"] if is_referential_owner(member.parent) else []
        head.prefixes.append(f"#{writer.refer_to_sysmlc(member.parent, keyword)}")
        head.types = [type_.removeprefix("~") for type_ in head.types or ()]
        return [Line(head.format(), body)]
    if not _has_port_type(writer, element):
        body = _move_type_inside(writer, member, head) + body
    if is_full_port:
        head.prefixes.append(f"#{writer.refer_to_sysmlc(member.parent, 'fullPort')}")
    return [Line(head.format(), body)]


def _has_port_type(writer: Writer, port: Element) -> bool:
    type_ = type_of(writer.graph, port)
    member = writer.plan.find(type_)
    if member is None:
        return False
    if type_ is not None and member.element is port:
        # The members of a property-specific class belong to the port.
        return type_.role == "interface block"
    return member.shape.keyword == "port def"


def _move_type_inside(writer: Writer, member: Member, head: Head) -> list[Line]:
    """Return a feature typed by the port's type, whose values flow through a port in SysML 1.2."""
    port = member.require_element()
    if not head.types:
        return []
    types = [type_.removeprefix("~") for type_ in list_types(writer, member, port)[0]]
    head.types = []
    direction = str(port.attrs.get("direction", ""))
    head.prefixes = [word for word in head.prefixes if word != direction]
    return [Line(f"{direction or 'ref'} : {', '.join(types)}")]


# -- operations, receptions and parameters -------------------------------------------------------


def write_operation(writer: Writer, member: Member) -> list[Line]:
    """Write an operation as an action of its owner; it specialises a method of another name."""
    element = member.require_element()
    head = make_definition_head(writer, member)
    if is_referential_owner(member.parent):
        head.prefixes.append("ref")
    body = write_contents(writer, member)
    for method in writer.graph.targets(element, Edge.METHOD):
        method_member = writer.plan.find(method)
        if method_member is member:
            writer.expressed.add(method.id)
            body += write_opaque_bodies(writer, method)
            continue
        if is_without_parameters(writer.graph, element, method):
            continue
        name = writer.refer_to(member.parent, element, Edge.METHOD, method)
        if name is None or method_member is None:
            continue
        if method_member.shape.is_definition:
            head.types = [*(head.types or ()), name]
        else:
            head.subsets = [*(head.subsets or ()), name]
    _redefine_operations(writer, member, element, head)
    return [Line(head.format(), body)]


def _redefine_operations(writer: Writer, member: Member, element: Element, head: Head) -> None:
    targets = writer.graph.targets(element, Edge.REDEFINES)
    names = [writer.refer_to_redefined(member.parent, target) for target in targets]
    head.redefines = [name for name in names if name is not None]
    if quote_name(member.name) in head.redefines:
        head.name = ""


def write_reception(writer: Writer, member: Member) -> list[Line]:
    """Write a reception: an action that accepts the signal."""
    types, _ = list_types(writer, member, member.require_element())
    payload = f" accept : {types[0]}" if types else ""
    keyword = "ref action" if is_referential_owner(member.parent) else "action"
    return [Line(f"{keyword} {quote_name(member.name)}{payload}", write_contents(writer, member))]


def write_parameter(writer: Writer, member: Member) -> list[Line]:
    """Write a parameter of an operation or behaviour; without a direction it is ``in``."""
    element = member.require_element()
    head = make_feature_head(writer, member)
    _add_direction(head)
    if _redefines_other_kind(writer, member):
        # A reference may have the types of both parameters.
        head.keyword = "ref"
    if "default" in element.attrs:
        sign = SIGNS[str(element.attrs.get("default_kind", "default"))]
        default = format_value(writer, member.parent, element, element, "default")
        head.value = f" {sign} {default}"
    return [Line(head.format(), write_contents(writer, member))]


def _redefines_other_kind(writer: Writer, member: Member) -> bool:
    """Whether a parameter cannot have the types of the parameter that it redefines.

    In SysML v2, a parameter redefines the parameters at its position in the generals of its owner.
    """
    plan, owner = writer.plan, member.parent
    if owner is None:
        return False
    position = _list_parameters(owner).index(member)
    generals = list(iter_generals(plan, owner))
    methods = [] if owner.element is None else writer.graph.targets(owner.element, Edge.METHOD)
    generals += [general for method in methods if (general := plan.find(method)) is not None]
    redefined = [p for general in generals for p in _list_parameters(general)[position:][:1]]
    return forbids_inherited_types(plan, member, [p.require_element() for p in redefined])


def _list_parameters(behaviour: Member) -> list[Member]:
    kinds = (Kind.PARAMETER, Kind.PIN, Kind.ACTIVITY_PARAMETER)
    return [m for m in behaviour.members if m.element is not None and m.element.kind in kinds]


def _add_direction(head: Head) -> None:
    """Add the direction ``in`` to a head that has none."""
    if not any(word in head.prefixes for word in _DIRECTIONS):
        head.prefixes = ["in", *(word for word in head.prefixes if word != "ref")]


# -- pins and object nodes -----------------------------------------------------------------------


def write_pin(writer: Writer, member: Member) -> list[Line]:
    """Write a pin: a parameter of its action, which redefines that of the called behaviour."""
    element = member.require_element()
    head = make_feature_head(writer, member)
    _add_direction(head)
    if element.kind is Kind.ACTIVITY_PARAMETER:
        writer.record_approximation(element, "a parameter node without a parameter", "a parameter")
    parameter = _find_parameter(writer, element)
    if parameter is not None:
        _redefine_parameter(writer, member, parameter, head)
    elif _redefines_other_kind(writer, member):
        head.keyword = "ref"
    value = format_value(writer, member.parent, element, element)
    value = value or _format_result(writer, member, element)
    sign = SIGNS[str(element.attrs.get("value_kind", "bound"))]
    head.value = f" {sign} {value}" if value else ""
    return [Line(head.format(), write_contents(writer, member))]


def _redefine_parameter(writer: Writer, member: Member, parameter: Element, head: Head) -> None:
    """Add the redefinition of *parameter* to the head; drop a name and types equal to its own."""
    name = writer.refer_to_redefined(member.parent, parameter)
    general = writer.plan.find(parameter)
    if name is None or general is None:
        return
    if forbids_inherited_types(writer.plan, member, [parameter]):
        # A reference may have the types of both.
        head.keyword = "ref"
    head.redefines = [*(head.redefines or ()), name]
    if name == quote_name(member.name):
        head.name = ""
        element = member.element
        types = [] if element is None else writer.graph.targets(element, Edge.TYPED_BY)
        if types == writer.graph.targets(parameter, Edge.TYPED_BY):
            head.types = []


def _find_parameter(writer: Writer, pin: Element) -> Element | None:
    """Return the parameter to which a pin of a call corresponds (UML 2.5.1, 16.3.3).

    Input pins correspond to the in and inout parameters in their order, output pins to the inout,
    out and return parameters.
    """
    action = writer.graph.owner(pin)
    called = None if action is None else writer.graph.target(action, Edge.CALLS)
    if action is None or action.subkind not in ("call-behavior", "call-operation"):
        return None
    if called is None or pin.subkind in ("target", "object"):
        return None
    if called.kind not in (Kind.OPERATION, Kind.ACTIVITY):
        return None
    is_output = pin.attrs.get("direction") == "out"
    directions = ("inout", "out", "return") if is_output else ("in", "inout")
    pins = [
        child
        for child in writer.graph.owned(action)
        if child.kind is Kind.PIN
        and (child.attrs.get("direction") == "out") is is_output
        and child.subkind not in ("target", "object")
    ]
    parameters = [
        child
        for child in writer.graph.owned(called)
        if child.kind is Kind.PARAMETER and direction_of(child) in directions
    ]
    index = pins.index(pin) if pin in pins else len(parameters)
    return parameters[index] if index < len(parameters) else None


def _format_result(writer: Writer, member: Member, pin: Element) -> str:
    """Return the value of a value action, or the feature that a read action reads."""
    action = writer.graph.owner(pin)
    if action is None or pin.attrs.get("direction") != "out":
        return ""
    if action.subkind == "value":
        return format_value(writer, member.parent, pin, action)
    if action.subkind != "read":
        return ""
    feature = writer.graph.target(action, Edge.CALLS)
    feature_member = writer.plan.find(feature)
    if feature is None or feature_member is None:
        return ""
    if not is_accessible(writer.plan, member.parent, feature_member):
        return ""
    return writer.refer_to(member.parent, action, Edge.CALLS, feature) or ""


def write_object_node(writer: Writer, member: Member) -> list[Line]:
    """Write a buffer or a data store: a feature of the activity."""
    head = make_feature_head(writer, member)
    return [Line(head.format(), write_contents(writer, member))]
