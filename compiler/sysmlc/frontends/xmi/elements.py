"""Adds the elements of rows to the graph, with what their kind, metaclass and feature imply."""

from itertools import islice

from sysmlc.diagnostics import Subject, Verdict
from sysmlc.frontends.xmi import metaclasses, rules
from sysmlc.frontends.xmi import vocabulary as v
from sysmlc.frontends.xmi.attributes import lower_attributes
from sysmlc.frontends.xmi.completions import COMPLETED_FEATURES, COMPLETIONS
from sysmlc.frontends.xmi.unit import ElementHandler, File, RowHandler
from sysmlc.ir import AttrValue, Element, Kind
from sysmlc.ir.element import derived_id
from sysmlc.sources import DEFAULT_LIMITS


def add_element(file: File, row: int, kind: Kind, subkind: str, type_name: str) -> bool:
    """Add the row's element with its attributes; return False if its owner cannot own the kind.

    *type_name* is the metaclass, which the row may omit.
    """
    document = file.document
    feature, owner = document.features[row], file.element_ids[row]
    if kind in metaclasses.OWNERS and not _may_own(file, owner, kind):
        return False
    values = document.attributes[row]
    id = _new_id(file, row, owner, feature)
    element = Element(
        id, kind, values.get("name", ""), owner or None, document.ordinals[row], document.name
    )
    implied = _imply_attributes(kind, subkind, type_name, feature)
    if implied:
        element.attrs = implied
    file.unit.graph.add(element)
    file.element_ids[row] = id
    file.elements[row] = element
    file.verdicts[row] = Verdict.MAPPED
    if kind in COMPLETIONS and feature in COMPLETED_FEATURES.get(kind, (feature,)):
        COMPLETIONS[kind](file, element, row)
    if len(values) > DEFAULT_LIMITS.attributes:
        values = _limit_attributes(file, row, values)
    lower_attributes(file, element, row, values)
    return True


def make_handler(type_name: str, complete: ElementHandler) -> RowHandler:
    """Return a handler that adds elements of one metaclass and then calls *complete*."""
    kind, subkind = metaclasses.KINDS[type_name]

    def lower(file: File, row: int) -> None:
        if add_element(file, row, kind, subkind, type_name):
            complete(file, file.unit.graph[file.element_ids[row]], row)
        else:
            file.mark_subtree(row, Verdict.UNSUPPORTED)

    return lower


def _new_id(file: File, row: int, owner: str, feature: str) -> str:
    """Return the id for the row's element: its own, else one derived from its position."""
    document, unit = file.document, file.unit
    id = document.attributes[row].get(document.id_key)
    if not id:
        owner = owner or document.name
        number = unit.positions[owner, feature]
        unit.positions[owner, feature] = number + 1
        return derived_id(owner, f"{feature}[{number}]")
    graph_id = unit.graph_id(document.name, id)
    if id in document.repeated_ids and graph_id in unit.graph:
        if not document.is_in_extension(row):
            subject = Subject(file.qualified_name(row), id, file.locate(row))
            unit.sink.report(rules.REPEATED_ID, subject, id=id, file=document.name)
        return derived_id(graph_id, str(document.ordinals[row]))
    return graph_id


def _may_own(file: File, owner: str, kind: Kind) -> bool:
    element = file.unit.graph.get(owner)
    return element is not None and element.kind in metaclasses.OWNERS[kind]


def _limit_attributes(file: File, row: int, values: dict[str, str]) -> dict[str, str]:
    most = DEFAULT_LIMITS.attributes
    name = file.qualified_name(row)
    subject = Subject(name, "", file.locate(row))
    file.unit.sink.report(
        rules.MANY_ATTRIBUTES, subject, element=name, count=len(values), most=most
    )
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
