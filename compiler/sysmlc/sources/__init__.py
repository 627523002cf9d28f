"""Sources: the bytes of input files and archive entries, read safely."""

from sysmlc.sources.archive import is_archive, read_entries
from sysmlc.sources.files import Roots, is_model_entry, load
from sysmlc.sources.source import DEFAULT_LIMITS, Fault, Limits, Source, SourceError

__all__ = [
    "DEFAULT_LIMITS",
    "Fault",
    "Limits",
    "Roots",
    "Source",
    "SourceError",
    "is_archive",
    "is_model_entry",
    "load",
    "read_entries",
]
