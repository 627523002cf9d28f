"""Back end ``sysml``: the graph in the textual notation of SysML v2."""

from sysmlc.backends.sysml.backend import BACKEND

__all__ = ["BACKEND"]
