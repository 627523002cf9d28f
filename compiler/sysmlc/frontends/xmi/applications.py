"""Applications of stereotypes: siblings of the model that refer to their base elements."""

from typing import NamedTuple

from sysmlc.diagnostics import Subject, Verdict
from sysmlc.frontends.xmi import metaclasses
from sysmlc.frontends.xmi.document import WrittenReference
from sysmlc.frontends.xmi.enterprise_architect import find_id_by_guid, read_stereotype_name
from sysmlc.frontends.xmi.rules import BASELESS, LOST_TAG
from sysmlc.frontends.xmi.unit import File, Target
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


def lower_applications(file: File) -> None:
    """Lower the applications that the walk over the document has found."""
    for row in file.applications:
        _lower_application(file, row)


def _lower_application(file: File, row: int) -> None:
    document = file.document
    references = _list_bases(file, row)
    targets = [file.find_target(r) for r in references]
    is_on_notation = bool(targets) and all(
        target is not None and target.verdict is Verdict.IGNORED_NOTATION for target in targets
    )
    if f"{_BASE}Diagram" in document.attributes[row] or is_on_notation:
        file.mark_subtree(row, Verdict.IGNORED_NOTATION)
        return
    bases = [target for target in targets if target is not None and target.element]
    folded_bases = [] if bases else _list_folded_bases(file, targets)
    if folded_bases:
        _add_folded_application(file, row, folded_bases)
        return
    if not bases and not any(reference.is_href for reference in references):
        file.mark_subtree(row, Verdict.UNSUPPORTED)
        file.losses[row] = BASELESS, "applied to a missing element"
        return
    file.mark_subtree(row, Verdict.MAPPED if bases else Verdict.EXTERNAL)
    application = _add_application(file, row, bases[0].element_id if bases else None)
    for reference in references:
        file.add_reference(Edge.SUBJECT, application.id, reference, "subject")
    _store_tags(file, application, row)
    _apply_sysml_meaning(file, application, row, bases)


def _list_bases(file: File, row: int) -> list[WrittenReference]:
    """Return the references to base elements, each target once."""
    document = file.document
    features = [name for name in document.attributes[row] if name.startswith(_BASE)]
    children = [document.features[child] for child in document.children(row)]
    features += [feature for feature in children if feature.startswith(_BASE)]
    bases: dict[str, WrittenReference] = {}
    for feature in dict.fromkeys(features):
        for reference in document.references(row, feature):
            bases.setdefault(reference.target, reference)
    return list(bases.values())


def _list_folded_bases(file: File, targets: list[Target | None]) -> list[_FoldedBase]:
    """Return the bases that became part of another element, such as a generalization."""
    return [
        _FoldedBase(holder, metaclasses.to_kebab_case(target.type))
        for target in targets
        if target is not None and target.verdict is Verdict.MAPPED and target.type
        for holder in _find_holders(file, target)
    ]


def _find_holders(file: File, target: Target) -> list[str]:
    """Return the triggers that refer to an event, else the element that contains the target."""
    if target.type not in metaclasses.EVENT_TYPES:
        return [target.element_id] if target.element_id else []
    if target.file is not file:
        return []
    return file.triggers_by_event.get(target.document.id(target.row), [])


def _add_folded_application(file: File, row: int, bases: list[_FoldedBase]) -> None:
    file.mark_subtree(row, Verdict.MAPPED)
    application = _add_application(file, row, bases[0].holder)
    application.attrs["on"] = bases[0].metaclass
    for base in bases:
        file.unit.graph.connect(Edge.REFERENCES, application, base.holder)
    _store_tags(file, application, row)


def _add_application(file: File, row: int, owner: str | None) -> Element:
    document = file.document
    name, namespace = read_stereotype_name(file, row)
    stereotype = file.unit.profiles.find_stereotype(
        file.unit.graph, document.namespace(row), document.features[row]
    )
    id = document.id(row)
    graph_id = file.unit.graph_id(document.name, id) if id else ""
    ordinal = document.ordinals[row]
    if not graph_id or graph_id in file.unit.graph:
        graph_id = derived_id(owner or document.name, f"{name}[{ordinal}]")
    attributes: dict[str, AttrValue] = {"stereotype": name, "namespace": namespace}
    application = file.unit.graph.add(
        Element(graph_id, Kind.APPLICATION, name, owner, ordinal, document.name, attributes)
    )
    file.element_ids[row] = application.id
    if stereotype is not None:
        file.unit.graph.connect(Edge.INSTANCE_OF, application, stereotype)
    return application


# -- tagged values ---------------------------------------------------------------------------------


