"""Back end ``aml``: the structure of the graph as AutomationML, CAEX 3.0."""

from sysmlc.backends.aml.backend import BACKEND

__all__ = ["BACKEND"]
