"""An input as bytes, the limits of its size, and the error of an input that cannot be read."""

import hashlib
from enum import StrEnum
from functools import cached_property

from msgspec import Struct


class Limits(Struct, frozen=True):
    """Limits of one input; sizes in bytes. Real archives have a ratio below 18."""

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
    """Unpacked size of all entries of an archive."""
    total_ratio: int = 50
    """Ratio of unpacked to packed size of an archive that unpacks to more than ``free_size``."""
    free_size: int = 64 << 20
    ratio: int = 200
    """Ratio of unpacked to packed size of an entry that unpacks to more than a megabyte."""


DEFAULT_LIMITS = Limits()
DOCUMENT_LIMITS = Limits(file_size=16 << 20)
"""Limits of documents written by hand: configuration, overlays, scenarios, contracts.

The largest in the corpus has 100 KiB; some readers take a hundred times the size in memory.
"""


class Fault(StrEnum):
    """Why an input cannot be read."""

    MALFORMED = "malformed"
    """The content is damaged or has the wrong form: exit code 1."""
    REFUSED = "refused"
    """The content is unsafe, such as a DOCTYPE or a path out of the archive: exit code 1."""
    LIMIT = "limit"
    """The input is larger or deeper than the limits: exit code 2."""
    MISSING = "missing"
    """The file cannot be opened: exit code 2."""
    CHANGING = "changing"
    """Another program is writing the file: exit code 2."""


class SourceError(Exception):
    """An input cannot be read; ``offset`` is the position of the fault in bytes, -1 if unknown."""

    def __init__(
        self, message: str, file: str, offset: int = -1, fault: Fault = Fault.MALFORMED
    ) -> None:
        super().__init__(message)
        self.message = message
        self.file = file
        self.offset = offset
        self.fault = fault

    @property
    def exit_code(self) -> int:
        """The exit code of the command: 1 for a fault of the input, 2 if it could not be read."""
        return 2 if self.fault in (Fault.LIMIT, Fault.MISSING, Fault.CHANGING) else 1


class Source(Struct, frozen=True, dict=True):
    """An input file, or an entry of an archive: its bytes, and its name in diagnostics and outputs.

    ``name`` is relative to the root of the compile unit, with ``/`` and in NFC; an entry of an
    archive is ``archive.mdzip!entry``.
    """

    name: str
    data: bytes
    digest: str = ""
    """SHA-256 of the file if ``data`` was converted to another encoding, else empty."""

    @cached_property
    def sha256(self) -> str:
        """SHA-256 of the file in hexadecimal digits."""
        return self.digest or hashlib.sha256(self.data).hexdigest()
