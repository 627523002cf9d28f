"""Sources: bytes of the inputs, read safely."""

from sysmlc.sources.archive import entries, is_archive
from sysmlc.sources.error import Fault, SourceError
from sysmlc.sources.files import is_model_entry, load
from sysmlc.sources.limits import DEFAULT_LIMITS, Limits
from sysmlc.sources.roots import Roots
from sysmlc.sources.source import Source

__all__ = [
    "DEFAULT_LIMITS",
    "Fault",
    "Limits",
    "Roots",
    "Source",
    "SourceError",
    "entries",
    "is_archive",
    "is_model_entry",
    "load",
]
