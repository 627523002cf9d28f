"""Attributes of elements that neither keywords nor declarations of SysML v2 text express."""

from collections.abc import Callable, Iterator

from sysmlc.backends.sysml.expressions import format_bounds, format_literal
from sysmlc.backends.sysml.plan import Member
from sysmlc.backends.sysml.profiles import is_standard
from sysmlc.backends.sysml.shapes import is_succession
from sysmlc.backends.sysml.writer import Writer
from sysmlc.ir import Edge, Element, Kind
from sysmlc.ir.expressions import ExpressionError, print_expression
from sysmlc.ir.query import waits_for_change
from sysmlc.ir.query.activities import is_joined, pin_subkind
from sysmlc.logic.expressions.parsing import tree_of

_FLOWS = (Kind.CONTROL_FLOW, Kind.OBJECT_FLOW)
_LISTED_KINDS = (Kind.DOCUMENT, Kind.METADATA, Kind.ALIAS, Kind.IMPORT)
"""Kinds whose attributes stand in a comment or in metadata."""
_ATTRIBUTES = """
    role level subkind multiplicity direction conjugated abstract ordered derived readonly unique
    visibility aggregation default default_language default_instance default_bodies
    default_languages domain body language bodies languages external href library qualified_name
    unresolved origin value value_language value_instance value_bodies value_languages guard
    guard_language guard_literal guard_bodies guard_languages guard_instance req_id text symbol
    when when_language when_bodies when_languages condition condition_language condition_bodies
    condition_languages relative port path represents data_type unit default_value category
    semantics version change_mode copyright ppr interface_ids associated_facet tag stereotype
    namespace lineage on diagram arguments message_kind description usage property_specific payload
    locale value_unit value_kind default_unit default_kind variation variant portion individual
    caex_id subject_name referential asserted port_path
"""
_EXPRESSED = frozenset(_ATTRIBUTES.split())
"""Attributes that the text expresses for most kinds, or that add nothing to what it expresses."""
_LOOP_ATTRIBUTES = ("mode", "collection")
_COMPOSITE = frozenset({"part", "item", "occurrence", "constraint"})
"""Keywords of features that are composite unless they are references."""
_UNEXPRESSED_SUBKINDS = frozenset({Kind.DATA_TYPE, Kind.ACTIVITY_PARAMETER})
"""Kinds whose subkind neither a keyword nor the metadata ``Kind`` expresses."""
_EXPRESSED_TAG_NAMES = """
    id text direction unit quantityKind base isConjugated kind propertyPath sourceContext
    targetContext sourcePropertyPath targetPropertyPath refines derived derivedFrom satisfiedBy
    verifiedBy tracedTo master allocatedTo allocatedFrom itemProperty onNestedPort
"""
_EXPRESSED_TAGS = frozenset(name.lower() for name in _EXPRESSED_TAG_NAMES.split())
"""Tags of SysML's own stereotypes that the text expresses."""


def iter_unexpressed_attributes(
    writer: Writer, member: Member | None, element: Element
) -> Iterator[str]:
    """Yield the keys of the attributes that nothing else in the text expresses.

    *member* is None for an element that has no member because another member expresses it.
    """
    is_listed = element.kind in _LISTED_KINDS
    if is_listed or (element.kind is Kind.APPLICATION and not is_standard(element)):
        return
    for key, value in element.attrs.items():
        check = _CHECKS.get(key)
        if value is None or (value == () and check is None):
            continue
        if check is not None:
            is_unexpressed = check(writer, member, element)
        elif key.startswith("value."):
            is_unexpressed = element.kind is not Kind.SLOT
        elif key.startswith("tag."):
            is_unexpressed = not _is_expressed_tag(element, key)
        else:
            is_of_loop = element.id in writer.collection_loops and key.startswith(_LOOP_ATTRIBUTES)
            is_unexpressed = key not in _EXPRESSED and not is_of_loop
        if is_unexpressed:
            yield key


def _is_expressed_tag(element: Element, key: str) -> bool:
    """Whether the text expresses a tag of a stereotype of SysML, or the tag has its default."""
    tag = key.removeprefix("tag.").lower()
    return tag in _EXPRESSED_TAGS or element.attrs[key] in ("false", False)


# -- attributes that the text expresses for some elements only -----------------------------------

