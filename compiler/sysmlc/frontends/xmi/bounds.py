"""Multiplicities: two bounds, each written in a place of its own, as one text in UML notation."""

from sysmlc.frontends.xmi import rules
from sysmlc.frontends.xmi.context import Context
from sysmlc.frontends.xmi.values import is_natural
from sysmlc.ir import AttrValue, Element


def write(context: Context) -> None:
    """Give the elements of the document their multiplicities; report bounds that are none."""
    graph = context.graph
    for gid, (lower, upper) in context.bounds.items():
        text = multiplicity(lower, upper)
        if text:
            graph[gid].attrs["multiplicity"] = text
            if not (is_natural(lower) and (upper == "*" or is_natural(upper))):
                _check(context, graph[gid], text)


def multiplicity(lower: AttrValue, upper: AttrValue) -> str:
    """UML notation of two bounds; the empty string for exactly 1."""
    if lower == upper:
        return "" if lower == 1 else str(lower)
    return "*" if lower == 0 and upper == "*" else f"{lower}..{upper}"


def _check(context: Context, element: Element, text: str) -> None:
    """A bound may be an expression, as ``size``, but no text and no negative number."""
    if text != "*" and element.id not in context.computed:
        name = context.graph.qualified_name(element)
        subject = context.graph.subject(element)
        context.sink.report(rules.BAD_BOUND, subject, multiplicity=text, element=name)
