"""Constraints of elements that only Enterprise Architect's extension tells of."""

from sysmlc.diagnostics import Verdict
from sysmlc.frontends.xmi.context import Context
from sysmlc.ir import Element, Kind
from sysmlc.ir.identity import derived_id

_SUBKINDS = {
    "pre-condition": "precondition",
    "post-condition": "postcondition",
    "invariant": "invariant",
}
_TEXTS = ("notes", "description", "documentation")
"""Attributes that hold what a constraint says, as versions of the tool call them."""


def constraints(context: Context, element: Element, row: int) -> None:
    """``<constraints><constraint name= type=>``; those that the model has too stay one."""
    document = context.document
    for number, child in enumerate(document.children(row, "constraint")):
        values = document.attributes[child]
        body = next((values[name] for name in _TEXTS if values.get(name)), "")
        name = values.get("name", "")
        if not name and not body:
            continue
        context.verdicts[row] = context.verdicts[child] = Verdict.MAPPED
        if not any(_is_same(one, name, body) for one in context.graph.owned(element)):
            id = derived_id(element.id, f"constraint[{number}]")
            _add(context, element, child, id, name, body)


def _is_same(known: Element, name: str, body: str) -> bool:
    is_named = bool(name) and known.name == name
    return known.kind is Kind.CONSTRAINT and (is_named or known.attrs.get("body") == (body or name))


def _add(context: Context, element: Element, row: int, id: str, name: str, body: str) -> None:
    document = context.document
    made = Element(
        id, Kind.CONSTRAINT, name if body else "", element.id, document.ordinals[row], document.name
    )
    # Who writes a formula in Enterprise Architect writes it where other tools have the name.
    made.attrs["body"] = body or name
    type_name = document.attributes[row].get("type", "")
    if type_name.lower() in _SUBKINDS:
        made.attrs["subkind"] = _SUBKINDS[type_name.lower()]
    elif type_name.upper() == "OCL":
        made.attrs["language"] = "OCL"
    elif type_name:
        made.attrs["tag.type"] = type_name
    context.graph.add(made)
