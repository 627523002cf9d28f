"""Conditions that filter the members of packages, imports and views, and what views expose."""

from typing import TYPE_CHECKING

from sysmlc.frontends.sysml import nodes, values
from sysmlc.ir import Element, list_items
from sysmlc.language.tree import Node

if TYPE_CHECKING:
    from sysmlc.frontends.sysml.lowering import Lowering

_EXPOSE = "expose "


def lower_filter(lowering: "Lowering", condition: Node, owner: Element | None) -> None:
    """Add the condition that the members of a package or view fulfil to its ``filters``."""
    if owner is None:
        lowering.mark_ignored(condition)
    else:
        _append_text(lowering, owner, "filters", values.expression_text(condition, lowering))


def lower_expose(lowering: "Lowering", node: Node, owner: Element | None) -> None:
    """Add what a view exposes to its ``exposed``, with the condition in brackets."""
    if owner is None:
        lowering.mark_ignored(node)
        return
    document = lowering.document_of(node)
    source = "" if document is None else nodes.quote_source(node, document.text)
    names = ", ".join(str(relation.reference) for relation in node.relations)
    text = source.partition(_EXPOSE)[2].removesuffix(";") or names
    _append_text(lowering, owner, "exposed", text)


def _append_text(lowering: "Lowering", element: Element, key: str, text: str) -> None:
    texts = list_items(element.attrs.get(key))
    lowering.graph.set(element, **{key: (*texts, text)})
