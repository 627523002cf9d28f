"""Elements of the graph from rows: the way of every row that has no plan of its shape."""

from itertools import islice

from sysmlc.diagnostics import Subject, Verdict
from sysmlc.frontends.xmi import details, metaclasses, rules
from sysmlc.frontends.xmi import vocabulary as v
from sysmlc.frontends.xmi.context import Context
from sysmlc.frontends.xmi.keys import PASSED_OVER
from sysmlc.ir import Element, Kind
from sysmlc.sources import DEFAULT_LIMITS


def make(
    context: Context, row: int, kind: Kind, subkind: str, type_name: str, feature: str
) -> bool:
    """Add the row's element with its attributes; False where it cannot stand."""
    document = context.document
    owner = context.gids[row]
    if kind in metaclasses.OWNERS and not context.may_own(owner, kind):
        return False
    values = document.attributes[row]
    id = context.new_id(row, owner, feature)
    element = Element(
        id, kind, values.get("name", ""), owner or None, document.ordinals[row], document.name
    )
    said = details.attributes(kind, subkind, type_name, feature)
    if said:
        element.attrs = said
    context.graph.add(element)
    context.gids[row] = id
    context.lowered.own[row] = element
    context.verdicts[row] = Verdict.MAPPED
    detail = details.of(kind, feature)
    if detail is not None:
        detail(context, element, row, type_name, feature)
    if len(values) > DEFAULT_LIMITS.attributes:
        values = _first_attributes(context, row, values)
    for name, value in values.items():
        if name not in PASSED_OVER and "}" not in name:
            context.attribute(element, row, name, value)
        elif name in v.REDUNDANT:
            context.look(row, name, value)
    return True


def _first_attributes(context: Context, row: int, values: dict[str, str]) -> dict[str, str]:
    """As many attributes as an element may have."""
    most = DEFAULT_LIMITS.attributes
    name = context.qualified_name(row)
    subject = Subject(name, "", context.place(row))
    context.sink.report(rules.MANY_ATTRIBUTES, subject, element=name, count=len(values), most=most)
    return dict(islice(values.items(), most))
