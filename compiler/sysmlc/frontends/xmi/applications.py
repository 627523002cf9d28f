"""Applications of stereotypes: siblings of the model that refer to their base elements."""

from typing import NamedTuple

from sysmlc.diagnostics import Subject, Verdict
from sysmlc.frontends.xmi import metaclasses
from sysmlc.frontends.xmi.context import Context
from sysmlc.frontends.xmi.document import WrittenReference
from sysmlc.frontends.xmi.enterprise_architect import find_id_by_guid, read_stereotype_name
from sysmlc.frontends.xmi.rules import LOST_TAG
from sysmlc.frontends.xmi.unit import LoweredDocument, Target
from sysmlc.frontends.xmi.values import read_value
from sysmlc.ir import AttrValue, Edge, Element, Kind
from sysmlc.ir.element import derived_id, is_generated

_BASE = "base_"
_NO_TAGS = (_BASE, "__EA")
_UNIT_TAGS = ("unit", "quantityKind", "dimension")
"""Tags of ``ValueType`` that refer to libraries (SysML 1.6 clause 8.3.2.16)."""


class _FoldedBase(NamedTuple):
    """A base element that is no element of the graph, but content of *holder*."""

    holder: str
    metaclass: str


def lower_applications(context: Context) -> None:
    """Lower the applications that the walk over the document has found."""
    for row in context.applications:
        _lower_application(context, row)
    for end, row in context.connector_ends:
        _lower_connector_path(context, end, row)


def _lower_application(context: Context, row: int) -> None:
    document = context.document
    references = _list_bases(context, row)
    targets = [context.unit.find_target(context.file, r.target, r.is_href) for r in references]
    is_on_notation = bool(targets) and all(
        target is not None and target.verdict is Verdict.IGNORED_NOTATION for target in targets
    )
    if f"{_BASE}Diagram" in document.attributes[row] or is_on_notation:
        context.mark_subtree(row, Verdict.IGNORED_NOTATION)
        return
    bases = [target for target in targets if target is not None and target.element]
    folded_bases = [] if bases else _list_folded_bases(context, targets)
    if folded_bases:
        _add_folded_application(context, row, folded_bases)
        return
    if not bases and not any(reference.is_href for reference in references):
        context.mark_subtree(row, Verdict.UNSUPPORTED)
        context.baseless_applications.append(row)
        return
    context.mark_subtree(row, Verdict.MAPPED if bases else Verdict.EXTERNAL)
    application = _add_application(context, row, bases[0].element_id if bases else None)
    for reference in references:
        context.add_reference(Edge.SUBJECT, application.id, reference, "subject")
    _store_tags(context, application, row)
    _apply_sysml_meaning(context, application, row, bases)


def _list_bases(context: Context, row: int) -> list[WrittenReference]:
    """Return the references to base elements, each target once."""
    document = context.document
    features = [name for name in document.attributes[row] if name.startswith(_BASE)]
    children = [document.features[child] for child in document.children(row)]
    features += [feature for feature in children if feature.startswith(_BASE)]
    bases: dict[str, WrittenReference] = {}
    for feature in dict.fromkeys(features):
        for reference in document.references(row, feature):
            bases.setdefault(reference.target, reference)
    return list(bases.values())


def _list_folded_bases(context: Context, targets: list[Target | None]) -> list[_FoldedBase]:
    """Return the bases that became part of another element, such as a generalization."""
    return [
        _FoldedBase(holder, metaclasses.to_kebab_case(target.type))
        for target in targets
        if target is not None and target.verdict is Verdict.MAPPED and target.type
        for holder in _find_holders(context, target)
    ]


def _find_holders(context: Context, target: Target) -> list[str]:
    """Return the triggers that refer to an event, else the element that contains the target."""
    if target.type not in metaclasses.EVENT_TYPES:
        return [target.element_id] if target.element_id else []
    if target.file is not context.file:
        return []
    id = target.document.id(target.row)
    return [
        trigger.id
        for trigger, row in context.triggers
        if id in context.document.targets(row, "event")
    ]


def _add_folded_application(context: Context, row: int, bases: list[_FoldedBase]) -> None:
    context.mark_subtree(row, Verdict.MAPPED)
    application = _add_application(context, row, bases[0].holder)
    application.attrs["on"] = bases[0].metaclass
    for base in bases:
        context.graph.connect(Edge.REFERENCES, application, base.holder)
    _store_tags(context, application, row)


def _add_application(context: Context, row: int, owner: str | None) -> Element:
    document = context.document
    name, namespace = read_stereotype_name(context, row)
    stereotype = context.unit.profiles.find_stereotype(
        context.graph, document.namespace(row), document.features[row]
    )
    id = document.id(row)
    graph_id = context.unit.graph_id(document.name, id) if id else ""
    ordinal = document.ordinals[row]
    if not graph_id or graph_id in context.graph:
        graph_id = derived_id(owner or document.name, f"{name}[{ordinal}]")
    attributes: dict[str, AttrValue] = {"stereotype": name, "namespace": namespace}
    application = context.graph.add(
        Element(graph_id, Kind.APPLICATION, name, owner, ordinal, document.name, attributes)
    )
    context.element_ids[row] = application.id
    if stereotype is not None:
        context.graph.connect(Edge.INSTANCE_OF, application, stereotype)
    return application


# -- tagged values ---------------------------------------------------------------------------------


