"""The graph IR: one typed property graph for SysML v1, SysML v2 and AutomationML."""

from sysmlc.ir.element import AttrValue, Element
from sysmlc.ir.graph import Graph
from sysmlc.ir.identity import derived_id
from sysmlc.ir.kinds import Edge, Kind
from sysmlc.ir.reference import Reference
from sysmlc.ir.text import IrSyntaxError, parse_text, print_text
from sysmlc.ir.verify import verify

__all__ = [
    "AttrValue",
    "Edge",
    "Element",
    "Graph",
    "IrSyntaxError",
    "Kind",
    "Reference",
    "derived_id",
    "parse_text",
    "print_text",
    "verify",
]
