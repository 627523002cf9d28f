"""Front end for SysML v2 and KerML: text, XMI and archives become the graph of docs/ir.md."""

from sysmlc.frontends.sysml.frontend import FRONTEND

__all__ = ["FRONTEND"]
