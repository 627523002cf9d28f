"""How large an input may be."""

from msgspec import Struct


class Limits(Struct, frozen=True):
    """Limits of one input; sizes in bytes. Real archives stay below a ratio of 18."""

    file_size: int = 2 << 30
    depth: int = 500
    """Nesting of XML elements; expat alone accepts a million, real models stay below 50.

    Qualified names and XPaths of a chain of n elements take n * n characters in the outputs.
    """
    attributes: int = 1_000
    """Attributes of one XML element; real ones have some dozens."""
    references: int = 20_000
    """Ids in one list; real lists have some hundreds."""
    entries: int = 10_000
    """Entries of an archive."""
    total_size: int = 2 << 30
    """What all entries of an archive hold when unpacked."""
    total_ratio: int = 50
    """Unpacked to packed size of an archive, above the first ``free_size``."""
    free_size: int = 64 << 20
    ratio: int = 200
    """Unpacked to packed size of one entry, above the first megabyte."""


DEFAULT_LIMITS = Limits()
DOCUMENT_LIMITS = Limits(file_size=16 << 20)
"""Limits of what people write by hand beside models: configuration, overlays, scenarios, contracts.

The largest in the corpus has 100 KiB; the readers of some formats take a hundred times the size.
"""
