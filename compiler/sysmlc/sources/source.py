"""One input file, or one entry of an archive, as bytes."""

import hashlib
from functools import cached_property

from msgspec import Struct


class Source(Struct, frozen=True, dict=True):
    """Bytes and the name that diagnostics and outputs use for them.

    ``name`` is relative to the root of the compile unit, with ``/`` and in NFC; an entry of an
    archive is ``archive.mdzip!entry``.
    """

    name: str
    data: bytes
    digest: str = ""
    """SHA-256 of the file, when the bytes are not as the file has them."""

    @cached_property
    def sha256(self) -> str:
        """SHA-256 of the bytes as the file has them, in hex."""
        return self.digest or hashlib.sha256(self.data).hexdigest()
