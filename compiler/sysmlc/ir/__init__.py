"""The graph IR: one typed property graph for SysML v1, SysML v2 and AutomationML."""

from importlib import import_module
from typing import TYPE_CHECKING

from sysmlc.ir.element import AttrValue, Element, as_items, as_texts, derived_id, list_items
from sysmlc.ir.graph import Graph
from sysmlc.ir.kinds import Edge, Kind
from sysmlc.ir.pending import Reference
from sysmlc.ir.verify import verify

if TYPE_CHECKING:
    from sysmlc.ir.text import IrSyntaxError, parse_text, print_text

__all__ = [
    "AttrValue",
    "Edge",
    "Element",
    "Graph",
    "IrSyntaxError",
    "Kind",
    "Reference",
    "as_items",
    "as_texts",
    "derived_id",
    "list_items",
    "parse_text",
    "print_text",
    "verify",
]


def __getattr__(name: str) -> object:
    """Import the text form at its first use: most runs neither read nor write it."""
    if name in ("IrSyntaxError", "parse_text", "print_text"):
        return getattr(import_module("sysmlc.ir.text"), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
