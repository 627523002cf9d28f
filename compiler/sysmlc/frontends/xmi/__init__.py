"""Front end for UML 2 and SysML v1 in XMI."""

from sysmlc.frontends.xmi.frontend import XmiFrontend

FRONTEND = XmiFrontend()

__all__ = ["FRONTEND", "XmiFrontend"]
