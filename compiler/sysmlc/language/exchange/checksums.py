"""Checksums of the files of a project, by the algorithms that KerML 1.0, 10.3, names."""

import hashlib
import zlib

from sysmlc.sources import Source

_ALGORITHMS = {
    "SHA1": "sha1",
    "SHA224": "sha224",
    "SHA256": "sha256",
    "SHA384": "sha384",
    "SHA512": "sha512",
    "SHA3256": "sha3_256",
    "SHA3384": "sha3_384",
    "SHA3512": "sha3_512",
    "MD5": "md5",
}
_BLAKE = {"BLAKE2B256": 32, "BLAKE2B384": 48, "BLAKE2B512": 64}


def digest(source: Source, algorithm: str) -> str | None:
    """The checksum in hex, or None for an algorithm that is not known; hyphens do not count."""
    known = algorithm.upper().replace("-", "")
    if known == "SHA256":
        return source.sha256
    if known in _ALGORITHMS:
        return hashlib.new(_ALGORITHMS[known], source.data, usedforsecurity=False).hexdigest()
    if known in _BLAKE:
        return hashlib.blake2b(source.data, digest_size=_BLAKE[known]).hexdigest()
    if known == "ADLER32":
        return f"{zlib.adler32(source.data):08x}"
    return None