_Check = Callable[[Writer, Member | None, Element], bool]
"""Whether the text does not express the attribute of this element."""


def _has_unexpressed_aggregation(writer: Writer, member: Member | None, element: Element) -> bool:
    if element.kind is Kind.PORT:
        return True
    owner = writer.graph.owner(element)
    if owner is not None and owner.kind is Kind.ASSOCIATION:
        return element.attrs["aggregation"] != "none"
    if element.kind is not Kind.PROPERTY or element.attrs["aggregation"] != "composite":
        return False
    if member is None or member.shape.keyword not in _COMPOSITE or "direction" in element.attrs:
        return True
    return member.parent is not None and member.parent.shape.usage_keyword == "attribute"


def _has_unexpressed_subkind(writer: Writer, _member: Member | None, element: Element) -> bool:
    if element.kind is Kind.ACTIVITY:
        has_body = "body" in element.attrs or "bodies" in element.attrs
        return element.subkind == "function" or (element.subkind == "opaque" and not has_body)
    if element.kind is Kind.PACKAGE:
        return element.subkind == "model"
    if element.kind is Kind.PROPERTY:
        owner = writer.graph.owner(element)
        is_variable = element.subkind == "variable"
        is_in_node = owner is not None and owner.kind is Kind.STRUCTURED
        return is_in_node and is_variable and element.owner not in writer.collection_loops
    check = _SUBKIND_CHECKS.get(element.kind)
    return element.kind in _UNEXPRESSED_SUBKINDS if check is None else check(writer, element)


def _has_unexpressed_action_kind(writer: Writer, action: Element) -> bool:
    """Whether the text lacks the kind: of a read action, or a call of an operation elsewhere."""
    operation = writer.graph.target(action, Edge.CALLS)
    is_outside = operation is not None and bool(operation.attrs.get("external"))
    return action.subkind == "read" or (action.subkind == "call-operation" and is_outside)


def _is_unexpressed_flow_end(writer: Writer, node: Element) -> bool:
    """Whether the text writes a flow final node as ``done``, which ends the whole behaviour."""
    is_flow_end = node.subkind == "flow-final" and writer.plan.find(node) is None
    return is_flow_end and is_joined(writer.graph, node)


def _has_unexpressed_pin_kind(writer: Writer, pin: Element) -> bool:
    """Whether a reader cannot derive the kind of a pin from the action."""
    owner = writer.graph.owner(pin)
    if owner is None or (owner.kind is Kind.ACTION and owner.subkind == "read"):
        return True
    return pin.subkind != pin_subkind(owner, pin)


_SUBKIND_CHECKS = {
    Kind.ACTION: _has_unexpressed_action_kind,
    Kind.CONTROL: _is_unexpressed_flow_end,
    Kind.PIN: _has_unexpressed_pin_kind,
}


def _has_unexpressed_guard(writer: Writer, _member: Member | None, element: Element) -> bool:
    """Whether the text lacks the guard: successions have guards, flows from pin to pin do not."""
    is_expression = element.attrs.get("guard") and "guard_literal" not in element.attrs
    has_notation = bool(is_expression) and is_succession(writer.graph, element)
    return element.kind in _FLOWS and not has_notation


def _waits_for_change(_writer: Writer, _member: Member | None, element: Element) -> bool:
    return waits_for_change(element)


def _is_flow(_writer: Writer, _member: Member | None, element: Element) -> bool:
    return element.kind in _FLOWS


def _has_unexpressed_direction(writer: Writer, member: Member | None, element: Element) -> bool:
    if element.kind is Kind.PARAMETER:
        return element.attrs["direction"] == "return"
    if element.kind is Kind.ACTIVITY_PARAMETER:
        parameter = writer.graph.target(element, Edge.REFERENCES)
        is_inout = parameter is not None and parameter.attrs.get("direction") == "inout"
        return is_inout and element.attrs["direction"] != "inout"
    return element.kind is Kind.PORT and _is_part(member)


def _has_unexpressed_conjugation(writer: Writer, member: Member | None, element: Element) -> bool:
    """Whether a port is conjugated, but has no port definition as its type."""
    is_typed = bool(writer.graph.targets(element, Edge.TYPED_BY))
    return element.kind is Kind.PORT and (_is_part(member) or not is_typed)


def _is_part(member: Member | None) -> bool:
    return member is not None and member.shape.keyword == "part"


