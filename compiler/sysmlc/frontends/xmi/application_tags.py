"""Tagged values of applications: texts, values, and ids of the elements that they name."""

from sysmlc.diagnostics import Subject, Verdict
from sysmlc.frontends.xmi import metaclasses
from sysmlc.frontends.xmi.context import Context
from sysmlc.frontends.xmi.enterprise_architect.profiles import id_of
from sysmlc.frontends.xmi.rules import LOST_TAG
from sysmlc.frontends.xmi.values import value_of
from sysmlc.ir import AttrValue, Element
from sysmlc.ir.identity import is_made_by_tools

_NOT_TAGS = ("base_", "__EA")


def read(context: Context, element: Element, row: int) -> None:
    """Put what the application in the row says into the element, as attributes ``tag.<name>``."""
    document = context.document
    for name, written in document.attributes[row].items():
        if "}" not in name and not name.startswith(_NOT_TAGS):
            element.attrs[f"tag.{name}"] = value(context, element, row, name, written)
    if document.ends[row] == row + 1:
        return
    collected: dict[str, list[AttrValue]] = {}
    for child in document.children(row):
        feature = document.features[child]
        if not feature.startswith(_NOT_TAGS):
            collected.setdefault(feature, []).append(_child_tag(context, element, child))
    for feature, values in collected.items():
        element.attrs[f"tag.{feature}"] = values[0] if len(values) == 1 else tuple(values)


def value(context: Context, element: Element, row: int, name: str, written: str) -> AttrValue:
    """What an attribute of an application says: a text, or ids of the elements that it names."""
    tokens = written.split()
    if written[:1] == "{":
        return id_of(context, written) or written
    ids = context.document.ids
    if len(tokens) == 1 and tokens[0] not in ids and not is_made_by_tools(tokens[0]):
        return written
    if all(token in ids for token in tokens):
        known = tokens
    else:
        known = _existing(context, element, row, name, tokens)
    found = [_meant(context, token) for token in known]
    return written if not found else found[0] if len(tokens) == 1 else tuple(found)


def _existing(
    context: Context, element: Element, row: int, name: str, tokens: list[str]
) -> list[str]:
    """Ids of elements, when all tokens are ids; those that lead nowhere are reported."""
    missing = dict.fromkeys(token for token in tokens if not _is_known(context, token))
    if not all(map(is_made_by_tools, missing)):
        return []
    if missing:
        _report(context, element, row, name, *missing)
    return [token for token in tokens if token not in missing]


def _child_tag(context: Context, element: Element, child: int) -> AttrValue:
    document = context.document
    href, id = document.attributes[child].get("href", ""), document.idref(child)
    if href:
        if context.unit.find(context.lowered, href, True) is None:
            context.verdicts[child] = Verdict.EXTERNAL
        return context.unit.target_id(context.lowered, href, True) or href
    if id:
        if not _is_known(context, id):
            _report(context, element, child, document.features[child], id)
        return _meant(context, id)
    return document.texts.get(child, document.attributes[child].get("value", ""))


def _is_known(context: Context, id: str) -> bool:
    return id in context.document.ids or (
        is_made_by_tools(id) and context.unit.find(context.lowered, id, False) is not None
    )


def _meant(context: Context, id: str) -> AttrValue:
    """Id of the element that a local id means; what a value specification says is its value."""
    row = context.document.ids.get(id, -1)
    if row >= 0 and context.lowered.own[row] is not None:
        return context.gids[row]
    if row >= 0 and context.document.types[row] in metaclasses.VALUE_TYPES:
        return value_of(context.document, row).value
    return context.unit.target_id(context.lowered, id, False) or id


def _report(
    context: Context, element: Element, row: int, tag: str, target: str, *others: str
) -> None:
    name = context.graph.qualified_name(element)
    subject = Subject(name, element.id, context.place(row))
    notes = (f"and {len(others)} more",) if others else ()
    context.sink.report(
        LOST_TAG, subject, notes=notes, tag=tag, stereotype=element.name, target=target
    )
