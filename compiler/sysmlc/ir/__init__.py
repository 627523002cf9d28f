"""The graph IR: one typed property graph for SysML v1, SysML v2 and AutomationML."""

from sysmlc.ir.element import AttrValue, Element
from sysmlc.ir.graph import Graph
from sysmlc.ir.kinds import Edge, Kind
from sysmlc.ir.reference import Reference

__all__ = ["AttrValue", "Edge", "Element", "Graph", "Kind", "Reference"]
