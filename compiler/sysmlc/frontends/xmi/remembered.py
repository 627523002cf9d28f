"""Columns of files as an earlier run read them: in a unit of many only what changed is parsed."""

import marshal
import sys
from collections import Counter
from pathlib import Path

from sysmlc import __version__
from sysmlc.cache import Cache
from sysmlc.frontends.xmi import columns, document, indexing, parsing, pieces, prefixes, tags
from sysmlc.frontends.xmi.document import Document
from sysmlc.sources import Source

_COLUMNS = tuple(name for name in Document.__slots__ if name != "name")
_MODULES = (columns, document, indexing, parsing, pieces, prefixes, tags)
_SMALL = 1 << 15
"""Bytes below which parsing costs no more than looking into the cache."""


def read(source: Source, cache: Cache | None) -> Document:
    """The columns of the file, from the cache when it has them. Raises SourceError."""
    if cache is None or len(source.data) < _SMALL:
        return parsing.read(source)
    key = f"{source.sha256}-xmi-{_code()}"
    found = _from_entry(source.name, cache.get(key))
    if found is None:
        found = parsing.read(source)
        cache.put(key, _entry(found))
    return found


def _entry(read: Document) -> bytes:
    values = [getattr(read, column) for column in _COLUMNS]
    return marshal.dumps([dict(v) if isinstance(v, Counter) else v for v in values])


def _from_entry(name: str, entry: bytes | None) -> Document | None:
    if entry is None:
        return None
    try:
        values = marshal.loads(entry)
    except (EOFError, TypeError, ValueError):
        return None
    if not isinstance(values, list) or len(values) != len(_COLUMNS):
        return None
    found = Document(name)
    for column, value in zip(_COLUMNS, values, strict=True):
        setattr(found, column, Counter(value) if column == "drawn" else value)
    return found


def _code() -> str:
    """What the form of an entry depends on: Python, our version, and the code that makes it."""
    files = (
        Path(str(module.__file__)).stat()
        for module in (columns, indexing, parsing, pieces, prefixes, tags)
    )
    stamps = "-".join(f"{stat.st_size:x}-{stat.st_mtime_ns:x}" for stat in files)
    return f"{sys.version_info.major}.{sys.version_info.minor}-{__version__}-{stamps}"
