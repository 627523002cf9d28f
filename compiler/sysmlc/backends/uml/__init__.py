"""Back end ``uml``: the graph as SysML v1 in XMI, as Papyrus saves it."""

from sysmlc.backends.uml.backend import BACKEND

__all__ = ["BACKEND"]
