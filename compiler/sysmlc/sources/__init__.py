"""Sources: bytes of the inputs, read safely."""

from sysmlc.sources.source import Source

__all__ = ["Source"]
