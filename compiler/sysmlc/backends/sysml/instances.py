"""Instances and their slots: usages with bound values."""

from sysmlc.backends.sysml.annotations import is_part_of_class, make_annotation, write_annotations
from sysmlc.backends.sysml.declarations import list_visibility, refer_to_type
from sysmlc.backends.sysml.expressions import SIGNS, format_value
from sysmlc.backends.sysml.plan import Member
from sysmlc.backends.sysml.preserved_facts import format_fact_value
from sysmlc.backends.sysml.printing import Line, quote_name
from sysmlc.backends.sysml.rules import UNSAID_EDGE
from sysmlc.backends.sysml.writer import Writer
from sysmlc.ir import Edge, Element, Kind, list_items


def write_instance(writer: Writer, member: Member) -> list[Line]:
    """Write an instance: a usage of its classifiers; the instance of a part redefines the part."""
    element = member.require_element()
    if element.role in ("unit", "quantity kind"):
        return [_write_measure(writer, member, element)]
    part = writer.graph.target(element, Edge.REPRESENTS)
    if element.subkind == "part" and part is not None:
        return _write_part(writer, member, element, part)
    return [Line(_format_head(writer, member, element), _write_body(writer, member, element))]


def _format_head(writer: Writer, member: Member, element: Element) -> str:
    keyword, name = member.shape.keyword, quote_name(member.name) if member.name else ""
    words = [*list_visibility(writer, element), keyword, name]
    head = " ".join(word for word in words if word)
    types: list[str] = []
    subsets: list[str] = []
    for classifier in writer.graph.targets(element, Edge.INSTANCE_OF):
        type_name = refer_to_type(writer, member.parent, element, classifier)
        type_member = writer.plan.find(classifier)
        if type_name is not None:
            is_type = type_member is None or type_member.shape.is_definition
            (types if is_type else subsets).append(type_name)
    head += f" : {', '.join(types)}" if types else ""
    return head + (f" :> {', '.join(subsets)}" if subsets else "")


def _write_body(writer: Writer, member: Member, element: Element) -> list[Line]:
    lines = write_annotations(writer, member)
    for child in writer.graph.owned(element):
        if child.kind is Kind.SLOT:
            writer.expressed.add(child.id)
            lines += _write_slot(writer, member, child)
    return lines + writer.write_members(member)


# -- parts of instances --------------------------------------------------------------------------


def _write_part(writer: Writer, member: Member, element: Element, part: Element) -> list[Line]:
    """Write the values of a part, nested in redefinitions of the parts that lead to it."""
    body = _write_body(writer, member, element)
    path = [writer.graph.get(str(id)) for id in list_items(element.attrs.get("path"))]
    steps = [*(step for step in path if step is not None and step is not part), part]
    name = writer.refer_to_redefined(member.parent, steps[0])
    if name is None:
        return writer.drop(member, "represents")
    for step in reversed(steps[1:]):
        body = [Line(f"part :>> {quote_name(step.name)}", body)]
        if is_part_of_class(writer, element):
            body.insert(0, make_annotation(writer, member, "AutomationML", {"kind": "part"}))
    return [Line(f"part {_choose_operator(writer, member, element, steps[0])} {name}", body)]


def _choose_operator(writer: Writer, member: Member, element: Element, part: Element) -> str:
    """Return ``:>>``, or ``:>`` for a sibling: a member must not redefine one of its own owner."""
    part_member = writer.plan.find(part)
    if part_member is None or part_member.parent is None:
        return ":>>"
    if part_member.parent is not member.parent:
        return ":>>"
    writer.record_approximation(element, "values of a part beside it", "a subset of the part")
    return ":>"


# -- slots ---------------------------------------------------------------------------------------


def _write_slot(writer: Writer, member: Member, slot: Element) -> list[Line]:
    """Write the redefinition of a feature with its value; a list if there are several values."""
    feature = writer.graph.target(slot, Edge.INSTANCE_OF)
    feature_member = writer.plan.find(feature)
    # Of a feature outside of the model only the id may be known: its stub is a definition.
    is_feature = feature_member is not None and not feature_member.shape.is_definition
    name = writer.refer_to_redefined(member, feature) if feature and is_feature else None
    children = [line for child in writer.graph.owned(slot) for line in _write_child(writer, child)]
    if name is None or feature is None:
        if feature is None or not feature.attrs.get("library"):
            writer.record_unreachable(slot, "instance-of")
        return children
    value = _format_slot_value(writer, member, slot, feature)
    is_port = feature_member is not None and feature_member.shape.keyword == "port"
    keyword = "port " if is_port else ""
    values = tuple(
        f"{key.removeprefix('value.')}={format_fact_value(value)}"
        for key, value in slot.attrs.items()
        if key.startswith("value.")
    )
    body = [make_annotation(writer, member, "AutomationML", {"values": values})] if values else []
    return [Line(f"{keyword}:>> {name}{value}", body), *children]


def _write_child(writer: Writer, element: Element) -> list[Line]:
    member = writer.plan.find(element)
    return [] if member is None else writer.write_member(member)


def _format_slot_value(writer: Writer, member: Member, slot: Element, feature: Element) -> str:
    names = writer.refer_to_all(member, slot, Edge.REFERENCES, _list_values(writer, slot))
    sign = SIGNS[str(slot.attrs.get("value_kind", "bound"))]
    if "value" in slot.attrs:
        return f" {sign} {format_value(writer, member, feature, slot)}"
    if not names:
        return ""
    return f" {sign} {names[0] if len(names) == 1 else '(' + ', '.join(names) + ')'}"


def _list_values(writer: Writer, slot: Element) -> list[Element]:
    """Return the elements that are values of a slot; record the loss of definitions among them.

    An instance outside of the model, of which only the id is known, is written as a definition.
    """
    values = []
    for target in writer.graph.targets(slot, Edge.REFERENCES):
        target_member = writer.plan.find(target)
        if target_member is not None and target_member.shape.is_definition:
            facts = {"edge": "references", "kind": str(slot.kind), "target": str(target.kind)}
            writer.losses.record(UNSAID_EDGE, slot, **facts)
        else:
            values.append(target)
    return values


# -- units ---------------------------------------------------------------------------------------


def _write_measure(writer: Writer, member: Member, element: Element) -> Line:
    """Write a unit or quantity kind that the model defines itself; its slots are not written."""
    symbol = element.attrs.get("symbol")
    siblings = member.parent.members if member.parent else writer.plan.roots
    names = {sibling.name for sibling in siblings}
    short_name = f"<{quote_name(str(symbol))}> " if symbol and str(symbol) not in names else ""
    is_unit = element.role == "unit"
    type_ = "MeasurementReferences::SimpleUnit" if is_unit else "Quantities::QuantityDimension"
    body = write_annotations(writer, member)
    writer.expressed.update(child.id for child in writer.graph.owned(element))
    body += writer.write_members(member)
    type_name = writer.refer_to_library(member.parent, type_)
    return Line(f"attribute {short_name}{quote_name(member.name)} : {type_name}", body)
