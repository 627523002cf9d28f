"""The back end ``platform``: which element of the plant offers which service of the recipes."""

from sysmlc.backends.platform.backend import PlatformBackend

BACKEND = PlatformBackend()

__all__ = ["BACKEND", "PlatformBackend"]
