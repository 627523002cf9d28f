"""Front end for AutomationML: CAEX 2.15 and 3.0 (IEC 62424)."""

from sysmlc.frontends.caex.frontend import CaexFrontend

FRONTEND = CaexFrontend()

__all__ = ["FRONTEND", "CaexFrontend"]