def _store_tags(context: Context, application: Element, row: int) -> None:
    """Store the tagged values of the row as attributes ``tag.<name>``."""
    document = context.document
    for name, text in document.attributes[row].items():
        if "}" not in name and not name.startswith(_NO_TAGS):
            application.attrs[f"tag.{name}"] = _read_tag(context, application, row, name, text)
    values_by_feature: dict[str, list[AttrValue]] = {}
    for child in document.children(row):
        feature = document.features[child]
        if not feature.startswith(_NO_TAGS):
            value = _read_child_tag(context, application, child)
            values_by_feature.setdefault(feature, []).append(value)
    for feature, values in values_by_feature.items():
        application.attrs[f"tag.{feature}"] = values[0] if len(values) == 1 else tuple(values)


def _read_tag(context: Context, application: Element, row: int, name: str, text: str) -> AttrValue:
    """Return the value of an attribute: text, or ids of the elements that it names."""
    if text[:1] == "{":
        return find_id_by_guid(context, text) or text
    tokens = text.split()
    ids = context.document.ids
    if len(tokens) == 1 and tokens[0] not in ids and not is_generated(tokens[0]):
        return text
    if all(token in ids for token in tokens):
        existing = tokens
    else:
        existing = _select_existing(context, application, row, name, tokens)
    values = [_read_target(context, token) for token in existing]
    return text if not values else values[0] if len(tokens) == 1 else tuple(values)


def _select_existing(
    context: Context, application: Element, row: int, name: str, tokens: list[str]
) -> list[str]:
    """Return the tokens that are ids of elements; report other ids. Empty if a token is no id."""
    missing = dict.fromkeys(token for token in tokens if not _has_target(context, token))
    if not all(map(is_generated, missing)):
        return []
    if missing:
        _report_lost_tag(context, application, row, name, *missing)
    return [token for token in tokens if token not in missing]


def _read_child_tag(context: Context, application: Element, child: int) -> AttrValue:
    document = context.document
    href, id = document.href(child), document.idref(child)
    if href:
        if context.unit.find_target(context.file, href, True) is None:
            context.verdicts[child] = Verdict.EXTERNAL
        return context.unit.find_target_id(context.file, href, True) or href
    if id:
        if not _has_target(context, id):
            _report_lost_tag(context, application, child, document.features[child], id)
        return _read_target(context, id)
    return document.texts.get(child, document.attributes[child].get("value", ""))


def _has_target(context: Context, id: str) -> bool:
    return id in context.document.ids or (
        is_generated(id) and context.unit.find_target(context.file, id, False) is not None
    )


def _read_target(context: Context, id: str) -> AttrValue:
    """Return the graph id of the element with a local id, or the value of a value specification."""
    row = context.document.ids.get(id, -1)
    if row >= 0 and context.elements[row] is not None:
        return context.element_ids[row]
    if row >= 0 and context.document.types[row] in metaclasses.VALUE_TYPES:
        return read_value(context.document, row).value
    return context.unit.find_target_id(context.file, id, False) or id


def _report_lost_tag(
    context: Context, application: Element, row: int, tag: str, target: str, *others: str
) -> None:
    name = context.graph.qualified_name(application)
    subject = Subject(name, application.id, context.locate(row))
    notes = (f"and {len(others)} more",) if others else ()
    context.sink.report(
        LOST_TAG, subject, notes=notes, tag=tag, stereotype=application.name, target=target
    )


# -- stereotypes of SysML --------------------------------------------------------------------------


def _apply_sysml_meaning(
    context: Context, application: Element, row: int, bases: list[Target]
) -> None:
    """Add what stereotypes of SysML state about their base elements."""
    document = context.document
    if not bases:
        return
    if application.name == "ItemFlow":
        flow = context.graph[bases[0].element_id]
        item = application.attrs.get("tag.itemProperty")
        if isinstance(item, str) and flow.kind is Kind.ITEM_FLOW:
            context.graph.set(flow, item_property=item)
    for feature in _UNIT_TAGS:
        _refer_to_unit(context, row, feature, bases[0].element_id)
    path = document.references(row, "propertyPath")
    if path:
        for base in bases:
            context.unit.nested_paths[base.element_id] = (context.file, path)


def _refer_to_unit(context: Context, row: int, feature: str, value_type: str) -> None:
    """Refer to a unit of measure in a library outside the compile unit; it becomes a stub."""
    for reference in context.document.references(row, feature):
        if not reference.is_href:
            continue
        if context.unit.find_target(context.file, reference.target, True) is None:
            context.add_reference(Edge.REFERENCES, value_type, reference, feature)


def _lower_connector_path(context: Context, end: Element, row: int) -> None:
    """Add the path of a connector end: its nested path, and the part that has the port.

    MagicDraw repeats that part in the nested path, and other tools repeat the role.
    """
    document = context.document
    nested_file, nested = context.unit.nested_paths.get(end.id, (context.file, []))
    part_with_port = document.references(row, "partWithPort")
    roles = {_fragment(role) for role in document.references(row, "role")}
    roles -= {_fragment(part) for part in part_with_port}
    while nested and _fragment(nested[-1]) in roles:
        nested = nested[:-1]
    nested_ids = {_fragment(step) for step in nested}
    steps: list[tuple[LoweredDocument, WrittenReference]]
    steps = [(nested_file, step) for step in nested]
    steps += [(context.file, part) for part in part_with_port if _fragment(part) not in nested_ids]
    for file, step in steps:
        context.add_reference(Edge.PATH, end.id, step, "partWithPort", file=file)


def _fragment(reference: WrittenReference) -> str:
    return reference.target.rpartition("#")[2]
