"""Back end ``sysmlx``: the model as interchange files of SysML v2 (XMI)."""

from sysmlc.backends.sysmlx.backend import BACKEND

__all__ = ["BACKEND"]
