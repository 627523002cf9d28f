"""Front end for the XML of MTIP, also called HUDS: models that a plug-in exports from Cameo."""

from sysmlc.frontends.huds.frontend import FRONTEND

__all__ = ["FRONTEND"]