def _is_enumeration_literal(_writer: Writer, _member: Member | None, element: Element) -> bool:
    return element.kind is Kind.ENUMERATION_LITERAL


def _has_unexpressed_visibility(writer: Writer, _member: Member | None, element: Element) -> bool:
    visibility = element.attrs["visibility"]
    owner = writer.graph.owner(element)
    is_end = owner is not None and owner.kind is Kind.ASSOCIATION
    if is_end or element.kind is Kind.PIN:
        return True
    is_known = visibility in ("private", "protected", "public")
    return not is_known or element.id in writer.public_ids


def _has_unexpressed_multiplicity(writer: Writer, member: Member | None, element: Element) -> bool:
    """Whether a bound is no expression: ``492x21`` for the size of a matrix."""
    text = str(element.attrs["multiplicity"])
    return member is not None and format_bounds(writer, member.parent, text) is None


def _has_unexpressed_default(writer: Writer, member: Member | None, element: Element) -> bool:
    """Whether the text lacks the default: of a port or a type, or a text that is no string."""
    default = element.attrs["default"]
    if element.kind in (Kind.PORT, Kind.DATA_TYPE) or member is None:
        return True
    if "default_instance" in element.attrs:
        return True
    if not isinstance(default, str):
        return False
    if "default_language" in element.attrs:
        return not default
    return not format_literal(writer, member.parent, element, default).startswith('"')


def is_measure(element: Element) -> bool:
    """Whether an element is a unit or quantity kind that the model defines itself."""
    return element.role in ("unit", "quantity kind")


def _is_measure(_writer: Writer, _member: Member | None, element: Element) -> bool:
    return is_measure(element)


def _has_empty_default(_writer: Writer, _member: Member | None, element: Element) -> bool:
    return element.attrs.get("default") == ""


def _has_unexpressed_path(writer: Writer, _member: Member | None, element: Element) -> bool:
    """Whether the text lacks the path: only an item flow without connector has it as its chain."""
    is_item_flow = element.kind is Kind.ITEM_FLOW
    return not is_item_flow or bool(writer.graph.targets(element, Edge.REALIZING))


def _has_unexpressed_body(_writer: Writer, member: Member | None, element: Element) -> bool:
    """Whether the text spells the expression of a constraint differently, or omits its language."""
    if element.kind is not Kind.CONSTRAINT:
        return False
    text = str(element.attrs["body"])
    if not text:
        return True
    try:
        is_same = print_expression(tree_of(text)) == text
    except ExpressionError:
        return member is None
    return not is_same or "language" in element.attrs


def _has_unexpressed_language(_writer: Writer, _member: Member | None, element: Element) -> bool:
    if element.kind is not Kind.ACTIVITY:
        return element.kind is Kind.CONSTRAINT
    return not (element.attrs.get("body") or element.attrs.get("bodies"))


def _is_never_expressed(_writer: Writer, _member: Member | None, _element: Element) -> bool:
    return True


def _has_unexpressed_role(writer: Writer, _member: Member | None, element: Element) -> bool:
    """Whether no keyword states the role: an association is a block, a stereotype has values."""
    if element.kind is Kind.ASSOCIATION:
        return True
    owner = writer.graph.owner(element) if element.kind is Kind.PROPERTY else None
    return owner is not None and owner.kind is Kind.STEREOTYPE


_CHECKS: dict[str, _Check] = {
    "role": _has_unexpressed_role,
    "aggregation": _has_unexpressed_aggregation,
    "subkind": _has_unexpressed_subkind,
    "guard": _has_unexpressed_guard,
    "guard_literal": _is_flow,
    "direction": _has_unexpressed_direction,
    "conjugated": _has_unexpressed_conjugation,
    "value": _is_enumeration_literal,
    "visibility": _has_unexpressed_visibility,
    "multiplicity": _has_unexpressed_multiplicity,
    "default": _has_unexpressed_default,
    "default_instance": _is_never_expressed,
    "description": _is_measure,
    "decision_input_flow": _is_never_expressed,
    "source_path": _has_unexpressed_path,
    "target_path": _has_unexpressed_path,
    "default_language": _has_empty_default,
    "body": _has_unexpressed_body,
    "language": _has_unexpressed_language,
    "immediate": _waits_for_change,
}