def _store_tags(file: File, application: Element, row: int) -> None:
    """Store the tagged values of the row as attributes ``tag.<name>``."""
    document = file.document
    for name, text in document.attributes[row].items():
        if "}" not in name and not name.startswith(_NO_TAGS):
            application.attrs[f"tag.{name}"] = _read_tag(file, application, row, name, text)
    values_by_feature: dict[str, list[AttrValue]] = {}
    for child in document.children(row):
        feature = document.features[child]
        if not feature.startswith(_NO_TAGS):
            value = _read_child_tag(file, application, child)
            values_by_feature.setdefault(feature, []).append(value)
    for feature, values in values_by_feature.items():
        application.attrs[f"tag.{feature}"] = values[0] if len(values) == 1 else tuple(values)


def _read_tag(file: File, application: Element, row: int, name: str, text: str) -> AttrValue:
    """Return the value of an attribute: text, or ids of the elements that it names."""
    if text[:1] == "{":
        return find_id_by_guid(file, text) or text
    tokens = text.split()
    ids = file.document.ids
    if len(tokens) == 1 and tokens[0] not in ids and not is_generated(tokens[0]):
        return text
    if all(token in ids for token in tokens):
        existing = tokens
    else:
        existing = _select_existing(file, application, row, name, tokens)
    values = [_read_target(file, token) for token in existing]
    return text if not values else values[0] if len(tokens) == 1 else tuple(values)


def _select_existing(
    file: File, application: Element, row: int, name: str, tokens: list[str]
) -> list[str]:
    """Return the tokens that are ids of elements; report other ids. Empty if a token is no id."""
    missing = dict.fromkeys(token for token in tokens if not _has_target(file, token))
    if not all(map(is_generated, missing)):
        return []
    if missing:
        _report_lost_tag(file, application, row, name, *missing)
    return [token for token in tokens if token not in missing]


def _read_child_tag(file: File, application: Element, child: int) -> AttrValue:
    document = file.document
    href, id = document.href(child), document.idref(child)
    if href:
        if file.unit.find_target(file, href, True) is None:
            file.verdicts[child] = Verdict.EXTERNAL
        return file.unit.find_target_id(file, href, True) or href
    if id:
        if not _has_target(file, id):
            _report_lost_tag(file, application, child, document.features[child], id)
        return _read_target(file, id)
    return document.texts.get(child, document.attributes[child].get("value", ""))


def _has_target(file: File, id: str) -> bool:
    return id in file.document.ids or (
        is_generated(id) and file.unit.find_target(file, id, False) is not None
    )


def _read_target(file: File, id: str) -> AttrValue:
    """Return the graph id of the element with a local id, or the value of a value specification."""
    row = file.document.ids.get(id, -1)
    if row >= 0 and file.elements[row] is not None:
        return file.element_ids[row]
    if row >= 0 and file.document.types[row] in metaclasses.VALUE_TYPES:
        return read_value(file.document, row).value
    return file.unit.find_target_id(file, id, False) or id


def _report_lost_tag(
    file: File, application: Element, row: int, tag: str, target: str, *others: str
) -> None:
    name = file.unit.graph.qualified_name(application)
    subject = Subject(name, application.id, file.locate(row))
    notes = (f"and {len(others)} more",) if others else ()
    file.unit.sink.report(
        LOST_TAG, subject, notes=notes, tag=tag, stereotype=application.name, target=target
    )


# -- stereotypes of SysML --------------------------------------------------------------------------


def _apply_sysml_meaning(file: File, application: Element, row: int, bases: list[Target]) -> None:
    """Add what stereotypes of SysML state about their base elements."""
    document = file.document
    if not bases:
        return
    if application.name == "ItemFlow":
        flow = file.unit.graph[bases[0].element_id]
        item = application.attrs.get("tag.itemProperty")
        if isinstance(item, str) and flow.kind is Kind.ITEM_FLOW:
            file.unit.graph.set(flow, item_property=item)
    for feature in _UNIT_TAGS:
        _refer_to_unit(file, row, feature, bases[0].element_id)
    path = document.references(row, "propertyPath")
    if path:
        for base in bases:
            file.unit.nested_paths[base.element_id] = (file, path)


def _refer_to_unit(file: File, row: int, feature: str, value_type: str) -> None:
    """Refer to a unit of measure in a library outside the compile unit; it becomes a stub."""
    for reference in file.document.references(row, feature):
        if not reference.is_href:
            continue
        if file.unit.find_target(file, reference.target, True) is None:
            file.add_reference(Edge.REFERENCES, value_type, reference, feature)
